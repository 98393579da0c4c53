//! Large files of changes. Each of these is read in a second or two; were its time to grow with the square of the number of
//! changes, it would take many minutes.

use framewright_graph::base::{Diagnostic, FilePath, Sources};
use framewright_graph::language::{self, Files, FoundFile, ReadFailure};

/// A large number of changes, or of other things.
const MANY: usize = 100_000;

/// Few enough for each of their mistakes to be told.
const FEW: usize = 80;

/// The most mistakes that are told.
const MOST_KEPT: usize = 256;

/// The pipeline that is extended.
struct Base(String);

impl Files for Base {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        Ok(FoundFile { shown: path.to_owned(), relative: path.into(), bytes: self.0.clone().into_bytes() })
    }
}

/// The mistakes of `changes` to a pipeline of these passes, images and outputs.
fn mistakes(passes: &str, images: &str, outputs: &str, changes: &str) -> Vec<Diagnostic> {
    let base = format!(
        r#"Pipeline(version: 1, images: [(name: "screen", format: Output, size: Output), {images}], passes: [{passes}],
        outputs: ["screen", {outputs}])"#
    );
    let text = format!("Pipeline(version: 1, extends: \"base.ron\", changes: [{changes}])");
    language::read_with(&mut Sources::default(), &mut Base(base), "test.ron", "test.ron", text)
        .err()
        .unwrap_or_default()
}

/// `one` of each number.
fn each(one: impl Fn(usize) -> String) -> String {
    (0..MANY).map(one).collect()
}

const PASS: &str = r#"(name: "one", draw: FullScreen("plain"), params: {"first": 0.0}, color: ["screen"]),"#;

#[test]
fn a_hundred_thousand_entries_of_a_map_are_set_and_set_again() {
    let entries = each(|at| format!("\"k{at}\": 1.0, "));
    let set = format!("Set(pass: \"one\", to: (params: {{{entries}}})),");
    assert_eq!(mistakes(PASS, "", "", &set.repeat(2)), []);
}

#[test]
fn a_hundred_thousand_fields_are_set_and_taken_away() {
    let fields = each(|at| format!("f{at}: 1, "));
    let names = each(|at| format!("\"f{at}\", "));
    let changes = format!("Set(pass: \"one\", to: ({fields})), Set(pass: \"one\", without: [{names}])");
    assert_eq!(mistakes(PASS, "", "", &changes), []);
}

#[test]
fn a_hundred_thousand_changes_each_with_its_mistake_show_both_places() {
    let passes = each(|at| format!("(name: \"p{at}\", draw: FullScreen(\"plain\"), color: [\"screen\"]),"));
    let changes = each(|at| format!("Set(pass: \"p{at}\", to: (drow: 1)),"));
    let mistakes = mistakes(&passes, "", "", &changes);
    assert_eq!(mistakes.len(), MOST_KEPT);
    for (at, mistake) in mistakes.iter().enumerate() {
        assert_eq!(mistake.message, format!("pass `p{at}` has no field `drow`"));
        assert_eq!(mistake.labels[1].text, format!("`p{at}` stands here"));
    }
}

#[test]
fn a_hundred_thousand_things_are_removed_that_are_missed_or_never_were() {
    let image = |at: usize| format!("(name: \"i{at}\", format: Output, size: Output),");
    let remove = |at: usize| format!("Remove(image: \"i{at}\"), Remove(image: \"i{at}\"), Remove(pass: \"p{at}\"),");
    let output = |at: usize| format!("\"i{at}\", ");
    let few: [String; 3] =
        [&image as &dyn Fn(usize) -> String, &output, &remove].map(|make| (0..FEW).map(make).collect());
    let found = mistakes(PASS, &few[0], &few[1], &few[2]);
    let count = |words: &str| found.iter().filter(|mistake| mistake.message.contains(words)).count();
    assert_eq!(count("is removed already"), FEW);
    assert_eq!(count("there is no pass named"), FEW);
    let missed = found.iter().filter(|mistake| mistake.message.contains("there is no image named"));
    assert!(missed.clone().all(|mistake| mistake.labels[1].text.ends_with("is removed here")));
    assert_eq!(missed.count(), FEW);
    let outputs = each(output);
    assert_eq!(mistakes(PASS, &each(image), &outputs, &each(remove)).len(), MOST_KEPT);

    let changes = each(|at| format!("Remove(output: \"i{at}\"),"));
    assert_eq!(mistakes(PASS, &each(image), &outputs, &changes), []);
}
