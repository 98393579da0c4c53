//! The examples of `docs/pipeline-format.md`.

use crate::table::{INPUTS, frame};

/// Texts between the lines "```ron" and "```".
fn examples() -> Vec<String> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/pipeline-format.md");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let fenced = text.split("```ron\n").skip(1);
    fenced.map(|after| after.split("```").next().unwrap_or_default().to_owned()).collect()
}

#[test]
fn every_example_of_the_documentation_is_right() {
    let examples = examples();
    assert_eq!(examples.len(), 10);
    for example in examples {
        let text = if example.starts_with("Pipeline") {
            example
        } else {
            let (images, buffers) = if example.contains("bytes:") { ("", &*example) } else { (&*example, "") };
            format!(
                r#"Pipeline(version: 1, settings: [(name: "count", value: Integer(default: 9, min: 1, max: 99))],
                    images: [(name: "screen", format: Output, size: Output), {images}], buffers: [{buffers}],
                    passes: [(name: "show", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#
            )
        };
        if let Err(answer) = frame(&text, &INPUTS) {
            panic!("{answer}");
        }
    }
}
