//! Where shaders and what they include are looked for, and how mistakes are placed.

use super::*;

#[test]
fn a_mistake_has_the_shaders_own_file_and_line() {
    let fragment = "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() {\n    color = colour;\n}\n";
    let messages = messages(&[("test.frag", fragment)]);
    assert_eq!(messages[0], "test.frag:4: error: 'colour' : undeclared identifier");
}

#[test]
fn a_mistake_in_an_included_file_has_that_files_name() {
    let included = "float half_of(float x) {\n    return x * missing;\n}\n";
    let fragment = "#version 460\n#include \"part.glsl\"\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(half_of(1.0)); }\n";
    let messages = messages(&[("part.glsl", included), ("test.frag", fragment)]);
    assert_eq!(messages[0], "part.glsl:2: error: 'missing' : undeclared identifier");
}

#[test]
fn includes_come_from_the_folders_and_then_from_what_is_shipped() {
    let body = "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(HALF); }\n";
    let fragment = format!("#version 460\n#include \"light/half.glsl\"\n{body}");
    assert!(drawn(Draw::FullScreen, &[("test.frag", &fragment)]).is_ok(), "shipped");
    let fragment = format!("#version 460\n#include \"own.glsl\"\n{body}");
    let own = "#include \"light/half.glsl\"\n";
    assert!(drawn(Draw::FullScreen, &[("test.frag", &fragment), ("own.glsl", own)]).is_ok(), "own, then shipped");
}

#[test]
fn an_include_can_not_leave_its_folder() {
    let outer = tempfile::tempdir().expect("a folder");
    let folder = outer.path().join("shaders");
    fs::create_dir(&folder).expect("a folder");
    fs::write(outer.path().join("secret.glsl"), "").expect("a file");
    fs::write(outer.path().join("secret.frag"), "").expect("a file");
    let absolute = outer.path().join("secret.glsl").display().to_string();
    for name in ["../secret.glsl", "./../secret.glsl", &absolute, "..\\secret.glsl"] {
        fs::write(folder.join("test.frag"), format!("#version 460\n#include \"{name}\"\n{WHITE} }}")).expect("a file");
        match library(&folder).draw_shader("test", Draw::FullScreen, &Variant::default()) {
            Err(ShaderProblem::DoesNotCompile { messages }) => {
                let refused = ["leads out of", "is no path of a file"];
                assert!(refused.iter().any(|words| messages[0].text.contains(words)), "{messages:?}");
            }
            other => panic!("{other:?}"),
        }
    }
    match library(&folder).draw_shader("../secret", Draw::FullScreen, &Variant::default()) {
        Err(ShaderProblem::Unsupported { what }) => assert!(what.contains("leads out of"), "{what}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_file_that_includes_itself_is_an_error() {
    let fragment = format!("#version 460\n#include \"circle.glsl\"\n{WHITE} }}");
    let messages = messages(&[("test.frag", &fragment), ("circle.glsl", "#include \"circle.glsl\"\n")]);
    assert!(messages.iter().any(|message| message.contains("a circle?")), "{messages:?}");
}

#[test]
fn a_missing_shader_says_where_it_was_looked_for_and_what_there_is() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("own.frag"), "").expect("a file");
    let problem = library(folder.path()).draw_shader("wanted", Draw::FullScreen, &Variant::default());
    let looked_in = vec![folder.path().display().to_string(), "the shipped shaders".to_owned()];
    let known = vec!["own".to_owned(), "plain".to_owned()];
    assert_eq!(problem, Err(ShaderProblem::Missing { looked_in, known }));
    let no_vertex_shader = library(folder.path()).draw_shader("plain", Draw::Sky, &Variant::default());
    let what = "no vertex shader: neither `plain.vert` nor `sky.vert` was found".to_owned();
    assert_eq!(no_vertex_shader, Err(ShaderProblem::Unsupported { what }));
}

/// What becomes of a shader whose files have these bytes.
fn of_bytes(files: &[(&str, &[u8])]) -> Result<ShaderInterface, ShaderProblem> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in files {
        fs::create_dir_all(folder.path().join(name).parent().expect("a folder")).expect("a folder");
        fs::write(folder.path().join(name), bytes).expect("a file");
    }
    library(folder.path()).draw_shader("test", Draw::FullScreen, &Variant::default())
}

#[test]
fn a_byte_order_mark_and_other_encodings_in_comments_are_taken() {
    let whole = [WHITE, " }\n"].concat();
    let marked = ["\u{feff}#version 460\n#include \"part.glsl\"\n", &whole].concat();
    let part = b"\xef\xbb\xbf// caf\xe9 \xff\n/* na\xefve\n \x80 */ float half_of(float x) { return x * 0.5; } // \xe9";
    assert_eq!(of_bytes(&[("test.frag", marked.as_bytes()), ("part.glsl", part)]).err(), None);
    // A mistake behind the mark is still at its line.
    let broken = "\u{feff}#version 460\nvoid main() { nothing; }\n";
    match of_bytes(&[("test.frag", broken.as_bytes())]) {
        Err(ShaderProblem::DoesNotCompile { messages }) => {
            assert!(
                messages[0].text.ends_with("test.frag:2: error: 'nothing' : undeclared identifier"),
                "{messages:?}"
            );
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_file_that_says_so_is_included_once_by_whatever_name() {
    const ONCE: &str = "#pragma once\nfloat half_of(float x) { return x * 0.5; }\n";
    let shader = |includes: &[&str]| {
        let includes = includes.iter().map(|name| format!("#include \"{name}\"\n")).collect::<String>();
        format!("#version 460\n{includes}{WHITE} color.r = half_of(1.0); }}")
    };
    // By names with dots, from another file, and from a file in a folder.
    let twice = shader(&["once.glsl", "./once.glsl", "in/../once.glsl", "in/part.glsl", "other.glsl"]);
    let files: [(&str, &[u8]); 4] = [
        ("test.frag", twice.as_bytes()),
        ("once.glsl", ONCE.as_bytes()),
        ("in/part.glsl", b"#pragma once\n#include \"../once.glsl\"\n"),
        ("other.glsl", b"#include \"once.glsl\"\n#include \"in/part.glsl\"\n"),
    ];
    assert_eq!(of_bytes(&files).err(), None);
    // The stage's own file is there already.
    let own = shader(&["part.glsl"]).replacen('\n', "\n#pragma once\n", 1);
    let part = ["#include \"test.frag\"\n", ONCE].concat();
    assert_eq!(of_bytes(&[("test.frag", own.as_bytes()), ("part.glsl", part.as_bytes())]).err(), None);
    // Another file with the same text is another file, and without the word a file is included as often as it is named.
    for (name, text) in [("same.glsl", ONCE), ("plain.glsl", &ONCE["#pragma once\n".len()..])] {
        let twice = shader(&["once.glsl", name]);
        let found =
            of_bytes(&[("test.frag", twice.as_bytes()), ("once.glsl", ONCE.as_bytes()), (name, text.as_bytes())]);
        assert!(matches!(found, Err(ShaderProblem::DoesNotCompile { .. })), "{name}: {found:?}");
    }
}

#[cfg(unix)]
#[test]
fn links_to_a_file_are_the_file_that_is_included_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("once.glsl"), "#pragma once\nfloat half_of(float x) { return x * 0.5; }\n").expect("a file");
    std::os::unix::fs::symlink("once.glsl", path("link.glsl")).expect("a link");
    fs::hard_link(path("once.glsl"), path("hard.glsl")).expect("a link");
    let includes = "#include \"link.glsl\"\n#include \"once.glsl\"\n#include \"hard.glsl\"\n";
    fs::write(path("test.frag"), format!("#version 460\n{includes}{WHITE} }}")).expect("a file");
    let found = library(folder.path()).draw_shader("test", Draw::FullScreen, &Variant::default());
    assert_eq!(found.err(), None);
}

#[cfg(unix)]
#[test]
fn no_pipe_is_waited_for() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["test.frag", "part.glsl"] {
        let made = std::process::Command::new("mkfifo").arg(folder.path().join(name)).status().expect("mkfifo");
        assert!(made.success());
    }
    match library(folder.path()).draw_shader("test", Draw::FullScreen, &Variant::default()) {
        Err(ShaderProblem::Unsupported { what }) => assert!(what.ends_with("is not a regular file"), "{what}"),
        other => panic!("{other:?}"),
    }
    fs::remove_file(folder.path().join("test.frag")).expect("removed");
    fs::write(folder.path().join("test.frag"), format!("#version 460\n#include \"part.glsl\"\n{WHITE} }}"))
        .expect("a file");
    match library(folder.path()).draw_shader("test", Draw::FullScreen, &Variant::default()) {
        Err(ShaderProblem::DoesNotCompile { messages }) => {
            assert!(messages[0].text.contains("is not a regular file"), "{messages:?}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_shader_on_disk_comes_before_a_shipped_one() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("plain.frag"), "no GLSL").expect("a file");
    let problem = library(folder.path()).draw_shader("plain", Draw::FullScreen, &Variant::default());
    assert!(matches!(problem, Err(ShaderProblem::DoesNotCompile { .. })), "{problem:?}");
}

#[test]
fn files_that_are_no_text_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("binary.frag"), b"#version 460\n\nfloat \xe9;").expect("a file");
    let utf16: Vec<u8> = "#version 460\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(path("wide.frag"), [&[0xff, 0xfe], &*utf16].concat()).expect("a file");
    fs::write(path("bare.frag"), utf16).expect("a file");
    fs::write(path("zero.frag"), "#version 460\0").expect("a file");
    fs::write(path("huge.frag"), vec![b'\n'; (1 << 20) + 1]).expect("a file");
    fs::create_dir(path("folder.frag")).expect("a folder");
    let mut library = library(folder.path());
    let mut what = |name: &str| match library.draw_shader(name, Draw::FullScreen, &Variant::default()) {
        Err(ShaderProblem::Unsupported { what }) => what.rsplit('/').next().unwrap_or("").to_owned(),
        other => panic!("{other:?}"),
    };
    assert_eq!(what("binary"), "binary.frag:3: this is not UTF-8, which only comments may hold");
    for wide in ["wide", "bare"] {
        assert_eq!(what(wide), format!("{wide}.frag is not text: it is UTF-16: save it as UTF-8"));
    }
    assert_eq!(what("zero"), "zero.frag contains a zero byte");
    assert_eq!(what("huge"), "huge.frag has 1048577 bytes, more than the 1048576 of a shader");
    assert_eq!(what("folder"), "folder.frag is not a regular file");
}
