//! What the crate `spirv-reflect` says.

use crate::facts::{Facts, PUSHED, add, add_sampler, rounded};
use spirv_reflect::ShaderModule;
use spirv_reflect::types::{
    ReflectBlockVariable, ReflectDecorationFlags, ReflectDescriptorBinding, ReflectDescriptorType, ReflectDimension,
    ReflectImageTraits, ReflectInterfaceVariable, ReflectNumericTraits, ReflectTypeDescription, ReflectTypeFlags,
};
use std::path::Path;

/// Reads an entry point.
pub fn read(file: &Path, entry: &str) -> Result<Facts, String> {
    let bytes = std::fs::read(file).map_err(|error| error.to_string())?;
    let words: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let module = ShaderModule::load_u32_data(&as_before_1_4(&words)).map_err(str::to_owned)?;
    let mut facts = Facts::new();
    for binding in module.enumerate_descriptor_bindings(Some(entry)).map_err(str::to_owned)? {
        resource(&mut facts, &binding);
    }
    for block in module.enumerate_push_constant_blocks(Some(entry)).map_err(str::to_owned)? {
        add(&mut facts, "resource", PUSHED, "uniform");
        members(&mut facts, PUSHED, &block);
    }
    for (kind, all) in [
        ("input", module.enumerate_input_variables(Some(entry)).map_err(str::to_owned)?),
        ("output", module.enumerate_output_variables(Some(entry)).map_err(str::to_owned)?),
    ] {
        all.iter().for_each(|it| varying(&mut facts, kind, it));
    }
    Ok(facts)
}

/// The module with entry points that name inputs and outputs alone, as before SPIR-V 1.4: this reader knows no others.
fn as_before_1_4(words: &[u32]) -> Vec<u32> {
    const ENTRY_POINT: u32 = 15;
    const VARIABLE: u32 = 59;
    let (mut instructions, mut rest) = (Vec::new(), words.get(5..).unwrap_or_default());
    while let Some((it, behind)) = rest.first().and_then(|first| rest.split_at_checked((first >> 16).max(1) as usize)) {
        instructions.push(it);
        rest = behind;
    }
    let varying = |id: u32| {
        let mut variables = instructions.iter().filter(|it| it[0] & 0xffff == VARIABLE && it.get(2) == Some(&id));
        variables.any(|it| matches!(it.get(3), Some(1 | 3)))
    };
    let mut kept = words[..words.len().min(5)].to_vec();
    for it in &instructions {
        if it[0] & 0xffff != ENTRY_POINT {
            kept.extend_from_slice(it);
            continue;
        }
        // The name ends with the word that has a zero byte.
        let name = it.iter().skip(3).position(|word| word.to_le_bytes().contains(&0)).map_or(it.len(), |at| at + 4);
        let interface = it[name..].iter().copied().filter(|id| varying(*id));
        let whole: Vec<u32> = it[..name].iter().copied().chain(interface).collect();
        kept.push((whole.len() as u32) << 16 | ENTRY_POINT);
        kept.extend_from_slice(&whole[1..]);
    }
    kept
}

fn resource(facts: &mut Facts, it: &ReflectDescriptorBinding) {
    use ReflectDescriptorType as Is;
    let at = format!("{} {}", it.set, it.binding);
    let kind = match it.descriptor_type {
        Is::Sampler => {
            add_sampler(facts, &at);
            return;
        }
        Is::CombinedImageSampler => "combined",
        Is::SampledImage => "image",
        Is::StorageImage => "storage_image",
        Is::UniformBuffer | Is::UniformBufferDynamic => "uniform",
        Is::StorageBuffer | Is::StorageBufferDynamic => "storage",
        Is::InputAttachment => "input_attachment",
        Is::UniformTexelBuffer | Is::StorageTexelBuffer => "texel_buffer",
        Is::Undefined | Is::AccelerationStructureNV => "unknown",
    };
    let sampler = facts.get(&("resource".to_owned(), at.clone())).is_some_and(|kind| kind == "sampler");
    add(facts, "resource", &at, if sampler && kind == "image" { "combined" } else { kind });
    add(facts, "count", &at, it.count);
    add(facts, "name", &at, &it.name);
    match kind {
        "combined" | "image" | "storage_image" => add(facts, "shape", &at, shape(&it.image)),
        "uniform" => {
            add(facts, "bytes", &at, rounded(it.block.padded_size.into()));
            members(facts, &at, &it.block);
        }
        _ => {}
    }
}

/// The members of a uniform block; of a struct that is all of it, those of the struct.
fn members(facts: &mut Facts, at: &str, block: &ReflectBlockVariable) {
    let of = match &block.members[..] {
        [only] if !only.members.is_empty() && only.array.dims.is_empty() => only,
        _ => block,
    };
    for member in &of.members {
        let at = format!("{at} {}", member.offset);
        let ty = described(&member.numeric, member.type_description.as_ref(), &member.array.dims);
        add(facts, "member", &at, ty);
        add(facts, "member_name", &at, &member.name);
    }
}

fn varying(facts: &mut Facts, kind: &str, it: &ReflectInterfaceVariable) {
    if it.decoration_flags.contains(ReflectDecorationFlags::BUILT_IN) || it.location == u32::MAX {
        return;
    }
    if !it.members.is_empty() {
        it.members.iter().for_each(|member| varying(facts, kind, member));
        return;
    }
    // Nothing is said of components.
    let at = format!("{} 0", it.location);
    add(facts, kind, &at, described(&it.numeric, it.type_description.as_ref(), &it.array.dims));
    add(facts, &format!("{kind}_name"), &at, &it.name);
}

/// A type as GLSL writes it; empty for structs.
fn described(numeric: &ReflectNumericTraits, ty: Option<&ReflectTypeDescription>, lengths: &[u32]) -> String {
    let flags = ty.map_or(ReflectTypeFlags::UNDEFINED, |ty| ty.type_flags);
    if flags.contains(ReflectTypeFlags::STRUCT) || flags.contains(ReflectTypeFlags::EXTERNAL_BLOCK) {
        return String::new();
    }
    let scalar = match (flags, numeric.scalar.width, numeric.scalar.signedness) {
        (flags, 64, _) if flags.contains(ReflectTypeFlags::FLOAT) => "double",
        (flags, 16, _) if flags.contains(ReflectTypeFlags::FLOAT) => "float16_t",
        (flags, ..) if flags.contains(ReflectTypeFlags::FLOAT) => "float",
        (_, 64, 0) => "uint64_t",
        (_, 64, _) => "int64_t",
        (_, 16, 0) => "uint16_t",
        (_, 16, _) => "int16_t",
        (_, _, 0) => "uint",
        _ => "int",
    };
    let prefix = match scalar {
        "float" => "",
        "float16_t" => "f16",
        "uint64_t" => "u64",
        "int64_t" => "i64",
        "uint16_t" => "u16",
        "int16_t" => "i16",
        other => &other[..1],
    };
    let (columns, rows) = (numeric.matrix.column_count, numeric.matrix.row_count);
    let one = if flags.contains(ReflectTypeFlags::MATRIX) {
        if columns == rows { format!("mat{columns}") } else { format!("mat{columns}x{rows}") }
    } else if flags.contains(ReflectTypeFlags::VECTOR) {
        format!("{prefix}vec{}", numeric.vector.component_count)
    } else {
        scalar.to_owned()
    };
    one + &lengths.iter().map(|length| format!("[{length}]")).collect::<String>()
}

fn shape(image: &ReflectImageTraits) -> String {
    let dimension = match image.dim {
        ReflectDimension::Type1d => "1D",
        ReflectDimension::Type2d => "2D",
        ReflectDimension::Type3d => "3D",
        ReflectDimension::Cube => "Cube",
        ReflectDimension::Buffer => "Buffer",
        _ => "?",
    };
    let (samples, layers) = (if image.ms == 1 { "MS" } else { "" }, if image.arrayed == 1 { "Array" } else { "" });
    format!("{dimension}{samples}{layers}")
}
