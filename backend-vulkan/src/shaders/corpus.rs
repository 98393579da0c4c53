//! What is read off modules of many compilers: tests/compilers/corpus.sh makes them, and holds these facts against other readers.

use super::module_file::ModuleFile;
use super::program_supply::ProgramSupply;
use super::push_constants::PushedBy;
use super::reflect::{StageInterface, reflect};
use super::validator::judge;
use super::varyings::Varying;
use crate::base::ShaderStage;
use crate::process::Verdict;
use framewright_graph::shader::{Binding, ShaderProblem};
use framewright_graph::vulkan::{Component, Dimension, ImageShape};
use rspirv::spirv::Op;
use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{env, fs};

/// The longest that a module may keep the program.
const MOST_TIME: Duration = Duration::from_secs(5);
/// The number of words that are garbled in a module, one at a time, spread over all of it.
const MOST_WORDS: usize = 400;
/// Bytes that reading a module of at most 64 KiB may take.
const MOST_BYTES: u64 = 256 << 20;

/// The modules of the corpus, sorted.
fn modules() -> (PathBuf, Vec<PathBuf>) {
    let folder = PathBuf::from(env::var_os("FRAMEWRIGHT_CORPUS").expect("FRAMEWRIGHT_CORPUS names the folder"));
    let mut files = Vec::new();
    for compiler in fs::read_dir(folder.join("modules")).expect("a folder").flatten() {
        let of_compiler = fs::read_dir(compiler.path()).expect("a folder").flatten().map(|entry| entry.path());
        files.extend(of_compiler.filter(|file| file.extension().is_some_and(|ending| ending == "spv")));
    }
    files.sort();
    (folder, files)
}

/// The entry points of a module that a pass may have, with their stages. They are found in its words: the reader of instructions doesn't
/// know all that is taken.
fn entry_points(bytes: &[u8]) -> Vec<(String, ShaderStage)> {
    let words: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let (mut entries, mut rest) = (Vec::new(), words.get(5..).unwrap_or_default());
    while let Some((it, behind)) = rest.first().and_then(|first| rest.split_at_checked((first >> 16).max(1) as usize)) {
        rest = behind;
        let [first, model, _, name @ ..] = it else { continue };
        let stage = ShaderStage::ALL.into_iter().find(|stage| stage.facts().model as u32 == *model);
        if let (Some(stage), true) = (stage, first & 0xffff == Op::EntryPoint as u32) {
            let name: Vec<u8> = name.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
            entries.push((String::from_utf8_lossy(&name).into_owned(), stage));
        }
    }
    entries
}

/// An entry point as a pass would have it.
fn interface(module: &ModuleFile, stage: ShaderStage, entry: Option<&str>) -> Result<StageInterface, String> {
    let cut = module.cut("", stage, entry, &[], &PushedBy::default()).map_err(|problem| match problem {
        ShaderProblem::BadModule { what } => what,
        other => format!("{other:?}"),
    })?;
    if let Verdict::Invalid(finding) = judge(&cut.spirv) {
        return Err(format!("invalid: {}", finding.words));
    }
    reflect(stage, &cut.spirv, false, false, &ProgramSupply::default()).map_err(|refused| format!("{refused:?}"))
}

/// A fact a line: what it is of, and what it is.
fn facts(interface: &StageInterface) -> String {
    let mut facts = String::new();
    let mut add = |kind: &str, of: &str, is: &str| _ = writeln!(facts, "{kind}\t{of}\t{is}");
    if let Some([x, y, z]) = interface.interface.workgroup_size {
        add("size", "", &format!("{x} {y} {z}"));
    }
    for binding in &interface.interface.bindings {
        let place = format!("{} {}", binding.set, binding.binding);
        add("resource", &place, resource(binding));
        add("name", &place, &binding.name);
        if binding.kind.unbindable().is_none() {
            add("count", &place, &binding.length.unwrap_or(1).to_string());
        }
        let shape = binding.kind.sampled().or(binding.kind.storage_image().map(|(shape, _)| shape));
        if let Some(shape) = shape {
            add("shape", &place, &words(shape));
            add("component", &place, component(shape.component));
        }
        if let Some((readable, writable)) = binding.kind.storage() {
            add("access", &place, &format!("{}{}", if readable { "r" } else { "" }, if writable { "w" } else { "" }));
        }
        if let Some((_, bytes)) = binding.kind.storage_block() {
            add("bytes", &place, &bytes.to_string());
        }
        let Some(block) = binding.kind.uniform_block() else { continue };
        add("bytes", &place, &block.bytes.to_string());
        for member in &block.members {
            let at = format!("{place} {}", member.offset);
            add("member", &at, &member.ty);
            add("member_name", &at, &member.name);
        }
    }
    for (kind, values) in [("input", &interface.inputs), ("output", &interface.outputs)] {
        for Varying { location, component, name, ty, used } in values {
            let at = format!("{location} {component}");
            let idle = if *used { "" } else { "idle_" };
            add(&format!("{idle}{kind}"), &at, ty);
            add(&format!("{idle}{kind}_name"), &at, name);
        }
    }
    for constant in &interface.interface.constants {
        add("constant", &constant.number.to_string(), &constant.ty);
        add("constant_name", &constant.number.to_string(), &constant.name);
    }
    facts
}

/// A word that all readers have for the kind.
fn resource(binding: &Binding) -> &'static str {
    let kind = &binding.kind;
    let words = [
        (kind.is_sampled() && binding.separate, "image"),
        (kind.is_sampled(), "combined"),
        (kind.is_sampler(), "sampler"),
        (kind.storage_image().is_some(), "storage_image"),
        (kind.uniform_block().is_some(), "uniform"),
        (kind.storage_block().is_some(), "storage"),
        (kind.is_input_attachment(), "input_attachment"),
    ];
    words.into_iter().find(|(is, _)| *is).map_or("other", |(_, word)| word)
}

fn words(shape: ImageShape) -> String {
    let dimension = match shape.dimension {
        Dimension::D1 => "1D",
        Dimension::D2 => "2D",
        Dimension::D3 => "3D",
        Dimension::Cube => "Cube",
        Dimension::Buffer => "Buffer",
    };
    let (samples, layers) = (if shape.multisampled { "MS" } else { "" }, if shape.arrayed { "Array" } else { "" });
    format!("{dimension}{samples}{layers}")
}

const fn component(component: Component) -> &'static str {
    match component {
        Component::Float => "float",
        Component::Int => "int",
        Component::Uint => "uint",
    }
}

/// Whether reading a module panics.
fn panics(bytes: &[u8]) -> bool {
    let read = || {
        let Ok(module) = ModuleFile::read(bytes) else { return };
        for stage in ShaderStage::ALL {
            _ = interface(&module, stage, None);
        }
    };
    catch_unwind(AssertUnwindSafe(read)).is_err()
}

#[test]
#[ignore = "tests/compilers/corpus.sh makes the modules"]
fn facts_of_each_module_are_written_for_other_readers_to_judge() {
    let (folder, files) = modules();
    let mut text = String::new();
    for file in &files {
        let bytes = fs::read(file).expect("a module");
        let name = name(&folder, file);
        let read = catch_unwind(AssertUnwindSafe(|| ModuleFile::read(&bytes)));
        let module = match read {
            Ok(Ok(module)) => module,
            Ok(Err(what)) => {
                _ = writeln!(text, "module\t{name}\t-\t-\nrefused\t\t{what}");
                continue;
            }
            Err(_) => panic!("{name}: a panic"),
        };
        for (entry, stage) in entry_points(&bytes) {
            _ = writeln!(text, "module\t{name}\t{entry}\t{}", &stage.facts().ending[1..]);
            let read = catch_unwind(AssertUnwindSafe(|| interface(&module, stage, Some(&entry))));
            match read.unwrap_or_else(|_| panic!("{name}:{entry}: a panic")) {
                Ok(interface) => text += &facts(&interface),
                Err(what) => _ = writeln!(text, "refused\t\t{}", what.replace('\n', " ")),
            }
        }
    }
    assert!(files.len() > 100, "{} modules", files.len());
    fs::write(folder.join("facts"), text).expect("written");
}

fn name(folder: &Path, file: &Path) -> String {
    file.strip_prefix(folder.join("modules")).expect("within").display().to_string()
}

#[test]
#[ignore = "tests/compilers/corpus.sh makes the modules"]
fn garbled_modules_of_each_compiler_end_neither_the_program_nor_its_time_and_memory() {
    let (folder, files) = modules();
    let every = env::var("FRAMEWRIGHT_CORPUS_EVERY").ok().and_then(|every| every.parse().ok()).unwrap_or(40);
    let (mut read, mut longest, mut most) = (0_u64, Duration::ZERO, 0);
    for file in files.iter().step_by(every) {
        let whole = fs::read(file).expect("a module");
        let name = name(&folder, file);
        let mut check = |what: &str, at: usize, bytes: &[u8]| {
            let begun = Instant::now();
            let mut panicked = false;
            let memory = allocation_counter::measure(|| panicked = panics(bytes));
            let took = begun.elapsed();
            assert!(!panicked, "{name}, {what} at byte {at}: a panic");
            assert!(took < MOST_TIME, "{name}, {what} at byte {at}: {took:?}");
            assert!(memory.bytes_max < MOST_BYTES, "{name}, {what} at byte {at}: {} bytes", memory.bytes_max);
            (read, longest, most) = (read + 1, longest.max(took), most.max(memory.bytes_max));
        };
        let words = whole.len() / 4;
        for at in (0..words).step_by(words.div_ceil(MOST_WORDS)).map(|word| word * 4) {
            check("cut", at, &whole[..at]);
            for (what, change) in CHANGES {
                let mut garbled = whole.clone();
                let word = u32::from_le_bytes([whole[at], whole[at + 1], whole[at + 2], whole[at + 3]]);
                garbled[at..at + 4].copy_from_slice(&change(word).to_le_bytes());
                check(what, at, &garbled);
            }
        }
    }
    println!("{read} garbled modules: the longest took {longest:?}, the most memory was {most} bytes");
    assert!(read > 1000, "{read}");
}

/// A name, and what becomes of a word.
type Change = (&'static str, fn(u32) -> u32);

/// All of them.
const CHANGES: [Change; 6] = [
    ("one more", |word| word.wrapping_add(1)),
    ("one less", |word| word.wrapping_sub(1)),
    ("zero", |_| 0),
    ("all ones", |_| u32::MAX),
    ("a high bit", |word| word ^ 0x8000_0000),
    ("other halves", |word| word.rotate_left(16)),
];

#[test]
#[ignore = "tests/compilers/corpus.sh makes the modules"]
fn later_versions_are_refused() {
    for file in modules().1 {
        let mut bytes = fs::read(&file).expect("a module");
        bytes[5] += 10;
        let refused = ModuleFile::read(&bytes).map(|_| ()).expect_err("a later version");
        assert!(refused.contains("versions 1.0 to 1.6"), "{}: {refused}", file.display());
    }
}
