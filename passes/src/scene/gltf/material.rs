//! glTF's materials (glTF 2.0, section 3.9), as far as they are drawn.

use super::accessor::Data;
use super::document;
use super::notes::Notes;
use super::picture::Textures;
use super::problem::{GltfError, Problem, leave_out};
use crate::scene::limits;
use crate::scene::model::{AlphaMode, Material};

/// The range of most factors, and its words.
const UP_TO_1: (f64, &str) = (1.0, "0 to 1");

/// The material of what names none: white, opaque, one-sided.
pub(super) fn default() -> Material {
    Material {
        name: "default".into(),
        base_color: [1.0; 4],
        base_color_texture: None,
        emissive: [0.0; 3],
        alpha: AlphaMode::Opaque,
        double_sided: false,
    }
}

/// Reads a material. A mistake in it leaves out or changes a part of it.
///
/// # Errors
/// Those of the file as a whole.
pub(super) fn read(
    data: &Data<'_>,
    material: &document::Material,
    at: &str,
    textures: &mut Textures,
    notes: &mut Notes,
) -> Result<Material, GltfError> {
    let pbr = &material.pbr_metallic_roughness;
    let mut base_color = [1.0; 4];
    for (place, factor) in base_color.iter_mut().zip(pbr.base_color_factor.unwrap_or([1.0; 4])) {
        *place = clamped("a base colour factor", factor, UP_TO_1, at, notes);
    }
    let strength = material.extensions.emissive_strength.as_ref().and_then(|it| it.emissive_strength).unwrap_or(1.0);
    let strength = clamped("the emissive strength", strength, (limits::RADIANCE, "0 to 1e9"), at, notes);
    let mut emissive = [0.0; 3];
    for (place, factor) in emissive.iter_mut().zip(material.emissive_factor.unwrap_or([0.0; 3])) {
        *place = clamped("an emissive factor", factor, UP_TO_1, at, notes) * strength;
    }
    if material.emissive_texture.is_some() && emissive != [0.0; 3] {
        // Without its texture the whole surface would glow.
        emissive = [0.0; 3];
        notes.add(format!("{at}: its emissive texture is not supported, so it gives no light of its own"));
    }
    let ignored = [
        (material.normal_texture.is_some(), "normal"),
        (material.occlusion_texture.is_some(), "occlusion"),
        (pbr.metallic_roughness_texture.is_some(), "metallic-roughness"),
    ];
    for (_, which) in ignored.iter().filter(|(present, _)| *present) {
        notes.add(format!("{at}: its {which} texture is ignored"));
    }
    let base_color_texture = match &pbr.base_color_texture {
        Some(texture) => {
            if texture.extensions.transform.is_some() {
                notes.add(format!("{at}: the transform of its base colour texture is ignored"));
            }
            match textures.place(data, texture.index, at, notes) {
                Ok(None) => {
                    notes.add(format!("{at}: its base colour texture has no PNG or JPEG picture, so it is left out"));
                    None
                }
                Ok(place) => place,
                Err(error) => {
                    leave_out(error, &format!("the base colour texture of {at}"), notes)?;
                    None
                }
            }
        }
        None => None,
    };
    let alpha = match material.alpha_mode.as_deref().unwrap_or("OPAQUE") {
        "OPAQUE" => AlphaMode::Opaque,
        "BLEND" => AlphaMode::Blend,
        "MASK" => {
            let cutoff = material.alpha_cutoff.unwrap_or(0.5);
            AlphaMode::Mask { cutoff: clamped("the alpha cut-off", cutoff, (limits::RADIANCE, "0 to 1e9"), at, notes) }
        }
        other => {
            let is = other.escape_debug().to_string();
            let wrong = Problem::Word { what: "alpha mode", is, expected: "OPAQUE, MASK or BLEND" }.at(at);
            notes.mistake(format!("{wrong}, so it is taken as OPAQUE"));
            AlphaMode::Opaque
        }
    };
    let name = material.name.clone().unwrap_or_else(|| at.to_owned());
    let double_sided = material.double_sided;
    Ok(Material { name, base_color, base_color_texture, emissive, alpha, double_sided })
}

/// A factor from 0 to the most that it may be. One beyond that is taken as the nearest that is right.
fn clamped(what: &'static str, is: f64, (most, expected): (f64, &'static str), at: &str, notes: &mut Notes) -> f32 {
    let taken = is.clamp(0.0, most);
    if taken != is {
        let wrong = Problem::OutOfRange { what, is: is.to_string(), expected }.at(at);
        notes.mistake(format!("{wrong}, so it is taken as {taken}"));
    }
    taken as f32
}
