//! Shaders that commands compile: what a command is given, and what is taken of it. `sh` stands in for compilers.

use super::*;
use framewright_graph::shader::FileLanguage;
use framewright_vulkan::{PrecompiledShaders, ShaderCompilers};

const FILES: &[(&str, &str)] = &[
    ("post.wgsl", "// Its compiler doesn't look at it.\n"),
    ("-Fo/post.wgsl", "\n"),
    ("reads.hlsl", "float a;\n#include \"/etc/passwd\"\n"),
    ("reads.slang", "import light;\nimport \"../../x\";\n"),
];

/// A folder with the files, and with a module that has the entry point `tinted`.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("-Fo")).expect("a folder");
    for (name, text) in FILES {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    let module = include_bytes!("../../../../tests/shaders/spirv/post_wgsl.spv");
    fs::write(folder.path().join("made.spv"), module).expect("a file");
    folder
}

/// A library whose shaders are compiled by a shell that is given these lines. `MADE` in them is the module.
fn by_shell(folder: &Path, lines: &str) -> ShaderLibrary {
    let made = folder.join("made.spv").display().to_string();
    let mut compilers = ShaderCompilers::default();
    let command = format!("sh -c \"{}\" {{input}} {{output}}", lines.replace("MADE", &made));
    for language in [FileLanguage::Hlsl, FileLanguage::Slang, FileLanguage::Wgsl] {
        compilers.set(language, &command).expect("a command");
    }
    library(folder).with_compilers(compilers)
}

fn computed(library: &mut ShaderLibrary, name: &str) -> Result<ShaderInterface, ShaderProblem> {
    library.compute_shader(name, &Variant::default())
}

#[test]
fn what_stands_for_nothing_in_a_command_is_said() {
    let set = |command: &str| ShaderCompilers::default().set(FileLanguage::Hlsl, command).map_err(|it| it.to_string());
    let said = set("tool {inptu} {output}").expect_err("a misspelt word");
    assert!(said.starts_with("`{inptu}` stands for nothing: there are {input}, {output}"), "{said}");
    assert_eq!(set("sh -c \"a=${b}\" {input} {output}"), Ok(()));
}

#[test]
fn no_command_is_run_for_a_shader_that_asks_for_files_elsewhere() {
    let folder = folder();
    let ran = folder.path().join("ran");
    for (name, line) in [("reads.hlsl", 2), ("reads.slang", 2)] {
        let mut library = by_shell(folder.path(), &format!("touch {}; cp MADE $1", ran.display()));
        let Err(ShaderProblem::DoesNotCompile { messages }) = computed(&mut library, name) else { panic!("{name}") };
        let [message] = &messages[..] else { panic!("{messages:?}") };
        assert!(message.text.contains(&format!("{name}:{line}: error: ")), "{}", message.text);
        assert_eq!(message.quote.as_ref().map(|quote| quote.line), Some(line));
        assert!(!ran.exists());
    }
}

#[test]
fn a_file_is_never_an_option() {
    let folder = folder();
    let mut library = by_shell(folder.path(), "cp MADE $1");
    let Err(ShaderProblem::DoesNotCompile { messages }) = computed(&mut library, "post.wgsl:-Fo/x") else { panic!() };
    assert!(messages[0].text.ends_with("post.wgsl: `-Fo/x` is no name of an entry point"), "{}", messages[0].text);
    let mut library = by_shell(folder.path(), "case $0 in ./*) cp MADE $1;; *) exit 1;; esac");
    computed(&mut library, "-Fo/post.wgsl:clear").expect("a path that begins with a dot");
}

#[test]
fn an_entry_point_that_is_not_there_is_none_though_the_compiler_is_not_told_of_it() {
    let folder = folder();
    let mut library = by_shell(folder.path(), "cp MADE $1");
    computed(&mut library, "post.wgsl:clear").expect("compiled");
    match computed(&mut library, "post.wgsl:clera") {
        Err(ShaderProblem::EntryPoint { named, .. }) => assert_eq!(named.as_deref(), Some("clera")),
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_was_written_and_is_no_file_is_said_in_words() {
    let folder = folder();
    match computed(&mut by_shell(folder.path(), "mkdir $1"), "post.wgsl:clear") {
        Err(ShaderProblem::Machine { what }) => {
            assert!(what.starts_with("what its compiler `sh` wrote can't"), "{what}")
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_one_command_compiled_ahead_is_not_taken_for_anothers_but_where_none_is_named() {
    let folder = folder();
    let ahead = PrecompiledShaders::in_folder(folder.path().join("ahead"));
    let with = |library: ShaderLibrary| library.with_precompiled(Some(ahead.clone().adding()));
    computed(&mut with(by_shell(folder.path(), "cp MADE $1")), "post.wgsl:clear").expect("compiled");
    assert!(computed(&mut with(by_shell(folder.path(), "exit 1")), "post.wgsl:clear").is_err());
    computed(&mut with(library(folder.path())), "post.wgsl:clear").expect("taken");
}
