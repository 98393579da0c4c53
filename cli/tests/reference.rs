//! Whole files in the reference can be copied: the command itself says that they are fine.

mod support;

use support::{Place, repository};

/// Each block of RON in the pages under `docs/`.
fn examples() -> Vec<String> {
    let pages = std::fs::read_dir(repository("docs")).expect("the pages");
    let mut pages: Vec<_> = pages.map(|page| page.expect("readable").path()).collect();
    pages.retain(|page| page.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    let texts = pages.iter().map(|page| std::fs::read_to_string(page).expect("a text"));
    let blocks = texts.flat_map(|text| text.split("```ron\n").skip(1).map(str::to_owned).collect::<Vec<_>>());
    blocks.map(|after| after.split("```").next().unwrap_or_default().to_owned()).collect()
}

/// The smallest picture.
fn picture() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(4, 4).write_to(&mut bytes, image::ImageFormat::Png).expect("written");
    bytes.into_inner()
}

#[test]
fn every_whole_file_of_the_reference_is_fine() {
    let place = Place::new();
    place.file("grain.png", picture());
    let mut checked = 0;
    for example in examples() {
        let file = place.file("example.ron", &example);
        let name = file.to_str().expect("a plain path");
        let arguments = match example.split('(').next() {
            Some("Pipeline") => vec!["check", name],
            Some("Extension") => vec!["check", "forward", "--extend", name],
            Some("Settings") => vec!["check", "post", "--settings", name],
            Some("Fragments") => {
                let including = "Pipeline(version: 1, include: [\"example.ron\"], \
                    images: [(name: \"screen\", format: Output, size: Output)], \
                    passes: [(use: \"wipe\", name: \"all\", with: {\"target\": \"screen\"})], outputs: [\"screen\"])";
                place.file("including.ron", including);
                vec!["check", "including.ron"]
            }
            // A part of a file, which a test of the reference puts into one.
            _ => continue,
        };
        checked += 1;
        let outcome = place.run(&arguments);
        assert_eq!(outcome.code, Some(0), "{example}\n{}", outcome.err);
    }
    assert!(checked >= 11, "{checked} whole files");
}
