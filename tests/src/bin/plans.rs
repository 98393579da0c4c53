//! Writes the Plans of the repository's pipelines and of random ones, without their sentences: what two builds of the compiler
//! write is compared to see whether a change of the program changed Plans.
//!
//! ```text
//! plans /tmp/before        in a checkout of before
//! plans /tmp/after         in this one
//! diff -rq /tmp/before /tmp/after
//! ```

use framewright_graph::base::{Diagnostic, Root, Sources, render};
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues, SHIPPED_PROFILES};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::language::{Document, Facts, PipelineFiles, read_with};
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::{Rotation, Sharing};
use framewright_passes::draw::interfaces;
use framewright_passes::shipped::SHADERS;
use framewright_tests::random_pipelines::allowed::Allowed;
use framewright_tests::random_pipelines::{generate, passes, to_frame};
use framewright_tests::render::in_repository;
use framewright_tests::shipped;
use framewright_vulkan::ShaderLibrary;
use serde_json::Value;
use std::fs::{create_dir_all, read_dir, read_to_string, write};
use std::io::Result;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

/// Where pipelines lie in the repository.
const FOLDERS: [&str; 2] = ["examples/pipelines", "tests/pipelines"];
/// Ways of drawing for two eyes, or for one.
const STEREO: [Stereo; 5] = [Stereo::Off, Stereo::MultiPass, Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];
/// How many random pipelines.
const RANDOM: u64 = 2000;

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("usage: plans FOLDER");
        return ExitCode::from(2);
    };
    match of_files(&folder).and_then(|files| Ok(files + of_shipped(&folder)? + of_random(&folder)?)) {
        Ok(plans) => {
            println!("{plans} Plans in {}", folder.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {}: {error}", folder.display());
            ExitCode::from(3)
        }
    }
}

/// Every pipeline file with its settings as they are, in each way of drawing and turned by a quarter, on each shipped device.
fn of_files(into: &Path) -> Result<usize> {
    let mut shaders = ShaderLibrary::new(vec![Root::new(in_repository("tests/shaders"))], SHADERS, interfaces());
    let mut written = 0;
    for folder in FOLDERS {
        let mut files: Vec<_> = read_dir(in_repository(folder))?.map(|file| Ok(file?.path())).collect::<Result<_>>()?;
        files.retain(|file| file.extension().is_some_and(|end| end == "ron"));
        files.sort();
        for file in files {
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let mut sources = Sources::default();
            let mut named = PipelineFiles::beside(Root::new(in_repository(folder)), &name, &[]);
            // A settings file isn't a pipeline.
            let Ok(pipeline) = read_with(&mut sources, &mut named, &name, &name, read_to_string(&file)?) else {
                continue;
            };
            let sources = Arc::new(sources);
            let turned = STEREO.map(|stereo| (stereo, Rotation::Identity)).into_iter();
            for (stereo, rotation) in turned.chain([(Stereo::Off, Rotation::Rotate90)]) {
                let frame = framed(&pipeline, &sources, stereo, rotation, &mut shaders);
                let into = into.join(folder).join(format!("{name} {stereo:?} {rotation:?}"));
                written += on_each_device(&into, &frame)?;
            }
        }
    }
    Ok(written)
}

fn framed(
    pipeline: &Document,
    sources: &Arc<Sources>,
    stereo: Stereo,
    rotation: Rotation,
    shaders: &mut ShaderLibrary,
) -> std::result::Result<Frame, String> {
    let inputs = Inputs {
        set: &[],
        facts: Facts::UNKNOWN,
        facts_known: true,
        output_extent: [333, 187],
        dump: &[],
        device: None,
        rotation,
        stereo,
        window: None,
    };
    expand(pipeline, sources.clone(), &inputs, shaders).map_err(|wrong| render(sources, &wrong))
}

/// The shipped pipelines in the combinations of their settings, on each shipped device.
fn of_shipped(into: &Path) -> Result<usize> {
    let mut written = 0;
    for (number, shipped) in shipped::frames([333, 187]).iter().enumerate() {
        written += on_each_device(&into.join("settings").join(number.to_string()), &Ok(shipped.frame.clone()))?;
    }
    Ok(written)
}

fn on_each_device(into: &Path, frame: &std::result::Result<Frame, String>) -> Result<usize> {
    let frame = match frame {
        Ok(frame) => frame,
        Err(wrong) => return kept(into, wrong),
    };
    let mut written = 0;
    for (name, text) in SHIPPED_PROFILES {
        let profile = Profile::from_ron(text).expect("shipped profiles are read");
        written += plan(&into.join(name), frame, &profile, &Options::default())?;
    }
    Ok(written)
}

/// Random pipelines for one queue and for several, with every order of execution.
fn of_random(into: &Path) -> Result<usize> {
    let mut written = 0;
    for seed in 0..RANDOM {
        let frame = to_frame::to_frame(&generate::pipeline(seed, passes(seed, 40), &Allowed::today()));
        let orders = [Order::Default, Order::File, Order::LowMemory, Order::Random(seed)];
        let options = Options {
            alias: seed % 3 != 0,
            poison: seed % 5 == 0,
            readable: false,
            order: orders[(seed / 2 % 4) as usize],
            demote: seed % 7 != 0,
            queues: true,
        };
        let sharing = if seed % 5 == 1 { Sharing::Concurrent } else { Sharing::Exclusive };
        let wait_bytes = [0, 4 << 10, 64 << 10][(seed / 5 % 3) as usize];
        let queues = Queues { compute: seed % 5 < 3, transfer: seed % 5 < 2, sharing, wait_bytes };
        let device = framewright_tests::frames::device();
        let device = Profile { local_read: seed.is_multiple_of(2), queues, ..device };
        written += plan(&into.join("random").join(seed.to_string()), &frame, &device, &options)?;
    }
    Ok(written)
}

fn plan(into: &Path, frame: &Frame, device: &Profile, options: &Options) -> Result<usize> {
    let text = match compile(frame, device, &mut MemoryEstimate(device), options) {
        Ok(plan) => without_sentences(&plan),
        Err(wrong) => messages(&wrong),
    };
    kept(into, &text)
}

fn messages(wrong: &[Diagnostic]) -> String {
    wrong.iter().map(|wrong| format!("{}\n", wrong.message)).collect()
}

fn kept(into: &Path, text: &str) -> Result<usize> {
    into.parent().map_or(Ok(()), create_dir_all)?;
    write(into.with_added_extension("json"), text)?;
    Ok(1)
}

/// The JSON form of version 13, without what is said in words and without its version.
fn without_sentences(plan: &Plan) -> String {
    let mut value = serde_json::to_value(plan).expect("random and shipped pipelines hold finite numbers");
    strip(&mut value);
    let steps = value["steps"].as_array_mut().into_iter().flatten();
    steps.filter_map(|step| step["work"].get_mut("render")).for_each(as_version_13);
    serde_json::to_string_pretty(&value).expect("JSON is written as text")
}

/// Puts the attachments of a scope where version 13 had them: those of colour in a list, those of depth and stencil in fields.
fn as_version_13(scope: &mut Value) {
    let attachments = scope["attachments"].take();
    let of_kind = |kind: &str| -> Vec<Value> {
        let own = attachments.as_array().into_iter().flatten().filter(|it| it["kind"] == kind).cloned();
        let old = own.map(|mut it| {
            it.as_object_mut().and_then(|fields| fields.remove("kind"));
            it
        });
        old.collect()
    };
    let [depth, stencil] = ["depth", "stencil"].map(|kind| of_kind(kind).pop().unwrap_or_default());
    let color = of_kind("color").into();
    if let Some(fields) = scope.as_object_mut() {
        fields.remove("attachments");
        fields
            .extend([("color", color), ("depth", depth), ("stencil", stencil)].map(|(name, it)| (name.to_owned(), it)));
    }
}

fn strip(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            for sentence in ["because", "notes", "untouched", "format_version"] {
                fields.remove(sentence);
            }
            fields.values_mut().for_each(strip);
        }
        Value::Array(values) => values.iter_mut().for_each(strip),
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => (),
    }
}
