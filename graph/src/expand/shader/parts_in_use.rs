//! Images of which a part is in use: a shader that sees one asks which part it is.

use super::variant;
use crate::base::{Code, Diagnostic};
use crate::expand::resources::Resources;
use crate::language;
use crate::shader::{
    FileLanguage, LanguageFacts, MOST_PARTS, ShaderInterface, declared_name, element_of, shader_words,
};

/// The mistake of a shader that samples or reads the image `part` as `name`, of which only a part is in use, and doesn't ask for that part;
/// `None` if it asks. `by`: how it could find the part, in words.
pub(super) fn not_asked(
    resources: &Resources<'_>,
    interface: &ShaderInterface,
    (shader, name, part): (&str, &str, &language::ImagePart),
    [reads, by]: [&str; 2],
) -> Option<Diagnostic> {
    let (image, span) = (&resources.declared(part.image.index).name.text, part.image.span);
    let wrong = |message: String, help: String| {
        let declared = resources.declared(part.image.index).size.span;
        Some(Diagnostic::new(Code::PART_NOT_ASKED, span, message).label(declared, "its size may change").help(help))
    };
    if element_of(name).is_some() {
        let array = declared_name(name);
        let message = format!(
            "only a part of `{image}` is in use, and shader `{shader}` can't be told which of the elements of `{array}` are so"
        );
        return wrong(message, "give it a fixed size, or declare an image of its own in the shader".to_owned());
    }
    if interface.asks_part.iter().any(|asked| **asked == *name) {
        return None;
    }
    let message = format!("shader `{shader}` {reads} `{name}` and doesn't ask which part of `{image}` is in use");
    let help = match FileLanguage::of_shader(shader).map(FileLanguage::facts) {
        None => format!("include `include/part.glsl` and look it up by {by}"),
        Some(LanguageFacts { includes: Some(ending), .. }) => {
            format!("include `include/part{ending}` and look it up by {by}")
        }
        Some(LanguageFacts { name, .. }) => format!("{name} isn't told of parts: write the shader in GLSL or HLSL"),
    };
    wrong(message, help)
}

/// How a shader looks up a place within the part of the image that it samples as `name`, where that may lie beyond the part, as behind an offset.
pub(super) fn within_part(shader: &str, name: &str) -> String {
    let within = format!("`uv_clamp(uv_adjust(uv, {name}_st), {name}_st, size)`, {SIZE}");
    match FileLanguage::of_shader(shader).and_then(|language| language.facts().includes) {
        Some(ending) => {
            format!("{within}, or by `found_in({name}, sampler, {name}_st, uv)` of `include/texture{ending}`")
        }
        None => within,
    }
}

/// How a shader asks for the extent of the part of the storage image `name`.
pub(super) fn extent_of_part(shader: &str, name: &str) -> String {
    match FileLanguage::of_shader(shader) {
        None => format!("`part_extent(imageSize({name}), {name}_st)`"),
        Some(_) => format!("`part_extent(size, {name}_st)`, {SIZE}"),
    }
}

const SIZE: &str = "where `size` is the image's width and height in texels";

/// How a shader could find its eye's half of the image that it samples as `name`.
pub(super) fn half_help(shader: &str, name: &str) -> String {
    match FileLanguage::of_shader(shader).map(FileLanguage::facts) {
        None => format!(
            "include `include/texture.glsl` and look it up by `found_in({name}, {name}_st, uv)` or `texel_in({name}, {name}_st, texel)`"
        ),
        Some(LanguageFacts { includes: Some(ending), .. }) => {
            format!("include `include/part{ending}` and look it up by {}", within_part(shader, name))
        }
        Some(LanguageFacts { name, .. }) => shader_words::without_halves(name),
    }
}

/// A shader can be told of some parts only.
pub(super) fn too_many(resources: &Resources<'_>, pass: &language::Pass, errors: &mut Vec<Diagnostic>) {
    if let Some((_, surplus)) = variant::in_part(resources, pass).nth(MOST_PARTS) {
        let message = format!("pass `{}` sees more than {MOST_PARTS} images that are used in part", pass.name.text);
        errors.push(
            Diagnostic::new(Code::PART_NOT_ASKED, surplus.image.span, message).help("give some of them a fixed size"),
        );
    }
}
