//! Shaders in HLSL, Slang and WGSL: compiled by what the user names, never by what a pipeline names, and told of in their own lines (DO-2).

use crate::testing::{Outcome, Place};

const HLSL: &str = include_str!("../../../tests/shaders/spirv/post.hlsl");
const WGSL: &str = include_str!("../../../tests/shaders/spirv/post.wgsl");

/// A pass with this shader.
fn pipeline(shader: &str) -> String {
    format!(
        "Pipeline(version: 1, images: [
    (name: \"light\", format: R16G16B16A16_SFLOAT, size: Output), (name: \"depth\", format: Depth, size: Output),
    (name: \"screen\", format: Output, size: Output)], passes: [
    (name: \"sky\", draw: Sky, color: [(image: \"light\", clear: (0, 0, 0, 1))], depth: (image: \"depth\", clear: 0)),
    (name: \"post\", draw: FullScreen(\"{shader}\"), sample: {{\"source\": \"light\"}},
        params: {{\"factor\": 1, \"tint\": (1, 1, 1)}}, color: [\"screen\"]),
], outputs: [\"screen\"])"
    )
}

fn of(shader: &str, file: &str, text: &str) -> Place {
    let place = Place::new();
    place.file("p.ron", pipeline(shader));
    place.file(file, text);
    place
}

/// A shader that is refused, by a compiler that is named so.
fn refused(compiler: &str, shader: &str, file: &str) -> Outcome {
    let place = of(shader, file, WGSL);
    place.run(&["check", "p.ron", "--shader-compiler", compiler])
}

#[test]
fn hlsl_needs_no_compiler_of_the_users() {
    let place = of("post.hlsl:PSMain", "post.hlsl", HLSL);
    place.run(&["check", "p.ron"]).exits(0);
    // As most files have it: registers of each kind from 0 on, or none at all.
    let from_0 = HLSL.replace("register(s1, space0)", "register(s0)").replace("register(b2, space0)", "register(b0)");
    let without = HLSL
        .replace(" : register(t0, space0)", "")
        .replace(" : register(s1, space0)", "")
        .replace(" : register(b2, space0)", "");
    assert!(from_0 != HLSL && !without.contains("register("));
    for text in [from_0, without] {
        place.file("post.hlsl", text);
        place.run(&["check", "p.ron"]).exits(0);
    }
    let told = place.run(&["inspect", "p.ron"]).exits(0).out;
    assert!(told.contains("with shader `post.hlsl:PSMain`"), "{told}");
}

#[test]
fn a_mistake_is_shown_at_its_line_of_the_file_that_has_it() {
    let place = of("post.hlsl:PSMain", "post.hlsl", &HLSL.replace("image.Sample", "imag.Sample"));
    place
        .run(&["check", "p.ron"])
        .exits(1)
        .mentions("error: shader `post.hlsl:PSMain` doesn't compile [E0802]")
        .mentions("post.hlsl:8");
    // What is included lies beside the file, or is shipped.
    let including = format!("#include \"part/light.hlsli\"\n{}", HLSL.replace(" * tint", " * tint * lit()"));
    place.file("post.hlsl", &including);
    std::fs::create_dir(place.path("part")).expect("made");
    place.file("part/light.hlsli", "float lit() { return 1.0; }\n");
    place.run(&["check", "p.ron"]).exits(0);
    place.file("part/light.hlsli", "float lit() {\n    return brightness; }\n");
    place.run(&["check", "p.ron"]).exits(1).mentions("part/light.hlsli:2");
    place.file("post.hlsl", including.replace("part/light", "part/dark"));
    place.run(&["check", "p.ron"]).exits(1).mentions("post.hlsl:1").mentions("part/dark.hlsli");
}

#[test]
fn an_entry_point_that_is_not_there_is_said() {
    let place = of("post.hlsl:PSMainn", "post.hlsl", HLSL);
    place.run(&["check", "p.ron"]).exits(1).mentions("post.hlsl:PSMainn").mentions("entry point");
    let place = of("past.hlsl:PSMain", "post.hlsl", HLSL);
    place
        .run(&["check", "p.ron"])
        .exits(1)
        .mentions("there is no shader named `past.hlsl:PSMain` [E0801]")
        .mentions("post.hlsl");
}

#[test]
fn a_language_of_which_no_compiler_is_named_is_said_with_the_option_that_names_one() {
    let place = of("post.wgsl:tinted", "post.wgsl", WGSL);
    place
        .run(&["check", "p.ron"])
        .exits(3)
        .mentions(
            "error: shader `post.wgsl:tinted` isn't compiled: no compiler of WGSL is named [E1310]\n --> p.ron:5:",
        )
        .mentions("`--shader-compiler LANGUAGE=COMMAND` names it");
}

#[test]
fn a_compiler_that_can_be_none_is_a_mistake_of_the_command_line() {
    for (compiler, words) in [
        ("wgsl", "`wgsl` names no compiler"),
        ("hlls=dxc", "did you mean `hlsl`?"),
        ("hlsl=naga", "`naga` doesn't compile HLSL"),
        (
            "hlsl=mycc -O2",
            "the arguments of `mycc` aren't known: write them, as in `mycc -E {entry} -o {output} {input}`",
        ),
        ("hlsl=mycc {input}", "don't say where it writes"),
        ("hlsl=", "the command is empty"),
    ] {
        refused(compiler, "post.wgsl", "post.wgsl").exits(2).mentions(words);
    }
    let place = of("post.wgsl:tinted", "post.wgsl", WGSL);
    place
        .run_with(&[("FRAMEWRIGHT_WGSL_COMPILER", "dxc")], &["check", "p.ron"])
        .exits(2)
        .mentions("FRAMEWRIGHT_WGSL_COMPILER: `dxc` doesn't compile WGSL");
}

#[test]
fn a_compiler_that_is_not_there_is_no_mistake_of_the_files() {
    refused("wgsl=no-such-compiler {input} {output}", "post.wgsl:tinted", "post.wgsl")
        .exits(3)
        .mentions("isn't compiled: its compiler `no-such-compiler` isn't there [E1310]");
    refused("wgsl=/nowhere/naga", "post.wgsl:tinted", "post.wgsl")
        .exits(3)
        .mentions("`/nowhere/naga` isn't there")
        .mentions("`cargo install naga-cli` installs it");
}

/// Stands in for a compiler: lines of a shell, which know `$1` as the file to write and `$2` as the file to read.
#[cfg(unix)]
struct StandIn(Place);

#[cfg(unix)]
impl StandIn {
    fn new(lines: &str) -> StandIn {
        let place = of("post.wgsl:tinted", "post.wgsl", WGSL);
        place.file("compiler.sh", lines);
        place.file("made.spv", include_bytes!("../../../tests/shaders/spirv/post_wgsl.spv"));
        StandIn(place)
    }

    fn check_with(&self, more: &[&str]) -> Outcome {
        let command = format!("wgsl=sh {} {{output}} {{input}}", self.0.path("compiler.sh").display());
        self.0.run(&[&["check", "p.ron", "--shader-compiler", &command][..], more].concat())
    }

    fn check(&self) -> Outcome {
        self.check_with(&[])
    }
}

#[cfg(unix)]
#[test]
fn a_compiler_that_fails_as_none_should_is_said_in_words() {
    let of = |lines: &str| StandIn::new(lines).check().exits(1);
    of("exit 3").mentions("its compiler `sh` failed without a word (exit status: 3) [E1310]");
    of("echo made it; exit 0")
        .mentions("wrote nothing, and says that all is well [E1310]")
        .mentions("help: it said: made it");
    of("echo words > $1").mentions("wrote no SPIR-V that can be read: it doesn't begin as SPIR-V does");
    of("printf '\\003\\002\\043\\007\\000\\007\\001\\000aaaabbbbcccc' > $1")
        .mentions("it is SPIR-V 1.7: versions 1.0 to 1.6 are taken, those of Vulkan 1.3");
    of("kill -SEGV $$").mentions("its compiler `sh` crashed (SIGSEGV)");
    // What it says is no more than its beginning, and its standard input is empty.
    of("cat; yes | head -c 300000000; exit 1").mentions("shader `post.wgsl:tinted` doesn't compile");
    of("head -c 100000000 /dev/zero > $1; sleep 20")
        .mentions("wrote more than the 16777216 bytes of SPIR-V that are taken");
}

#[cfg(unix)]
#[test]
fn a_compiler_that_hangs_is_ended_with_all_that_it_started() {
    let stand_in = StandIn::new("sleep 77.125 & echo $! > $PLACE; sleep 77");
    let began = std::time::Instant::now();
    let kept = stand_in.0.path("pid");
    let script = format!("PLACE={}\nsleep 77 &\necho $! > $PLACE\nwait\n", kept.display());
    stand_in.0.file("compiler.sh", script);
    let outcome = stand_in.check_with(&["--shader-seconds", "1"]).exits(1);
    outcome
        .mentions("its compiler `sh` took longer than 1 s for ./post.wgsl, which is its limit")
        .mentions("`--shader-seconds` raises it");
    assert!(began.elapsed().as_secs() < 30);
    let child = std::fs::read_to_string(kept).expect("it began");
    // A process that was killed, and that nobody has asked for, is a zombie at most.
    let state = std::fs::read_to_string(format!("/proc/{}/stat", child.trim())).unwrap_or_default();
    assert!(state.is_empty() || state.contains(") Z "), "{state}");
}

/// One that never ends would fill the disk: it is given up long before its time is over.
#[cfg(unix)]
#[test]
fn a_compiler_that_writes_without_end_is_ended() {
    let stand_in = StandIn::new("while :; do head -c 1000000 /dev/zero >> $1; done");
    stand_in
        .check_with(&["--shader-seconds", "600"])
        .exits(1)
        .mentions("wrote more than the 16777216 bytes of SPIR-V that are taken");
}

#[cfg(unix)]
#[test]
fn a_compiler_is_run_once_for_one_text_and_told_of_by_no_pipeline() {
    let stand_in = StandIn::new("");
    let place = &stand_in.0;
    let runs = place.path("runs");
    let script = format!("echo ran >> {}\ncp {} $1\n", runs.display(), place.path("made.spv").display());
    place.file("compiler.sh", script);
    place.file(
        "p.ron",
        pipeline("post.wgsl:tinted")
            .replace("\"source\"", "\"binding 0\"")
            .replace("\"factor\"", "\"offset 0\"")
            .replace("\"tint\"", "\"offset 16\""),
    );
    let ran = || std::fs::read_to_string(&runs).unwrap_or_default().lines().count();
    stand_in.check().exits(0);
    assert_eq!(ran(), 1);
    stand_in.check().exits(0);
    assert_eq!(ran(), 1);
    stand_in.check_with(&["--no-cache"]).exits(0);
    assert_eq!(ran(), 2);
    place.file("post.wgsl", format!("{WGSL}// another text\n"));
    stand_in.check().exits(0);
    assert_eq!(ran(), 3);
    // A folder of compiled shaders needs no compiler.
    stand_in.check_with(&["--precompiled", "ahead"]).exits(0);
    place.run(&["check", "p.ron", "--precompiled", "ahead"]).exits(0);
}

/// Whether a compiler of this name can be started; says so if not.
fn is_there(compiler: &str) -> bool {
    let found = std::process::Command::new(compiler).arg("--version").output().is_ok();
    if !found {
        println!("skipped: `{compiler}` isn't there; tests/compilers/fetch.sh fetches compilers");
    }
    found
}

#[test]
fn naga_compiles_wgsl_and_its_words_are_shown_at_the_line() {
    if !is_there("naga") {
        return;
    }
    let place = of("post.wgsl:tinted", "post.wgsl", WGSL);
    place.file(
        "p.ron",
        pipeline("post.wgsl:tinted")
            .replace("\"source\"", "\"binding 0\"")
            .replace("\"factor\"", "\"offset 0\"")
            .replace("\"tint\"", "\"offset 16\""),
    );
    let check = || place.run(&["check", "p.ron", "--shader-compiler", "wgsl=naga"]);
    check().exits(0);
    place.file("post.wgsl", WGSL.replace("textureSample(source", "textureSample(sourc"));
    check()
        .exits(1)
        .mentions("doesn't compile [E0802]")
        .mentions("post.wgsl:8")
        .mentions("no definition in scope for identifier: `sourc`");
}

#[test]
fn slangc_compiles_slang_and_hlsl() {
    if !is_there("slangc") {
        return;
    }
    let slang = include_str!("../../../tests/shaders/spirv/post.slang");
    let place = of("post.slang:tinted", "post.slang", slang);
    let check = || {
        place.run(&["check", "p.ron", "--shader-compiler", "slang=slangc -O0", "--shader-compiler", "hlsl=slangc -O0"])
    };
    check().exits(0);
    place.file("p.ron", pipeline("post.slang"));
    check().exits(0);
    place.file("light.slang", "module light;\npublic float lit() { return 1.0; }\n");
    let importing = format!("import light;\n{}", slang.replace(".rgb *", ".rgb * lit() *"));
    place.file("post.slang", importing);
    check().exits(0);
    place.file("light.slang", "module light;\npublic float lit() {\n    return brightness;\n}\n");
    check().exits(1).mentions("light.slang:3").mentions("brightness");
    place.file("p.ron", pipeline("post.hlsl:PSMain"));
    place.file("post.hlsl", HLSL);
    check().exits(0);
}

#[test]
fn a_constant_that_the_shader_has_not_or_of_another_type_is_said_at_its_place() {
    let place = Place::new();
    place.file("tile.comp", include_str!("../../../tests/shaders/constants.comp"));
    let check = |constants: &str| {
        place.file(
            "p.ron",
            format!(
                "Pipeline(version: 1, images: [], buffers: [(name: \"to\", bytes: 256)], passes: [
    (name: \"tile\", dispatch: \"tile\", groups: Invocations(64), storage: {{\"Numbers\": (buffer: \"to\", access: Write)}},
        constants: {{{constants}}}),
], outputs: [(buffer: \"to\", after: Host)])"
            ),
        );
        place.run(&["check", "p.ron"])
    };
    check("\"FACTOR\": 2, \"constant 0\": 32").exits(0);
    check("\"FACTR\": 2")
        .exits(1)
        .mentions("error: shader `tile` has no constant named `FACTR` [E0830]\n --> p.ron:3:21")
        .mentions("did you mean `FACTOR`?");
    check("\"FACTOR\": 0.5").exits(1).mentions(
        "error: constant `FACTOR` of shader `tile` has the type `uint` and can't be `0.5` [E0830]\n --> p.ron:3:31",
    );
    check("\"FACTOR\": -1").exits(1).mentions("has the type `uint` and can't be `-1`");
    check("\"DOUBLED\": (1, 2)").exits(1).mentions("has the type `bool` and can't be `(1, 2)`");
    check("\"FACTOR\": 2, \"FACTOR\": 3").exits(1).mentions("names `FACTOR` twice");
    // Limits see the size that the file gives.
    check("\"constant 0\": 100000").exits(1).mentions("maxComputeWorkGroup");
    place.file(
        "p.ron",
        pipeline("copy").replace("params: {\"factor\": 1, \"tint\": (1, 1, 1)}", "constants: {\"A\": 1}"),
    );
    place
        .run(&["check", "p.ron"])
        .exits(1)
        .mentions("has no constant named `A`")
        .mentions("it has no specialization constants");
}

#[test]
fn a_vertex_stage_in_hlsl_is_drawn_turned_by_the_include() {
    let place = Place::new();
    place.file(
        "p.ron",
        "Pipeline(version: 1, images: [(name: \"screen\", format: Output, size: Output)], passes: [
    (name: \"triangle\", draw: Vertices(3), shader: (vertex: \"post.hlsl:VSMain\", fragment: \"post.hlsl:PSMain\"),
        color: [(image: \"screen\", clear: (0, 0, 0, 1))]),
], outputs: [\"screen\"])",
    );
    let hlsl = |position: &str| {
        format!(
            "#include \"include/rotation.hlsl\"\n#include \"include/stereo.hlsl\"\n
float4 VSMain(uint vertex : SV_VertexID) : SV_Position {{
    float2 uv = float2((vertex << 1) & 2, vertex & 2);
    return {position}(float4(screen_uv(uv) * 2.0 - 1.0, 0.0, 1.0));
}}
float4 PSMain() : SV_Target0 {{ return float4(eye_index, 0.0, 0.0, 1.0); }}\n"
        )
    };
    let compilers = ["", "hlsl=dxc", "hlsl=glslangValidator", "hlsl=slangc -O0"];
    let there = |compiler: &&&str| {
        let command = compiler.split(['=', ' ']).nth(1);
        command.is_none_or(is_there)
    };
    for compiler in compilers.iter().filter(there) {
        let named: &[&str] = if compiler.is_empty() { &[] } else { &["--shader-compiler", compiler] };
        let check = || place.run(&[&["check", "p.ron", "--rotate", "90"][..], named].concat());
        place.file("post.hlsl", hlsl("rotate_clip"));
        check().exits(0);
        place.file("post.hlsl", hlsl(""));
        check().exits(1).mentions("`triangle`").mentions("`rotate_clip()` of `include/rotation.hlsl`");
    }
}
