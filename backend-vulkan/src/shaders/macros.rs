//! The macros with which a stage is compiled for a pass.

use super::eyes::{BothEyes, EYE};
use super::mentioned_names::{COMPONENTS, HAS, LOCAL, MentionedNames, PART, TEXTURE};
use crate::base::ShaderStage;
use framewright_graph::frame::{Eye, EyeForm};
use framewright_graph::shader::{EyeSource, Variant};

/// Macros and what they stand for.
pub(super) type Macros = Vec<(String, String)>;

/// The most components that a format can have.
const MOST_COMPONENTS: u32 = 4;

/// The value of part macros where the whole image is used.
const WHOLE: &str = "vec4(1.0, 1.0, 0.0, 0.0)";

/// The value of part macros for the left eye where both eyes' parts lie side by side.
const LEFT_HALF: &str = "vec4(0.5, 1.0, 0.0, 0.0)";

/// The macro that says how many parts push constants tell of, if they tell of any.
const PARTS: &str = "FRAMEWRIGHT_PARTS";

/// The macro that says that the right eye is drawn for by itself, of a stage that asks for the index of a view.
const RIGHT_EYE: &str = "FRAMEWRIGHT_RIGHT_EYE";

/// Whether a stage that asks for the index of a view is for the right eye by itself.
pub(super) fn is_for_right_eye(macros: &Macros) -> bool {
    macros.iter().any(|(name, _)| name == RIGHT_EYE)
}

/// How a variant draws for both eyes at once, if it does.
pub(super) fn both_eyes(variant: &Variant) -> Option<BothEyes> {
    Some(BothEyes { source: variant.eye?, form: variant.form? })
}

/// Whether push constants tell a stage which parts of images are in use.
pub(super) fn tells_parts(macros: &Macros) -> bool {
    macros.iter().any(|(name, _)| name == PARTS)
}

/// Images that a variant samples in the layer of the eye that is drawn for.
pub(super) fn in_layers(variant: &Variant, stage: ShaderStage) -> Vec<String> {
    if !stage.facts().draws {
        return Vec::new();
    }
    let own = variant.eyes.iter().filter(|(_, form, eye)| *form == EyeForm::Layers && eye.is_none());
    own.map(|(name, ..)| name.to_string()).collect()
}

/// The macros that depend on a pass, with their values, in a stage whose file mentions such names.
pub(super) fn macros(mentioned: &MentionedNames, variant: &Variant, stage: ShaderStage) -> Macros {
    let textures = mentioned.adapting.iter().map(|name| {
        let given = variant.textures.iter().find(|(given, _)| **given == **name);
        let texture = given.map_or_else(|| "sampler2D".to_owned(), |(_, texture)| texture.to_string());
        (format!("{TEXTURE}{name}"), texture)
    });
    let sampled = variant.sampled.iter().filter(|name| mentioned.optional.iter().any(|known| **known == ***name));
    let sampled = sampled.map(|name| (format!("{HAS}{name}"), String::new()));
    let components = mentioned.counted.iter().map(|name| {
        let given = variant.components.iter().find(|(given, _)| **given == **name);
        (format!("{COMPONENTS}{name}"), given.map_or(MOST_COMPONENTS, |(_, count)| *count).to_string())
    });
    let local = variant.local.iter().map(|name| (format!("{LOCAL}{name}"), String::new()));
    let depth_only = variant.depth_only.then(|| ("DEPTH_ONLY".to_owned(), String::new()));
    let covers = variant.alpha_to_coverage.then(|| ("ALPHA_TO_COVERAGE".to_owned(), String::new()));
    let fixed = local.chain(depth_only).chain(covers).filter(|(name, _)| !mentioned.own.contains(name));
    let place = |name: &String| variant.parts.iter().position(|part| **part == **name);
    let parts = mentioned.parts.iter().map(|name| {
        let part = place(name).map(|at| format!("framewright_parts.st[{at}]"));
        let halves = variant.eyes.iter().find(|(known, form, _)| **known == **name && *form == EyeForm::Halves);
        let part = match (part, halves) {
            (Some(part), None) => part,
            (None, None) => WHOLE.to_owned(),
            (part, Some((_, _, eye))) => half(&part.unwrap_or_else(|| LEFT_HALF.to_owned()), *eye),
        };
        (format!("{name}{PART}"), part)
    });
    let in_part = mentioned.parts.iter().any(|name| place(name).is_some());
    let count = in_part.then(|| (PARTS.to_owned(), variant.parts.len().to_string()));
    let one = match variant.eye {
        Some(EyeSource::One(Eye::Right)) if mentioned.eye => Some(("eye_index".to_owned(), "1".to_owned())),
        _ => None,
    };
    let right = variant.eye == Some(EyeSource::One(Eye::Right)) && mentioned.view;
    let of_view = right.then(|| (RIGHT_EYE.to_owned(), String::new()));
    let both = both_eyes(variant).into_iter().flat_map(|both| {
        let base = mentioned.base_instance.then(|| both.base_instance(stage));
        both.macros(stage).into_iter().chain(base.into_iter().flatten())
    });
    let own = textures.chain(sampled).chain(components).chain(fixed).chain(parts).chain(count);
    own.chain(one).chain(of_view).chain(both).collect()
}

/// Whether a macro means something in GLSL alone.
pub(super) fn is_of_glsl(name: &str) -> bool {
    name.starts_with(TEXTURE) || name == "main" || name.starts_with("gl_")
}

/// A macro's value in HLSL and Slang.
pub(super) fn in_hlsl(value: &str) -> String {
    value.replace("vec4(", "float4(")
}

/// One eye's part of an image that is used in halves. `left` is the left eye's part.
fn half(left: &str, eye: Option<Eye>) -> String {
    let eye = eye.map_or_else(|| format!("float({EYE})"), |eye| format!("{}.0", eye as u32));
    format!("({left} + vec4(0.0, 0.0, {left}.x * {eye}, 0.0))")
}
