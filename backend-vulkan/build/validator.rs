//! Compiles the validator of SPIRV-Tools, from the sources in the crate `spirv-tools-sys`.
//!
//! The GLSL compiler brings SPIRV-Tools along as well: Debian 12's is of 2023 and refuses what today's compilers write. Two versions
//! have the same symbols and don't go into one program. So the validator is linked into one object whose symbols are local, but for
//! the function in `validator.cpp`. The optimiser isn't compiled, which would take several times as long.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The version of the crate with the sources, as in the workspace's `Cargo.toml`.
const VERSION: &str = "0.13.3";

/// The one function that is seen from outside.
const FUNCTION: &str = "framewright_validate_spirv";

/// A variable of the environment that names another folder with the crate's contents.
const FOLDER: &str = "FRAMEWRIGHT_SPIRV_TOOLS";

/// Files of `spirv-tools/source` that the validator needs beside those in `val`.
const SHARED: [&str; 22] = [
    "util/bit_vector",
    "util/parse_number",
    "util/string_utils",
    "assembly_grammar",
    "binary",
    "diagnostic",
    "disassemble",
    "ext_inst",
    "extensions",
    "name_mapper",
    "opcode",
    "operand",
    "parsed_operand",
    "print",
    "spirv_endian",
    "spirv_target_env",
    "spirv_validator_options",
    "table",
    "table2",
    "text",
    "text_handler",
    "to_string",
];

/// A file of `val` that has names of its own that another one has too: it is compiled apart.
const APART: &str = "validate_ray_tracing_reorder.cpp";

/// Where binutils and a compiler of C++ are those of GNU. Elsewhere programs are built without the validator.
pub(crate) fn build() {
    println!("cargo:rerun-if-env-changed={FOLDER}");
    if env::var_os("CARGO_CFG_TARGET_OS").is_none_or(|system| system != "linux") {
        return;
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("Cargo sets OUT_DIR"));
    let sources = folder();
    let objects = compiled(&sources, &out);
    let [merged, apart] = ["merged.o", "validator.o"].map(|name| out.join(name));
    // Groups of sections are taken apart: the linker would else take functions of equal names for the same ones.
    let cpp = cc::Build::new().cpp(true).get_compiler();
    run(cpp.to_command().args(["-r", "-nostdlib", "-Wl,--force-group-allocation", "-o"]).arg(&merged).args(objects));
    run(Command::new("objcopy").arg(format!("--keep-global-symbol={FUNCTION}")).args([&merged, &apart]));
    cc::Build::new().object(&apart).compile("framewright_spirv_validator");
    println!("cargo:rustc-link-lib=stdc++");
    println!("cargo:rustc-cfg=spirv_validator");
}

/// Two files, each of which includes many: their headers are read once, which saves two thirds of the time.
fn compiled(sources: &Path, out: &Path) -> Vec<PathBuf> {
    let source = sources.join("spirv-tools/source");
    let of_val = fs::read_dir(source.join("val")).expect("the sources of the validator");
    let mut of_val: Vec<PathBuf> = of_val.map(|file| file.expect("a file").path()).collect();
    of_val.retain(|file| file.extension().is_some_and(|it| it == "cpp"));
    of_val.sort();
    let (apart, together): (Vec<PathBuf>, Vec<PathBuf>) = of_val.into_iter().partition(|file| file.ends_with(APART));
    let shared = SHARED.iter().map(|name| source.join(format!("{name}.cpp")));
    let own = Path::new(&env::var_os("CARGO_MANIFEST_DIR").expect("Cargo sets it")).join("build/validator.cpp");
    let units = [together.into_iter().chain(shared).chain([own]).collect(), apart];
    let units = units.into_iter().enumerate().map(|(number, files): (usize, Vec<PathBuf>)| {
        let unit = out.join(format!("unit_{number}.cpp"));
        let text: String = files.iter().map(|file| format!("#include \"{}\"\n", file.display())).collect();
        fs::write(&unit, text).expect("OUT_DIR can be written");
        unit
    });
    cc::Build::new()
        .cpp(true)
        .std("c++17")
        // Higher levels take longer than they save.
        .opt_level(1)
        .debug(false)
        .warnings(false)
        .flags(["-w", "-fno-exceptions", "-fno-rtti", "-fvisibility=hidden"])
        // Variables of templates and of inline functions would stay global.
        .flag_if_supported("-fno-gnu-unique")
        .define("SPIRV_LINUX", None)
        // An assertion that fails ends the process.
        .define("NDEBUG", None)
        .includes(["spirv-tools", "spirv-tools/include", "generated"].map(|folder| sources.join(folder)))
        .includes(["include", "include/spirv/unified1"].map(|folder| sources.join("spirv-headers").join(folder)))
        .files(units)
        .compile_intermediates()
}

/// The folder with the contents of the crate: beside this one, where both come from a registry or a vendored folder, or where Cargo
/// unpacks crates.
fn folder() -> PathBuf {
    let named = env::var_os(FOLDER).map(PathBuf::from);
    let name = format!("spirv-tools-sys-{VERSION}");
    let this = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let around = this.as_deref().and_then(Path::parent);
    let beside = around.into_iter().flat_map(|around| [around.join(&name), around.join("spirv-tools-sys")]);
    let home = env::var_os("CARGO_HOME").map(PathBuf::from).or_else(|| Some(env::home_dir()?.join(".cargo")));
    let unpacked = home.and_then(|home| fs::read_dir(home.join("registry/src")).ok());
    let unpacked = unpacked.into_iter().flatten().flatten().map(|registry| registry.path().join(&name));
    let found = named.into_iter().chain(beside).chain(unpacked).find(|it| it.join("spirv-tools/source/val").is_dir());
    found.unwrap_or_else(|| {
        panic!(
            "the sources of the crate spirv-tools-sys {VERSION} aren't where Cargo unpacks crates: name the folder with its \
             contents in {FOLDER}, or build without the feature `spirv-validator`"
        )
    })
}

fn run(command: &mut Command) {
    let status = command.status().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(status.success(), "{command:?} ended with {status}");
}
