//! Our own scene format, in RON.
//!
//! ```ron
//! Scene(
//!     version: 1,
//!     camera: (position: (4, 3, 8), target: (0, 1, 0), fov: 40, near: 0.1, far: 500),
//!     cameras: [(name: "top", position: (0, 9, 0), target: (0, 0, 0), up: (0, 0, -1))],
//!     sun: (direction: (1, -2, -1), color: "#fff0d0", intensity: 1.2),
//!     ambient: (0.1, 0.1, 0.12),
//!     sky: (zenith: "#3060a0", horizon: "#c0d0e0", ground: "#505050"),
//!     lights: [(position: (0, 3, 0), color: "#ffffff", intensity: 20, range: 10)],
//!     exposure: 1.0,
//!     materials: [
//!         (name: "grass", color: "#408040", texture: Checker(count: (8, 8), colors: ("#ffffff", "#d0d0d0"))),
//!         (name: "sieve", color: "#c08040", texture: Dots(count: (12, 6), radius: 0.3), alpha: Mask(0.5), double_sided: true),
//!         (name: "glass", color: "#80c0ff", opacity: 0.4, alpha: Blend),
//!         (name: "lamp", color: "#000000", emissive: "#ffffff", strength: 8),
//!     ],
//!     objects: [
//!         Plane(material: "grass", size: (20, 20)),
//!         Sphere(name: "ball", material: "sieve", position: (0, 1, 0), radius: 1),
//!         Cube(material: ["glass", "lamp"], position: (0, 0.5, 3), size: 1, rotation: (0, 30, 0),
//!              repeat: Grid(count: (4, 1, 1), step: (2, 0, 0))),
//!     ],
//! )
//! ```
//!
//! Lengths are metres, angles degrees, colours linear numbers or sRGB as the web writes it. Rotations turn about the
//! world's x, then y, then z. A plane lies flat and faces up; its size is width and depth. A grid's middle is the object's
//! position; a ring lies around it, beginning in front (+z), and turns each copy with it. Copies take several materials
//! by turns. A sun or light with `shadows: true` casts shadows, where a pipeline draws any. An object with `cross_fade: 0.3`
//! is seen in three tenths of its pixels, one with `-0.3` in the others.
//!
//! A camera sees from the distance `near` on, 0.1 m if it says nothing, to the distance `far`: infinitely far if that is left
//! out.
//!
//! Cameras and objects move steadily with `velocity: (1, 0, 0)`, metres a second, and turn about their own place with
//! `spin: (0, 90, 0)`: the axis, as long as the degrees a second. A frame lasts [`super::FRAME_SECONDS`]; the first shows
//! everything where the file says that it is. Copies move alike; lights stand still.
//!
//! All light is multiplied by `exposure`. `Auto` chooses it so that a white surface in the strongest light shows 1: lights may be in lux
//! and candela, or any unit. Where it is left out it is 1, a white surface in a sun of intensity 1 showing as white; but `Auto` if
//! the light is 64 times as strong and more, or all of it less than a 256th, which would show as nothing but white or black.
//!
//! `version`, `materials` and `objects` must be there; without a camera the objects are framed; without sun, ambient light or
//! sky it is a clear day. Numbers beyond [`super::limits`], and sizes below a micrometre, are mistakes.

mod materials;
mod objects;
mod values;

use super::exposure::{InventedLight, Lights, colors};
use super::model::{Camera, NamedCamera, PointLight, Scene, Sky, Sun};
use super::{defaults, limits};
use framewright_graph::base::{Code, Diagnostic, Sources, Span, without_mark};
use framewright_graph::fields;
use framewright_graph::ron::{Leaf, Name, Names, Reader, Tree};
use glam::DVec3;
use materials::{MaterialFields, Patterns};
use objects::Objects;
use std::sync::Arc;
use values::{color, direction, movement, number, place};

/// The version of the format that this library reads.
pub const VERSION: i64 = 1;

fields! {
    struct SceneFields<'s> as "Scene" {
        version: Leaf<'s>,
        camera: Option<Leaf<'s>>,
        cameras: Option<Leaf<'s>>,
        sun: Option<Leaf<'s>>,
        ambient: Option<Leaf<'s>>,
        sky: Option<Leaf<'s>>,
        lights: Option<Leaf<'s>>,
        exposure: Option<Leaf<'s>>,
        materials: Leaf<'s>,
        objects: Leaf<'s>,
    }
}

/// Reads a scene file's text, which is added to `sources`. `shown` is the path as the user named it, `relative` the file's
/// name.
///
/// # Errors
/// Everything that is wrong with the file, in its order.
pub fn read(sources: &mut Sources, shown: &str, relative: &str, text: String) -> Result<Scene, Vec<Diagnostic>> {
    let text: Arc<str> = without_mark(&text).into();
    let file = sources.add(shown, relative, text.clone());
    let mut reader = Reader::default();
    let scene = readable(&mut reader, file, text).and_then(|tree| whole(&mut reader, tree.root()));
    let mut mistakes = reader.errors;
    match scene {
        Some(scene) if mistakes.is_empty() => Ok(scene),
        _ => {
            mistakes.sort_by_key(|mistake| mistake.labels.first().map_or(0, |label| label.span.start));
            Err(mistakes)
        }
    }
}

/// The file's syntax tree; `None` if the file is empty or not RON.
fn readable(reader: &mut Reader, file: u32, text: Arc<str>) -> Option<Tree> {
    if text.trim().is_empty() {
        let end = u32::try_from(text.len()).unwrap_or(u32::MAX);
        let empty = Diagnostic::new(Code::FILE_EMPTY, Span::new(file, 0, end), "the file is empty");
        reader.report(empty.help("a scene begins with `Scene(version: 1,`"));
        return None;
    }
    Tree::read(file, text, &mut reader.errors)
}

fn whole<'s>(reader: &mut Reader, all: Leaf<'s>) -> Option<Scene> {
    let fields: SceneFields<'_> = reader.read(all, "the scene")?;
    let version = reader.integer(fields.version)?;
    if version != VERSION {
        let message = format!("this file is written in version {version} of the scene format");
        reader.wrong(Code::VERSION, fields.version, message, &format!("this program reads version {VERSION}"));
        return None;
    }
    let sun = fields.sun.map_or(Some(defaults::SUN), |leaf| sun(reader, leaf));
    let ambient = |leaf| color(reader, leaf, "the ambient light", limits::RADIANCE);
    let ambient = fields.ambient.map_or(Some(defaults::AMBIENT), ambient);
    let sky = fields.sky.map_or(Some(defaults::SKY), |leaf| sky(reader, leaf));
    let point_lights = fields.lights.map_or(Some(Vec::new()), |leaf| lights(reader, leaf));

    let exposure = fields.exposure.map_or(Some(None), |leaf| exposure(reader, leaf).map(Some));

    let mut names = Names::new("material", Code::UNKNOWN_IN_SCENE);
    let mut patterns = Patterns::default();
    let mut materials = Vec::new();
    for leaf in reader.list(fields.materials, "`materials`")? {
        let entry: Option<MaterialFields<'_>> = reader.read(leaf, "this material");
        let name = entry.as_ref().and_then(|entry| Name::written(entry.name));
        names.give(reader, name);
        materials.push(entry.and_then(|entry| materials::lower(reader, &entry, &mut patterns)));
    }
    let mut objects = Objects::default();
    let mut object_names = Names::new("object", Code::UNKNOWN_IN_SCENE);
    for (number, leaf) in reader.list(fields.objects, "`objects`")?.into_iter().enumerate() {
        objects.add(reader, leaf, number, &names, &mut object_names);
        if objects.full {
            break;
        }
    }
    let cameras = fields.cameras.map_or(Some(Vec::new()), |leaf| cameras(reader, leaf));
    let first = cameras.as_ref().and_then(|cameras| cameras.first());
    let camera = match (fields.camera, first) {
        (Some(leaf), _) => camera(reader, leaf),
        (None, Some(first)) => Some(first.camera),
        (None, None) => {
            let bounds = objects::bounds(&objects);
            if bounds.is_none() && reader.errors.is_empty() {
                reader.wrong(Code::SCENE_CAMERA, fields.objects, "a scene without objects needs a camera", "");
            }
            bounds.map(Camera::framing)
        }
    };
    let scene = Scene {
        meshes: objects.meshes,
        materials: materials.into_iter().collect::<Option<_>>()?,
        textures: patterns.textures,
        objects: objects.objects,
        sun: sun?,
        ambient: ambient?,
        point_lights: point_lights?,
        sky: sky?,
        exposure: 1.0,
        camera: camera?,
        cameras: cameras?,
        notes: Vec::new(),
        mistakes: Vec::new(),
    };
    let invented =
        InventedLight { sun: fields.sun.is_none(), ambient: fields.ambient.is_none(), sky: fields.sky.is_none() };
    let lights = Lights {
        sun: (!invented.sun).then_some(&scene.sun),
        points: &scene.point_lights,
        ambient: (!invented.ambient).then_some(scene.ambient),
        bounds: scene.bounds(),
    };
    let others = scene.materials.iter().map(|material| material.emissive);
    let others = others.chain(colors(&scene.sky)).chain(invented.sun.then_some(scene.sun.color));
    let exposure = match exposure? {
        None => lights.exposure_if_beyond(others),
        Some(Exposure::Auto) => lights.exposure(),
        Some(Exposure::Fixed(factor)) => factor,
    };
    Some(scene.exposed(exposure, invented))
}

/// What a file says of its exposure.
#[derive(Debug, Clone, Copy)]
enum Exposure {
    Auto,
    Fixed(f64),
}

fn exposure<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<Exposure> {
    if leaf.number().is_some() {
        return number(reader, leaf, "the exposure", 1e-12, 1e12).map(Exposure::Fixed);
    }
    let (_, rest) = reader.word(leaf, "the exposure", &["Auto"], "write a number, or `Auto`")?;
    reader.bare("Auto", rest)?;
    Some(Exposure::Auto)
}

fields! {
    struct CameraFields<'s> {
        position: Leaf<'s>,
        target: Leaf<'s>,
        up: Option<Leaf<'s>>,
        fov: Option<Leaf<'s>>,
        near: Option<Leaf<'s>>,
        far: Option<Leaf<'s>>,
        velocity: Option<Leaf<'s>>,
        spin: Option<Leaf<'s>>,
    }
}

/// Field of view in degrees where a file says nothing.
const FOV: f64 = 40.0;
/// Near distance in metres where a file says nothing.
const NEAR: f64 = 0.1;

fn camera<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<Camera> {
    let fields = reader.read(leaf, "the camera")?;
    standing(reader, fields)
}

fn standing(reader: &mut Reader, fields: CameraFields<'_>) -> Option<Camera> {
    let position = place(reader, fields.position, "the position");
    let target = place(reader, fields.target, "the target");
    let up = fields.up.map_or(Some(DVec3::Y), |leaf| direction(reader, leaf, "the upward direction"));
    let fov = fields.fov.map_or(Some(FOV), |leaf| number(reader, leaf, "the field of view", 1.0, 170.0));
    let near = fields.near.map_or(Some(NEAR), |leaf| number(reader, leaf, "the near distance", 1e-6, 1e9));
    let far = fields.far.map(|leaf| (leaf, number(reader, leaf, "the far distance", 1e-6, 1e12)));
    let movement = movement(reader, fields.velocity, fields.spin);
    let far = match far {
        None => None,
        Some((leaf, far)) => {
            let (far, near) = (far? as f32, near? as f32);
            if far <= near {
                let help = "a far plane lies behind the near plane; without `far` the camera sees infinitely far";
                reader.wrong(
                    Code::SCENE_CAMERA,
                    leaf,
                    format!("the far distance ({far}) isn't greater than the near distance ({near})"),
                    help,
                );
                return None;
            }
            Some(far)
        }
    };
    let (position, target, up, movement) = (position?, target?, up?, movement?);
    let camera = Camera::look_at(position, target, up, fov?.to_radians() as f32, near? as f32);
    if camera.is_none() {
        let help = "position and target must differ, and the view must not run along `up`";
        reader.wrong(Code::SCENE_CAMERA, fields.target, "this leaves the camera's direction open", help);
    }
    camera.map(|camera| Camera { far, movement, ..camera })
}

fields! {
    struct NamedCameraFields<'s> {
        name: Leaf<'s>,
        position: Leaf<'s>,
        target: Leaf<'s>,
        up: Option<Leaf<'s>>,
        fov: Option<Leaf<'s>>,
        near: Option<Leaf<'s>>,
        far: Option<Leaf<'s>>,
        velocity: Option<Leaf<'s>>,
        spin: Option<Leaf<'s>>,
    }
}

fn cameras<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<Vec<NamedCamera>> {
    let mut names = Names::new("camera", Code::UNKNOWN_CAMERA);
    let mut cameras = Vec::new();
    for leaf in reader.list(leaf, "`cameras`")? {
        let entry: Option<NamedCameraFields<'_>> = reader.read(leaf, "this camera");
        let name = entry.as_ref().and_then(|entry| Name::written(entry.name));
        let written = name.as_ref().map(|name| name.text.to_string());
        names.give(reader, name);
        cameras.push(entry.and_then(|entry| {
            let NamedCameraFields { position, target, up, fov, near, far, velocity, spin, .. } = entry;
            let camera = standing(reader, CameraFields { position, target, up, fov, near, far, velocity, spin })?;
            Some(NamedCamera { name: written?, camera })
        }));
    }
    cameras.into_iter().collect()
}

fields! {
    struct SunFields<'s> {
        direction: Leaf<'s>,
        color: Option<Leaf<'s>>,
        intensity: Option<Leaf<'s>>,
        shadows: Option<Leaf<'s>>,
    }
}

fn sun<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<Sun> {
    let fields: SunFields<'_> = reader.read(leaf, "the sun")?;
    let direction = direction(reader, fields.direction, "the sun's direction");
    let (color, intensity) = light(reader, fields.color, fields.intensity);
    let shadows = fields.shadows.map_or(Some(false), |leaf| reader.truth(leaf));
    let intensity = intensity?;
    let color = color?.map(|part| part * intensity);
    Some(Sun { direction: direction?.as_vec3().to_array(), color, shadows: shadows? })
}

fields! {
    struct LightFields<'s> {
        position: Leaf<'s>,
        color: Option<Leaf<'s>>,
        intensity: Option<Leaf<'s>>,
        range: Option<Leaf<'s>>,
        shadows: Option<Leaf<'s>>,
    }
}

fn lights<'s>(reader: &mut Reader, list: Leaf<'s>) -> Option<Vec<PointLight>> {
    let leaves = reader.list(list, "`lights`")?;
    if leaves.len() > limits::POINT_LIGHTS {
        let message = format!("the scene has {} lights", leaves.len());
        reader.wrong(Code::SCENE_TOO_LARGE, list, message, &format!("at most {} are allowed", limits::POINT_LIGHTS));
        return None;
    }
    let lights: Vec<Option<PointLight>> = leaves.into_iter().map(|leaf| point_light(reader, leaf)).collect();
    lights.into_iter().collect()
}

fn point_light<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<PointLight> {
    let fields: LightFields<'_> = reader.read(leaf, "this light")?;
    let position = place(reader, fields.position, "the position");
    let (color, intensity) = light(reader, fields.color, fields.intensity);
    let range = |leaf| number(reader, leaf, "the range", 1e-6, limits::COORDINATE).map(Some);
    let range = fields.range.map_or(Some(None), range);
    let shadows = fields.shadows.map_or(Some(false), |leaf| reader.truth(leaf));
    Some(PointLight {
        position: position?.to_array(),
        color: color?,
        intensity: intensity?,
        range: range?.map(|range| range as f32),
        shadows: shadows?,
    })
}

/// Colour (white where the file says nothing) and intensity (1).
fn light<'s>(
    reader: &mut Reader,
    hue: Option<Leaf<'s>>,
    intensity: Option<Leaf<'s>>,
) -> (Option<[f32; 3]>, Option<f32>) {
    let hue = hue.map_or(Some([1.0; 3]), |leaf| color(reader, leaf, "the colour", 1.0));
    let strength = |leaf| number(reader, leaf, "the intensity", 0.0, limits::RADIANCE);
    (hue, intensity.map_or(Some(1.0), strength).map(|intensity| intensity as f32))
}

fields! {
    struct SkyFields<'s> {
        zenith: Leaf<'s>,
        horizon: Leaf<'s>,
        ground: Leaf<'s>,
    }
}

fn sky<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<Sky> {
    let fields: SkyFields<'_> = reader.read(leaf, "the sky")?;
    let mut read = |leaf, what| color(reader, leaf, what, limits::RADIANCE);
    let zenith = read(fields.zenith, "the zenith");
    let horizon = read(fields.horizon, "the horizon");
    let ground = read(fields.ground, "the ground");
    Some(Sky { zenith: zenith?, horizon: horizon?, ground: ground? })
}
