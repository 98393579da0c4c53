//! Outputs of a frame, under its own names and with the encodings that the file says.

use crate::testing::{self, Outcome, Place, Vulkan};

/// A picture, its light and the depth that it was drawn with.
const OUTPUTS: [&str; 3] =
    [r#"(image: "screen", encoding: Srgb)"#, r#"(image: "light", encoding: Linear)"#, r#""depth""#];

fn pipeline(outputs: &[&str]) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            images: [
                (name: "light", format: Color(hdr: true), size: Output),
                (name: "depth", format: Depth, size: Output),
                (name: "screen", format: R8G8B8A8_SRGB, size: Output),
                (name: "unshown", format: Color, size: Output),
            ],
            passes: [
                (name: "opaque", draw: Objects(Opaque), shader: "lit",
                    color: [(image: "light", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
                (name: "show", draw: FullScreen("reinhard"), sample: {{"source": "light"}}, color: ["screen"]),
                (name: "unshown", draw: FullScreen("reinhard"), sample: {{"source": "light"}}, color: ["unshown"]),
            ],
            outputs: [{}],
        )"#,
        outputs.join(", ")
    )
}

fn run(place: &Place, more: &[&str]) -> Option<Outcome> {
    let variables = Vulkan::LAVAPIPE_CURRENT.variables()?;
    let arguments = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "96x54", "--validate"];
    Some(place.run_with(&variables, &[&arguments[..], more].concat()))
}

#[test]
fn each_output_is_written_under_its_name_as_it_is_when_it_comes_first() {
    let place = Place::new();
    place.file("p.ron", pipeline(&OUTPUTS));
    let all = ["-o", "screen.png", "-o", "light=light.exr", "-o", "depth=depth.png", "-o", "light=light.png"];
    let Some(outcome) = run(&place, &all) else { return };
    let outcome = outcome.exits(0);
    assert!(outcome.out.contains("validation: silent; "), "{}", outcome.out);
    for (first, file) in ["screen.png", "light.exr", "depth.png"].into_iter().enumerate() {
        let mut outputs = OUTPUTS;
        outputs.swap(0, first);
        place.file("p.ron", pipeline(&outputs));
        let alone = format!("alone_{file}");
        if let Some(outcome) = run(&place, &["-o", &alone]) {
            outcome.exits(0);
        }
        let [written, alone] = [file, &alone].map(|name| std::fs::read(place.path(name)).expect("written"));
        assert!(written == alone, "{file} depends on where its image stands among the outputs");
    }
    let png = std::fs::read(place.path("screen.png")).expect("written");
    assert!(png.windows(4).any(|chunk| chunk == b"sRGB"), "the picture says how it is encoded");
    // Nearer is brighter, and the sky is infinitely far.
    let depth = image::open(place.path("depth.png")).expect("a picture").into_luma8();
    assert_eq!((depth.get_pixel(2, 2).0, depth.pixels().map(|texel| texel.0[0]).max()), ([0], Some(255)));
}

#[test]
fn a_picture_for_hdr10_says_so() {
    let place = Place::new();
    let encode = r#"(name: "encode", draw: FullScreen("encode_hdr10"), sample: {"source": "light"},
        params: {"reference_white": 203.0}, color: ["screen"])"#;
    let text =
        pipeline(&[r#"(image: "screen", encoding: Hdr10)"#]).replace("R8G8B8A8_SRGB", "A2B10G10R10_UNORM_PACK32");
    let show = r#"(name: "show", draw: FullScreen("reinhard"), sample: {"source": "light"}, color: ["screen"])"#;
    assert!(text.contains(show));
    place.file("p.ron", text.replace(show, encode));
    let Some(outcome) = run(&place, &["-o", "hdr.png"]) else { return };
    outcome.exits(0);
    let png = std::fs::read(place.path("hdr.png")).expect("written");
    assert!(png.windows(4).any(|chunk| chunk == b"cICP"), "the picture says how it is encoded");
}

#[test]
fn what_is_no_output_is_not_written_and_said() {
    let place = Place::new();
    place.file("p.ron", pipeline(&OUTPUTS));
    let Some(outcome) = run(&place, &["-o", "unshown=a.png"]) else { return };
    outcome
        .exits(2)
        .mentions("error: there is no output named `unshown`\nhelp: `--dump unshown=FILE.png` writes any image");
    if let Some(outcome) = run(&place, &["-o", "sceen=a.png", "--dump", "light=b.png"]) {
        outcome
            .exits(2)
            .mentions("error: there is no output named `sceen`\nhelp: there are `screen`, `light`, `depth`");
    }
    assert_eq!(place.names(), ["p.ron"]);
}

#[cfg(unix)]
#[test]
fn a_file_larger_than_the_user_may_write_is_an_error_that_leaves_nothing_behind() {
    let place = Place::new();
    // In blocks of 512 bytes or of 1024, as the shell has it.
    let limited = "ulimit -f 2; exec \"$0\" inspect forward --format json -o plan.json";
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", limited, env!("CARGO_BIN_EXE_framewright")]).current_dir(place.path(""));
    let outcome = testing::outcome(&mut shell).exits(3).mentions("`plan.json` can't be written: File too large");
    outcome.mentions("help: allow larger files: ulimit -f unlimited");
    assert_eq!(place.names(), [""; 0]);
}
