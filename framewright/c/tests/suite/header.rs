//! `framewright.h` is what cbindgen makes of the crate, and what compilers take (EM-12).

use crate::testing::{compile, has, has_headers, text};
use framewright_tests::render::in_repository;
use std::process::Command;

/// `./test` builds what makes it: a workspace of its own.
#[test]
fn the_header_is_made_of_the_crate() {
    let maker = in_repository("tests/header/target/debug/header");
    if !maker.exists() {
        let how = "cargo build --manifest-path tests/header/Cargo.toml";
        assert!(std::env::var_os("CI").is_none(), "in CI this is a failure: {how}");
        return eprintln!("SKIPPED: {how}");
    }
    let out = Command::new(maker).arg(in_repository("framewright/c")).output().expect("it runs");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let made = String::from_utf8(out.stdout).expect("a text");
    if std::env::var_os("FRAMEWRIGHT_UPDATE").is_some() {
        std::fs::write(in_repository("framewright/c/framewright.h"), &made).expect("written");
    }
    assert!(
        made == text("framewright/c/framewright.h"),
        "framewright/c/framewright.h is another one: FRAMEWRIGHT_UPDATE=1 before this test writes it, `git diff` shows it"
    );
}

#[test]
fn compilers_of_c_and_of_cpp_take_the_header() {
    if !has_headers() || !has("cc") || !has("c++") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let program = folder.path().join("program.c");
    std::fs::write(
        &program,
        "#include <framewright.h>\n#include <framewright.h>\nint main(void) { return (int)framewright_abi(); }\n",
    )
    .expect("written");
    let program = program.to_string_lossy();
    let strict = ["-fsyntax-only", "-pedantic", "-Wall", "-Wextra", "-Werror"];
    for (compiler, language, standard) in
        [("cc", "c", "-std=c99"), ("cc", "c", "-std=c11"), ("c++", "c++", "-std=c++11"), ("c++", "c++", "-std=c++20")]
    {
        compile(compiler, &[&strict[..], &["-x", language, standard, &program]].concat());
    }
}

/// Each function of the crate stands in the header.
#[test]
fn the_header_names_each_function_of_the_crate() {
    let header = text("framewright/c/framewright.h");
    let mut functions = 0;
    for file in in_repository("framewright/c/src").read_dir().expect("a folder") {
        let text = std::fs::read_to_string(file.expect("an entry").path()).expect("a text");
        for function in text.split("extern \"C\" fn framewright_").skip(1) {
            let name = format!("framewright_{}(", function.split('(').next().unwrap_or_default());
            assert!(header.contains(&name), "the header lacks {name}: does tests/header read its file?");
            functions += 1;
        }
    }
    assert!(functions > 30, "{functions}");
}
