//! Files that a pipeline names: where they are looked for, and that nothing outside the root is read.

use crate::testing::{self, Outcome, Place};

/// A pipeline that includes `file` and uses its fragment `fill`.
fn pipeline(file: &str) -> String {
    format!(
        r#"Pipeline(
    version: 1,
    include: ["{file}"],
    images: [(name: "screen", format: Output, size: Output)],
    passes: [(use: "fill", name: "all", with: {{"target": "screen"}})],
    outputs: ["screen"],
)"#
    )
}

const FILL: &str = r#"Fragments(version: 1, fragments: [
    (name: "fill", parameters: [(name: "target", value: Image)],
        passes: [(name: "sky", draw: Sky, color: [(image: "target", clear: (0.0, 0.0, 0.0, 1.0))])]),
])"#;

/// A folder with `inside/p.ron`, which includes `file`, and `outside/fill.ron` beside it.
fn place(file: &str) -> Place {
    let place = Place::new();
    for folder in ["inside", "inside/deep", "outside"] {
        std::fs::create_dir(place.path(folder)).expect("a folder");
    }
    place.file("inside/p.ron", pipeline(file));
    place.file("outside/fill.ron", FILL);
    place
}

fn check(place: &Place, words: &[&str]) -> Outcome {
    place.run(&[&["check", "inside/p.ron"], words].concat())
}

/// That `file` is refused, with these words, at the line that names it.
#[track_caller]
fn refused(place: &Place, why: &str) {
    check(place, &[]).exits(1).mentions(&format!("error: {why}")).mentions(" --> inside/p.ron:3:15\n");
}

#[test]
fn a_file_is_counted_from_the_one_that_names_it_and_shown_with_its_folder() {
    let place = place("deep/more.ron");
    place.file("inside/deep/more.ron", r#"Fragments(version: 1, include: ["../fill.ron"], fragments: [])"#);
    place.file("inside/fill.ron", FILL);
    check(&place, &[]).exits(0);
    let plan = place.run(&["inspect", "inside/p.ron"]).exits(0).out;
    assert!(plan.contains("`all.sky` draws the sky with shader `sky` (fill.ron:3)"), "{plan}");

    place.file("inside/fill.ron", FILL.replace("draw: Sky", "drow: Sky"));
    check(&place, &[])
        .exits(1)
        .mentions("error: pass `sky` has no field `drow`\n --> inside/fill.ron:3:32\n")
        .mentions("::: inside/deep/more.ron:1:33\n")
        .mentions("::: inside/p.ron:3:15\n")
        .mentions("included here");
}

/// A pipeline that includes the shipped bloom.
pub(crate) const WITH_BLOOM: &str = r#"Pipeline(
    version: 1,
    include: ["library/bloom.ron"],
    images: [
        (name: "color", format: Color(hdr: true), size: Output),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "sky", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
        (use: "bloom", name: "glow", with: {"source": "color", "target": "screen"}),
    ],
    outputs: ["screen"],
)"#;

#[test]
fn a_shipped_file_is_taken_where_there_is_none_beside() {
    let place = Place::new();
    place.file("p.ron", WITH_BLOOM);
    let plan = place.run(&["inspect", "p.ron"]).exits(0).out;
    assert!(plan.contains("(shipped:library/bloom.ron:"), "{plan}");
    let near = place.file("near.ron", WITH_BLOOM.replace("library/bloom", "library/blom"));
    place
        .run(&["check".as_ref(), near.as_os_str()])
        .exits(1)
        .mentions("error: there is no file `library/blom.ron` beside `near.ron`, and none of that path is shipped\n")
        .mentions("help: did you mean `library/bloom.ron`, which is shipped?");

    std::fs::create_dir(place.path("library")).expect("a folder");
    place.file("library/bloom.ron", FILL);
    place.run(&["check", "p.ron"]).exits(1).mentions("there is no fragment named `bloom`");
}

#[test]
fn nothing_outside_the_folder_of_the_pipeline_is_read() {
    let place = place("../outside/fill.ron");
    refused(&place, "`../outside/fill.ron` leads out of `inside`, from which nothing may be read");
    // Whether there is such a file isn't told either.
    place.file("inside/p.ron", pipeline("../outside/nothing.ron"));
    refused(&place, "`../outside/nothing.ron` leads out of `inside`, from which nothing may be read");
    place.file("inside/p.ron", pipeline("deep/../../outside/fill.ron"));
    refused(&place, "`deep/../../outside/fill.ron` leads out of `inside`, from which nothing may be read");
    let absolute = place.path("outside/fill.ron").to_string_lossy().into_owned();
    place.file("inside/p.ron", pipeline(&absolute));
    refused(&place, &format!("`{absolute}` leads out of `inside`, from which nothing may be read"));
    place.file("inside/p.ron", pipeline(&place.path("inside/fill.ron").to_string_lossy()));
    place.file("inside/fill.ron", FILL);
    check(&place, &[]).exits(1).mentions("leads out of `inside`");
}

#[test]
fn no_file_that_the_pipeline_is_made_of_is_written_over() {
    let place = place("deep/fill.ron");
    place.file("inside/deep/fill.ron", FILL);
    place
        .run(&["inspect", "inside/p.ron", "-o", "inside/../inside/deep/fill.ron"])
        .exits(2)
        .mentions("is a fragment of the pipeline, which would be lost");
    assert_eq!(std::fs::read_to_string(place.path("inside/deep/fill.ron")).expect("it is there"), FILL);
}

#[cfg(unix)]
#[test]
fn no_link_leads_outside() {
    use std::os::unix::fs::symlink;
    let place = place("link.ron");
    symlink(place.path("outside/fill.ron"), place.path("inside/link.ron")).expect("a link");
    refused(&place, "`link.ron` leads out of `inside`, from which nothing may be read");
    place.file("inside/p.ron", pipeline("folder/fill.ron"));
    symlink("../outside", place.path("inside/folder")).expect("a link");
    refused(&place, "`folder/fill.ron` leads out of `inside`, from which nothing may be read");
    // Links that stay inside are followed, and lead to one file, not to two of the same contents.
    let both = pipeline("a.ron").replace("\"a.ron\"", "\"a.ron\", \"b.ron\"");
    place.file("inside/p.ron", both);
    place.file("inside/a.ron", FILL);
    symlink("a.ron", place.path("inside/b.ron")).expect("a link");
    check(&place, &[]).exits(0);
    // A shader is read under the same rule.
    place.file("inside/p.ron", pipeline("a.ron"));
    place.file("inside/a.ron", FILL.replace("draw: Sky", "draw: FullScreen(\"secret\")"));
    place.file("outside/secret.frag", "top secret");
    symlink("../outside/secret.frag", place.path("inside/secret.frag")).expect("a link");
    let outcome = check(&place, &[]).exits(1).mentions("inside/secret.frag leads out of `inside`");
    assert!(!outcome.err.contains("top"), "{}", outcome.err);
}

#[test]
fn the_user_may_choose_another_root_or_none() {
    let place = place("../outside/fill.ron");
    check(&place, &["--root", "."]).exits(0);
    check(&place, &["--allow-outside"]).exits(0);
    let plan = place.run(&["inspect", "inside/p.ron", "--root", "."]).exits(0).out;
    assert!(plan.contains("(../outside/fill.ron:3)"), "{plan}");
    check(&place, &["--root", "outside"])
        .exits(2)
        .says("error: `inside/p.ron` lies outside of `outside`, which `--root` names: name a folder that the pipeline lies in");
    check(&place, &["--root", "nowhere"]).exits(1).mentions("error: the folder `nowhere` can't be read");
    check(&place, &["--root", ".", "--allow-outside"]).exits(2);
    let absolute = place.path("outside/fill.ron").to_string_lossy().into_owned();
    place.file("inside/p.ron", pipeline(&absolute));
    check(&place, &["--allow-outside"]).exits(0);
    check(&place, &["--root", "."]).exits(1).mentions("leads out of `.`");
}

/// Runs the command as a user who may not read everything, even where root runs the test.
#[cfg(unix)]
fn check_as_nobody(place: &Place, words: &[&str]) -> Outcome {
    use std::os::unix::fs::PermissionsExt;
    use std::os::unix::process::CommandExt;
    std::fs::set_permissions(place.path(""), PermissionsExt::from_mode(0o755)).expect("allowed");
    let mut command = place.command(words);
    // Root reads everything.
    if std::fs::File::open("/etc/shadow").is_ok() {
        command.uid(65534);
    }
    testing::outcome(&mut command)
}

#[cfg(unix)]
#[test]
fn a_file_that_may_not_be_read_is_the_environments_fault_in_all_files_that_are_named() {
    use std::os::unix::fs::PermissionsExt;
    let place = place("fill.ron");
    let forbid = |file: &str| {
        std::fs::set_permissions(place.file(file, FILL), PermissionsExt::from_mode(0o000)).expect("allowed");
    };
    forbid("inside/fill.ron");
    check_as_nobody(&place, &["check", "inside/p.ron"])
        .exits(3)
        .mentions("error: `fill.ron` can't be read: Permission denied")
        .mentions(" --> inside/p.ron:3:15\n")
        .mentions("help: chmod u+r inside/fill.ron");
    forbid("secret.ron");
    check_as_nobody(&place, &["check", "secret.ron"])
        .exits(3)
        .mentions("error: the pipeline `secret.ron` can't be read: Permission denied")
        .mentions("help: chmod u+r secret.ron");
}

#[cfg(unix)]
#[test]
fn a_folder_may_be_called_anything_and_a_file_that_two_links_lead_to_is_one() {
    let place = Place::new();
    for folder in ["own", "a:b"] {
        std::fs::create_dir(place.path(folder)).expect("a folder");
    }
    place.file("own/p.ron", pipeline("fill.ron").replace("include:", "extensions: [\"link.ron\"], include:"));
    place.file("own/fill.ron", FILL);
    place.file("a:b/more.ron", FILL.replace("\"fill\"", "\"more\""));
    place.file("a:b/extension.ron", r#"Extension(version: 1, include: ["more.ron"], changes: [])"#);
    std::os::unix::fs::symlink("../a:b/extension.ron", place.path("own/link.ron")).expect("a link");
    place.file("own/alone.ron", pipeline("fill.ron"));
    place.run(&["check", "own/alone.ron", "--extend", "a:b/extension.ron", "--root", "."]).exits(0);
    place
        .run(&["check", "own/p.ron", "--extend", "a:b/extension.ron", "--root", "."])
        .exits(1)
        .mentions("error: `../a:b/extension.ron` is applied twice");
}

#[test]
fn what_is_no_text_file_is_refused_without_being_waited_for() {
    let place = place("odd.ron");
    std::fs::create_dir(place.path("inside/odd.ron")).expect("a folder");
    refused(&place, "`odd.ron` is not a regular file");
    std::fs::remove_dir(place.path("inside/odd.ron")).expect("gone");
    let made = std::process::Command::new("mkfifo").arg(place.path("inside/odd.ron")).status().expect("mkfifo");
    assert!(made.success());
    refused(&place, "`odd.ron` is not a regular file");
    std::fs::remove_file(place.path("inside/odd.ron")).expect("gone");
    place.file("inside/odd.ron", b"Fragments(\xff)");
    refused(&place, "`inside/odd.ron` is not a text file: byte 10 is 0xFF, which is not UTF-8");
    std::fs::File::create(place.path("inside/odd.ron")).and_then(|file| file.set_len(1 << 40)).expect("a sparse file");
    refused(&place, "`odd.ron` has 1099511627776 bytes, more than the 16777216 that are allowed");

    place.file("inside/p.ron", pipeline("/dev/zero"));
    check(&place, &["--allow-outside"]).exits(1).mentions("error: `/dev/zero` is not a regular file");
    for path in ["", "a//b.ron", "deep/", "c:\\\\a.ron"] {
        place.file("inside/p.ron", pipeline(path));
        check(&place, &[]).exits(1).mentions("is no path of a file: names are divided by `/`");
    }
}

#[test]
fn a_circle_is_found_however_it_is_written() {
    let place = place("deep/a.ron");
    place.file("inside/deep/a.ron", r#"Fragments(version: 1, include: ["../b.ron"], fragments: [])"#);
    place.file("inside/b.ron", r#"Fragments(version: 1, include: ["deep/../deep/./a.ron"], fragments: [])"#);
    check(&place, &[])
        .exits(1)
        .mentions("error: files include each other in a circle: `deep/a.ron` → `b.ron` → `deep/a.ron`\n")
        .mentions(" --> inside/b.ron:1:33\n")
        .mentions("::: inside/deep/a.ron:1:33\n");
    place.file("inside/p.ron", pipeline("./p.ron"));
    check(&place, &[]).exits(1).mentions("in a circle: `p.ron` → `p.ron`");
}

/// A pipeline of one's own that uses shipped fragments.
fn of_shipped_fragments(source: &str) -> String {
    format!(
        r#"Pipeline(
    version: 1,
    include: ["library/blur.ron", "library/tone_mapping.ron"],
    images: [
        (name: "color", format: Color(hdr: true), size: Output), (name: "depth", format: Depth, size: Output),
        (name: "soft", format: Color(hdr: true), size: Output), (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "opaque", draw: Objects(Opaque), shader: "lit", color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))],
            depth: (image: "depth", clear: 0.0)),
        (use: "blur", name: "soften", with: {{"source": "{source}", "target": "soft", "times": 1}}),
        (use: "tone_mapping", name: "show", with: {{"source": "soft", "target": "screen", "operator": "'reinhard'"}}),
    ],
    outputs: ["screen"],
)"#
    )
}

#[test]
fn what_goes_wrong_in_a_shipped_fragment_is_said_first_where_it_is_used() {
    let place = Place::new();
    place.file("p.ron", of_shipped_fragments("depth"));
    let answer = place.run(&["check", "p.ron"]).exits(1);
    let answer = answer.mentions("is a depth image (D32_SFLOAT) and can't be a colour target\n  --> p.ron:11:29\n");
    answer.mentions("^^^^^^^^ used here as `soften`\n").mentions("::: shipped:library/blur.ron:");
}

#[test]
fn what_a_shipped_fragment_leaves_out_by_itself_is_told_to_programs_alone() {
    let place = Place::new();
    place.file("p.ron", of_shipped_fragments("color"));
    let told = place.run(&["check", "p.ron"]).exits(0).out;
    assert!(!told.contains("is off"), "{told}");
    let tree = place.run(&["inspect", "p.ron"]).exits(0).out;
    assert!(!tree.contains("is off"), "{tree}");
    let all = place.run(&["check", "p.ron", "--format", "json"]).exits(0).out;
    assert!(all.contains(".tone_map_scaled") && all.contains("is off: "), "{all}");
    // An entry that the user's own file leaves out is told.
    let own = of_shipped_fragments("color").replace("(name: \"opaque\",", "(name: \"opaque\", when: \"1 < 2\",");
    let own =
        own.replace("passes: [", "passes: [\n        (name: \"off\", when: \"1 > 2\", draw: Sky, color: [\"color\"]),");
    place.file("p.ron", own);
    let told = place.run(&["check", "p.ron"]).exits(0).out;
    assert!(told.contains("note: `off`: is off: "), "{told}");
}
