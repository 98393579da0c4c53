//! The interface of a shader, as data: a backend reads it off SPIR-V; `check` needs it, and no device.

mod brought_needs;
mod brought_vertices;
mod constant;
mod draw_faults;
mod draw_interface;
mod draw_interfaces;
mod draw_kind;
mod element;
mod given_names;
mod interface_file;
mod interface_sets;
mod interface_values;
mod interface_vertices;
mod needs;
mod param_type;
mod place_names;
mod problem;
mod program_set;
mod push_constants;
mod set_faults;
mod shader_name;
pub(crate) mod shader_words;
mod vertex_layout;

use crate::base::{FilePath, OutsideChoice, Quote};
use crate::device::Need;
use crate::frame::{Draw, Eye, EyeForm, ParamValue};
use crate::vulkan::{Component, Format, ImageShape, Stages};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::fmt;
use std::sync::Arc;

pub use brought_needs::{push_needs, vertex_needs};
pub use brought_vertices::{Attribute, AttributeMisfit, BroughtLocation, VertexBuffer, VertexRate};
pub use constant::{ConstantValue, ShaderConstant};
pub use draw_faults::{DrawFault, DrawPart};
pub use draw_interface::{DrawInterface, SuppliedKind, SuppliedResource};
pub use draw_interfaces::DrawInterfaces;
pub use draw_kind::DrawKind;
use draw_kind::InterfaceOf;
pub use element::{declared_name, element_name, element_of};
pub use interface_file::LARGEST_INTERFACE;
pub use needs::{needs_in_pass, resource_needs};
pub use param_type::{ParamMisfit, ParamScalar, ParamType};
pub use place_names::{
    GivenNames, PASS_SET, binding_name, binding_of, constant_name, is_place, location_name, offset_name, offset_of,
};
pub use program_set::{
    BindingFlags, DescriptorType, ProgramBinding, ProgramResource, ProgramSet, bindings_of_read_sets, set_needs,
};
pub use push_constants::{PushConstants, PushedBlock};
pub use set_faults::SetFault;
pub use shader_name::{FileLanguage, LanguageFacts, ShaderName, StageName};
pub use vertex_layout::{LayoutFault, LocationLayout, VertexInput, VertexLayout};

/// Everything that a shader (all its stages together) uses.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ShaderInterface {
    /// Resources by set and binding.
    pub bindings: Vec<Binding>,
    /// What it reads of the program's own sets.
    pub program: Vec<ProgramResource>,
    /// The blocks of push constants that its stages read, without those of the library's own.
    pub pushed: Vec<PushedBlock>,
    /// Why push constants that became parameters aren't those that the draw brings, in words, where it brings any and the pass gives no
    /// member of theirs.
    pub pushed_misfits: Vec<String>,
    /// Vertex attributes that the vertex stage declares.
    pub vertex_inputs: Vec<VertexInput>,
    /// Colour outputs of the fragment stage.
    pub outputs: Vec<FragmentOutput>,
    /// Whether the fragment stage writes a second colour for the first target, at `location = 0, index = 1`.
    pub second_source: bool,
    /// Whether the vertex stage writes `gl_PointSize`.
    pub point_size: bool,
    /// Whether the fragment stage may discard fragments.
    pub discards: bool,
    /// Whether the fragment stage writes `gl_SampleMask`, and may leave out samples by it.
    pub masks_samples: bool,
    /// File and line, `FILE:LINE`, where it may leave out fragments or samples, if they are known.
    pub leaves_out_at: Option<String>,
    /// File and line, `FILE:LINE`, of the declarations of storage images and blocks that it writes and doesn't read, by their names, as
    /// far as they are known.
    pub only_written_at: Vec<(String, String)>,
    /// Outputs of the fragment stage that it doesn't set on every path, its depth included.
    pub unset: Vec<UnsetOutput>,
    /// The file of the vertex stage, of a full-screen draw whose vertex stage isn't the usual one: nothing is known of where its
    /// triangle lies.
    pub own_vertices: Option<String>,
    /// Whether the fragment stage reads `gl_FragCoord`.
    pub uses_frag_coord: bool,
    /// Whether the fragment stage takes screen-space derivatives, implicit ones included.
    pub uses_derivatives: bool,
    /// Whether the fragment stage may tell the samples of a texel apart: it runs once a sample, writes `gl_SampleMask` or reads
    /// `gl_SampleMaskIn`.
    pub per_sample: bool,
    /// Whether the fragment stage writes its own depth.
    pub writes_depth: bool,
    /// Invocations of a workgroup in x, y and z, each at least 1; of compute shaders only.
    pub workgroup_size: Option<[u32; 3]>,
    /// The parts of it that go wrong where the picture that it draws is turned, as far as that can be told.
    pub unturned: Vec<UnturnedPart>,
    /// Names of sampled images and storage images whose part in use it asks for, by mentioning `NAME_st`.
    pub asks_part: Vec<String>,
    /// The pass's blocks with matrices by which the vertex stage may place vertices, if no stage asks which eye it draws for: both
    /// eyes then see the same.
    pub sees_alike: Vec<String>,
    /// What it asks of a device beyond what every device has, but for the number of its resources ([`resource_needs`]).
    pub needs: Vec<Need>,
    /// Its specialization constants, but for those of the library's own.
    pub constants: Vec<ShaderConstant>,
}

/// A pass samples at most this many images of which only a part is in use: the places of the parts take all the bytes of
/// push constants that every device has.
pub const MOST_PARTS: usize = 8;

/// A part of a shader that doesn't follow a turned picture; functions in shaders/include/rotation.glsl follow it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum UnturnedPart {
    /// It places vertices in its vertex stage.
    Vertices,
    /// It reads the positions of its fragments.
    FragCoord,
    /// It takes derivatives to the right or down.
    Derivatives,
}

/// The name of the uniform block whose members are a pass's parameters.
pub const PARAMS: &str = "params";

/// Bindings are numbered below this: drivers make tables as long as the largest number.
pub const BINDINGS: u32 = 256;

/// One resource.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Binding {
    /// Descriptor set.
    pub set: u32,
    /// Binding number in its set.
    pub binding: u32,
    /// Name in the shader: of the variable, or for a block without instance name, of the block.
    pub name: String,
    /// Kind and shape; of an array those of each element.
    pub kind: BindingKind,
    /// The elements of an array, at least 1; `None`: it is no array.
    pub length: Option<u32>,
    /// Whether the pass chooses its type: the shader declares `uniform TEXTURE_NAME NAME`.
    pub adapts: bool,
    /// Whether it is a sampled image without a sampler: `texture2D`, HLSL's `Texture2D`.
    pub separate: bool,
    /// Stages that use it.
    pub stages: Stages,
}

/// Kind and shape of a resource.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum BindingKind {
    /// A sampled image, with its sampler or, where the binding is separate, without.
    SampledImage(ImageShape),
    /// A sampled image that is compared with a depth: `sampler2DShadow`.
    ComparedDepth(ImageShape),
    /// A sampler by itself. A pass gives it nothing: it samples as the pass says of the images.
    Sampler {
        /// The names of the images that it samples.
        images: Vec<String>,
        /// Whether it compares depths.
        compares: bool,
    },
    /// A storage image.
    StorageImage {
        /// Dimension and component type.
        shape: ImageShape,
        /// The texel format that the declaration names; `None`: it names none.
        format: Option<Format>,
        /// Whether the shader may read it.
        readable: bool,
        /// Whether the shader may write it.
        writable: bool,
    },
    /// A uniform block.
    UniformBlock(Block),
    /// A storage block.
    StorageBlock {
        /// Whether the shader may read it.
        readable: bool,
        /// Whether the shader may write it.
        writable: bool,
        /// Bytes of its members, an array of no written length left out.
        bytes: u32,
    },
    /// An input attachment: the texel at the fragment's own position.
    InputAttachment {
        /// Whether single samples are read.
        multisampled: bool,
        /// The type of a component.
        component: Component,
    },
    /// Anything else (texel buffers, storage images of formats that no image of a pipeline has, …): not
    /// supported.
    Other(UnbindableResource),
}

impl BindingKind {
    /// Whether the shader may write it.
    #[must_use]
    pub fn is_written(&self) -> bool {
        self.storage().is_some_and(|(_, writable)| writable)
    }

    /// Whether the shader may read, and may write, a storage image or block; `None`: it is none.
    #[must_use]
    pub fn storage(&self) -> Option<(bool, bool)> {
        match self {
            BindingKind::StorageImage { readable, writable, .. }
            | BindingKind::StorageBlock { readable, writable, .. } => Some((*readable, *writable)),
            BindingKind::SampledImage(_)
            | BindingKind::ComparedDepth(_)
            | BindingKind::Sampler { .. }
            | BindingKind::UniformBlock(_)
            | BindingKind::InputAttachment { .. }
            | BindingKind::Other(_) => None,
        }
    }

    /// The shape of a sampled image, compared or not; `None`: it is none.
    #[must_use]
    pub fn sampled(&self) -> Option<ImageShape> {
        match self {
            BindingKind::SampledImage(shape) | BindingKind::ComparedDepth(shape) => Some(*shape),
            BindingKind::StorageImage { .. }
            | BindingKind::Sampler { .. }
            | BindingKind::UniformBlock(_)
            | BindingKind::StorageBlock { .. }
            | BindingKind::InputAttachment { .. }
            | BindingKind::Other(_) => None,
        }
    }

    /// The names of the images that a sampler samples, and whether it compares depths; `None`: it is no sampler.
    #[must_use]
    pub fn sampler(&self) -> Option<(&[String], bool)> {
        match self {
            BindingKind::Sampler { images, compares } => Some((images, *compares)),
            _ => None,
        }
    }

    /// Whether it is a sampler by itself.
    #[must_use]
    pub fn is_sampler(&self) -> bool {
        self.sampler().is_some()
    }

    /// Takes over from the same image in another stage that it is compared with a depth.
    pub fn compare_as(&mut self, other: &BindingKind) {
        if other.is_compared() {
            self.clone_from(other);
        }
    }

    /// Takes over what the same sampler samples in another stage.
    pub fn join_sampler(&mut self, other: &BindingKind) {
        let (BindingKind::Sampler { images, compares }, Some((others, also))) = (self, other.sampler()) else { return };
        for other in others {
            if !images.contains(other) {
                images.push(other.clone());
            }
        }
        *compares |= also;
    }

    /// Calls one of the images that a sampler samples by another name.
    pub(crate) fn rename_sampled(&mut self, from: &str, to: &str) {
        if let BindingKind::Sampler { images, .. } = self {
            images.iter_mut().filter(|name| **name == *from).for_each(|name| to.clone_into(name));
        }
    }

    /// Whether the shader samples it.
    #[must_use]
    pub fn is_sampled(&self) -> bool {
        self.sampled().is_some()
    }

    /// The shape of a storage image, and the texel format that its declaration names; `None`: it is none.
    #[must_use]
    pub fn storage_image(&self) -> Option<(ImageShape, Option<Format>)> {
        match self {
            BindingKind::StorageImage { shape, format, .. } => Some((*shape, *format)),
            _ => None,
        }
    }

    /// Whether single samples of an input attachment are read, and the type of a component; `None`: it is none.
    #[must_use]
    pub fn input_attachment(&self) -> Option<(bool, Component)> {
        match self {
            BindingKind::InputAttachment { multisampled, component } => Some((*multisampled, *component)),
            _ => None,
        }
    }

    /// Whether sampling compares it with a depth.
    #[must_use]
    pub fn is_compared(&self) -> bool {
        matches!(self, BindingKind::ComparedDepth(_))
    }

    /// Whether it is an input attachment.
    #[must_use]
    pub fn is_input_attachment(&self) -> bool {
        self.input_attachment().is_some()
    }

    /// The block, if it is a uniform block.
    #[must_use]
    pub fn uniform_block(&self) -> Option<&Block> {
        match self {
            BindingKind::UniformBlock(block) => Some(block),
            _ => None,
        }
    }

    /// Whether the shader may write a storage block, and the bytes of its members; `None`: it is none.
    #[must_use]
    pub fn storage_block(&self) -> Option<(bool, u32)> {
        match self {
            BindingKind::StorageBlock { writable, bytes, .. } => Some((*writable, *bytes)),
            _ => None,
        }
    }

    /// The resource that no pass can give, if it is one.
    #[must_use]
    pub fn unbindable(&self) -> Option<&UnbindableResource> {
        match self {
            BindingKind::Other(unbindable) => Some(unbindable),
            _ => None,
        }
    }

    /// The same, to be changed.
    #[must_use]
    pub fn unbindable_mut(&mut self) -> Option<&mut UnbindableResource> {
        match self {
            BindingKind::Other(unbindable) => Some(unbindable),
            _ => None,
        }
    }

    /// Whether the shader may write it, and can't read it.
    #[must_use]
    pub fn is_only_written(&self) -> bool {
        self.storage() == Some((false, true))
    }

    /// The kind in words.
    #[must_use]
    pub fn words(&self) -> &str {
        match self {
            BindingKind::SampledImage(_) => "a sampled image",
            BindingKind::ComparedDepth(_) => "a sampled image that is compared",
            BindingKind::Sampler { .. } => "a sampler",
            BindingKind::StorageImage { .. } => "a storage image",
            BindingKind::UniformBlock(_) => "a uniform block",
            BindingKind::StorageBlock { .. } => "a storage block",
            BindingKind::InputAttachment { .. } => "an input attachment",
            BindingKind::Other(other) => &other.what,
        }
    }
}

/// A resource that no pass can give.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct UnbindableResource {
    /// The name in messages: `a texel buffer`.
    pub what: String,
    /// The declaration to use instead.
    pub instead: String,
    /// File and line of its declaration, `FILE:LINE`, if they are known.
    pub place: Option<String>,
}

/// A uniform block.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Block {
    /// Bytes it takes (std140).
    pub bytes: u32,
    /// Members in order.
    pub members: Vec<Member>,
}

/// A member of a block.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Member {
    /// Name.
    pub name: String,
    /// Offset in bytes.
    pub offset: u32,
    /// Type, as GLSL writes it: `float`, `int`, `uint`, `bool`, `vec4`, `mat4`, `float[9]`, …; `bool` members read as `uint`.
    pub ty: String,
    /// How a matrix lies in the block, or each matrix of an array; `None`: it is none.
    pub matrix: Option<MatrixLayout>,
    /// Bytes from element to element of an array; `None`: it is none.
    pub stride: Option<u32>,
    /// The members of a structure, at their offsets in it; empty: it is none.
    pub within: Vec<Member>,
}

impl Block {
    /// Its members as parameters: those of a structure each by itself, `light.color`.
    #[must_use]
    pub fn parameters(&self) -> Vec<Member> {
        let mut parameters = Vec::new();
        self.members.iter().for_each(|member| member.add_parameters("", 0, &mut parameters));
        parameters
    }
}

impl Member {
    fn add_parameters(&self, before: &str, from: u32, parameters: &mut Vec<Member>) {
        let (name, offset) = (format!("{before}{}", self.name), from.saturating_add(self.offset));
        if self.within.is_empty() {
            parameters.push(Member { name, offset, ..self.clone() });
        } else {
            let before = format!("{name}.");
            self.within.iter().for_each(|member| member.add_parameters(&before, offset, parameters));
        }
    }
}

/// How a matrix lies in a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct MatrixLayout {
    /// Bytes from column to column, or from row to row if rows follow each other.
    pub stride: u32,
    /// Whether rows follow each other, and not columns.
    pub row_major: bool,
}

/// A colour output.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FragmentOutput {
    /// Location.
    pub location: u32,
    /// Name in the shader.
    pub name: String,
    /// The type of a component.
    pub component: Component,
    /// Number of components.
    pub components: u32,
}

/// An output of a fragment stage that isn't set on every path. Vulkan leaves its value undefined there.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnsetOutput {
    /// Its location; `None`: it is the depth.
    pub location: Option<u32>,
    /// Its name in the shader.
    pub name: String,
    /// What the stage doesn't do, in words: "never sets `color.a`".
    pub what: String,
    /// Whether the stage is refused: some path leaves the output, however many rounds loops have and whatever indices are. Conditions
    /// aren't looked at: paths count that exclude each other.
    pub refused: bool,
    /// File and line of its declaration, `FILE:LINE`, if they are known.
    pub place: Option<String>,
}

/// Why a shader has no interface. Text from files inside is not yet escaped.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ShaderProblem {
    /// No such shader.
    Missing {
        /// Where it was looked for.
        looked_in: Vec<String>,
        /// Names that exist.
        known: Vec<String>,
    },
    /// It doesn't compile.
    DoesNotCompile {
        /// The messages of the compiler.
        messages: Vec<ShaderMessage>,
    },
    /// It can't be read, or uses something that can't be bound or that not every device has.
    Unsupported {
        /// The reason, in words.
        what: String,
    },
    /// Its SPIR-V can't be read.
    BadModule {
        /// The reason, in words.
        what: String,
    },
    /// Its SPIR-V has no entry point of that name and stage, or several of the stage.
    EntryPoint {
        /// The file.
        file: Box<str>,
        /// The stage: `fragment`.
        stage: &'static str,
        /// The entry point that was named, if one was.
        named: Option<String>,
        /// All entry points of the stage.
        of_stage: Box<[String]>,
        /// Those of other stages, each with its stage.
        others: Box<[(String, &'static str)]>,
    },
    /// The compiler of its language can't be used, or doesn't do what a compiler does.
    Compiler {
        /// The reason, in words.
        what: String,
        /// How it is mended.
        help: String,
        /// Whether nothing is wrong with any file: it isn't there.
        of_machine: bool,
        /// The choice from outside that may mend it.
        choice: Option<OutsideChoice>,
    },
    /// Nothing is known of it: the machine doesn't let it be read or compiled.
    Machine {
        /// The reason, in words.
        what: String,
    },
}

/// A message of the compiler about a shader. Text from files inside is not yet escaped.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShaderMessage {
    /// The compiler's words, with the shader's own file and line.
    pub text: String,
    /// The line that it is about, where that is known, or its file.
    pub quote: Option<Quote>,
    /// The limit that was exceeded, if the compiler has limits and that is the mistake.
    pub limit: Option<OutsideChoice>,
}

impl fmt::Display for ShaderMessage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// How a shader is compiled for a pass: the values of the macros that depend on the pass.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Variant {
    /// The value of the macro `TEXTURE_NAME`, by the shader's names of sampled images: GLSL's type of such an image. Names
    /// that are missing here are two-dimensional images of floating point, so that mistakes in a pass can be told from its
    /// shader.
    pub textures: Vec<(Arc<str>, ImageShape)>,
    /// The shader's names of images and arrays of images that the pass samples: the macro `HAS_NAME` is defined.
    pub sampled: Vec<Arc<str>>,
    /// Numbers of components, by the shader's names of sampled images: the macro `COMPONENTS_NAME`. Names without one have 4.
    pub components: Vec<(Arc<str>, u32)>,
    /// The shader's names of images of which only a part is in use, at most [`MOST_PARTS`]: then `NAME_st` is the place of the
    /// part, and else all of the image.
    pub parts: Vec<Arc<str>>,
    /// How its stages learn which eye they draw for; `None`: there is one eye, or both see the same picture.
    pub eye: Option<EyeSource>,
    /// The form in which its targets hold both eyes' parts, if it draws for both at once.
    pub form: Option<EyeForm>,
    /// The shader's names of images that hold both eyes' parts: form, and the eye that is sampled; `None`: the eye drawn for.
    pub eyes: Vec<(Arc<str>, EyeForm, Option<Eye>)>,
    /// The shader's names of images that are read from the pass's own rendering scope, on devices with local reads: the macro
    /// `LOCAL_READ_NAME` is defined.
    pub local: Vec<Arc<str>>,
    /// Whether the shader draws nothing but depth: the macro `DEPTH_ONLY` is defined in its fragment stage, which is left out
    /// if it neither discards fragments nor writes depth of its own then.
    pub depth_only: bool,
    /// Whether its alpha says how many samples are covered: the macro `ALPHA_TO_COVERAGE` is defined in its fragment stage.
    pub alpha_to_coverage: bool,
    /// Of SPIR-V, the names by which the pass gives it things; none of GLSL.
    pub given: GivenNames,
    /// Values of specialization constants, by the pass's names for them.
    pub constants: Vec<(Arc<str>, ConstantValue)>,
}

impl Variant {
    /// The names by which a pass gives things to the shader `shader`, if it has stages in files with an ending.
    pub fn given_to<'n>(
        shader: &str,
        bindings: impl Iterator<Item = &'n Arc<str>>,
        params: impl Iterator<Item = &'n Arc<str>>,
    ) -> GivenNames {
        if !ShaderName::has_file(shader) {
            return GivenNames::default();
        }
        GivenNames { bindings: bindings.cloned().collect(), params: params.cloned().collect() }
    }

    /// The values of specialization constants that a pass gives.
    pub fn constants<'v>(
        given: impl Iterator<Item = (&'v Arc<str>, &'v ParamValue)>,
    ) -> Vec<(Arc<str>, ConstantValue)> {
        given.filter_map(|(name, value)| Some((name.clone(), ConstantValue::of(value)?))).collect()
    }

    /// Puts the name of each array in place of those of its elements, once: a shader is compiled for an array as a whole.
    pub fn name_arrays(names: &mut Vec<Arc<str>>) {
        if names.iter().any(|name| element_of(name).is_some()) {
            names.iter_mut().for_each(|name| *name = declared_name(name).into());
            let mut seen = HashSet::new();
            names.retain(|name| seen.insert(name.clone()));
        }
    }
}

/// How the stages of a shader learn which eye they draw for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum EyeSource {
    /// They draw for this eye only.
    One(Eye),
    /// The device draws for each (`gl_ViewIndex`).
    ViewIndex,
    /// By the highest bit of the instance's number, which counts instances of one eye else.
    InstanceBit,
    /// By the lowest bit of the instance's number, which counts those of both eyes in turn.
    InstanceParity,
}

/// Where shader interfaces come from: a compiler and reflection over files on disk, or a table in a test.
pub trait ShaderInterfaces {
    /// The shader that the file `from` calls `name`, for a draw of `draw` (`None`: a compute shader). Returns the name by
    /// which the other functions know it, and which stands in Plans. Shaders of one name in different folders have
    /// different such names.
    ///
    /// # Errors
    /// [`ShaderProblem`] says why there is none.
    fn find(&mut self, from: &FilePath, name: &Arc<str>, draw: Option<Draw>) -> Result<Arc<str>, ShaderProblem> {
        let _ = (from, draw);
        Ok(name.clone())
    }

    /// The interface of the shader `name` when it draws `draw`, compiled as `variant` says.
    ///
    /// # Errors
    /// [`ShaderProblem`] says whether it is missing, doesn't compile or can't be used.
    fn draw_shader(&mut self, name: &str, draw: Draw, variant: &Variant) -> Result<ShaderInterface, ShaderProblem>;

    /// The interface of the compute shader `name`, compiled as `variant` says.
    ///
    /// # Errors
    /// [`ShaderProblem`] says whether it is missing, doesn't compile or can't be used.
    fn compute_shader(&mut self, name: &str, variant: &Variant) -> Result<ShaderInterface, ShaderProblem>;

    /// The interface of the draw source for `draw` (`None`: for compute shaders); an empty one where the pass has vertices of
    /// its own. `name` is the name of the shader; of a custom pass that by which the program knows it.
    fn brought_along(&self, draw: Option<Draw>, name: &str) -> DrawInterface;

    /// The sets that the program makes and binds itself.
    fn program_sets(&self) -> Vec<ProgramSet> {
        Vec::new()
    }

    /// The names of custom passes that the program records; `None` if they aren't known, and any may be right.
    fn custom_passes(&self) -> Option<Vec<Arc<str>>> {
        None
    }
}
