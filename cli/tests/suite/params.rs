//! Parameters of a pass and the block of its shader: arrays and structures (EM-5), and push constants of other languages' shaders (DO-5).

use crate::testing::{Outcome, Place};

const SHADER: &str = "#version 460
struct Light { vec3 color; float gains[2]; };
struct Lamp { float power; };
layout(set = 0, binding = 0) uniform Params {
    float weights[3];
    vec2 places[2];
    int counts[2];
    uint seeds[2];
    Light light;
    /* more */
} params;
layout(location = 0) out vec4 color;
void main() {
    color = vec4(params.weights[1] + params.light.gains[1], params.places[1], params.counts[0] + params.seeds[0]);
}
";

const GIVEN: &str = "\"weights\": [0.25, 0.5, \"size\"], \"places\": [(0, 1), (2, \"size / 2\")], \"counts\": [1, -2],
        \"seeds\": [\"frame\", 7], \"light.color\": (1, 2, 3), \"light.gains\": [4, 5]";

fn place(shader: &str, text: &str, params: &str) -> Place {
    let place = Place::new();
    place.file(shader.split(':').next().unwrap_or(shader), text);
    let name = shader.strip_suffix(".frag").unwrap_or(shader);
    place.file(
        "p.ron",
        format!(
            "Pipeline(version: 1, settings: [(name: \"size\", value: Number(default: 1, min: 0, max: 9))],
    images: [(name: \"screen\", format: Output, size: Output)], passes: [
    (name: \"post\", draw: FullScreen(\"{name}\"), color: [\"screen\"],
        params: {{{params}}}),
], outputs: [\"screen\"])"
        ),
    );
    place
}

/// The check with one piece of what is given replaced.
#[track_caller]
fn with(old: &str, new: &str) -> Outcome {
    assert!(GIVEN.contains(old), "{old}");
    place("effect.frag", SHADER, &GIVEN.replacen(old, new, 1)).run(&["check", "p.ron"])
}

#[test]
fn arrays_and_members_of_structures_are_given_by_lists_and_by_their_names() {
    with("0.25", "0.125").exits(0);
    // Each element is an expression.
    with("\"size / 2\"", "\"size / 2 > 1\"").exits(1).mentions("component 2 of element 1 is `false`");
}

#[test]
fn an_array_that_does_not_fit_says_its_length_and_the_element_at_its_place() {
    with("[0.25, 0.5, \"size\"]", "[0.25, 0.5]")
        .exits(1)
        .mentions("parameter `weights` of shader `effect` has the type `float[3]` and can't be `[0.25, 0.5]`: it has 2 elements [E0836]")
        .mentions("p.ron:4:29");
    with("[0.25, 0.5, \"size\"]", "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]")
        .exits(1)
        .mentions("`[0, 1, 2, 3, 4, 5, 6, 7, …]`: it has 10 elements [E0836]");
    with("[1, -2]", "[1, 0.5]")
        .exits(1)
        .mentions("can't be `[1, 0.5]`: element 1 is `0.5` [E0808]")
        .mentions("p.ron:4:");
    with("(0, 1)", "(0, true)").exits(1).mentions("component 2 of element 0 is `true` [E0808]");
    with("(0, 1)", "3")
        .exits(1)
        .mentions("element 0 isn't written so [E0808]")
        .mentions("values of this type are written `[(…, …), (…, …)]`");
    with("[0.25, 0.5, \"size\"]", "0.5")
        .exits(1)
        .mentions("`float[3]` and can't be `0.5` [E0808]")
        .mentions("values of this type are written `[…, …, …]`");
    with("[\"frame\", 7]", "[\"time\", 7]").exits(1).mentions("`frame` is a `uint`, and `time` a `float`");
    with("(1, 2, 3)", "1").exits(1).mentions("parameter `light.color` of shader `effect` has the type `vec3`");
}

#[test]
fn an_array_is_written_in_square_brackets_and_is_not_empty() {
    with("[0.25, 0.5, \"size\"]", "[]").exits(1).mentions("an array has at least one value").mentions("p.ron:4:29");
    with("[0.25, 0.5, \"size\"]", "(1, 2, 3, 4, 5)")
        .exits(1)
        .mentions("a vector or matrix has 2 to 4 values in `(…, …)`; here are 5")
        .mentions("an array stands in `[…, …]`");
    with("[0.25, 0.5, \"size\"]", "[[1], 2, 3]").exits(1).mentions("p.ron:4:30");
}

#[test]
fn an_array_that_is_not_given_is_named_with_its_form_and_arrays_of_structures_are_refused() {
    with("\"weights\": [0.25, 0.5, \"size\"],", "")
        .exits(1)
        .mentions("needs the parameter `weights`")
        .mentions("add `params: {\"weights\": […, …, …]}`; its type is `float[3]`");
    with("\"light.gains\": [4, 5]", "\"light.gain\": [4, 5]").exits(1).mentions("did you mean `light.gains`?");
    for member in ["Lamp lamps[2];", "float table[2][3];"] {
        let text = SHADER.replace("/* more */", member);
        place("effect.frag", &text, GIVEN).run(&["check", "p.ron"]).exits(1).mentions(
            "neither a number nor a vector nor a matrix of 32 bits, nor an array of such: split it into several",
        );
    }
}

/// Checks an HLSL effect that has push constants. A draw brings `bytes` of them, the pass gives `params`.
fn pushed(bytes: u32, params: &str) -> Outcome {
    let text = "struct Object { float4 place; float4 tint; };
[[vk::push_constant]] ConstantBuffer<Object> object;
float4 PSMain() : SV_Target0 { return object.place + object.tint; }
";
    let place = place("effect.hlsl:PSMain", text, params);
    if bytes == 0 {
        return place.run(&["check", "p.ron"]);
    }
    let brought = format!("push_constants: [(offset: 0, bytes: {bytes})], supplied: []");
    place.file("i.ron", format!("Interface(version: 1, draws: [(of: [FullScreen], {brought})])"));
    place.run(&["check", "p.ron", "--interface", "i.ron"])
}

#[test]
fn do_5_push_constants_of_hlsl_are_the_draws_where_they_fit_and_else_parameters() {
    let both = "\"place\": (1, 2, 3, 4), \"tint\": (1, 1, 1, 1)";
    pushed(32, "").exits(0);
    pushed(16, both).exits(0);
    pushed(0, both).exits(0);
    // Who gives a member means parameters, and gives all of them.
    pushed(32, both).exits(0);
    pushed(32, "\"tint\": (1, 1, 1, 1)").exits(1).mentions("needs the parameter `place`");
    pushed(0, "").exits(1).mentions("needs the parameter `place`");
    pushed(16, "")
        .exits(1)
        .mentions(
            "shader `effect.hlsl:PSMain` reads push constants `object`, bytes 0 to 31, and the stage is brought bytes 0 to 15; \
             as parameters, pass `post` gives no `place` [E0837]",
        )
        .mentions("p.ron:3:");
}
