//! `run --plan`: a Plan from a file is verified and drawn as it is, or refused with a reason.

use crate::testing::{Outcome, Place, Vulkan, shipped_pipelines};
use framewright_tests::sweep;
use serde_json::Value;

const SCENE: [&str; 2] = ["--scene", "spheres_and_cubes"];
const SIZE: [&str; 2] = ["--size", "64x36"];

/// A folder, and lavapipe to draw on.
struct Bench {
    place: Place,
    variables: Vec<(&'static str, &'static str)>,
}

impl Bench {
    fn new() -> Option<Bench> {
        Some(Bench { place: Place::new(), variables: Vulkan::LAVAPIPE.variables()? })
    }

    fn run(&self, arguments: &[&[&str]]) -> Outcome {
        self.place.run_with(&self.variables, &[&["run"][..], &arguments.concat()].concat())
    }

    fn read(&self, file: &str) -> Vec<u8> {
        std::fs::read(self.place.path(file)).expect("written")
    }

    /// Draws a pipeline, and its Plan from a file; both pictures must be the same.
    fn draws_the_same(&self, pipeline: &[&str], of_plan: &[&str]) {
        self.run(&[pipeline, &SCENE, &SIZE, &["--save-plan", "plan.json", "-o", "pipeline.png"]]).exits(0);
        self.run(&[&["--plan", "plan.json"], &SCENE, of_plan, &["-o", "plan.png"]]).exits(0);
        assert!(self.read("pipeline.png") == self.read("plan.png"), "{pipeline:?}");
    }

    /// The Plan of `forward`, with one text in place of another one.
    fn changed(&self, from: &str, to: &str) {
        if !self.place.path("plan.json").exists() {
            self.run(&[&["forward"], &SCENE, &SIZE, &["--save-plan", "plan.json"]]).exits(0);
        }
        let text = String::from_utf8(self.read("plan.json")).expect("text");
        assert!(text.contains(from), "{from}");
        self.place.file("changed.json", text.replacen(from, to, 1));
    }

    /// The message about the changed Plan, of which nothing is drawn.
    fn refused(&self) -> String {
        let outcome = self.run(&[&["--plan", "changed.json"], &SCENE, &["-o", "x.png"]]).exits(1);
        assert!(!self.place.path("x.png").exists());
        outcome.err
    }
}

#[test]
fn every_shipped_pipeline_draws_the_same_from_its_plan() {
    let Some(bench) = Bench::new() else { return };
    bench.place.run_with(&bench.variables, &["devices", "--save", "live.ron", "--device", "0"]).exits(0);
    for name in sweep::of("Plans of shipped pipelines", shipped_pipelines(), 4) {
        bench.draws_the_same(&[&*name], &[]);
        // A Plan made without the device at hand, too.
        let estimated =
            [&["inspect", &*name, "--device", "live.ron"][..], &SCENE, &SIZE, &["--format", "json", "-o", "plan.json"]];
        bench.place.run(&estimated.concat()).exits(0);
        bench.run(&[&["--plan", "plan.json"], &SCENE, &["-o", "plan.png"]]).exits(0);
        assert!(bench.read("pipeline.png") == bench.read("plan.png"), "{name}");
    }
}

#[test]
fn a_plan_for_another_device_is_told_and_one_without_outputs_gives_no_picture() {
    let Some(bench) = Bench::new() else { return };
    let drawn = || bench.run(&[&["--plan", "changed.json"], &SCENE, &["-o", "x.png"]]);
    bench.changed("", "");
    assert!(!drawn().exits(0).err.contains("was made for"));
    bench.changed("\"name\": \"llvmpipe", "\"name\": \"other \\u001b[31m");
    let said = drawn().exits(0).err;
    assert!(said.contains("note: the Plan was made for other \\u{1b}[31m (LLVM "), "{said}");
    assert!(said.contains(", and is drawn on llvmpipe (LLVM "), "{said}");

    let mut plan: Value = serde_json::from_slice(&bench.read("plan.json")).expect("JSON");
    plan["outputs"] = serde_json::json!([]);
    bench.place.file("changed.json", plan.to_string());
    let said = drawn().exits(1).err;
    assert!(said.contains("error: there is no output, so there is no picture to write"), "{said}");
}

#[test]
fn plans_made_in_every_way_draw_the_same() {
    let Some(bench) = Bench::new() else { return };
    for stereo in ["multi-pass", "double-wide", "instanced"] {
        bench.draws_the_same(&["forward", "--stereo", stereo], &[]);
    }
    for way in [&["--rotate", "90"][..], &["--no-alias"], &["--order", "random:3"], &["--naive", "resolves"]] {
        bench.draws_the_same(&[&["forward"], way].concat(), &[]);
    }
    bench.draws_the_same(&["forward", "--poison"], &["--poison", "--validate"]);
    bench.draws_the_same(&["forward", "--dump", "color=color.png"], &["-o", "color=again.png", "--frames", "1"]);
    assert!(bench.read("color.png") == bench.read("again.png"));
}

#[test]
fn the_report_names_the_plan_and_its_size() {
    let Some(bench) = Bench::new() else { return };
    bench.draws_the_same(&["forward"], &["--report", "report.json", "--frames", "2", "--device", "0"]);
    let report: Value = serde_json::from_slice(&bench.read("report.json")).expect("JSON");
    assert_eq!([&report["pipeline"], &report["plan"]], [&Value::Null, &Value::from("plan.json")]);
    assert_eq!(report["size"], serde_json::json!([64, 36]));
}

#[test]
fn shaders_are_found_where_a_pipeline_finds_them() {
    let Some(bench) = Bench::new() else { return };
    let shader =
        "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(0.25, 0.5, 0.75, 1.0); }\n";
    bench.place.file("plain.frag", shader);
    let text = r#"Pipeline(version: 1, images: [(name: "screen", format: R8G8B8A8_SRGB, size: Output)],
        passes: [(name: "plain", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#;
    bench.place.file("p.ron", text);
    bench.draws_the_same(&["p.ron"], &[]);
    std::fs::create_dir(bench.place.path("elsewhere")).expect("made");
    std::fs::copy(bench.place.path("plan.json"), bench.place.path("elsewhere/plan.json")).expect("copied");
    let elsewhere = bench.run(&[&["--plan", "elsewhere/plan.json"], &SCENE]).exits(1);
    elsewhere.mentions("error: shader `plain`: not found in elsewhere; the shipped shaders");
    let outside = bench.run(&[&["--plan", "plan.json", "--root", "elsewhere"], &SCENE]).exits(2);
    outside.mentions("`plan.json` lies outside of `elsewhere`");
    bench.place.file(
        "changed.json",
        String::from_utf8(bench.read("plan.json")).expect("text").replace("\"plain\"", "\"../plain\""),
    );
    assert!(bench.refused().contains("leads out of"), "{}", bench.refused());
}

#[test]
fn what_a_plan_says_itself_can_not_be_chosen() {
    let place = Place::new();
    let choices = [
        &["--set", "msaa=1"][..],
        &["--preset", "low"],
        &["--settings", "s.ron"],
        &["--extend", "e.ron"],
        &["--stereo", "auto"],
        &["--size", "8x8"],
        &["--dump", "color=a.png"],
        &["--dump-all", "all"],
        &["--save-plan", "again.json"],
        &["--order", "file"],
        &["--naive", "resolves"],
        &["--one-queue"],
        &["--no-alias"],
        &["--rotate", "90"],
    ];
    for choice in choices {
        let outcome = place.run(&[&["run", "--plan", "plan.json"][..], &SCENE, choice].concat()).exits(2);
        outcome.mentions(&format!("error: the argument '--plan' cannot be used with '{}", choice[0]));
    }
    place.run(&[&["run", "forward", "--plan", "plan.json"][..], &SCENE].concat()).exits(2);
}

#[test]
fn a_text_that_is_no_plan_or_a_wrong_one_is_refused() {
    let Some(bench) = Bench::new() else { return };
    let version = "\"format_version\": 14";
    bench.changed(version, "\"format_version\": 13");
    assert_eq!(
        bench.refused().trim_end(),
        "error: changed.json: the Plan has format version 13, this program reads version 14: compile it again [E1608]"
    );
    bench.changed("\"layers\": 1", "\"layers\": 1000000000");
    assert!(bench.refused().contains("has no images like `color`"), "{}", bench.refused());
    bench.changed("\"extent\": [\n    ", "\"extent\": [\n    999");
    assert!(bench.refused().contains("`extent`: a side of 999"), "{}", bench.refused());
    bench.changed("\"load\": \"CLEAR\"", "\"load\": \"LOAD\"");
    assert!(bench.refused().starts_with("error: changed.json: the Plan is not right: "), "{}", bench.refused());
    bench.changed("\"name\": \"color\"", "\"name\": \"\\u001b[31m\\u202e\"");
    let hostile = bench.run(&[&["--plan", "changed.json"], &SCENE, &["-o", "nothing=x.png"]]).exits(2);
    assert!(!hostile.err.contains(['\u{1b}', '\u{202e}']), "{}", hostile.err);
    let text = String::from_utf8(bench.read("plan.json")).expect("text");
    bench.place.file("changed.json", &text[..text.len() / 2]);
    assert!(bench.refused().starts_with("error: changed.json: not a Plan: EOF while parsing"), "{}", bench.refused());
    bench.place.file("changed.json", [0xff]);
    assert!(bench.refused().contains("is not UTF-8"), "{}", bench.refused());
    let outcome = bench.run(&[&["--plan", "plan.json"], &SCENE, &["--report", "plan.json"]]).exits(2);
    outcome.mentions("`plan.json` is a Plan that is read, which would be lost");
    bench.run(&[&["--plan", "plan.json"], &SCENE, &["-o", "colour=x.png"]]).exits(2).mentions("there are `screen`");
    let poisoned = bench.run(&[&["--plan", "plan.json"], &SCENE, &["--poison"]]).exits(1);
    poisoned.mentions("can't be poisoned: compile the Plan with poison\nhelp: ");
    bench.run(&[&["--plan", "none.json"], &SCENE]).exits(1).mentions("none.json");
}

#[test]
fn a_plan_for_another_device_is_refused_with_the_command_that_makes_one_for_this() {
    let Some(bench) = Bench::new() else { return };
    for device in ["mali-g78", "meta-quest-3"] {
        let inspect = ["inspect", "forward", "--device", device, "--format", "json", "-o", "changed.json"];
        bench.place.run(&inspect).exits(0);
        let said = bench.refused();
        assert!(
            said.contains("\nhelp: framewright run PIPELINE --scene SCENE --save-plan PLAN.json"),
            "{device}: {said}"
        );
    }
}

/// A shipped pipeline's Plan in a file.
fn planned(pipeline: &str) -> Place {
    let place = Place::new();
    place.run(&["inspect", pipeline, "--format", "json", "-o", "plan.json"]).exits(0);
    place
}

#[test]
fn inspect_and_explain_say_of_a_plan_in_a_file_what_they_say_of_its_pipeline() {
    let place = planned("deferred");
    for format in ["tree", "json", "dot", "mermaid", "svg"] {
        let of = |file: &str| place.run(&["inspect", file, "--format", format, "--verbose"]).exits(0).out;
        assert_eq!(of("plan.json"), of("deferred"), "{format}");
    }
    for format in ["human", "json"] {
        for thing in ["color", "lighting", "barrier:color", "step:3", "heap:0"] {
            let of = |file: &str| place.run(&["explain", file, thing, "--format", format]).exits(0).out;
            assert_eq!(of("plan.json"), of("deferred"), "{thing}, {format}");
        }
    }
    place.run(&["inspect", "plan.json", "--format", "html", "-o", "page.html"]).exits(0);
    let page = std::fs::read_to_string(place.path("page.html")).expect("written");
    assert!(page.contains("plan.json") && page.contains("lighting"));
    place.run(&["explain", "plan.json", "colr"]).exits(1).mentions("did you mean `color`?");
}

#[test]
fn a_plan_leaves_inspect_explain_and_diff_nothing_to_choose() {
    let place = planned("forward");
    let commands: [&[&str]; 3] =
        [&["inspect", "plan.json"], &["explain", "plan.json", "color"], &["diff", "plan.json", "plan.json"]];
    let options: [&[&str]; 12] = [
        &["--set", "msaa=1"],
        &["--preset", "reference"],
        &["--extend", "more.ron"],
        &["--settings", "low.ron"],
        &["--stereo", "multiview"],
        &["--scene", "courtyard"],
        &["--device", "lavapipe"],
        &["--size", "64x36"],
        &["--order", "low-memory"],
        &["--naive", "resolves"],
        &["--no-alias"],
        &["--rotate", "90"],
    ];
    for command in commands {
        place.run(command).exits(0);
        for option in options {
            let said = format!("{} chooses something for `plan.json`, which is a Plan", option[0]);
            place.run(&[command, option].concat()).exits(2).mentions(&said);
        }
    }
    let capture = ["inspect", "plan.json", "--format", "html", "--capture", "--scene", "courtyard", "-o", "a.html"];
    place.run(&capture).exits(2).mentions("--capture chooses something");
    place.file("cut.json", "{");
    place.file(
        "wrong.json",
        std::fs::read_to_string(place.path("plan.json")).expect("written").replacen(
            "SHADER_READ_ONLY_OPTIMAL",
            "GENERAL",
            1,
        ),
    );
    for command in ["inspect", "explain"] {
        let of = |file: &str| {
            place.run(&[&[command, file][..], if command == "explain" { &["color"] } else { &[] }].concat()).exits(1)
        };
        of("cut.json").mentions("cut.json: not a Plan: ");
        of("wrong.json").mentions("wrong.json: the Plan is not right: ");
        of("gone.json").mentions("gone.json");
    }
    let written = ["inspect", "plan.json", "-o", "plan.json"];
    place.run(&written).exits(2).mentions("`plan.json` is a Plan that is read, which would be lost");
}

/// A Plan was made of shaders as they were: what one leaves as it was by now, its load operations don't know.
#[test]
fn a_plan_is_refused_whose_shader_leaves_texels_out_since() {
    let Some(bench) = Bench::new() else { return };
    bench.place.file(
        "p.ron",
        "Pipeline(version: 1, images: [(name: \"o\", format: R8G8B8A8_UNORM, size: Fixed(8, 8))],
            passes: [(name: \"fill\", draw: FullScreen(\"fill\"), color: [\"o\"])],
            outputs: [(image: \"o\", encoding: Unorm)])",
    );
    let shader = |body: &str| {
        let text =
            format!("#version 460\nlayout(location = 0) out vec4 c;\nvoid main() {{ {body} c = vec4(0, 1, 0, 1); }}\n");
        bench.place.file("fill.frag", text);
    };
    shader("");
    bench.run(&[&["p.ron"], &SCENE, &["--save-plan", "plan.json"]]).exits(0);
    let drawn = || bench.run(&[&["--plan", "plan.json"], &SCENE, &["-o", "x.png"]]);
    drawn().exits(0);
    std::fs::remove_file(bench.place.path("x.png")).expect("a picture");
    for body in ["if (gl_FragCoord.x < 4.0) discard;", "gl_SampleMask[0] = gl_FragCoord.x < 4.0 ? 0 : -1;"] {
        shader(body);
        drawn().exits(1).mentions("leaves samples out, which the Plan doesn't know: compile the Plan again");
    }
    assert!(!bench.place.path("x.png").exists());
}

/// A blend keeps what was there, whatever the shader leaves; depth that is drawn again must leave the same.
#[test]
fn a_plan_is_refused_for_what_a_shader_leaves_out_only_where_it_relies_on_that() {
    let Some(bench) = Bench::new() else { return };
    let size = "size: Fixed(8, 8)";
    let blended = "(name: \"before\", fill: (to: \"o\", value: 0)),
        (name: \"draw\", draw: FullScreen(\"draw\"), color: [(image: \"o\", blend: Alpha)])";
    let again = "(name: \"draw\", draw: Objects(Opaque), shader: \"draw\", depth: (image: \"d\", clear: 0.0)),
        (name: \"show\", draw: FullScreen(\"show\"), sample: {\"source\": \"d\"}, color: [\"o\"])";
    let depth = format!(", (name: \"d\", format: Depth, {size}, samples: 4, resolve: DepthOnly)");
    bench.place.file(
        "show.frag",
        "#version 460\nlayout(set = 0, binding = 0) uniform sampler2D source;\nlayout(location = 0) out vec4 c;
         void main() { c = vec4(texelFetch(source, ivec2(gl_FragCoord.xy), 0).r); }\n",
    );
    let outputs = "outputs: [(image: \"o\", encoding: Unorm)]";
    for (images, passes, out, is_refused) in
        [("", blended, "layout(location = 0) out vec4 c;", false), (&*depth, again, "", true)]
    {
        let images = format!("(name: \"o\", format: R8G8B8A8_UNORM, {size}){images}");
        bench.place.file("p.ron", format!("Pipeline(version: 1, images: [{images}], passes: [{passes}], {outputs})"));
        let shader = |body: &str| {
            let set = if out.is_empty() { "" } else { "c = vec4(0.5);" };
            bench.place.file("draw.frag", format!("#version 460\n{out}\nvoid main() {{ {body} {set} }}\n"));
        };
        shader("");
        bench.run(&[&["p.ron"], &SCENE, &["--save-plan", "plan.json"]]).exits(0);
        shader("if (gl_FragCoord.x < 4.0) discard;");
        let drawn = bench.run(&[&["--plan", "plan.json"], &SCENE, &["-o", "x.png"]]);
        if is_refused {
            drawn.exits(1).mentions("leaves samples out, which the Plan doesn't know: compile the Plan again");
        } else {
            drawn.exits(0);
        }
    }
}
