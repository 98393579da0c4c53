//! glTF 2.0: in its binary form (GLB), one file with everything in it, or as JSON (`.gltf`). In both, buffers and images may
//! be `data:` URIs, or files in the folder of this one, never outside of it.
//!
//! Read are: triangles (lists, strips, fans) with positions, normals (computed flat where missing), one set of texture
//! coordinates (the one that the base colour texture names; zeros where missing) and indices of 8, 16 or 32 bits or none;
//! sparse accessors; base colour factor and texture (PNG or JPEG); emissive factor and strength
//! (`KHR_materials_emissive_strength`); alpha modes; double-sided materials; node hierarchies with matrices or
//! translation, rotation and scale; the first perspective camera; directional and point lights (`KHR_lights_punctual`: the
//! first directional light is the sun; candela and lux are divided by π, see [`crate::scene`], and all light of the file is
//! multiplied by [`Scene::exposure`], so that a white surface in its strongest light shows 1, whatever the unit).
//!
//! Not drawn, and noted in [`Scene::notes`]: points and lines, vertex colours, emissive, normal, occlusion and
//! metallic-roughness textures, metallic and roughness factors, texture transforms, skins, morph targets, animations,
//! orthographic cameras, spot lights, further suns, every extension but the two named. A file that *requires* another
//! extension is refused. A node that a scene lists although it is a child is drawn once, where its parent places it.
//!
//! A picture is decoded once, and kept once, however many textures show it.
//!
//! A file may lie about everything. Each reference, range, count and number is checked where it is used. A mistake in a part of the
//! file leaves out that part, or a factor beyond its range is taken as the nearest that is right: [`Scene::mistakes`] tells of each.
//! A mistake of the whole file is an error: no JSON, a required extension, data that isn't there, or more than is allowed.

mod accessor;
mod container;
mod document;
mod extensions;
mod external;
mod ignored_extensions;
mod json;
mod lights;
mod material;
mod nodes;
mod notes;
mod picture;
mod primitive;
mod problem;

pub use problem::{GltfError, Problem};

use super::exposure::{self, InventedLight};
use super::model::{Bounds, Camera, Material, Mesh, Movement, NamedCamera, Object, Scene};
use super::{defaults, limits};
use accessor::Data;
use document::{Document, follow};
use framewright_graph::base::Root;
use glam::{DMat4, DVec3};
use nodes::PlacedNode;
use notes::Notes;
use picture::Textures;
use problem::{at_most_in_all, leave_out, within};
use std::ops::Bound;

/// Reads a scene from the bytes of a GLB file. Files that it names are read from `beside`, and without that not at all.
///
/// # Errors
/// [`GltfError`] says which thing in the file is wrong.
pub fn read_glb(bytes: &[u8], beside: Option<&Root>) -> Result<Scene, GltfError> {
    let container = container::split(bytes)?;
    scene(container.json, container.binary, beside)
}

/// Reads a scene from the JSON of a `.gltf` file; `beside` as in [`read_glb`].
///
/// # Errors
/// [`GltfError`] says which thing in the file is wrong.
pub fn read_json(json: &[u8], beside: Option<&Root>) -> Result<Scene, GltfError> {
    scene(json, None, beside)
}

fn scene(json: &[u8], binary: Option<&[u8]>, beside: Option<&Root>) -> Result<Scene, GltfError> {
    let mut notes = Notes::default();
    let document = &Document::read(json, &mut notes)?;
    let data = Data::new(document, binary, beside);
    if document.animated {
        notes.add("animations are ignored".into());
    }
    ignored_extensions::note(document, &mut notes);
    let mut textures = Textures::default();
    let mut materials = Vec::with_capacity(document.materials.len() + 1);
    for (number, material) in document.materials.iter().enumerate() {
        let at = format!("material {number}");
        materials.push(match material {
            Some(material) => material::read(&data, material, &at, &mut textures, &mut notes)?,
            None => material::default(),
        });
    }
    let (meshes, groups) = meshes(&data, &mut materials, &mut notes)?;
    let placed = nodes::walk(document, &mut notes);
    let (objects, bounds) = objects(document, &placed, &meshes, &groups, &mut notes)?;
    if !objects.iter().any(|object| meshes[object.mesh].has_area(object.transform)) {
        notes.mistake(Problem::Nothing.to_string());
    }
    let lights = lights::read(document, &placed, &mut notes)?;
    let cameras = cameras(document, &placed, &mut notes)?;
    let nowhere = Bounds { min: DVec3::ZERO, max: DVec3::ZERO };
    let camera = cameras.first().map_or_else(|| Camera::framing(bounds.unwrap_or(nowhere)), |first| first.camera);
    data.external.mistakes().into_iter().for_each(|mistake| notes.mistake(mistake));
    let (notes, mistakes) = notes.finish();
    let lights::Lights { sun, points, invented_sun } = lights;
    let own = exposure::Lights { sun: (!invented_sun).then_some(&sun), points: &points, ambient: None, bounds };
    let exposure = own.exposure();
    let scene = Scene {
        meshes,
        materials,
        textures: textures.decoded,
        objects,
        sun,
        ambient: defaults::AMBIENT,
        point_lights: points,
        sky: defaults::SKY,
        exposure: 1.0,
        camera,
        cameras,
        notes,
        mistakes,
    };
    Ok(scene.exposed(exposure, InventedLight { sun: invented_sun, ambient: true, sky: true }))
}

/// A primitive of a glTF mesh, as a mesh and a material of the scene.
#[derive(Debug, Clone, Copy)]
struct ScenePrimitive {
    mesh: usize,
    material: usize,
}

/// The primitives of each glTF mesh; none of one that is left out.
type Groups = Vec<Option<Vec<ScenePrimitive>>>;

/// The scene's meshes, and of which of them each glTF mesh is made.
///
/// # Errors
/// Those of the file as a whole.
fn meshes(data: &Data<'_>, materials: &mut Vec<Material>, notes: &mut Notes) -> Result<(Vec<Mesh>, Groups), GltfError> {
    let mut meshes = Vec::new();
    let mut groups = Vec::with_capacity(data.document.meshes.len());
    let mut budget = primitive::Budget::default();
    let (mut default_material, mut wasted) = (None, 0);
    for (number, group) in data.document.meshes.iter().enumerate() {
        let Some(group) = group else {
            groups.push(None);
            continue;
        };
        let mut parts = Vec::new();
        for (part, primitive) in group.primitives.iter().enumerate() {
            let Some(primitive) = primitive else { continue };
            let at = format!("mesh {number}, primitive {part}");
            let taken = data.taken();
            let mesh = match primitive::read(data, primitive, &at, &mut budget, notes) {
                Ok(Some(mesh)) => mesh,
                Ok(None) => continue,
                Err(error) => {
                    leave_out(error, &at, notes)?;
                    // What is read in vain is bounded as what is kept.
                    wasted += data.taken() - taken;
                    at_most_in_all("bytes of what is left out", wasted, limits::FILE_BYTES, &at)?;
                    continue;
                }
            };
            let count = data.document.materials.len();
            let material = primitive.material.and_then(|material| {
                let known = usize::try_from(material).ok().filter(|known| *known < count);
                if known.is_none() {
                    let missing = Problem::Missing { kind: "material", index: material, count }.at(&at);
                    notes.mistake(format!("{missing}, so a white one stands in its place"));
                }
                known
            });
            let material = material.unwrap_or_else(|| {
                *default_material.get_or_insert_with(|| {
                    materials.push(material::default());
                    materials.len() - 1
                })
            });
            parts.push(ScenePrimitive { mesh: meshes.len(), material });
            meshes.push(mesh);
        }
        groups.push(Some(parts));
    }
    Ok((meshes, groups))
}

/// One object for each primitive of each placed mesh, and the box around them all.
///
/// # Errors
/// Those of the file as a whole.
fn objects(
    document: &Document,
    placed: &[PlacedNode<'_>],
    meshes: &[Mesh],
    groups: &Groups,
    notes: &mut Notes,
) -> Result<(Vec<Object>, Option<Bounds>), GltfError> {
    let mut objects: Vec<Object> = Vec::new();
    let mut all: Option<Bounds> = None;
    for PlacedNode { number, node, to_world } in placed {
        let Some(group) = node.mesh else { continue };
        let at = format!("node {number}");
        let parts = match follow(groups, group, "mesh", &at) {
            Ok(parts) => parts,
            Err(error) => {
                leave_out(error, "its mesh", notes)?;
                continue;
            }
        };
        if node.skin.is_some() {
            notes.add(format!("{at}: its skin is ignored; the mesh stands as it was modelled"));
        }
        at_most_in_all("objects up to here", (objects.len() + parts.len()) as u64, limits::OBJECTS as u64, &at)?;
        let mesh_name = document.meshes.get(group as usize).and_then(|mesh| mesh.as_ref()?.name.clone());
        let name = node.name.clone().or(mesh_name).unwrap_or_else(|| at.clone());
        for (index, part) in parts.iter().enumerate() {
            let transform = *to_world;
            let bounds = meshes[part.mesh].bounds.transformed(transform);
            if !bounds.within(limits::COORDINATE) {
                let is = format!("{:?} to {:?}", bounds.min.as_vec3().to_array(), bounds.max.as_vec3().to_array());
                let expected = "at most 1e9 m";
                let far = Problem::OutOfRange { what: "its place in the world", is, expected }.at(&at);
                leave_out(far, "its mesh", notes)?;
                continue;
            }
            all = Some(all.map_or(bounds, |all| all.union(bounds)));
            let name = if index == 0 { name.clone() } else { format!("{name}, primitive {index}") };
            objects.push(Object {
                name,
                mesh: part.mesh,
                material: part.material,
                transform,
                cross_fade: 1.0,
                movement: Movement::default(),
            });
        }
    }
    Ok((objects, all))
}

/// Every perspective camera that stands somewhere, without the scale of its node, by the name of its node.
///
/// # Errors
/// Those of the file as a whole.
fn cameras(document: &Document, placed: &[PlacedNode<'_>], notes: &mut Notes) -> Result<Vec<NamedCamera>, GltfError> {
    let mut cameras = Vec::new();
    for PlacedNode { number, node, to_world } in placed {
        let Some(index) = node.camera else { continue };
        let at = format!("camera {index}");
        let found = follow(&document.cameras, index, "camera", &format!("node {number}"));
        let lens = match found.and_then(|found| lens(found, &at)) {
            Ok(Some(lens)) => lens,
            Ok(None) => {
                notes.add(format!("{at}: only perspective cameras are used"));
                continue;
            }
            Err(error) => {
                leave_out(error, &at, notes)?;
                continue;
            }
        };
        match looking(*to_world, lens.fov, lens.near) {
            Some(camera) => {
                let camera = Camera { far: lens.far, ..camera };
                let name = node.name.clone().unwrap_or_else(|| at.clone());
                cameras.push(NamedCamera { name, camera });
            }
            None => notes.add(format!("{at}: its node gives it no direction, so it is not used")),
        }
    }
    Ok(cameras)
}

/// The numbers of a perspective camera.
struct Lens {
    fov: f32,
    near: f32,
    far: Option<f32>,
}

/// The numbers of a camera; `None`: it isn't perspective.
fn lens(camera: &document::Camera, at: &str) -> Result<Option<Lens>, GltfError> {
    let ("perspective", Some(perspective)) = (camera.kind.as_str(), &camera.perspective) else { return Ok(None) };
    let fov = within("the vertical field of view", perspective.yfov, 1e-4..3.1, "1e-4 to 3.1 radians", at)?;
    let near = within("the near distance", perspective.znear, 1e-6..=1e9, "1e-6 to 1e9 m", at)?;
    let beyond_near = (Bound::Excluded(f64::from(near as f32)), Bound::Included(f64::from(f32::MAX)));
    let far =
        perspective.zfar.map(|far| within("the far distance", far, beyond_near, "more than the near distance", at));
    Ok(Some(Lens { fov: fov as f32, near: near as f32, far: far.transpose()?.map(|far| far as f32) }))
}

fn looking(to_world: DMat4, vertical_fov: f32, near: f32) -> Option<Camera> {
    let position = to_world.w_axis.truncate();
    let back = to_world.z_axis.truncate().try_normalize()?;
    let near_enough = position.abs().max_element() <= limits::COORDINATE;
    let up: DVec3 = to_world.y_axis.truncate();
    Camera::facing(position, -back, up, vertical_fov, near).filter(|_| near_enough)
}
