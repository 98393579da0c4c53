//! The parts of glTF's JSON that are read. Everything else is skipped.

use super::problem::{GltfError, Problem};
use serde::Deserialize;
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
}

/// Extensions that a file may require.
const KNOWN_EXTENSIONS: [&str; 2] = ["KHR_lights_punctual", "KHR_materials_emissive_strength"];

impl Document {
    /// Reads the JSON; each element of a list by itself, so that a mistake in it can be named.
    pub(super) fn read(json: &[u8]) -> Result<Document, GltfError> {
        let whole = |problem| GltfError { at: String::new(), problem };
        let json = std::str::from_utf8(json).map_err(|_| whole(Problem::Json("the JSON is not UTF-8".into())))?;
        let root: Root = serde_json::from_str(json).map_err(|error| whole(Problem::Json(words(&error, true))))?;
        if !root.asset.version.starts_with("2.") {
            return Err(whole(Problem::AssetVersion(root.asset.version.escape_debug().to_string())));
        }
        if let Some(unknown) = root.extensions_required.iter().find(|name| !KNOWN_EXTENSIONS.contains(&name.as_str())) {
            return Err(whole(Problem::Extension(unknown.escape_debug().to_string())));
        }
        Ok(Document {
            accessors: list("accessor", &root.accessors)?,
            buffers: list("buffer", &root.buffers)?,
            buffer_views: list("buffer view", &root.buffer_views)?,
            cameras: list("camera", &root.cameras)?,
            images: list("image", &root.images)?,
            lights: list("light", &root.extensions.lights.lights)?,
            materials: list("material", &root.materials)?,
            meshes: list("mesh", &root.meshes)?,
            nodes: list("node", &root.nodes)?,
            samplers: list("sampler", &root.samplers)?,
            scenes: list("scene", &root.scenes)?,
            textures: list("texture", &root.textures)?,
            scene: root.scene,
            animated: !root.animations.is_empty(),
        })
    }
}

/// The element that `at` refers to, or which reference leads nowhere.
pub(super) fn follow<'d, T>(list: &'d [T], index: u64, kind: &'static str, at: &str) -> Result<&'d T, GltfError> {
    usize::try_from(index)
        .ok()
        .and_then(|index| list.get(index))
        .ok_or_else(|| GltfError { at: at.into(), problem: Problem::Missing { kind, index, count: list.len() } })
}

fn list<T: for<'a> Deserialize<'a>>(kind: &str, elements: &[&RawValue]) -> Result<Vec<T>, GltfError> {
    let read = |(index, element): (usize, &&RawValue)| {
        serde_json::from_str(element.get())
            .map_err(|error| GltfError { at: format!("{kind} {index}"), problem: Problem::Json(words(&error, false)) })
    };
    elements.iter().enumerate().map(read).collect()
}

/// The parser's words; without its place where that counts from the start of an element.
fn words(error: &serde_json::Error, place: bool) -> String {
    let words = error.to_string();
    let told = words.rfind(" at line ").filter(|_| !place).map_or(words.as_str(), |end| &words[..end]);
    told.escape_debug().to_string().replace("\\'", "'").replace("\\\"", "\"")
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", expecting = "a glTF object")]
struct Root<'a> {
    asset: Asset,
    #[serde(default)]
    extensions_required: Vec<String>,
    scene: Option<u64>,
    #[serde(default, borrow)]
    accessors: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    animations: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    buffers: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    buffer_views: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    cameras: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    images: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    materials: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    meshes: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    nodes: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    samplers: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    scenes: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    textures: Vec<&'a RawValue>,
    #[serde(default, borrow)]
    extensions: RootExtensions<'a>,
}

#[derive(Deserialize)]
struct Asset {
    version: String,
}

#[derive(Default, Deserialize)]
struct RootExtensions<'a> {
    #[serde(default, rename = "KHR_lights_punctual", borrow)]
    lights: Lights<'a>,
}

#[derive(Default, Deserialize)]
struct Lights<'a> {
    #[serde(default, borrow)]
    lights: Vec<&'a RawValue>,
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
