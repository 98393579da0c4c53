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
//! A file may lie about everything. Each reference, range, count and number is checked where it is used.

mod accessor;
mod container;
mod document;
mod extensions;
mod external;
mod json;
mod lights;
mod material;
mod nodes;
mod picture;
mod primitive;
mod problem;
mod unsupported;

pub use problem::{GltfError, Problem};

use super::exposure::{self, Invented};
use super::model::{Bounds, Camera, Material, Mesh, Movement, NamedCamera, Object, Scene};
use super::notes::Notes;
use super::{defaults, limits};
use accessor::Data;
use document::{Document, follow};
use framewright_graph::base::Root;
use glam::{DMat4, DVec3};
use nodes::Placed;
use picture::Textures;
use problem::{at_most, within};
use std::ops::Bound;

/// Reads a scene from the bytes of a GLB file. Files that it names are read from `beside`, and without that not at all.
///
/// # Errors
/// [`GltfError`] says which thing in the file is wrong.
pub fn read_glb(bytes: &[u8], beside: Option<&Root>) -> Result<Scene, GltfError> {
    let container = container::split(bytes)?;
    scene(&Document::read(container.json)?, container.binary, beside)
}

/// Reads a scene from the JSON of a `.gltf` file; `beside` as in [`read_glb`].
///
/// # Errors
/// [`GltfError`] says which thing in the file is wrong.
pub fn read_json(json: &[u8], beside: Option<&Root>) -> Result<Scene, GltfError> {
    scene(&Document::read(json)?, None, beside)
}

fn scene(document: &Document, binary: Option<&[u8]>, beside: Option<&Root>) -> Result<Scene, GltfError> {
    let data = Data::new(document, binary, beside);
    let mut notes = Notes::default();
    if document.animated {
        notes.add("animations are ignored".into());
    }
    unsupported::note(document, &mut notes);
    let mut textures = Textures::default();
    let mut materials = Vec::with_capacity(document.materials.len() + 1);
    for (number, material) in document.materials.iter().enumerate() {
        materials.push(material::read(&data, material, &format!("material {number}"), &mut textures, &mut notes)?);
    }
    let (meshes, groups) = meshes(&data, &mut materials, &mut notes)?;
    let placed = nodes::walk(document, &mut notes)?;
    let (objects, bounds) = objects(document, &placed, &meshes, &groups, &mut notes)?;
    let bounds = bounds.ok_or(Problem::Nothing.at(""))?;
    let lights = lights::read(document, &placed, &mut notes)?;
    let cameras = cameras(document, &placed, &mut notes)?;
    let camera = cameras.first().map_or_else(|| Camera::framing(bounds), |first| first.camera);
    let lights::Lights { sun, points, invented_sun } = lights;
    let own =
        exposure::Lights { sun: (!invented_sun).then_some(&sun), points: &points, ambient: None, bounds: Some(bounds) };
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
        notes: notes.finish(),
    };
    Ok(scene.exposed(exposure, Invented { sun: invented_sun, ambient: true, sky: true }))
}

/// A primitive of a glTF mesh, as a mesh and a material of the scene.
#[derive(Debug, Clone, Copy)]
struct ScenePrimitive {
    mesh: usize,
    material: usize,
}

/// The scene's meshes, and of which of them each glTF mesh is made.
fn meshes(
    data: &Data<'_>,
    materials: &mut Vec<Material>,
    notes: &mut Notes,
) -> Result<(Vec<Mesh>, Vec<Vec<ScenePrimitive>>), GltfError> {
    let mut meshes = Vec::new();
    let mut groups = Vec::with_capacity(data.document.meshes.len());
    let mut budget = primitive::Budget::default();
    let mut default_material = None;
    for (number, group) in data.document.meshes.iter().enumerate() {
        let mut parts = Vec::new();
        for (part, primitive) in group.primitives.iter().enumerate() {
            let at = format!("mesh {number}, primitive {part}");
            let material = match primitive.material {
                Some(material) => {
                    follow(&data.document.materials, material, "material", &at)?;
                    material as usize
                }
                None => *default_material.get_or_insert_with(|| {
                    materials.push(defaults::material());
                    materials.len() - 1
                }),
            };
            if let Some(mesh) = primitive::read(data, primitive, &at, &mut budget, notes)? {
                parts.push(ScenePrimitive { mesh: meshes.len(), material });
                meshes.push(mesh);
            }
        }
        groups.push(parts);
    }
    Ok((meshes, groups))
}

/// One object for each primitive of each placed mesh, and the box around them all.
fn objects(
    document: &Document,
    placed: &[Placed<'_>],
    meshes: &[Mesh],
    groups: &[Vec<ScenePrimitive>],
    notes: &mut Notes,
) -> Result<(Vec<Object>, Option<Bounds>), GltfError> {
    let mut objects: Vec<Object> = Vec::new();
    let mut all: Option<Bounds> = None;
    for Placed { number, node, to_world } in placed {
        let Some(group) = node.mesh else { continue };
        let at = format!("node {number}");
        let parts = follow(groups, group, "mesh", &at)?;
        if node.skin.is_some() {
            notes.add(format!("{at}: its skin is ignored; the mesh stands as it was modelled"));
        }
        at_most("objects up to here", (objects.len() + parts.len()) as u64, limits::OBJECTS as u64, &at)?;
        let mesh_name = document.meshes.get(group as usize).and_then(|mesh| mesh.name.clone());
        let name = node.name.clone().or(mesh_name).unwrap_or_else(|| at.clone());
        for (index, part) in parts.iter().enumerate() {
            let transform = *to_world;
            let bounds = meshes[part.mesh].bounds.transformed(transform);
            if !bounds.within(limits::COORDINATE) {
                let is = format!("{:?} to {:?}", bounds.min.as_vec3().to_array(), bounds.max.as_vec3().to_array());
                return Err(
                    Problem::OutOfRange { what: "its place in the world", is, expected: "at most 1e9 m" }.at(&at)
                );
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
fn cameras(document: &Document, placed: &[Placed<'_>], notes: &mut Notes) -> Result<Vec<NamedCamera>, GltfError> {
    let mut cameras = Vec::new();
    for Placed { number, node, to_world } in placed {
        let Some(index) = node.camera else { continue };
        let camera = follow(&document.cameras, index, "camera", &format!("node {number}"))?;
        let at = format!("camera {index}");
        let perspective = match (camera.kind.as_str(), &camera.perspective) {
            ("perspective", Some(perspective)) => perspective,
            _ => {
                notes.add(format!("{at}: only perspective cameras are used"));
                continue;
            }
        };
        let fov = within("the vertical field of view", perspective.yfov, 1e-4..3.1, "1e-4 to 3.1 radians", &at)?;
        let near = within("the near distance", perspective.znear, 1e-6..=1e9, "1e-6 to 1e9 m", &at)?;
        let beyond_near = (Bound::Excluded(f64::from(near as f32)), Bound::Included(f64::from(f32::MAX)));
        let far = perspective
            .zfar
            .map(|far| within("the far distance", far, beyond_near, "more than the near distance", &at));
        let far = far.transpose()?.map(|far| far as f32);
        match looking(*to_world, fov as f32, near as f32) {
            Some(camera) => {
                let camera = Camera { far, ..camera };
                let name = node.name.clone().unwrap_or_else(|| at.clone());
                cameras.push(NamedCamera { name, camera });
            }
            None => notes.add(format!("{at}: its node gives it no direction, so it is not used")),
        }
    }
    Ok(cameras)
}

fn looking(to_world: DMat4, vertical_fov: f32, near: f32) -> Option<Camera> {
    let position = to_world.w_axis.truncate();
    let back = to_world.z_axis.truncate().try_normalize()?;
    let near_enough = position.abs().max_element() <= limits::COORDINATE;
    let up: DVec3 = to_world.y_axis.truncate();
    Camera::facing(position, -back, up, vertical_fov, near).filter(|_| near_enough)
}
