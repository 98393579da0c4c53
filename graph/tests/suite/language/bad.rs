//! Every file under `bad/` is wrong, its name says how, and the whole answer stands beside it.

use crate::testing::pipelines::{INPUTS, Pictures};
use crate::testing::plans::shipped;
use crate::testing::table::Table;
use framewright_graph::base::{self, Diagnostic, FilePath, Sources};
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::frame::{Stereo, TextureFile, TextureInfo, TextureProblem};
use framewright_graph::language::{self, Files, FoundFile, ReadFailure};
use framewright_graph::vulkan::Rotation;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Mistakes that are shown before the others are counted.
const MOST_SHOWN: usize = 20;

/// The settings, dumps and size that a file's first lines ask for: `//! set NAME=VALUE`, `//! dump IMAGE`, `//! size WxH`.
/// Beside them may stand `//! rotate 90` and `//! eyes 2`; `//! device NAME` has the file compiled for a shipped device too,
/// `//! device NAME without FORMAT` for that device without a format.
fn asked(text: &str) -> (Vec<(String, String)>, Vec<String>, [u32; 2]) {
    let (mut set, mut dump, mut size) = (Vec::new(), Vec::new(), INPUTS.output_extent);
    for line in text.lines().map_while(|line| line.strip_prefix("//! ")) {
        match line.split_once(' ') {
            Some(("set", choice)) => {
                let (name, value) = choice.split_once('=').expect("set NAME=VALUE");
                set.push((name.to_owned(), value.to_owned()));
            }
            Some(("dump", image)) => dump.push(image.to_owned()),
            Some(("size", extent)) => {
                let (width, height) = extent.split_once('x').expect("size WxH");
                size = [width, height].map(|extent| extent.parse().expect("a whole number"));
            }
            Some(("device" | "rotate" | "eyes", _)) => {}
            _ => panic!("what is `{line}`?"),
        }
    }
    (set, dump, size)
}

/// Files beside the wrong ones.
struct Folder;

impl Files for Folder {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        let bytes = std::fs::read(folder().join(path)).map_err(|_| format!("there is no file `{path}`"))?;
        Ok(FoundFile { shown: path.to_owned(), relative: path.into(), bytes })
    }

    fn picture(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        Pictures::info(file)
    }
}

/// The device that a file is compiled for, if its first line names one.
pub(crate) fn device(text: &str) -> Option<Profile> {
    let asked = text.strip_prefix("//! device ")?.lines().next()?;
    let (name, lacks) = asked.split_once(" without ").unwrap_or((asked, ""));
    let mut profile = shipped(name);
    profile.formats.retain(|it| it.format.name() != lacks);
    Some(profile)
}

/// The mistakes of a file.
pub(crate) fn mistakes(name: &str, text: String) -> (Arc<Sources>, Vec<Diagnostic>) {
    let (sources, errors) = mistakes_if_any(name, text);
    assert!(!errors.is_empty(), "{name}");
    (sources, errors)
}

/// The mistakes of a file that may be right.
pub(crate) fn mistakes_if_any(name: &str, text: String) -> (Arc<Sources>, Vec<Diagnostic>) {
    let (set, dump, output_extent) = asked(&text);
    let device = device(&text);
    let stereo = if text.contains("//! eyes 2\n") { Stereo::MultiPass } else { Stereo::Off };
    let rotation = if text.contains("//! rotate 90\n") { Rotation::Rotate90 } else { Rotation::Identity };
    let inputs = Inputs { set: &set, dump: &dump, output_extent, device: device.as_ref(), rotation, stereo, ..INPUTS };
    let mut sources = Sources::default();
    let pipeline = language::read_with(&mut sources, &mut Folder, name, name, text);
    let sources = Arc::new(sources);
    let frame = pipeline.and_then(|pipeline| expand(&pipeline, sources.clone(), &inputs, &mut Table));
    let plan = frame.and_then(|frame| match device {
        Some(device) => compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default()).map(drop),
        None => Ok(()),
    });
    (sources, plan.err().unwrap_or_default())
}

/// The answer about a file, in both forms.
fn answer(name: &str, text: String) -> (String, serde_json::Value) {
    let (sources, errors) = mistakes(name, text);
    // All are pinned, so none is left to be counted.
    let shown: Vec<String> = errors.chunks(MOST_SHOWN).map(|some| base::render(&sources, some)).collect();
    (shown.join("\n"), base::to_json(&sources, &errors))
}

pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/language/bad")
}

pub(crate) fn files(extension: &str) -> Vec<PathBuf> {
    let entries = folder().read_dir().expect("the folder of bad files");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.retain(|path| path.extension().is_some_and(|found| found == extension));
    files.sort();
    files
}

#[test]
fn every_bad_file_is_answered_as_it_stands_beside_it() {
    for path in files("ron") {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let (shown, json) = answer(&name, std::fs::read_to_string(&path).expect("a text"));
        assert!(shown.starts_with("error: ") && !shown.contains("a mistake of framewright itself"), "{name}\n{shown}");
        let visible = |c: char| c == '\n' || !c.is_control();
        assert!(shown.chars().all(visible), "{name} is shown with control characters");
        let blocks = shown.lines().filter(|line| line.starts_with("error: ")).count();
        assert_eq!(json.as_array().map(Vec::len), Some(blocks), "{name}: one block each");
        insta::with_settings!({
            snapshot_path => folder(), prepend_module_to_snapshot => false, omit_expression => true,
        }, { insta::assert_snapshot!(name.trim_end_matches(".ron"), shown) });
    }
}

#[test]
fn no_answer_stands_alone() {
    for path in files("snap") {
        assert!(path.with_extension("ron").exists(), "{} has no file that it answers", path.display());
    }
}
