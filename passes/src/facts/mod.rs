//! The facts of a scene that pipeline files can use, and what decided each.

mod peak;
pub(crate) mod splits;

use crate::scene::{AlphaMode, Bounds, Camera, Object, Scene};
use framewright_graph::frame::{Cascade, DrawList};
use framewright_graph::language::{Fact, FactValue, Facts};
use peak::{Peak, peak};

/// A fact with its cause.
#[derive(Debug, Clone, PartialEq)]
pub struct ExplainedFact {
    /// The fact.
    pub fact: Fact,
    /// Its value.
    pub value: FactValue,
    /// The reason for the value, without final stop ("3 objects: `glass`, `bottle`, …"), or nothing. Names in it are those of
    /// the file, shortened, not escaped.
    pub because: String,
}

/// Names that are shown of many.
const NAMES: usize = 3;
/// Characters that are shown of a name.
const NAME_LENGTH: usize = 40;

impl Scene {
    /// Its facts.
    #[must_use]
    pub fn facts(&self) -> Facts {
        facts(self, peak(self))
    }

    /// Every fact with what decided it, in the order of [`Fact::ALL`].
    #[must_use]
    pub fn explained(&self) -> Vec<ExplainedFact> {
        let peak = peak(self);
        let facts = facts(self, peak);
        let explained = |fact| ExplainedFact { fact, value: facts.value(fact), because: because(self, peak, fact) };
        Fact::ALL.into_iter().map(explained).collect()
    }
}

fn facts(scene: &Scene, peak: Peak) -> Facts {
    let any = |list| scene.objects.iter().any(|object| scene.draw_list(object) == list);
    let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    let triangles = scene.objects.iter().map(|object| (scene.meshes[object.mesh].indices.len() / 3) as u64);
    Facts {
        has_opaque: any(DrawList::Opaque),
        has_alpha_clip: scene.objects.iter().any(|object| is_clipped(scene, object)),
        has_transparent: any(DrawList::Transparent),
        has_cross_fade: scene.objects.iter().any(|object| is_dithered(scene, object)),
        casts_shadows: casts_shadows(scene),
        shadow_cascades: shadow_cascades(scene),
        peak_radiance: peak.radiance,
        exposure: scene.exposure,
        size: scene.size(),
        suns: u32::from(scene.sun.shines()),
        point_lights: count(scene.point_lights.iter().filter(|light| light.shines()).count()),
        objects: count(scene.objects.len()),
        triangles: triangles.sum(),
        depth_range: depth_range(scene),
    }
}

/// From the box around all objects and cameras, as they stand at first.
fn depth_range(scene: &Scene) -> Option<f64> {
    let cameras = || scene.cameras.iter().map(|camera| &camera.camera).chain([&scene.camera]);
    let places = cameras().map(|camera| Bounds { min: camera.position(), max: camera.position() });
    let all = scene.bounds().into_iter().chain(places).reduce(Bounds::union)?;
    let range = |camera: &Camera| {
        let far = camera.far.map_or(f64::INFINITY, f64::from);
        (2.0 * all.radius()).min(far) / f64::from(camera.near)
    };
    Some(cameras().map(range).fold(1.0, f64::max))
}

fn is_clipped(scene: &Scene, object: &Object) -> bool {
    matches!(scene.materials[object.material].alpha, AlphaMode::Mask { .. })
}

/// Whether it leaves out fragments to fade. Transparent objects fade by their opacity instead.
fn is_dithered(scene: &Scene, object: &Object) -> bool {
    object.fades() && scene.draw_list(object) == DrawList::Masked
}

/// Whether an object that isn't transparent is lit by a light with shadows.
fn casts_shadows(scene: &Scene) -> bool {
    let caster = scene.objects.iter().any(|object| scene.draw_list(object) != DrawList::Transparent);
    caster && !shadowing_lights(scene).is_empty()
}

/// How many cascades the sun's shadows need; 0 if it casts none.
fn shadow_cascades(scene: &Scene) -> u32 {
    if !(scene.sun.shadows && scene.sun.shines() && casts_shadows(scene)) {
        return 0;
    }
    depth_range(scene).map_or(Cascade::MOST, splits::needed).into()
}

/// Lights that shine and cast shadows, in words.
fn shadowing_lights(scene: &Scene) -> Vec<String> {
    let sun = (scene.sun.shadows && scene.sun.shines()).then(|| "the sun".to_owned());
    let points = scene.point_lights.iter().enumerate().filter(|(_, light)| light.shadows && light.shines());
    sun.into_iter().chain(points.map(|(number, _)| format!("point light {number}"))).collect()
}

fn because(scene: &Scene, peak: Peak, fact: Fact) -> String {
    let listed = |wanted: &dyn Fn(&Object) -> bool| named(scene.objects.iter().filter(|object| wanted(object)));
    match fact {
        Fact::HasOpaque => listed(&|object| scene.draw_list(object) == DrawList::Opaque),
        Fact::HasAlphaClip => listed(&|object| is_clipped(scene, object)),
        Fact::HasTransparent => listed(&|object| scene.draw_list(object) == DrawList::Transparent),
        Fact::HasCrossFade => listed(&|object| is_dithered(scene, object)),
        Fact::CastsShadows => match (&shadowing_lights(scene)[..], casts_shadows(scene)) {
            ([], _) => "no light that shines has `shadows: true`".to_owned(),
            (_, false) => "there is nothing that light doesn't go through".to_owned(),
            (lights, true) => few(lights.iter().cloned()),
        },
        Fact::ShadowCascades if shadow_cascades(scene) == 0 => "the sun casts none".to_owned(),
        Fact::ShadowCascades => depth_range(scene).map_or_else(String::new, |range| {
            format!("all objects and cameras are within {range:.0} times the shortest near distance")
        }),
        Fact::PeakRadiance => {
            let where_to = peak.object.map_or_else(
                || if scene.sun.shines() { "the sky, towards the sun".to_owned() } else { "the sky".to_owned() },
                |object| shown(&scene.objects[object]),
            );
            if peak.added > 0.0 {
                format!("{where_to}; {:.2} of it through what transparent objects mirror and emit in front", peak.added)
            } else {
                where_to
            }
        }
        Fact::Exposure if scene.exposure == 1.0 => "the file's own numbers are drawn".to_owned(),
        Fact::Exposure => {
            format!("a white surface in the light of the file would show {:.4}", scene.exposure.recip())
        }
        Fact::Size => scene.bounds().map_or_else(
            || "there is no object".to_owned(),
            |bounds| format!("the radius of the box around all objects is {:.4}", bounds.radius()),
        ),
        Fact::Suns if scene.sun.shines() => format!("its colour is {:?}", scene.sun.color),
        Fact::Suns => "its colour is black".to_owned(),
        Fact::PointLights => {
            let black = scene.point_lights.iter().filter(|light| !light.shines()).count();
            if black > 0 { format!("{black} more give no light") } else { String::new() }
        }
        Fact::Triangles => {
            let triangles = |object: &Object| scene.meshes[object.mesh].indices.len() / 3;
            let most = scene.objects.iter().rev().max_by_key(|object| triangles(object));
            most.map_or_else(String::new, |object| format!("{} of them in {}", triangles(object), shown(object)))
        }
        Fact::Lights | Fact::Objects => String::new(),
    }
}

/// How many objects, and the first of them.
fn named<'s>(objects: impl Iterator<Item = &'s Object>) -> String {
    let names: Vec<String> = objects.map(shown).collect();
    match names.len() {
        0 => "no object".to_owned(),
        1 => format!("1 object: {}", names[0]),
        count => format!("{count} objects: {}", few(names.into_iter())),
    }
}

/// The first few.
fn few(mut all: impl Iterator<Item = String>) -> String {
    let first: Vec<String> = all.by_ref().take(NAMES).collect();
    let more = if all.next().is_some() { ", …" } else { "" };
    format!("{}{more}", first.join(", "))
}

/// A name in quotes.
fn shown(object: &Object) -> String {
    match object.name.char_indices().nth(NAME_LENGTH) {
        Some((end, _)) => format!("`{}…`", &object.name[..end]),
        None => format!("`{}`", object.name),
    }
}
