//! An engine's frame of 114 passes draws equal pictures in GLSL, HLSL and Slang (DO-2).
//!
//! `tests/pipelines/frame` has it in GLSL and in HLSL. In Slang it is the HLSL, with what Slang writes otherwise.

use crate::testing::{Place, Vulkan, repository};
use image::RgbImage;
use std::fs;
use std::process::Command;

/// A way to compile the frame's own shaders: its name, the language, the option that names the compiler, and the compiler's program.
struct Way {
    name: &'static str,
    ending: &'static str,
    compiler: Option<[&'static str; 2]>,
}

const GLSL: Way = Way { name: "GLSL", ending: "", compiler: None };
const HLSL: Way = Way { name: "HLSL by shaderc", ending: ".hlsl", compiler: None };
const OTHERS: [Way; 3] = [
    Way { name: "HLSL by glslang", ending: ".hlsl", compiler: Some(["hlsl=glslangValidator", "glslangValidator"]) },
    Way { name: "HLSL by DXC", ending: ".hlsl", compiler: Some(["hlsl=dxc", "dxc"]) },
    Way { name: "Slang", ending: ".slang", compiler: Some(["slang=slangc -O0", "slangc"]) },
];

/// What Slang writes otherwise than HLSL. Formats of images are its own, it counts vertices as Vulkan does by these names, and an array
/// of images is indexed by a constant only where the function is inlined.
fn in_slang(hlsl: &str) -> String {
    let mut text = String::new();
    for line in hlsl.lines() {
        let stage = ["CSMain(", "VSMain(", "PSMain("].iter().position(|entry| line.contains(entry));
        let stage = stage.filter(|_| !line.starts_with(' ')).map(|stage| ["compute", "vertex", "fragment"][stage]);
        text += &stage.map_or_else(String::new, |stage| format!("[shader(\"{stage}\")]\n"));
        let formatted =
            line.strip_prefix("[[spv::format_").and_then(|rest| rest.split_once("]] [[vk::image_format(\""));
        match formatted.and_then(|(format, rest)| Some((format, rest.split_once("]]")?.1))) {
            Some((format, rest)) => text += &format!("[format(\"{format}\")]{rest}\n"),
            None => text += &format!("{line}\n"),
        }
    }
    let mut text = text
        .replace("SV_VertexID", "SV_VulkanVertexID")
        .replace("SV_InstanceID", "SV_VulkanInstanceID")
        .replace("bool may_be_seen", "[ForceInline]\nbool may_be_seen");
    for own in ["camera", "scene", "cull", "gpu_vertex", "pyramid", "particle", "found"] {
        text = text.replace(&format!("#include \"{own}.hlsl\""), &format!("#include \"{own}.slang\""));
    }
    text
}

/// The frame with its shaders in a language.
fn frame(way: &Way) -> Place {
    let place = Place::new();
    fs::create_dir(place.path("fx")).expect("made");
    let folder = repository("tests/pipelines/frame");
    let (mut pipelines, mut shaders) = (Vec::new(), Vec::new());
    for name in ["", "fx"].iter().flat_map(|below| fs::read_dir(folder.join(below)).expect("listed")) {
        let path = name.expect("listed").path();
        let name = path.strip_prefix(&folder).expect("within").to_string_lossy().into_owned();
        if path.is_dir() {
            continue;
        }
        let bytes = fs::read(&path).expect("read");
        match name.rsplit_once('.') {
            Some((_, "ron")) => pipelines.push((name, String::from_utf8(bytes).expect("a text"))),
            Some((stem, "hlsl")) => {
                let text = String::from_utf8(bytes).expect("a text");
                let own = if way.ending == ".slang" { in_slang(&text) } else { text.clone() };
                if !way.ending.is_empty() {
                    place.file(format!("{stem}{}", way.ending), own);
                }
                shaders.push((stem.to_owned(), text));
            }
            // Nothing else is there that could be drawn in place of the language's own.
            Some((_, "comp" | "frag" | "vert" | "glsl")) if !way.ending.is_empty() => {}
            _ => _ = place.file(name, bytes),
        }
    }
    for (name, mut text) in pipelines {
        for (stem, shader) in shaders.iter().filter(|_| !way.ending.is_empty()) {
            let file = format!("{stem}{}", way.ending);
            let vertex =
                if shader.contains("VSMain(") { format!("vertex: \"{file}:VSMain\", ") } else { String::new() };
            text = text
                .replace(&format!("FullScreen(\"{stem}\")"), &format!("FullScreen(\"{file}:PSMain\")"))
                .replace(&format!("dispatch: \"{stem}\""), &format!("dispatch: \"{file}:CSMain\""))
                .replace(&format!("shader: \"{stem}\""), &format!("shader: ({vertex}fragment: \"{file}:PSMain\")"));
        }
        place.file(name, text);
    }
    place
}

/// The picture of the frame's third time; `None`: this driver can't draw it, which is said.
fn drawn(way: &Way, vulkan: Vulkan, variables: &[(&str, &str)], more: &[&str]) -> Option<RgbImage> {
    let place = frame(way);
    let scene = ["run", "frame.ron", "--scene", "spheres_and_cubes", "--size", "128x72", "--frames", "3", "--validate"];
    let compiler = way.compiler.iter().flat_map(|[option, _]| ["--shader-compiler", option]);
    let arguments: Vec<&str> = scene.iter().chain(more).copied().chain(["-o", "drawn.png"]).chain(compiler).collect();
    let outcome = place.run_with(variables, &arguments);
    // OpCopyLogical of structures, which slangc writes, is too much for Mesa 22.
    if way.ending == ".slang" && vulkan.is_lavapipe() && outcome.err.contains("creating a pipeline failed") {
        println!(
            "skipped: {}: {}",
            way.name,
            outcome.err.lines().find(|line| line.starts_with("error")).unwrap_or_default()
        );
        return None;
    }
    let outcome = outcome.exits(0);
    assert!(outcome.out.contains("validation: silent; "), "{}: {}", way.name, outcome.out);
    Some(image::open(place.path("drawn.png")).expect("a picture").into_rgb8())
}

/// Compilers contract and reorder sums, and filters of a part keep off its edges: a pixel in four hundred may differ by a few steps.
fn assert_alike(one: &RgbImage, other: &RgbImage, how: &str) {
    assert_eq!(one.dimensions(), other.dimensions());
    let steps = one
        .pixels()
        .zip(other.pixels())
        .map(|(one, other)| one.0.iter().zip(other.0).map(|(one, other)| one.abs_diff(other)).max().unwrap_or(0));
    let different: Vec<u8> = steps.filter(|step| *step > 0).collect();
    let worst = different.iter().max().copied().unwrap_or(0);
    println!("{how}: {} pixels differ, by {worst} at most", different.len());
    assert!(different.len() <= (one.width() * one.height()) as usize / 400 && worst <= 8, "{how}");
}

#[test]
fn a_frame_of_an_engine_draws_the_same_in_each_language() {
    for vulkan in [Vulkan::LAVAPIPE_CURRENT, Vulkan::SWIFTSHADER_CURRENT] {
        let Some(variables) = vulkan.variables() else { continue };
        let glsl = drawn(&GLSL, vulkan, &variables, &[]).expect("GLSL is always drawn");
        // It is a picture.
        assert!(glsl.pixels().collect::<std::collections::HashSet<_>>().len() > 500);
        let others = OTHERS.iter().filter(|way| {
            let program = way.compiler.map_or("", |[_, program]| program);
            let there = Command::new(program).arg("--version").output().is_ok();
            if !there {
                println!("skipped: `{program}` isn't there; tests/compilers/fetch.sh fetches compilers");
            }
            there
        });
        for way in std::iter::once(&HLSL).chain(others) {
            let Some(picture) = drawn(way, vulkan, &variables, &[]) else { continue };
            assert_alike(&glsl, &picture, &format!("{} on {vulkan:?}", way.name));
        }
    }
}

#[test]
fn do_12_both_eyes_drawn_at_once_are_what_each_draws_by_itself() {
    let vulkan = Vulkan::SWIFTSHADER_CURRENT;
    let Some(variables) = vulkan.variables() else { return };
    for way in [&GLSL, &HLSL] {
        let [apart, at_once] =
            ["multi-pass", "multiview"].map(|mode| drawn(way, vulkan, &variables, &["--stereo", mode]));
        assert!(apart.is_some() && apart == at_once, "{}", way.name);
    }
    // Compute passes store into the layer of their eye, so most of the frame is drawn once.
    let passes = |mode| {
        let place = frame(&GLSL);
        let said = place.run(&["check", "frame.ron", "--device", "nvidia-rtx-2080", "--stereo", mode]).exits(0).out;
        let (before, _) = said.split_once(" passes in ").expect("how many");
        before.rsplit(' ').next().and_then(|number| number.parse::<u32>().ok()).expect("a number")
    };
    let [apart, at_once] = ["multi-pass", "multiview"].map(passes);
    assert!(at_once < apart * 3 / 4, "{at_once} of {apart} passes");
}

/// The share of the output that the frame is rendered at, which may be another one in each frame.
const RENDERED: &str = "if(render_scale == 'native', 1, if(render_scale == 'quality', 0.6667, 0.5))";

#[test]
fn do_10_what_is_used_in_part_draws_what_images_of_that_size_draw() {
    let vulkan = Vulkan::LAVAPIPE_CURRENT;
    let Some(variables) = vulkan.variables() else { return };
    for scale in ["quality", "performance"] {
        let setting = format!("render_scale={scale}");
        let drawn = |place: &Place| {
            let run = ["run", "frame.ron", "--scene", "spheres_and_cubes", "--size", "128x72", "--frames", "3"];
            let outcome =
                place.run_with(&variables, &[&run[..], &["--validate", "--set", &setting, "-o", "it.png"]].concat());
            assert!(outcome.exits(0).out.contains("validation: silent; "), "{scale}");
            image::open(place.path("it.png")).expect("a picture").into_rgb8()
        };
        let part = frame(&GLSL);
        let whole = frame(&GLSL);
        let text = fs::read_to_string(whole.path("frame.ron")).expect("read");
        let dynamic = format!("Dynamic(by: \"{RENDERED}\", up_to: 1.0)");
        assert_eq!(text.matches(&dynamic).count(), 1);
        whole.file("frame.ron", text.replace(&dynamic, &format!("Scaled(\"{RENDERED}\")")));
        assert_alike(&drawn(&whole), &drawn(&part), &setting);
    }
}

#[test]
fn the_example_in_slang_draws_what_the_one_in_hlsl_draws() {
    if Command::new("slangc").arg("--version").output().is_err() {
        println!("skipped: `slangc` isn't there; tests/compilers/fetch.sh fetches compilers");
        return;
    }
    let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
    let drawn = |file: &str| {
        let place = Place::new();
        for name in ["tint.hlsl", "tint.slang"] {
            place.file(name, fs::read(repository("examples/hlsl").join(name)).expect("read"));
        }
        let pipeline = fs::read_to_string(repository("examples/hlsl/tint.ron")).expect("read");
        place.file("tint.ron", pipeline.replace("tint.hlsl:PSMain", file));
        let run =
            ["run", "tint.ron", "--scene", "spheres_and_cubes", "--size", "64x36", "--validate", "-o", "drawn.png"];
        let slang = ["--shader-compiler", "slang=slangc -O0"];
        let outcome = place.run_with(&variables, &[&run[..], &slang[..]].concat()).exits(0);
        assert!(outcome.out.contains("validation: silent; "), "{file}: {}", outcome.out);
        image::open(place.path("drawn.png")).expect("a picture").into_rgb8()
    };
    assert_alike(&drawn("tint.hlsl:PSMain"), &drawn("tint.slang"), "the example");
}
