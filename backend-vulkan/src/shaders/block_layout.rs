//! By which of Vulkan's rules the members of blocks lie: no capability tells it, their offsets and strides do. See "Offset and Stride
//! Assignment" in Vulkan's specification.

use super::addresses;
use super::module::{IndexedModule, id, number, storage_class};
use super::needs::Feature;
use super::text::Words;
use framewright_graph::shader::MatrixLayout;
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Decoration, Op, StorageClass};
use std::collections::HashMap;

/// Rules for the members of a block, from the strictest on. What follows one rule follows those behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rules {
    /// Arrays, structs and columns of matrices begin at multiples of 16 bytes: std140.
    Extended,
    /// They begin at multiples of what they are made of: std430.
    Base,
    /// Everything begins at multiples of the scalars that it is made of.
    Scalar,
}

/// How a type lies in a block.
#[derive(Debug, Clone, Copy)]
struct TypeLayout {
    align: u64,
    bytes: u64,
    /// Whether what follows it begins behind its padding.
    padded: bool,
    /// The bytes of a vector's scalars; `None`: it is no vector.
    scalar_of_vector: Option<u64>,
}

/// No array has more dimensions.
const DEEPEST: usize = 64;

/// The features that a device must have for the layouts of blocks.
pub(super) fn features(module: &IndexedModule<'_>) -> Vec<Feature> {
    let mut found = Vec::new();
    let blocks: Vec<_> = blocks(module).collect();
    let layouts = if blocks.is_empty() { None } else { Some(Layouts::of(module)) };
    for ((block, usual, own), layouts) in blocks.into_iter().zip(layouts.iter().cycle()) {
        let name = match usual {
            _ if layouts.follows(block, usual) => continue,
            Rules::Extended if layouts.follows(block, Rules::Base) => "uniformBufferStandardLayout",
            _ => "scalarBlockLayout",
        };
        let words = Words::Whole(if own.is_empty() { module.name(block) } else { own }.to_owned());
        found.push(Feature { name, words });
    }
    found
}

/// The structs that lie in buffers, each with the rules that every device has for it, and a name of its own if it has one.
fn blocks<'m>(module: &'m IndexedModule<'m>) -> impl Iterator<Item = (u32, Rules, &'m str)> {
    let of_variables = module.variables().filter_map(|(variable, it)| {
        let class = storage_class(it);
        let in_block = [StorageClass::Uniform, StorageClass::StorageBuffer, StorageClass::PushConstant].map(Some);
        if !in_block.contains(&class) {
            return None;
        }
        let mut ty = module.pointee(it)?;
        // An array of blocks.
        if matches!(ty.class.opcode, Op::TypeArray | Op::TypeRuntimeArray) {
            ty = module.global(id(ty, 0)?)?;
        }
        let block = ty.result_id.filter(|_| ty.class.opcode == Op::TypeStruct)?;
        let of_uniform = class == Some(StorageClass::Uniform) && !module.is_storage_block(it, ty);
        let usual = if of_uniform { Rules::Extended } else { Rules::Base };
        Some((block, usual, module.name(variable)))
    });
    let followed = addresses::followed_types(module).filter(|ty| ty.class.opcode == Op::TypeStruct);
    of_variables.chain(followed.filter_map(|ty| Some((ty.result_id?, Rules::Base, ""))))
}

/// Where vectors may not lie across a boundary.
const BOUNDARY: u64 = 16;

/// How each struct lies by each of the rules.
struct Layouts<'m> {
    module: &'m IndexedModule<'m>,
    /// By the bytes behind the last boundary at which it begins, in steps of four.
    structs: HashMap<u32, [[Option<TypeLayout>; 4]; 3]>,
}

impl<'m> Layouts<'m> {
    fn of(module: &'m IndexedModule<'m>) -> Layouts<'m> {
        let mut layouts = Layouts { module, structs: HashMap::new() };
        // SPIR-V declares a type after those that it is made of, so each is looked at once.
        for it in module.module.types_global_values.iter().filter(|it| it.class.opcode == Op::TypeStruct) {
            if let Some(structure) = it.result_id {
                let by = [Rules::Extended, Rules::Base, Rules::Scalar]
                    .map(|rules| [0, 4, 8, 12].map(|begin| layouts.structure(it, structure, rules, begin)));
                layouts.structs.insert(structure, by);
            }
        }
        layouts
    }

    fn follows(&self, structure: u32, rules: Rules) -> bool {
        self.known(structure, rules, 0).is_some()
    }

    fn known(&self, structure: u32, rules: Rules, begin: u64) -> Option<TypeLayout> {
        let by = self.structs.get(&structure)?[rules as usize];
        begin.is_multiple_of(4).then(|| by[(begin % BOUNDARY / 4) as usize]).flatten()
    }

    fn structure(&self, it: &Instruction, structure: u32, rules: Rules, begin: u64) -> Option<TypeLayout> {
        let said = |member, decoration| self.module.member_decoration(structure, member, decoration).flatten();
        let members = (0_u32..).zip(it.operands.iter().map(Operand::id_ref_any));
        let placed =
            members.map(|(member, ty)| Some((said(member, Decoration::Offset).and_then(number)?, member, ty?)));
        let mut placed: Vec<(u32, u32, u32)> = placed.collect::<Option<_>>()?;
        placed.sort_unstable();
        let (mut align, mut end, mut free) = (1, 0, 0);
        for (offset, member, ty) in placed {
            let offset = u64::from(offset);
            let matrix = self.module.matrix_layout(structure, member);
            let lies = self.lies(ty, matrix, rules, begin + offset)?;
            let aligned = match (rules, lies.scalar_of_vector) {
                // Vectors may begin at any of their scalars, unless they lie across a boundary of 16 bytes.
                (Rules::Base | Rules::Extended, Some(scalar)) => {
                    let at = begin + offset;
                    let across = at / BOUNDARY != (at + lies.bytes - 1) / BOUNDARY;
                    let straddles = if lies.bytes <= BOUNDARY { across } else { !at.is_multiple_of(BOUNDARY) };
                    offset.is_multiple_of(scalar) && !straddles
                }
                _ => offset.is_multiple_of(lies.align),
            };
            if !aligned || offset < free {
                return None;
            }
            align = align.max(lies.align);
            end = offset.saturating_add(lies.bytes);
            let padded = lies.padded && rules != Rules::Scalar;
            free = if padded { end.checked_next_multiple_of(lies.align)? } else { end };
        }
        Some(TypeLayout::padded(extended(align, rules), end))
    }

    /// How a member's type lies that begins at a byte, if it follows `rules`. `matrix`: how a matrix in it does.
    fn lies(&self, ty: u32, matrix: Option<MatrixLayout>, rules: Rules, begin: u64) -> Option<TypeLayout> {
        let module = self.module;
        let it = module.global(ty)?;
        match it.class.opcode {
            Op::TypeStruct => self.known(ty, rules, begin),
            Op::TypeVector => Some(vector(self.scalar(id(it, 0)?)?, module.components(ty), rules)),
            Op::TypeMatrix => {
                let column = id(it, 0)?;
                let scalar = self.scalar(id(module.global(column)?, 0)?)?;
                let (columns, rows) = (it.operands.get(1).and_then(number)?, module.components(column));
                let MatrixLayout { stride, row_major } = matrix?;
                let (line, lines) = if row_major { (columns, rows) } else { (rows, columns) };
                let line = vector(scalar, line, rules);
                let (align, stride) = (extended(line.align, rules), u64::from(stride));
                let fits = stride.is_multiple_of(align) && stride >= line.bytes;
                fits.then(|| TypeLayout::padded(align, stride * u64::from(lines)))
            }
            Op::TypeArray | Op::TypeRuntimeArray => self.array(it, matrix, rules, begin),
            _ => {
                let bytes = self.scalar(ty)?;
                Some(TypeLayout { align: bytes, bytes, padded: false, scalar_of_vector: None })
            }
        }
    }

    /// The same of an array, or an array of arrays.
    fn array(&self, array: &Instruction, matrix: Option<MatrixLayout>, rules: Rules, begin: u64) -> Option<TypeLayout> {
        let (mut levels, mut begins, mut it) = (Vec::new(), vec![begin % BOUNDARY], array);
        while matches!(it.class.opcode, Op::TypeArray | Op::TypeRuntimeArray) && levels.len() < DEEPEST {
            let stride = u64::from(self.module.decoration_number(it.result_id?, Decoration::ArrayStride)?);
            let length = if it.class.opcode == Op::TypeArray { self.module.array_length(it).into() } else { u64::MAX };
            levels.push((stride, length));
            // After a few elements the places behind boundaries repeat.
            for number in 1..length.min(BOUNDARY) {
                begins.extend(begins.clone().iter().map(|begin| (begin + number * stride) % BOUNDARY));
                begins.sort_unstable();
                begins.dedup();
            }
            it = self.module.global(id(it, 0)?)?;
        }
        // One that is made of itself.
        if levels.len() == DEEPEST {
            return None;
        }
        let mut elements = begins.iter().map(|begin| self.lies(it.result_id?, matrix, rules, *begin));
        let mut lies = elements.next()??;
        if elements.any(|it| it.is_none()) {
            return None;
        }
        for (stride, length) in levels.into_iter().rev() {
            let align = extended(lies.align, rules);
            if !stride.is_multiple_of(align) || stride < lies.bytes {
                return None;
            }
            // One of unknown length is the last member.
            let bytes = if length == u64::MAX { stride } else { stride.saturating_mul(length) };
            lies = TypeLayout::padded(align, bytes);
        }
        Some(lies)
    }

    /// Bytes of a scalar; a pointer has 8.
    fn scalar(&self, ty: u32) -> Option<u64> {
        let it = self.module.global(ty)?;
        match it.class.opcode {
            Op::TypeInt | Op::TypeFloat => it.operands.first().and_then(number).map(|bits| u64::from(bits / 8).max(1)),
            Op::TypePointer => Some(8),
            _ => None,
        }
    }
}

impl TypeLayout {
    const fn padded(align: u64, bytes: u64) -> TypeLayout {
        TypeLayout { align, bytes, padded: true, scalar_of_vector: None }
    }
}

fn vector(scalar: u64, components: u32, rules: Rules) -> TypeLayout {
    let align = match rules {
        Rules::Scalar => scalar,
        Rules::Base | Rules::Extended => scalar * u64::from(components.next_power_of_two()),
    };
    TypeLayout { align, bytes: scalar * u64::from(components), padded: false, scalar_of_vector: Some(scalar) }
}

fn extended(align: u64, rules: Rules) -> u64 {
    if rules == Rules::Extended { align.next_multiple_of(16) } else { align }
}

#[cfg(all(test, spirv_validator))]
mod tests {
    use super::*;
    use crate::shaders::validator::is_valid;
    use rspirv::binary::Assemble;
    use rspirv::dr::{Builder, Module};
    use rspirv::spirv::{AddressingModel, Capability, ExecutionMode, ExecutionModel, FunctionControl, MemoryModel};

    /// Numbers that look random, the same in each run.
    struct Numbers(u64);

    impl Numbers {
        fn below(&mut self, most: u32) -> u32 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 33) as u32 % most
        }

        fn of<T: Copy>(&mut self, all: &[T]) -> T {
            all[self.below(all.len() as u32) as usize]
        }
    }

    /// A type, its bytes if it lies as densely as it can, and how a matrix in it lies.
    fn member(builder: &mut Builder, numbers: &mut Numbers) -> (u32, u32, Option<(u32, bool)>) {
        let float = builder.type_float(32, None);
        let components = 1 + numbers.below(4);
        let value = if components == 1 { float } else { builder.type_vector(float, components) };
        match numbers.below(4) {
            0 | 1 => (value, 4 * components, None),
            2 => {
                let stride = 4 * components + 4 * numbers.below(3);
                array(builder, value, stride)
            }
            _ => {
                let (columns, rows) = (2 + numbers.below(3), 2 + numbers.below(3));
                let column = builder.type_vector(float, rows);
                let matrix = builder.type_matrix(column, columns);
                let row_major = numbers.below(2) == 0;
                let (line, lines) = if row_major { (columns, rows) } else { (rows, columns) };
                let stride = 4 * line + 4 * numbers.below(2);
                (matrix, stride * lines, Some((stride, row_major)))
            }
        }
    }

    /// An array of three elements.
    fn array(builder: &mut Builder, element: u32, stride: u32) -> (u32, u32, Option<(u32, bool)>) {
        let uint = builder.type_int(32, 0);
        let length = builder.constant_bit32(uint, 3);
        let array = builder.type_array_id(None, element, length);
        builder.decorate(array, Decoration::ArrayStride, [Operand::LiteralBit32(stride)]);
        (array, 3 * stride, None)
    }

    /// A struct of a few members, and where it ends.
    fn structure(builder: &mut Builder, numbers: &mut Numbers, deep: u32) -> (u32, u32) {
        let mut members = Vec::new();
        let mut end: u32 = 0;
        for _ in 0..1 + numbers.below(3) {
            let nested = deep > 0 && numbers.below(4) == 0;
            let (ty, bytes, matrix) = if nested {
                let (ty, bytes) = structure(builder, numbers, deep - 1);
                if numbers.below(2) == 0 { array(builder, ty, bytes + 4 * numbers.below(5)) } else { (ty, bytes, None) }
            } else {
                member(builder, numbers)
            };
            let offset = end.next_multiple_of(numbers.of(&[4, 4, 8, 16])) + numbers.of(&[0, 0, 0, 4]);
            members.push((ty, offset, matrix));
            end = offset + bytes;
        }
        let structure = builder.type_struct_id(None, members.iter().map(|(ty, ..)| *ty));
        for (member, (_, offset, matrix)) in (0..).zip(members) {
            builder.member_decorate(structure, member, Decoration::Offset, [Operand::LiteralBit32(offset)]);
            if let Some((stride, row_major)) = matrix {
                let order = if row_major { Decoration::RowMajor } else { Decoration::ColMajor };
                builder.member_decorate(structure, member, order, []);
                builder.member_decorate(structure, member, Decoration::MatrixStride, [Operand::LiteralBit32(stride)]);
            }
        }
        (structure, end)
    }

    fn module(numbers: &mut Numbers, class: StorageClass) -> Module {
        let mut builder = Builder::new();
        builder.set_version(1, 5);
        builder.capability(Capability::Shader);
        builder.memory_model(AddressingModel::Logical, MemoryModel::GLSL450);
        let (block, _) = structure(&mut builder, numbers, 2);
        builder.decorate(block, Decoration::Block, []);
        let pointer = builder.type_pointer(None, class, block);
        let variable = builder.variable(pointer, None, class, None);
        for place in [Decoration::DescriptorSet, Decoration::Binding] {
            builder.decorate(variable, place, [Operand::LiteralBit32(0)]);
        }
        let nothing = builder.type_void();
        let ty = builder.type_function(nothing, []);
        let main = builder.begin_function(nothing, None, FunctionControl::NONE, ty).expect("a function");
        builder.begin_block(None).expect("a block");
        builder.ret().expect("its end");
        builder.end_function().expect("its end");
        builder.entry_point(ExecutionModel::GLCompute, main, "main", [variable]);
        builder.execution_mode(main, ExecutionMode::LocalSize, [1, 1, 1]);
        builder.module()
    }

    /// The validator judges the same blocks by each rule.
    #[test]
    fn layouts_of_random_blocks_follow_the_rules_that_the_validator_finds() {
        let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
        let mut counts = [0; 4];
        for number in 0..3000 {
            let class = if number % 2 == 0 { StorageClass::Uniform } else { StorageClass::StorageBuffer };
            let module = module(&mut numbers, class);
            let spirv = module.assemble();
            let rules = [(false, false), (true, false), (true, true)];
            let found = rules.iter().position(|(standard, scalar)| is_valid(&spirv, *standard, *scalar));
            let expected = match found {
                Some(0) => None,
                Some(1) => Some("uniformBufferStandardLayout"),
                Some(_) => Some("scalarBlockLayout"),
                // By no rule: the validator refuses it.
                None => {
                    counts[3] += 1;
                    continue;
                }
            };
            counts[found.unwrap_or(3)] += 1;
            let features = features(&IndexedModule::new(&module));
            let said = features.first().map(|it| it.name);
            assert_eq!(said, expected, "number {number}\n{}", rspirv::binary::Disassemble::disassemble(&module));
        }
        assert!(counts[..3].iter().all(|count| *count > 100), "{counts:?}");
    }
}
