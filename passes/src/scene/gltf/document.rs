//! The parts of glTF's JSON that are read. Everything else is skipped.

use super::extensions::{self, Extensions};
use super::json;
use super::problem::{GltfError, Problem};
use serde::Deserialize;
use serde_json::Value;
use serde_json::value::RawValue;
use std::collections::BTreeMap;

/// glTF's lists by their names there. References between them are plain numbers, checked where they are followed.
#[derive(Debug, Default)]
pub(super) struct Document {
    pub(super) accessors: Vec<Accessor>,
    pub(super) buffers: Vec<Buffer>,
    pub(super) buffer_views: Vec<BufferView>,
    pub(super) cameras: Vec<Camera>,
    pub(super) images: Vec<Image>,
    pub(super) lights: Vec<Light>,
    pub(super) materials: Vec<Material>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) nodes: Vec<Node>,
    pub(super) samplers: Vec<Sampler>,
    pub(super) scenes: Vec<Scene>,
    pub(super) textures: Vec<Texture>,
    pub(super) scene: Option<u64>,
    pub(super) animated: bool,
    pub(super) extensions: Extensions,
}

impl Document {
    /// Reads the JSON; each element of a list by itself, so that a mistake in it can be named.
    pub(super) fn read(json: &[u8]) -> Result<Document, GltfError> {
        let json = std::str::from_utf8(json).map_err(|_| Problem::Json("the JSON is not UTF-8".into()).at(""))?;
        // First of all the version: of another one everything else may differ.
        let head: Head = json::text(json).map_err(|words| Problem::Json(words).at(""))?;
        if !head.asset.version.starts_with("2.") {
            return Err(Problem::AssetVersion(head.asset.version.escape_debug().to_string()).at(""));
        }
        if let Some(unknown) = head.extensions_required.iter().find(|name| !extensions::READ.contains(&name.as_str())) {
            return Err(Problem::Extension(unknown.escape_debug().to_string()).at(""));
        }
        let root: Root = json::text(json).map_err(|words| Problem::Json(words).at(""))?;
        let mut extensions = Extensions::default();
        head.extensions_used.iter().for_each(|name| extensions.add(name, None));
        let own = root.extensions.map(|own| json::value(own).map(|own| Value::from_iter([("extensions", own)])));
        let own = own.map(|own| element::<ExtendedRoot>("the file", own, &mut extensions)).transpose()?;
        let lights = own.unwrap_or_default().extensions.lights.lights.into_iter().enumerate();
        let lights = lights.map(|(index, light)| element(&format!("light {index}"), Ok(light), &mut extensions));
        let lights = lights.collect::<Result<_, _>>()?;
        let scene = root.scene.map(|scene| element("scene", json::value(scene), &mut extensions)).transpose()?;
        Ok(Document {
            accessors: list("accessor", &root.accessors, &mut extensions)?,
            buffers: list("buffer", &root.buffers, &mut extensions)?,
            buffer_views: list("buffer view", &root.buffer_views, &mut extensions)?,
            cameras: list("camera", &root.cameras, &mut extensions)?,
            images: list("image", &root.images, &mut extensions)?,
            lights,
            materials: list("material", &root.materials, &mut extensions)?,
            meshes: list("mesh", &root.meshes, &mut extensions)?,
            nodes: list("node", &root.nodes, &mut extensions)?,
            samplers: list("sampler", &root.samplers, &mut extensions)?,
            scenes: list("scene", &root.scenes, &mut extensions)?,
            textures: list("texture", &root.textures, &mut extensions)?,
            scene,
            animated: !root.animations.is_empty(),
            extensions,
        })
    }
}

/// The element that `at` refers to, or which reference leads nowhere.
pub(super) fn follow<'d, T>(list: &'d [T], index: u64, kind: &'static str, at: &str) -> Result<&'d T, GltfError> {
    usize::try_from(index)
        .ok()
        .and_then(|index| list.get(index))
        .ok_or_else(|| Problem::Missing { kind, index, count: list.len() }.at(at))
}

fn list<T: for<'a> Deserialize<'a>>(
    kind: &str,
    elements: &[&RawValue],
    extensions: &mut Extensions,
) -> Result<Vec<T>, GltfError> {
    let numbered = elements.iter().enumerate();
    numbered.map(|(index, raw)| element(&format!("{kind} {index}"), json::value(raw), extensions)).collect()
}

/// One thing in the file, `at` by its name.
fn element<T: for<'a> Deserialize<'a>>(
    at: &str,
    value: Result<Value, String>,
    extensions: &mut Extensions,
) -> Result<T, GltfError> {
    let wrong = |words| Problem::Json(words).at(at);
    let value = value.map_err(wrong)?;
    extensions.add_used(at, &value);
    json::read(value).map_err(wrong)
}

/// The version, and the extensions that the file uses.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", expecting = "a glTF object")]
struct Head {
    asset: Asset,
    #[serde(default)]
    extensions_required: Vec<String>,
    #[serde(default)]
    extensions_used: Vec<String>,
}

/// The file's lists, whose elements are read one by one.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase", expecting = "a glTF object", bound(deserialize = "'de: 'a"))]
struct Root<'a> {
    accessors: Vec<&'a RawValue>,
    animations: Vec<&'a RawValue>,
    buffers: Vec<&'a RawValue>,
    buffer_views: Vec<&'a RawValue>,
    cameras: Vec<&'a RawValue>,
    images: Vec<&'a RawValue>,
    materials: Vec<&'a RawValue>,
    meshes: Vec<&'a RawValue>,
    nodes: Vec<&'a RawValue>,
    samplers: Vec<&'a RawValue>,
    scenes: Vec<&'a RawValue>,
    textures: Vec<&'a RawValue>,
    scene: Option<&'a RawValue>,
    extensions: Option<&'a RawValue>,
}

#[derive(Deserialize)]
struct Asset {
    version: String,
}

/// The file itself, as far as it is extended.
#[derive(Default, Deserialize)]
struct ExtendedRoot {
    extensions: RootExtensions,
}

#[derive(Default, Deserialize)]
struct RootExtensions {
    #[serde(default, rename = "KHR_lights_punctual")]
    lights: Lights,
}

#[derive(Default, Deserialize)]
struct Lights {
    #[serde(default)]
    lights: Vec<Value>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<u64>,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) count: u64,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) sparse: Option<Sparse>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Sparse {
    pub(super) count: u64,
    pub(super) indices: SparsePart,
    pub(super) values: SparsePart,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparsePart {
    pub(super) buffer_view: u64,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: Option<u32>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    pub(super) byte_length: u64,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: u64,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: Option<u64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Camera {
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) perspective: Option<Perspective>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Perspective {
    pub(super) yfov: f64,
    pub(super) znear: f64,
    /// Left out where the camera sees infinitely far.
    pub(super) zfar: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    pub(super) name: Option<String>,
    pub(super) uri: Option<String>,
    pub(super) buffer_view: Option<u64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Light {
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) color: Option<[f64; 3]>,
    pub(super) intensity: Option<f64>,
    pub(super) range: Option<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) pbr_metallic_roughness: PbrMetallicRoughness,
    pub(super) emissive_factor: Option<[f64; 3]>,
    pub(super) emissive_texture: Option<TextureInfo>,
    pub(super) normal_texture: Option<TextureInfo>,
    pub(super) occlusion_texture: Option<TextureInfo>,
    pub(super) alpha_mode: Option<String>,
    pub(super) alpha_cutoff: Option<f64>,
    #[serde(default)]
    pub(super) double_sided: bool,
    #[serde(default)]
    pub(super) extensions: MaterialExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub(super) emissive_strength: Option<EmissiveStrength>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct EmissiveStrength {
    pub(super) emissive_strength: Option<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct PbrMetallicRoughness {
    pub(super) base_color_factor: Option<[f64; 4]>,
    pub(super) base_color_texture: Option<TextureInfo>,
    pub(super) metallic_roughness_texture: Option<TextureInfo>,
    pub(super) metallic_factor: Option<f64>,
    pub(super) roughness_factor: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
    pub(super) index: u64,
    #[serde(default)]
    pub(super) tex_coord: u64,
    #[serde(default)]
    pub(super) extensions: TextureInfoExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct TextureInfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(super) transform: Option<serde::de::IgnoredAny>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    pub(super) primitives: Vec<Primitive>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: BTreeMap<String, u64>,
    pub(super) indices: Option<u64>,
    pub(super) material: Option<u64>,
    pub(super) mode: Option<u64>,
    #[serde(default)]
    pub(super) targets: Vec<serde::de::IgnoredAny>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    pub(super) mesh: Option<u64>,
    pub(super) camera: Option<u64>,
    pub(super) skin: Option<u64>,
    #[serde(default)]
    pub(super) children: Vec<u64>,
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    #[serde(default)]
    pub(super) extensions: NodeExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) light: Option<NodeLight>,
}

#[derive(Debug, Deserialize)]
pub(super) struct NodeLight {
    pub(super) light: u64,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Sampler {
    pub(super) mag_filter: Option<u64>,
    pub(super) min_filter: Option<u64>,
    pub(super) wrap_s: Option<u64>,
    pub(super) wrap_t: Option<u64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub(super) nodes: Vec<u64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Texture {
    pub(super) sampler: Option<u64>,
    pub(super) source: Option<u64>,
}
