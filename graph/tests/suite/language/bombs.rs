//! Small files that would make a great deal: each ends at a limit that its answer names, soon and in bounded memory.

use crate::testing::pipelines::{INPUTS, frame};
use framewright_graph::base::{self, FilePath, Sources};
use framewright_graph::expand::Inputs;
use framewright_graph::language::{self, Files, FoundFile, ReadFailure};
use std::fmt::Write as _;

/// The first lines of what is said about a file, and how much memory reading it took at most, in bytes.
fn answer(files: &mut dyn Files, text: &str) -> (String, u64) {
    let mut shown = String::new();
    let measured = allocation_counter::measure(|| {
        let mut sources = Sources::default();
        let errors = language::read_with(&mut sources, files, "bomb.ron", "bomb.ron", text.to_owned());
        shown = base::render(&sources, &errors.expect_err("a bad file"));
    });
    (shown, measured.bytes_max)
}

/// The answer about a file that names no other.
fn alone(text: &str) -> (String, u64) {
    answer(&mut language::NoFiles, text)
}

/// A pipeline with these fragments, which uses the one called `f0`, or doesn't.
fn pipeline(fragments: &str, uses: &str) -> String {
    format!(
        r#"Pipeline(version: 1, fragments: [{fragments}], images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "show", draw: FullScreen("plain"), color: ["screen"]), {uses}], outputs: ["screen"])"#
    )
}

/// Fragments each of which does something twice to the next, `depth` of them.
fn doubling(depth: usize) -> String {
    (0..depth).fold(String::new(), |mut text, at| {
        let next = at + 1;
        let twice = format!("(use: \"f{next}\", name: \"a\"), (use: \"f{next}\", name: \"b\")");
        let inside = if next == depth { "(anchor: \"end\")" } else { &twice };
        write!(text, "(name: \"f{at}\", passes: [{inside}]),").expect("memory");
        text
    })
}

#[test]
fn fragments_that_double_each_other_end_at_a_million() {
    let (shown, memory) = alone(&pipeline(&doubling(31), r#"(use: "f0", name: "bomb")"#));
    assert!(
        shown.contains("error: this makes more than 1000000 images, buffers, passes and uses of fragments"),
        "{shown}"
    );
    assert_eq!(shown.matches("error: ").count(), 1, "{shown}");
    assert!(memory < 400 << 20, "reading took {memory} bytes");
}

#[test]
fn images_that_multiply_end_at_a_million() {
    let tens = |at: usize| {
        let next = format!("(use: \"f{}\", name: \"n\", repeat: (\"i\", 10))", at + 1);
        let inside = if at == 9 { "" } else { &next };
        format!(
            "(name: \"f{at}\", images: [(name: \"x\", repeat: (\"i\", 10), format: Depth, size: Output)], passes: [{inside}]),"
        )
    };
    let fragments: String = (0..10).map(tens).collect();
    let (shown, memory) = alone(&pipeline(&fragments, r#"(use: "f0", name: "bomb")"#));
    assert!(shown.contains("this makes more than 1000000 images"), "{shown}");
    assert!(memory < 1 << 30, "reading took {memory} bytes");
}

#[test]
fn a_bomb_that_nobody_uses_does_no_harm() {
    let text = pipeline(&doubling(31), "");
    let measured = allocation_counter::measure(|| {
        frame(&text, &INPUTS).unwrap_or_else(|answer| panic!("{answer}"));
    });
    assert!(measured.bytes_max < 400 << 20, "it took {} bytes", measured.bytes_max);
}

#[test]
fn ten_thousand_fragments_in_each_other_are_too_deep() {
    let chain: String = (0..10_000)
        .map(|at| format!("(name: \"f{at}\", passes: [(use: \"f{}\", name: \"n\")]),", (at + 1).min(9_999)))
        .collect();
    let (shown, _) = alone(&pipeline(&chain, r#"(use: "f0", name: "deep")"#));
    assert!(shown.contains("error: uses of fragments stand at most 32 deep in each other"), "{shown}");
    assert!(shown.contains("error: fragments use each other in a circle: `f9999` → `f9999`"), "{shown}");
}

#[test]
fn ten_thousand_brackets_in_an_expression_are_too_many() {
    let when = |expression: &str| {
        alone(&pipeline("", &format!("(name: \"p\", when: \"{expression}\", draw: Sky, color: [\"screen\"])"))).0
    };
    let long = "this expression has 10000 bytes; 4096 are allowed";
    for (text, answer) in [
        ("(".repeat(10_000), long),
        ("!".repeat(10_000), long),
        ("-".repeat(10_000), long),
        (format!("{}true{}", "(".repeat(65), ")".repeat(65)), "nested more than 64 deep"),
        (format!("{}true", "!".repeat(4_000)), "nested more than 64 deep"),
    ] {
        let shown = when(&text);
        assert!(shown.contains(answer), "{shown}");
        assert_eq!(shown.matches("error: ").count(), 1, "{shown}");
    }
}

/// Each file includes two others.
struct Endless(usize);

impl Files for Endless {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        self.0 += 1;
        let at: usize = path.trim_end_matches(".ron").parse().map_err(|_| format!("what is `{path}`?"))?;
        let text =
            format!("Fragments(version: 1, include: [\"{}.ron\", \"{}.ron\"], fragments: [])", at + 1, at + 1000);
        Ok(FoundFile { shown: path.to_owned(), relative: path.into(), bytes: text.into_bytes() })
    }
}

#[test]
fn files_without_end_are_too_many() {
    let text = pipeline("", "").replacen("version: 1,", "version: 1, include: [\"1.ron\"],", 1);
    let mut files = Endless(0);
    let (shown, memory) = answer(&mut files, &text);
    assert!(shown.contains("error: a pipeline is made of at most 256 files"), "{shown}");
    assert_eq!(shown.matches("error: ").count(), 1, "{shown}");
    assert!(files.0 < 1_000, "{} files were read", files.0);
    assert!(memory < 16 << 20, "reading took {memory} bytes");
}

#[test]
fn a_hundred_thousand_passes_are_put_in_in_bounded_memory() {
    let fragments = r#"(name: "f0", parameters: [(name: "target", value: Image)], passes: [
        (name: "draw", repeat: ("i", 10), draw: FullScreen("plain"), color: ["target"])])"#;
    let uses = r#"(use: "f0", name: "many", repeat: ("i", 10000), with: {"target": "screen"})"#;
    let text = pipeline(fragments, uses);
    let mut passes = 0;
    let measured = allocation_counter::measure(|| {
        passes = frame(&text, &INPUTS).unwrap_or_else(|answer| panic!("{answer}")).passes.len();
    });
    assert_eq!(passes, 100_001);
    let each = measured.bytes_max / 100_001;
    assert!(each < 4096, "{each} bytes for each pass at the peak");
}

/// Files that all hold no fragment, and how often one was read.
struct Counted(u32);

impl Files for Counted {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        self.0 += 1;
        let bytes = b"Fragments(version: 1, fragments: [])".to_vec();
        Ok(FoundFile { shown: path.to_owned(), relative: path.into(), bytes })
    }
}

#[test]
fn a_file_that_is_named_again_and_again_is_read_a_thousand_times_at_most() {
    let mut files = Counted(0);
    let again = r#""lib.ron","#.repeat(20_000);
    let (shown, _) =
        answer(&mut files, &pipeline("", "").replace("version: 1,", &format!("version: 1, include: [{again}],")));
    assert!(shown.contains("error: the files of a pipeline name others at most 1024 times"), "{}", &shown[..400]);
    assert_eq!(files.0, 1024);
}

/// A right pipeline, but for `wrong` among its fields.
fn with_field(wrong: &str) -> String {
    pipeline("", "").replacen("version: 1,", &format!("version: 1, {wrong},"), 1)
}

#[test]
fn a_value_that_a_choice_of_a_million_refuses_is_answered_with_a_dozen_of_them() {
    let all: String = (1..=1_000_000).map(|value| format!("{value},")).collect();
    let text = with_field(&format!("settings: [(name: \"many\", value: OneOf(default: 1, of: [{all}]))]"));
    let set = [("many".to_owned(), "0".to_owned())];
    let shown = frame(&text, &Inputs { set: &set, ..INPUTS }).expect_err("a value that isn't allowed");
    assert!(shown.contains("it is one of 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 and 999988 more"), "{}", &shown[..400]);
    assert!(shown.len() < 1_000, "{} bytes", shown.len());
}

#[test]
fn a_token_of_a_million_letters_is_not_echoed_whole() {
    let (token, number) = ("X".repeat(1_000_000), format!("{}x", "1".repeat(1_000_000)));
    for wrong in [
        format!("depth: {token}"),
        format!("{token}: 1"),
        format!("views: {number}"),
        format!("settings: [(name: \"{token}\", value: Bool(default: true))]"),
        format!("settings: [(name: \"a\", value: OneOf(default: \"b\", of: [\"{token}\"]))]"),
        format!("include: [\"{token}\"]"),
    ] {
        let (shown, _) = alone(&with_field(&wrong));
        assert!(shown.len() < 2_000, "{} bytes: {}…", shown.len(), &shown[..300]);
        assert!(shown.starts_with("error: "), "{}", &shown[..300]);
    }
}

#[test]
fn thirty_thousand_files_that_are_not_there_are_answered_briefly_in_json_too() {
    let deep = "a/".repeat(1_000);
    let all: String = (0..30_000).map(|at| format!("\"{deep}{at}.ron\",")).collect();
    let text =
        with_field(&format!("include: [{}]", &all[..all.len().min(4_000_000)].rsplit_once(',').expect("several").0));
    let mut sources = Sources::default();
    let errors = language::read_with(&mut sources, &mut language::NoFiles, "bomb.ron", "bomb.ron", text);
    let errors = errors.expect_err("files that are not there");
    let json = base::to_json(&sources, &errors).to_string();
    assert!(json.len() < 600_000, "{} bytes of JSON", json.len());
    let shown = base::render(&sources, &errors);
    assert!(shown.len() < 20_000, "{} bytes", shown.len());
}

#[test]
fn sixteen_million_commas_are_a_few_mistakes() {
    let text = with_field(&format!("views: [{}", ",".repeat(16_000_000)));
    let (shown, memory) = alone(&text);
    assert!(shown.contains("error: expected a value, found `,`"), "{shown}");
    assert!(shown.contains("… and at least "), "{shown}");
    assert!(memory < 128 << 20, "reading took {memory} bytes");
}

#[test]
fn a_million_unknown_fields_are_answered_soon() {
    let all: String = (0..1_000_000).map(|at| format!("f{at}: 1,")).collect();
    let text = with_field(all.trim_end_matches(','));
    let mut shown = String::new();
    let measured = allocation_counter::measure(|| {
        let mut sources = Sources::default();
        let errors = language::read(&mut sources, "bomb.ron", "bomb.ron", text).expect_err("a bad file");
        shown = base::render(&sources, &errors);
    });
    assert!(shown.contains("the pipeline has no field `f0`") && shown.contains("… and at least "), "{shown}");
    assert!(measured.bytes_max < 300 << 20, "reading took {} bytes", measured.bytes_max);
    // A message or a near name for each would allocate a million times.
    assert!(measured.count_total < 100_000, "{} allocations", measured.count_total);
}
