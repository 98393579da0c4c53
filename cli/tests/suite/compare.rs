//! `compare`: metrics agree with their published implementations, planted errors move them, and limits decide (NU-2).

use crate::testing::shell::shell;
use crate::testing::{Place, repository};
use serde_json::Value;
use std::path::PathBuf;

/// The difference that a figure may have from the published implementation's, which calculates with 32 bits.
const AGREEMENT: f64 = 1e-4;

fn picture(name: &str) -> PathBuf {
    repository("cli/tests/metrics").join(name)
}

/// The JSON answer about two of the judged pictures.
fn errors(reference: &str, test: &str) -> Value {
    let [reference, test] = [reference, test].map(picture);
    let arguments = ["compare".as_ref(), reference.as_os_str(), test.as_os_str(), "--format".as_ref(), "json".as_ref()];
    let out = Place::new().run(&arguments).exits(0).out;
    serde_json::from_str::<Value>(&out).expect("JSON")["errors"].clone()
}

/// A float OpenEXR file of one colour, with some pixels put in.
fn light(place: &Place, name: &str, color: [f32; 3], others: &[[f32; 3]]) {
    let color_at = |x: usize, y: usize| others.get(x + 16 * y).map_or(color, |other| *other);
    let image = exr::prelude::Image::from_channels(
        (16, 16),
        exr::prelude::SpecificChannels::rgb(|at: exr::prelude::Vec2<usize>| {
            let [red, green, blue] = color_at(at.x(), at.y());
            (red, green, blue)
        }),
    );
    exr::prelude::WritableImage::write(&image).to_file(place.path(name)).expect("written");
}

/// A PNG of one grey, which is small whatever its size.
pub(crate) fn grey(place: &Place, name: &str, side: u32) {
    let file = std::fs::File::create(place.path(name)).expect("made");
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), side, side);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().expect("written");
    let mut stream = writer.stream_writer().expect("begun");
    let row = vec![0; side as usize];
    (0..side).for_each(|_| std::io::Write::write_all(&mut stream, &row).expect("written"));
    stream.finish().expect("written");
}

#[cfg(target_os = "linux")]
#[test]
fn sizes_are_compared_before_anything_is_decoded() {
    let place = Place::new();
    grey(&place, "small.png", 16);
    grey(&place, "large.png", 16384);
    let limited = |line: &str| {
        let line = format!("ulimit -v 400000; exec \"$0\" {line}");
        shell(&place, "sh", &["-c", &line, env!("CARGO_BIN_EXE_framewright")], &[])
    };
    let sizes = "only pictures of one size are compared";
    limited("compare small.png large.png").exits(1).mentions(sizes);
    limited("compare large.png small.png").exits(1).mentions(sizes);
    limited("compare large.png large.png")
        .exits(1)
        .mentions("has 16384 × 16384 pixels, and at most 67108864 are compared");
    // An .exr file that says that it is as large.
    light(&place, "light.exr", [0.5; 3], &[]);
    let mut file = std::fs::read(place.path("light.exr")).expect("read");
    for window in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
        let at = file.windows(window.len()).position(|it| it == window).expect("it is there") + window.len() + 4;
        file[at + 8..at + 16].copy_from_slice(&[16383_u32.to_le_bytes(); 2].concat());
    }
    place.file("large.exr", file);
    limited("compare small.png large.exr").exits(1).mentions(sizes);
    limited("compare large.exr large.exr").exits(1);
}

#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_refused_at_once() {
    let place = Place::new();
    grey(&place, "small.png", 16);
    let made = std::process::Command::new("mkfifo").arg(place.path("pipe.png")).status().expect("mkfifo");
    assert!(made.success());
    for file in ["/dev/zero", "pipe.png"] {
        for pair in [["small.png", file], [file, "small.png"]] {
            let said = format!("the picture `{file}` can't be read: it is a pipe or a device, not a regular file");
            place.run(&["compare", pair[0], pair[1]]).exits(1).mentions(&said);
        }
    }
}

#[test]
fn every_metric_agrees_with_its_published_implementation() {
    let file = std::fs::read_to_string(picture("figures.json")).expect("read");
    let judged: Vec<Value> = serde_json::from_str(&file).expect("JSON");
    assert_eq!(judged.len(), 9);
    for pair in &judged {
        let [reference, test] = ["reference", "picture"].map(|it| pair[it].as_str().expect("a name"));
        let ours = errors(reference, test);
        let agrees = |ours: &Value, theirs: &Value, what: &str| {
            let (Some(ours), Some(theirs)) = (ours.as_f64(), theirs.as_f64()) else {
                panic!("{what} of {test}: {ours}, published {theirs}");
            };
            let most = AGREEMENT * theirs.abs().max(1.0);
            assert!((ours - theirs).abs() <= most, "{what} of {test}: {ours}, published {theirs}");
        };
        for figure in ["mean", "percentile_95", "worst"] {
            agrees(&ours["flip"][figure], &pair["flip"][figure], figure);
        }
        if test.ends_with(".exr") {
            for figure in ["first", "last", "count"] {
                agrees(&ours["flip"]["exposures"][figure], &pair["flip"]["exposures"][figure], figure);
            }
        } else {
            assert!(ours["flip"]["exposures"].is_null(), "{ours}");
        }
        for figure in ["rmse", "max_error", "relative_mse"] {
            agrees(&ours[figure], &pair[figure], figure);
        }
        match pair.get("psnr") {
            Some(published) => agrees(&ours["psnr"], published, "psnr"),
            None => assert!(ours["psnr"].is_null(), "{ours}"),
        }
        // The published implementation of SSIM takes no picture below 11 pixels.
        match pair.get("ssim") {
            Some(published) => agrees(&ours["ssim"], published, "ssim"),
            None => assert_eq!(test, "low_noise.png"),
        }
    }
}

#[test]
fn a_picture_has_no_error_beside_itself() {
    for name in ["shown.png", "bright.exr", "low.png"] {
        let errors = errors(name, name);
        for figure in ["rmse", "max_error", "relative_mse"] {
            assert_eq!(errors[figure], 0.0, "{name}: {errors}");
        }
        assert_eq!((errors["flip"]["worst"].as_f64(), errors["ssim"].as_f64()), (Some(0.0), Some(1.0)), "{errors}");
        assert!(errors["psnr"].is_null(), "{errors}");
    }
}

#[test]
fn each_planted_error_moves_the_metrics_that_see_it() {
    let [pixel, shifted, gamma] = ["one_pixel.png", "shifted.png", "gamma.png"].map(|test| errors("shown.png", test));
    let figure = |errors: &Value, name: &str| errors[name].as_f64().expect("a number");
    // One wrong pixel: the worst is seen, the mean hardly.
    assert!(pixel["flip"]["worst"].as_f64() > Some(0.05) && pixel["flip"]["mean"].as_f64() < Some(1e-3), "{pixel}");
    assert!(figure(&pixel, "max_error") > 0.1 && figure(&pixel, "rmse") < 1e-3, "{pixel}");
    // Half a pixel's shift: structure suffers. A slip of gamma: colours do, and structure stays.
    assert!(figure(&shifted, "ssim") < figure(&gamma, "ssim"), "{shifted} {gamma}");
    assert!(gamma["flip"]["mean"].as_f64() > shifted["flip"]["mean"].as_f64(), "{shifted} {gamma}");
}

/// Light beyond white is part of the noise.
#[test]
fn light_that_is_cut_off_at_white_is_noise() {
    let clipped = errors("bright.exr", "bright_clipped.exr");
    assert!(clipped["psnr"].as_f64().is_some_and(|psnr| psnr < 15.0) && clipped["ssim"] == 1.0, "{clipped}");
}

#[test]
fn limits_decide_how_the_command_ends() {
    let (place, [shown, noise]) = (Place::new(), ["shown.png", "noise.png"].map(picture));
    let compare = |limits: &[&str]| {
        let files = ["compare".as_ref(), shown.as_os_str(), noise.as_os_str()];
        place.run(&files.into_iter().chain(limits.iter().map(AsRef::as_ref)).collect::<Vec<_>>())
    };
    let out = compare(&["--max-flip", "0.2", "--min-ssim", "0.1", "--min-psnr=-1"]).exits(0).out;
    assert!(out.contains("(most 0.2: held)") && out.contains("(least 0.1: held)"), "{out}");
    for (limit, said) in [
        (["--max-flip", "0.001"], "(most 0.001: exceeded)"),
        (["--max-rmse", "1e-9"], "exceeded"),
        (["--max-error", "0"], "exceeded"),
        (["--max-relative-mse", "0"], "exceeded"),
        (["--min-psnr", "99"], "(least 99: missed)"),
        (["--min-ssim", "1"], "(least 1: missed)"),
    ] {
        let out = compare(&limit).exits(1).out;
        assert!(out.contains(said), "{limit:?}: {out}");
    }
    let out = compare(&["--metric", "ssim", "--metric", "rmse"]).exits(0).out;
    assert_eq!(out.lines().count(), 2, "{out}");
    for wrong in [["--max-flip", "NaN"], ["--max-flip", "x"], ["--metric", "mse"], ["--pixels-per-degree", "0"]] {
        compare(&wrong).exits(2);
    }
}

#[test]
fn pixels_that_are_not_finite_are_counted_and_hold_no_limit() {
    let place = Place::new();
    light(&place, "right.exr", [0.25, 0.5, 1.0], &[]);
    let wrong = [[f32::NAN, 0.5, 1.0], [0.25, f32::INFINITY, 1.0], [0.25, 0.5, f32::NEG_INFINITY]];
    light(&place, "wrong.exr", [0.25, 0.5, 1.0], &wrong);
    let out = place.run(&["compare", "right.exr", "wrong.exr", "--format", "json"]).exits(0).out;
    let errors = &serde_json::from_str::<Value>(&out).expect("JSON")["errors"];
    assert_eq!(errors["non_finite"], serde_json::json!([0, 3]));
    // All that is finite is right.
    assert_eq!((errors["rmse"].as_f64(), errors["flip"]["mean"].as_f64()), (Some(0.0), Some(0.0)), "{errors}");
    let out = place.run(&["compare", "right.exr", "wrong.exr", "--max-rmse", "1"]).exits(1).out;
    assert!(out.contains("not finite    0 of 256 pixels in the reference, 3 in the picture; they are no part of the figures, and no limit is held"), "{out}");
    // Each limit says the same, and so does the answer for programs.
    assert!(out.contains("(most 1: not held)"), "{out}");
    let json = ["compare", "right.exr", "wrong.exr", "--max-rmse", "1", "--min-ssim", "0", "--format", "json"];
    let answer: Value = serde_json::from_str(&place.run(&json).exits(1).out).expect("JSON");
    assert_eq!(answer["held"], false);
    assert!(answer["limits"].as_array().expect("limits").iter().all(|limit| limit["held"] == false), "{answer}");
    // Nothing but such pixels, and light beyond every tone curve.
    light(&place, "all.exr", [f32::NAN; 3], &[]);
    place.run(&["compare", "all.exr", "all.exr"]).exits(1).mentions("no pixel is finite in both");
    light(&place, "huge.exr", [f32::MAX; 3], &[[1e-38; 3], [0.0; 3], [-f32::MAX; 3]]);
    let out = place.run(&["compare", "right.exr", "huge.exr", "--format", "json"]).exits(0).out;
    let errors = &serde_json::from_str::<Value>(&out).expect("JSON")["errors"];
    assert!(["rmse", "max_error", "relative_mse", "ssim"].iter().all(|it| errors[it].is_f64()), "{errors}");
}

#[test]
fn a_heat_map_shows_where_the_difference_is() {
    let (place, [shown, wrong]) = (Place::new(), ["shown.png", "one_pixel.png"].map(picture));
    let arguments =
        ["compare".as_ref(), shown.as_os_str(), wrong.as_os_str(), "--heatmap".as_ref(), "heat.png".as_ref()];
    place.run(&arguments).exits(0);
    let map = image::open(place.path("heat.png")).expect("a picture").into_rgb8();
    assert_eq!(map.dimensions(), (160, 120));
    let light = |x: u32, y: u32| map.get_pixel(x, y).0.iter().map(|it| u32::from(*it)).sum::<u32>();
    assert!(light(101, 37) > light(20, 100) + 20, "{} {}", light(101, 37), light(20, 100));
    // A picture that is compared isn't written over.
    std::fs::copy(&shown, place.path("own.png")).expect("copied");
    let said = place.run(&["compare", "own.png", "own.png", "--heatmap", "own.png"]).exits(2);
    said.mentions("`own.png` is a picture that is compared, which would be lost");
    place.run(&["compare", "own.png", "own.png", "--heatmap", "heat.exr"]).exits(2);
}

#[test]
fn files_that_are_no_pictures_of_one_size_are_refused() {
    let place = Place::new();
    light(&place, "right.exr", [1.0; 3], &[]);
    place.file("text.png", "no picture");
    std::fs::copy(picture("shown.png"), place.path("shown.png")).expect("copied");
    let compare = |test: &str| place.run(&["compare", "right.exr", test]);
    compare("missing.png").exits(1).mentions("the picture `missing.png` can't be read");
    compare("text.png")
        .exits(1)
        .mentions("the picture `text.png` can't be read: it is neither a PNG nor an OpenEXR file");
    compare("shown.png").exits(1).mentions("`right.exr` is 16×16, and `shown.png` is 160×120");
    compare(".").exits(1);
}
