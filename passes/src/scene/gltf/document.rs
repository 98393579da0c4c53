//! The parts of glTF's JSON that are read. Everything else is skipped.

use super::extensions::{self, Extensions};
use super::json;
use super::notes::Notes;
use super::problem::{GltfError, Problem};
use framewright_graph::base::{NoText, text_of};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;
use serde_json::value::RawValue;
use std::collections::BTreeMap;

/// A list by the numbers of its elements. One that can't be read is left out, and keeps its number.
pub(super) type List<T> = Vec<Option<T>>;

/// glTF's lists by their names there. References between them are plain numbers, checked where they are followed.
#[derive(Debug, Default)]
pub(super) struct Document {
    pub(super) accessors: List<Accessor>,
    pub(super) buffers: List<Buffer>,
    pub(super) buffer_views: List<BufferView>,
    pub(super) cameras: List<Camera>,
    pub(super) images: List<Image>,
    pub(super) lights: List<Light>,
    pub(super) materials: List<Material>,
    pub(super) meshes: List<Mesh>,
    pub(super) nodes: Vec<Node>,
    pub(super) samplers: List<Sampler>,
    pub(super) scenes: List<Scene>,
    pub(super) textures: List<Texture>,
    pub(super) scene: Option<u64>,
    pub(super) animated: bool,
    pub(super) extensions: Extensions,
}

impl Document {
    /// Reads the JSON; each element of a list by itself, so that a mistake in it can be named, and the element left out.
    ///
    /// # Errors
    /// Those of the file as a whole.
    pub(super) fn read(json: &[u8], notes: &mut Notes) -> Result<Document, GltfError> {
        let json = text_of(json).map_err(|why| match why {
            NoText::Encoding(_) => Problem::Json(format!("this is no JSON: {why}")).at(""),
            NoText::Byte { .. } => Problem::Json("the JSON is not UTF-8".into()).at(""),
        })?;
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
        let mut elements = Elements { extensions: &mut extensions, notes };
        let own: Option<ExtendedRoot> = own.and_then(|own| elements.read("the file", "its lights are", own));
        let lights = own.unwrap_or_default().extensions.lights.lights.into_iter().enumerate();
        let lights = lights.map(|(index, light)| elements.read(&format!("light {index}"), IT_IS, Ok(light))).collect();
        let meshes: List<RawMesh> = elements.list("mesh", &root.meshes);
        Ok(Document {
            accessors: elements.list("accessor", &root.accessors),
            buffers: elements.list("buffer", &root.buffers),
            buffer_views: elements.list("buffer view", &root.buffer_views),
            cameras: elements.list("camera", &root.cameras),
            images: elements.list("image", &root.images),
            lights,
            materials: elements.list("material", &root.materials),
            meshes: (0..).zip(meshes).map(|(number, mesh)| Some(elements.primitives(number, mesh?))).collect(),
            nodes: root.nodes.iter().enumerate().map(|(number, node)| elements.node(number, node)).collect(),
            samplers: elements.list("sampler", &root.samplers),
            scenes: elements.list("scene", &root.scenes),
            textures: elements.list("texture", &root.textures),
            scene: root.scene.and_then(|scene| elements.read("scene", IT_IS, json::value(scene))),
            animated: root.animations.is_some_and(|list| {
                serde_json::from_str::<Vec<IgnoredAny>>(list.get()).map_or(true, |list| !list.is_empty())
            }),
            extensions,
        })
    }
}

/// The element that `at` refers to, or which reference leads nowhere.
pub(super) fn follow<'d, T>(
    list: &'d [Option<T>],
    index: u64,
    kind: &'static str,
    at: &str,
) -> Result<&'d T, GltfError> {
    let element = usize::try_from(index).ok().and_then(|index| list.get(index));
    let element = element.ok_or_else(|| Problem::Missing { kind, index, count: list.len() }.at(at))?;
    element.as_ref().ok_or_else(|| Problem::LeftOut { kind, index }.at(at))
}

/// What is left out with an element that can't be read.
const IT_IS: &str = "it is";

/// Reads elements, and leaves out those that can't be read.
struct Elements<'n> {
    extensions: &'n mut Extensions,
    notes: &'n mut Notes,
}

impl Elements<'_> {
    fn list<T: for<'a> Deserialize<'a>>(&mut self, kind: &str, elements: &[&RawValue]) -> List<T> {
        let numbered = elements.iter().enumerate();
        numbered.map(|(index, raw)| self.read(&format!("{kind} {index}"), IT_IS, json::value(raw))).collect()
    }

    /// A mesh, whose primitives are elements too.
    fn primitives(&mut self, number: usize, RawMesh { name, primitives }: RawMesh) -> Mesh {
        let numbered = primitives.into_iter().enumerate();
        let primitives = numbered.map(|(part, primitive)| {
            let at = format!("mesh {number}, primitive {part}");
            json::read(primitive).map_err(|words| self.leave_out(words, &at, IT_IS)).ok()
        });
        Mesh { name, primitives: primitives.collect() }
    }

    /// A node. Where it can't be read, what is below it is left out too.
    fn node(&mut self, number: usize, raw: &RawValue) -> Node {
        let node = self.read(&format!("node {number}"), "it and what is below it are", json::value(raw));
        node.unwrap_or_else(|| {
            let value = json::value(raw).unwrap_or_default();
            let children = value["children"].as_array().into_iter().flatten().filter_map(Value::as_u64);
            Node { children: children.collect(), left_out: true, ..Node::default() }
        })
    }

    /// One thing in the file, `at` by its name; `left_out` names what is missing without it.
    fn read<T: for<'a> Deserialize<'a>>(
        &mut self,
        at: &str,
        left_out: &str,
        value: Result<Value, String>,
    ) -> Option<T> {
        let read = value.and_then(|value| {
            self.extensions.add_used(at, &value);
            json::read(value)
        });
        read.map_err(|words| self.leave_out(words, at, left_out)).ok()
    }

    fn leave_out(&mut self, words: String, at: &str, left_out: &str) {
        self.notes.mistake(format!("{}, so {left_out} left out", Problem::Json(words).at(at)));
    }
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
    animations: Option<&'a RawValue>,
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
    pub(super) emissive_texture: Option<IgnoredAny>,
    pub(super) normal_texture: Option<IgnoredAny>,
    pub(super) occlusion_texture: Option<IgnoredAny>,
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
    pub(super) metallic_roughness_texture: Option<IgnoredAny>,
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
    pub(super) transform: Option<IgnoredAny>,
}

/// A mesh whose primitives are not yet read.
#[derive(Debug, Deserialize)]
struct RawMesh {
    name: Option<String>,
    primitives: Vec<Value>,
}

#[derive(Debug)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    pub(super) primitives: List<Primitive>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: BTreeMap<String, u64>,
    pub(super) indices: Option<u64>,
    pub(super) material: Option<u64>,
    pub(super) mode: Option<u64>,
    #[serde(default)]
    pub(super) targets: Vec<IgnoredAny>,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    pub(super) mesh: Option<u64>,
    pub(super) camera: Option<u64>,
    pub(super) skin: Option<IgnoredAny>,
    #[serde(default)]
    pub(super) children: Vec<u64>,
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    #[serde(default)]
    pub(super) extensions: NodeExtensions,
    /// Whether it can't be read, but for its children.
    #[serde(skip)]
    pub(super) left_out: bool,
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
