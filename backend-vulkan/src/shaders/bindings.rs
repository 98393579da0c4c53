//! The resources that a shader stage uses, read off its SPIR-V.

use super::module::{IndexedModule, id, number, storage_class};
use super::program_supply::ProgramSupply;
use super::sampler_pairs::SamplerPairs;
use super::text::RefusedStage;
use crate::base::ShaderStage;
use crate::base::named;
use framewright_graph::shader::{
    BINDINGS, Binding, BindingKind, Block, FileLanguage, Member, PASS_SET, PushedBlock, UnbindableResource,
};
use framewright_graph::vulkan::{Component, Dimension, Format, ImageShape};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Decoration, Dim, ImageFormat, Op, StorageClass};
use std::collections::HashSet;

/// The block of push constants that tells which parts of images are in use, and its variable: see shaders/include/part.glsl. Of HLSL's
/// compilers each names the block in its own way.
const PARTS: [&str; 2] = ["FramewrightParts", "framewright_parts"];

/// Whether push constants of this name tell which parts of images are in use.
pub(super) fn tells_parts(name: &str) -> bool {
    PARTS.contains(&name)
}

/// The resources. In the pass's own set every declared one counts, since that is what a pipeline file binds; in the
/// others only what is used, since include libraries declare more than one shader needs. `in_part`: push constants tell which
/// parts of images are in use. Sets of the program's are left out: [`super::program_resources`] has them.
pub(super) fn bindings(
    module: &IndexedModule<'_>,
    stage: ShaderStage,
    used: &HashSet<u32>,
    in_part: bool,
    program: &ProgramSupply,
) -> Result<Vec<Binding>, RefusedStage> {
    let stage = stage.facts();
    let pairs = SamplerPairs::of(module);
    let mut bindings = Vec::new();
    for (variable, instruction) in module.variables() {
        if storage_class(instruction) == Some(StorageClass::PushConstant) && used.contains(&variable) {
            let ty = module.pointee(instruction).and_then(|ty| ty.result_id);
            let own = in_part && ty.into_iter().chain([variable]).any(|id| tells_parts(module.name(id)));
            if own || program.pushes && stage.draws {
                continue;
            }
            let what = "push constants: parameters come in the uniform block `params`".to_owned();
            return Err(RefusedStage::named("push_constant", what));
        }
        let set = module.decoration_number(variable, Decoration::DescriptorSet);
        let binding = module.decoration_number(variable, Decoration::Binding);
        let (Some(set), Some(binding)) = (set, binding) else { continue };
        if set != PASS_SET && !used.contains(&variable) || program.sets.contains(&set) {
            continue;
        }
        let Some(ty) = module.pointee(instruction) else { continue };
        let (element, length) = element(module, ty);
        let kind = match (element, length) {
            (Some(element), length) => match kind(module, &pairs, (variable, instruction), element) {
                one if length.is_none() => one,
                one => elements(one),
            },
            (None, _) => endless(),
        };
        let length = length.filter(|_| kind.unbindable().is_none());
        if !stage.may_store && kind.is_written() {
            return Err(may_not_store(module.name(variable), stage.name));
        }
        let separate = kind.is_sampled() && element.is_some_and(|element| element.class.opcode == Op::TypeImage);
        bindings.push(Binding {
            set,
            binding,
            name: name_of(module, variable, instruction).to_owned(),
            kind,
            length,
            adapts: false,
            separate,
            stages: stage.pipeline,
        });
    }
    bindings.sort_by_key(|it| (it.set, it.binding));
    join_pairs(&mut bindings);
    join_views(&mut bindings);
    if let Some(far) = bindings.iter().find(|it| it.binding >= BINDINGS) {
        return Err(too_far(&far.name, far.binding));
    }
    if let Some(pair) =
        bindings.windows(2).find(|pair| (pair[0].set, pair[0].binding) == (pair[1].set, pair[1].binding))
    {
        let (Binding { set, binding, name, .. }, other) = (&pair[0], &pair[1].name);
        let what = format!("`{name}` and `{other}` at the same place: set {set}, binding {binding}");
        return Err(RefusedStage::named(other, what).mended(part_places));
    }
    Ok(bindings)
}

/// What mends that two resources lie at one place, as registers of two kinds in HLSL do.
const fn part_places(language: Option<FileLanguage>) -> Option<&'static str> {
    match language {
        None => None,
        Some(FileLanguage::Hlsl) => Some(
            "leave out the registers, or let DXC move those of each kind: \
             `-fvk-t-shift 10 0 -fvk-s-shift 20 0 -fvk-u-shift 30 0`",
        ),
        Some(FileLanguage::Slang) => Some("leave out the registers, or give each a number of its own"),
        Some(FileLanguage::Spirv) => Some(
            "where HLSL is compiled, leave out the registers, or let DXC move those of each kind: \
             `-fvk-t-shift 10 0 -fvk-s-shift 20 0 -fvk-u-shift 30 0`",
        ),
        Some(FileLanguage::Wgsl) => Some("give each a `@binding` of its own"),
    }
}

/// The blocks of push constants that a stage reads, without that of the parts of images.
pub(super) fn pushed(module: &IndexedModule<'_>, stage: ShaderStage, used: &HashSet<u32>) -> Vec<PushedBlock> {
    let read = |(variable, it): &(u32, &Instruction)| {
        storage_class(it) == Some(StorageClass::PushConstant) && used.contains(variable)
    };
    let read_block = |(variable, it): (u32, &Instruction)| {
        let ty = module.pointee(it)?;
        let id = ty.result_id.filter(|ty| ![*ty, variable].into_iter().any(|id| tells_parts(module.name(id))))?;
        let members = block(module, ty).members;
        let offset = members.iter().map(|member| member.offset).min()?;
        let name = name_of(module, variable, it).to_owned();
        Some(PushedBlock { name, stages: stage.facts().pipeline, offset, end: module.block_end(id) })
    };
    module.variables().filter(read).filter_map(read_block).collect()
}

/// That a stage writes what it may not.
pub(super) fn may_not_store(name: &str, stage: &str) -> RefusedStage {
    let what = format!("`{name}` is written by a {stage} shader: not every device can");
    RefusedStage::named(name, what).mended(only_read)
}

/// What mends that a stage may write what it may only read.
#[allow(clippy::unnecessary_wraps, reason = "it is one of `Mends`")]
const fn only_read(language: Option<FileLanguage>) -> Option<&'static str> {
    Some(match language {
        None => "declare it `readonly`",
        Some(FileLanguage::Hlsl | FileLanguage::Slang) => {
            "use `StructuredBuffer` in place of `RWStructuredBuffer`, `Texture2D` in place of `RWTexture2D`"
        }
        Some(FileLanguage::Spirv) => "let the module decorate it as `NonWritable`",
        Some(FileLanguage::Wgsl) => "declare it with the access `read`",
    })
}

/// That a binding has too large a number.
pub(super) fn too_far(name: &str, binding: u32) -> RefusedStage {
    RefusedStage::named(name, format!("`{name}` at binding {binding}: bindings go up to {}", BINDINGS - 1))
}

/// Whether shaders may read, and may write, a storage image or block.
pub(super) fn storage_access(module: &IndexedModule<'_>, variable: u32, block: Option<&Instruction>) -> (bool, bool) {
    let lacks = |wanted| {
        let whole = module.decoration(variable, wanted).is_none();
        let Some(block) = block else { return whole };
        let members = u32::try_from(block.operands.len()).unwrap_or(0);
        let decorated = |member| module.member_decoration(block.result_id?, member, wanted);
        whole && !(0..members).all(|member| decorated(member).is_some())
    };
    (lacks(Decoration::NonReadable), lacks(Decoration::NonWritable))
}

/// The name of a resource: of its variable, or of its block.
pub(super) fn name_of<'m>(module: &IndexedModule<'m>, variable: u32, instruction: &Instruction) -> &'m str {
    let own = module.name(variable);
    if own.is_empty() {
        module.pointee(instruction).and_then(|ty| ty.result_id).map_or("", |ty| module.name(ty))
    } else {
        own
    }
}

/// Makes one sampled image of an image and its sampler that share a place.
fn join_pairs(bindings: &mut Vec<Binding>) {
    let places = |it: &Binding| (it.set, it.binding);
    let samplers = bindings.iter().filter(|it| it.kind.is_sampler()).map(places).collect::<Vec<_>>();
    let joined: Vec<_> =
        bindings.iter().filter(|it| it.separate && samplers.contains(&places(it))).map(places).collect();
    bindings.retain(|it| !(it.kind.is_sampler() && joined.contains(&places(it))));
    for image in bindings.iter_mut().filter(|it| joined.contains(&(it.set, it.binding))) {
        image.separate = false;
    }
}

/// Makes one storage block of several of one name at one place: Slang has one for each type that it reads a `ByteAddressBuffer` by.
fn join_views(bindings: &mut Vec<Binding>) {
    bindings.dedup_by(|next, first| {
        let [one, other] = [&*first, &*next].map(|it| it.kind.storage().zip(it.kind.storage_block()));
        let same = (next.set, next.binding, &next.name) == (first.set, first.binding, &first.name);
        let Some((((reads, writes), (_, bytes)), ((also_reads, also_writes), (_, least)))) =
            one.zip(other).filter(|_| same)
        else {
            return false;
        };
        let (readable, writable) = (reads || also_reads, writes || also_writes);
        first.kind = BindingKind::StorageBlock { readable, writable, bytes: bytes.max(least) };
        true
    });
}

/// Kind and shape of a resource of type `ty`.
fn kind(
    module: &IndexedModule<'_>,
    pairs: &SamplerPairs,
    (variable, instruction): (u32, &Instruction),
    ty: &Instruction,
) -> BindingKind {
    match (ty.class.opcode, storage_class(instruction)) {
        (Op::TypeArray | Op::TypeRuntimeArray, _) => other("an array of arrays", "declare one array"),
        (Op::TypeSampledImage, _) => match id(ty, 0).and_then(|image| module.global(image)) {
            Some(image) => {
                let compares = image.operands.get(2).and_then(number) == Some(1);
                let kind = if compares { BindingKind::ComparedDepth } else { BindingKind::SampledImage };
                image_shape(module, image)
                    .filter(|shape| shape.dimension != Dimension::Buffer)
                    .map_or_else(texel_buffer, kind)
            }
            None => other("an image of unknown type", "declare it `sampler2D`"),
        },
        (Op::TypeImage, _) => match (image_shape(module, ty), ty.operands.get(5).and_then(number)) {
            (Some(ImageShape { dimension: Dimension::Buffer, .. }), _) => texel_buffer(),
            (Some(shape), Some(2)) => match texel_format(ty.operands.get(6)) {
                Ok(format) => {
                    let (readable, writable) = storage_access(module, variable, None);
                    BindingKind::StorageImage { shape, format, readable, writable }
                }
                Err(what) => other(&what, "declare it with the format of the pass's image, such as `layout(rgba16f)`"),
            },
            (Some(shape), _) if pairs.compares(variable) => BindingKind::ComparedDepth(shape),
            (Some(shape), _) => BindingKind::SampledImage(shape),
            (None, _) => BindingKind::InputAttachment {
                multisampled: ty.operands.get(4).and_then(number) == Some(1),
                component: id(ty, 0).map_or(Component::Float, |component| component_of(&module.type_name(component))),
            },
        },
        (Op::TypeSampler, _) => {
            let image = |image: u32| module.global(image).map(|it| name_of(module, image, it).to_owned());
            let (images, compares) = (pairs.images_of(variable).filter_map(image).collect(), pairs.compares(variable));
            BindingKind::Sampler { images, compares }
        }
        (Op::TypeStruct, _) if module.is_storage_block(instruction, ty) => {
            let (readable, writable) = storage_access(module, variable, Some(ty));
            let bytes = ty.result_id.map_or(0, |ty| module.block_end(ty));
            BindingKind::StorageBlock { readable, writable, bytes }
        }
        (Op::TypeStruct, Some(StorageClass::Uniform)) => BindingKind::UniformBlock(block(module, ty)),
        (Op::TypeAccelerationStructureKHR, _) => other(
            "an acceleration structure",
            "only sets that the program binds itself hold such (`sets` of its interface)",
        ),
        (opcode, _) => other(&format!("an {} of SPIR-V", named(opcode)), "declare an image or a block"),
    }
}

/// The type of the elements of an array, and how many they are; else the type itself. `None`: nothing tells how many.
fn element<'m>(module: &IndexedModule<'m>, ty: &'m Instruction) -> (Option<&'m Instruction>, Option<u32>) {
    let element = || id(ty, 0).and_then(|element| module.global(element));
    match ty.class.opcode {
        Op::TypeArray => match module.array_length(ty) {
            0 => (None, None),
            length => (element(), Some(length)),
        },
        Op::TypeRuntimeArray => (None, None),
        _ => (Some(ty), None),
    }
}

/// The kind of an array whose elements are of a kind.
fn elements(of: BindingKind) -> BindingKind {
    match of {
        BindingKind::UniformBlock(_) | BindingKind::StorageBlock { .. } => {
            other("an array of blocks", "declare one storage block that holds an array")
        }
        BindingKind::InputAttachment { .. } => other("an array of input attachments", "give each a name of its own"),
        BindingKind::Sampler { .. } => other("an array of samplers", "give each a name of its own"),
        BindingKind::SampledImage(_)
        | BindingKind::ComparedDepth(_)
        | BindingKind::StorageImage { .. }
        | BindingKind::Other(_) => of,
    }
}

fn endless() -> BindingKind {
    let written = "write how many elements it has: `uniform sampler2D textures[64];`";
    let table = "only sets that the program binds itself have arrays of any length (`sets` of its interface)";
    other("an array of unknown length", &format!("{written}; {table}"))
}

/// A binding that no pass can give, and the declaration to write instead.
fn other(what: &str, instead: &str) -> BindingKind {
    BindingKind::Other(UnbindableResource { what: what.to_owned(), instead: instead.to_owned(), place: None })
}

fn texel_buffer() -> BindingKind {
    other("a texel buffer", "declare a storage block: `readonly buffer Texels { vec4 texels[]; };`")
}

/// The format that a storage image's declaration names, if it names one; an error in words if no image of a pipeline has it.
fn texel_format(operand: Option<&Operand>) -> Result<Option<Format>, String> {
    let Some(Operand::ImageFormat(format)) = operand else { return Ok(None) };
    let format = match format {
        ImageFormat::Unknown => return Ok(None),
        ImageFormat::R8 => Format::R8_UNORM,
        ImageFormat::R8Snorm => Format::R8_SNORM,
        ImageFormat::R8ui => Format::R8_UINT,
        ImageFormat::R8i => Format::R8_SINT,
        ImageFormat::Rg8 => Format::R8G8_UNORM,
        ImageFormat::Rg8Snorm => Format::R8G8_SNORM,
        ImageFormat::Rg8ui => Format::R8G8_UINT,
        ImageFormat::Rg8i => Format::R8G8_SINT,
        ImageFormat::Rgba8 => Format::R8G8B8A8_UNORM,
        ImageFormat::Rgba8Snorm => Format::R8G8B8A8_SNORM,
        ImageFormat::Rgba8ui => Format::R8G8B8A8_UINT,
        ImageFormat::Rgba8i => Format::R8G8B8A8_SINT,
        ImageFormat::Rgb10A2 => Format::A2B10G10R10_UNORM_PACK32,
        ImageFormat::R16 => Format::R16_UNORM,
        ImageFormat::R16Snorm => Format::R16_SNORM,
        ImageFormat::R16ui => Format::R16_UINT,
        ImageFormat::R16i => Format::R16_SINT,
        ImageFormat::R16f => Format::R16_SFLOAT,
        ImageFormat::Rg16 => Format::R16G16_UNORM,
        ImageFormat::Rg16Snorm => Format::R16G16_SNORM,
        ImageFormat::Rg16ui => Format::R16G16_UINT,
        ImageFormat::Rg16i => Format::R16G16_SINT,
        ImageFormat::Rg16f => Format::R16G16_SFLOAT,
        ImageFormat::Rgba16 => Format::R16G16B16A16_UNORM,
        ImageFormat::Rgba16Snorm => Format::R16G16B16A16_SNORM,
        ImageFormat::Rgba16ui => Format::R16G16B16A16_UINT,
        ImageFormat::Rgba16i => Format::R16G16B16A16_SINT,
        ImageFormat::Rgba16f => Format::R16G16B16A16_SFLOAT,
        ImageFormat::R32ui => Format::R32_UINT,
        ImageFormat::R32i => Format::R32_SINT,
        ImageFormat::R32f => Format::R32_SFLOAT,
        ImageFormat::Rg32ui => Format::R32G32_UINT,
        ImageFormat::Rg32i => Format::R32G32_SINT,
        ImageFormat::Rg32f => Format::R32G32_SFLOAT,
        ImageFormat::Rgba32ui => Format::R32G32B32A32_UINT,
        ImageFormat::Rgba32i => Format::R32G32B32A32_SINT,
        ImageFormat::Rgba32f => Format::R32G32B32A32_SFLOAT,
        ImageFormat::R11fG11fB10f => Format::B10G11R11_UFLOAT_PACK32,
        other => {
            return Err(format!("a storage image of the format `{}`, which no image of a pipeline has", named(other)));
        }
    };
    Ok(Some(format))
}

/// Shape of an image type; `None` for input attachments.
fn image_shape(module: &IndexedModule<'_>, image: &Instruction) -> Option<ImageShape> {
    let [Operand::IdRef(component), Operand::Dim(dim), _, arrayed, multisampled, ..] = &image.operands[..] else {
        return None;
    };
    let dimension = match dim {
        Dim::Dim1D => Dimension::D1,
        Dim::Dim2D => Dimension::D2,
        Dim::Dim3D => Dimension::D3,
        Dim::DimCube => Dimension::Cube,
        Dim::DimBuffer => Dimension::Buffer,
        _ => return None,
    };
    Some(ImageShape {
        dimension,
        arrayed: number(arrayed) == Some(1),
        multisampled: number(multisampled) == Some(1),
        component: component_of(&module.type_name(*component)),
    })
}

/// The component of a scalar or vector with the GLSL name `ty`.
pub(super) fn component_of(ty: &str) -> Component {
    match ty.as_bytes().first() {
        Some(b'i') => Component::Int,
        Some(b'u') => Component::Uint,
        _ => Component::Float,
    }
}

/// A uniform block's members, and its size rounded up to 16 bytes as std140 does. Of a struct that is all of the block, they are those
/// of the struct, from where it begins: so one compiler wraps what WGSL binds.
pub(super) fn block(module: &IndexedModule<'_>, structure: &Instruction) -> Block {
    let inner = match &structure.operands[..] {
        [Operand::IdRef(only)] => module.global(*only).filter(|it| it.class.opcode == Op::TypeStruct),
        _ => None,
    };
    let Some(structure_id) = structure.result_id else { return Block::default() };
    let mut found = members(module, inner.unwrap_or(structure), STRUCTURE_DEPTH, &mut { MOST_MEMBERS });
    if inner.is_some() {
        let begins = module.member_decoration(structure_id, 0, Decoration::Offset).flatten().and_then(number);
        let begins = begins.unwrap_or(0);
        found.iter_mut().for_each(|member| member.offset = member.offset.saturating_add(begins));
    }
    Block { bytes: module.block_bytes(structure_id), members: found }
}

/// How deep structures within structures are followed: in a broken module one may hold itself.
const STRUCTURE_DEPTH: u32 = 8;
/// How many members of a block are found: a structure may hold many of one that holds many.
const MOST_MEMBERS: usize = 16 << 10;

/// The members of a structure, and those of structures in it down to `depth`. `left`: how many may still be found.
fn members(module: &IndexedModule<'_>, structure: &Instruction, depth: u32, left: &mut usize) -> Vec<Member> {
    let Some(structure_id) = structure.result_id else { return Vec::new() };
    let mut found = Vec::new();
    for (index, operand) in (0_u32..).zip(&structure.operands) {
        let Some(ty) = operand.id_ref_any() else { continue };
        let Some(fewer) = left.checked_sub(1) else { break };
        *left = fewer;
        let offset = module.member_decoration(structure_id, index, Decoration::Offset).flatten().and_then(number);
        let inner = module.global(ty).filter(|it| depth > 0 && it.class.opcode == Op::TypeStruct);
        found.push(Member {
            name: module.member_name(structure_id, index).to_owned(),
            offset: offset.unwrap_or(0),
            ty: module.type_name(ty),
            matrix: module.matrix_layout(structure_id, index),
            stride: module.decoration_number(ty, Decoration::ArrayStride),
            within: inner.map_or_else(Vec::new, |inner| members(module, inner, depth - 1, left)),
        });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use rspirv::dr::Builder;

    #[test]
    fn a_structure_that_is_all_of_its_block_lies_where_the_block_says() {
        let mut builder = Builder::new();
        let float = builder.type_float(32, None);
        let inner = builder.type_struct_id(None, [float, float]);
        let outer = builder.type_struct_id(None, [inner]);
        for (structure, member, offset) in [(inner, 0, 0), (inner, 1, 4), (outer, 0, 64)] {
            builder.member_decorate(structure, member, Decoration::Offset, [Operand::LiteralBit32(offset)]);
        }
        let built = builder.module();
        let module = IndexedModule::new(&built);
        let found = block(&module, module.global(outer).expect("it is there"));
        let offsets: Vec<u32> = found.members.iter().map(|member| member.offset).collect();
        assert_eq!((found.bytes, offsets), (80, vec![64, 68]));
    }
}
