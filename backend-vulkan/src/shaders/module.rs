//! A SPIR-V module with its instructions found by id.

use framewright_graph::shader::MatrixLayout;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Capability, Decoration, Op, StorageClass};
use std::collections::HashMap;

/// A module, indexed. Types may be nested as deep and as wide as they like: nothing here calls itself for what a type is made of.
pub(super) struct IndexedModule<'m> {
    /// The module itself.
    pub(super) module: &'m Module,
    globals: HashMap<u32, &'m Instruction>,
    /// The sizes of each type and constant.
    sizes: HashMap<u32, Sizes>,
    names: HashMap<u32, &'m str>,
    member_names: HashMap<(u32, u32), &'m str>,
    /// The first operand of each decoration that has one.
    decorations: HashMap<(u32, Decoration), Option<&'m Operand>>,
    member_decorations: HashMap<(u32, u32, Decoration), Option<&'m Operand>>,
}

/// Bytes that a ray query is taken for: drivers keep the way that a ray has taken through an acceleration structure. None tells how much.
const RAY_QUERY_BYTES: u64 = 512;

/// Sizes of a type.
#[derive(Debug, Clone, Copy, Default)]
struct Sizes {
    /// Bytes of a variable of the type, with each scalar in four.
    own_bytes: u64,
    /// Locations of a value of the type.
    locations: u32,
    /// Bytes of a struct up to the end of its last member of a written length.
    block_end: u32,
}

impl<'m> IndexedModule<'m> {
    /// Indexes `module`.
    pub(super) fn new(module: &'m Module) -> IndexedModule<'m> {
        let globals = module.types_global_values.iter().filter_map(|it| Some((it.result_id?, it))).collect();
        let mut names = HashMap::new();
        let mut member_names = HashMap::new();
        for instruction in &module.debug_names {
            match &instruction.operands[..] {
                [Operand::IdRef(id), Operand::LiteralString(name)] => {
                    names.insert(*id, name.as_str());
                }
                [Operand::IdRef(id), Operand::LiteralBit32(member), Operand::LiteralString(name)] => {
                    member_names.insert((*id, *member), name.as_str());
                }
                _ => {}
            }
        }
        let mut decorations = HashMap::new();
        let mut member_decorations = HashMap::new();
        for instruction in &module.annotations {
            match &instruction.operands[..] {
                [Operand::IdRef(on), Operand::Decoration(kind), rest @ ..]
                    if instruction.class.opcode == Op::Decorate =>
                {
                    decorations.entry((*on, *kind)).or_insert(rest.first());
                }
                [Operand::IdRef(on), Operand::LiteralBit32(member), Operand::Decoration(kind), rest @ ..] => {
                    member_decorations.entry((*on, *member, *kind)).or_insert(rest.first());
                }
                _ => {}
            }
        }
        let sizes = HashMap::new();
        let mut indexed =
            IndexedModule { module, globals, sizes, names, member_names, decorations, member_decorations };
        // SPIR-V declares a type after those that it is made of, so each is measured once.
        for it in &module.types_global_values {
            if let Some(ty) = it.result_id {
                let sizes = Sizes {
                    own_bytes: indexed.measured(it),
                    locations: indexed.located(it),
                    block_end: indexed.laid_out(it),
                };
                indexed.sizes.insert(ty, sizes);
            }
        }
        indexed
    }

    fn sizes(&self, ty: u32) -> Sizes {
        self.sizes.get(&ty).copied().unwrap_or_default()
    }

    /// Bytes that a variable of a type takes, without padding; 0 for what isn't a type.
    pub(super) fn own_bytes(&self, ty: u32) -> u64 {
        self.sizes(ty).own_bytes
    }

    /// Bytes that a struct takes as a block, rounded up to 16 as std140 does.
    pub(super) fn block_bytes(&self, structure: u32) -> u32 {
        self.block_end(structure).checked_next_multiple_of(16).unwrap_or(u32::MAX)
    }

    /// Bytes of a block up to the end of its last member, an array of no written length left out.
    pub(super) fn block_end(&self, structure: u32) -> u32 {
        self.sizes(structure).block_end
    }

    /// Locations that a value of a type takes.
    pub(super) fn locations(&self, ty: u32) -> u32 {
        self.sizes(ty).locations
    }

    fn measured(&self, it: &Instruction) -> u64 {
        let element = || id(it, 0).map_or(0, |element| self.own_bytes(element));
        match it.class.opcode {
            Op::TypeInt | Op::TypeFloat => u64::from(bits(it) / 8),
            Op::TypeBool => 4,
            Op::TypePointer | Op::TypeAccelerationStructureKHR => 8,
            Op::TypeRayQueryKHR => RAY_QUERY_BYTES,
            Op::TypeVector | Op::TypeMatrix => {
                element().saturating_mul(it.operands.get(1).and_then(number).unwrap_or(0).into())
            }
            Op::TypeArray => element().saturating_mul(self.array_length(it).into()),
            Op::TypeStruct => {
                let members = it.operands.iter().filter_map(Operand::id_ref_any);
                members.fold(0, |sum: u64, member| sum.saturating_add(self.own_bytes(member)))
            }
            _ => 0,
        }
    }

    fn located(&self, it: &Instruction) -> u32 {
        let element = || id(it, 0).map_or(1, |element| self.sizes(element).locations);
        let count = || it.operands.get(1).and_then(number).unwrap_or(1);
        match it.class.opcode {
            // Two numbers of 64 bits fill a location.
            Op::TypeVector if id(it, 0).and_then(|scalar| self.global(scalar)).is_some_and(|it| bits(it) == 64) => {
                count().div_ceil(2)
            }
            Op::TypeMatrix => count().saturating_mul(element()),
            Op::TypeArray => self.array_length(it).saturating_mul(element()),
            Op::TypeStruct => {
                let members = it.operands.iter().filter_map(Operand::id_ref_any);
                members.fold(0, |sum: u32, member| sum.saturating_add(self.sizes(member).locations))
            }
            _ => 1,
        }
    }

    fn laid_out(&self, it: &Instruction) -> u32 {
        let (Op::TypeStruct, Some(structure)) = (it.class.opcode, it.result_id) else { return 0 };
        let members = (0_u32..).zip(it.operands.iter().map(Operand::id_ref_any));
        let ends = members.filter_map(|(member, ty)| {
            let said = |decoration| self.member_decoration(structure, member, decoration).flatten().and_then(number);
            let bytes = self.member_bytes(ty?, self.matrix_layout(structure, member));
            Some(said(Decoration::Offset).unwrap_or(0).saturating_add(bytes))
        });
        ends.max().unwrap_or(0)
    }

    /// How a block's member lies if it is a matrix, or an array of them.
    pub(super) fn matrix_layout(&self, structure: u32, member: u32) -> Option<MatrixLayout> {
        let stride = self.member_decoration(structure, member, Decoration::MatrixStride).flatten().and_then(number)?;
        let row_major = self.member_decoration(structure, member, Decoration::RowMajor).is_some();
        Some(MatrixLayout { stride, row_major })
    }

    /// Bytes that a block's member of type `ty` spans.
    fn member_bytes(&self, ty: u32, matrix: Option<MatrixLayout>) -> u32 {
        let Some(it) = self.global(ty) else { return 0 };
        let scalar_bytes = |it: &Instruction| bits(it) / 8;
        match it.class.opcode {
            Op::TypeVector => {
                let element = id(it, 0).and_then(|element| self.global(element)).map_or(0, scalar_bytes);
                element.saturating_mul(self.components(ty))
            }
            Op::TypeMatrix => {
                let columns = it.operands.get(1).and_then(number).unwrap_or(0);
                let lines = match matrix {
                    Some(MatrixLayout { row_major: true, .. }) => id(it, 0).map_or(0, |column| self.components(column)),
                    _ => columns,
                };
                matrix.map_or(16, |matrix| matrix.stride).saturating_mul(lines)
            }
            Op::TypeArray => {
                let stride = self.decoration_number(ty, Decoration::ArrayStride).unwrap_or(16);
                let last = id(it, 0).map_or(0, |element| self.member_bytes(element, matrix));
                match self.array_length(it) {
                    0 => 0,
                    length => stride.saturating_mul(length - 1).saturating_add(last),
                }
            }
            Op::TypeRuntimeArray => 0,
            Op::TypeStruct => self.block_end(ty),
            Op::TypePointer => 8,
            _ => scalar_bytes(it),
        }
    }

    /// The capabilities that it names.
    pub(super) fn capabilities(&self) -> impl Iterator<Item = Capability> + Clone {
        self.module.capabilities.iter().filter_map(|it| match it.operands.first() {
            Some(Operand::Capability(capability)) => Some(*capability),
            _ => None,
        })
    }

    /// The type, constant or global variable `id`.
    pub(super) fn global(&self, id: u32) -> Option<&'m Instruction> {
        self.globals.get(&id).copied()
    }

    /// The global variables: id, storage class operand's instruction.
    pub(super) fn variables(&self) -> impl Iterator<Item = (u32, &'m Instruction)> {
        let globals = self.module.types_global_values.iter();
        globals.filter(|it| it.class.opcode == Op::Variable).filter_map(|it| Some((it.result_id?, it)))
    }

    /// The type that the variable points to.
    pub(super) fn pointee(&self, variable: &Instruction) -> Option<&'m Instruction> {
        self.global(id(self.global(variable.result_type?)?, 1)?)
    }

    /// Whether a variable is a storage block. Before SPIR-V 1.3 its type says so, and not its storage class.
    pub(super) fn is_storage_block(&self, variable: &Instruction, structure: &Instruction) -> bool {
        let marked = || structure.result_id.is_some_and(|ty| self.decoration(ty, Decoration::BufferBlock).is_some());
        match storage_class(variable) {
            Some(StorageClass::StorageBuffer) => true,
            Some(StorageClass::Uniform) => marked(),
            _ => false,
        }
    }

    /// The name of `id`; empty if it has none.
    pub(super) fn name(&self, id: u32) -> &'m str {
        self.names.get(&id).copied().unwrap_or("")
    }

    /// The name of a struct's member; empty if it has none.
    pub(super) fn member_name(&self, of: u32, member: u32) -> &'m str {
        self.member_names.get(&(of, member)).copied().unwrap_or("")
    }

    /// The first operand of a decoration of `id`: `None` if not decorated so, `Some(None)` if it takes no operand.
    pub(super) fn decoration(&self, id: u32, wanted: Decoration) -> Option<Option<&'m Operand>> {
        self.decorations.get(&(id, wanted)).copied()
    }

    /// A decoration's number: location, binding, set, stride.
    pub(super) fn decoration_number(&self, id: u32, wanted: Decoration) -> Option<u32> {
        self.decoration(id, wanted).flatten().and_then(number)
    }

    /// The first operand of a decoration of a struct's member.
    pub(super) fn member_decoration(&self, of: u32, member: u32, wanted: Decoration) -> Option<Option<&'m Operand>> {
        self.member_decorations.get(&(of, member, wanted)).copied()
    }

    /// Every instruction of every function. The compiler leaves out functions that nobody calls.
    pub(super) fn code(&self) -> impl Iterator<Item = &'m Instruction> {
        self.module.functions.iter().flat_map(|it| &it.blocks).flat_map(|it| &it.instructions)
    }

    /// The value of an integer constant.
    pub(super) fn constant(&self, id: u32) -> Option<u32> {
        number(self.global(id)?.operands.first()?)
    }

    /// A type as GLSL writes it: `float`, `uvec2`, `mat4`, `mat3x4`, `vec4[8]`, or a struct's name.
    pub(super) fn type_name(&self, ty: u32) -> String {
        let mut lengths = String::new();
        let mut ty = ty;
        let mut dimensions = 0;
        // No array has more dimensions than there are types.
        while let Some(it) = self.global(ty).filter(|_| dimensions < self.globals.len()) {
            match it.class.opcode {
                Op::TypeArray => lengths += &format!("[{}]", self.array_length(it)),
                Op::TypeRuntimeArray => lengths += "[]",
                _ => break,
            }
            dimensions += 1;
            ty = id(it, 0).unwrap_or(0);
        }
        self.element_name(ty) + &lengths
    }

    /// The name of a type that is no array.
    fn element_name(&self, ty: u32) -> String {
        let Some(it) = self.global(ty) else { return "?".to_owned() };
        let element = || id(it, 0).unwrap_or(0);
        match it.class.opcode {
            Op::TypeVector => {
                let prefix = match self.scalar_name(element()) {
                    "float" => "",
                    "int64_t" => "i64",
                    "uint64_t" => "u64",
                    "float16_t" => "f16",
                    "int16_t" => "i16",
                    "uint16_t" => "u16",
                    "int8_t" => "i8",
                    "uint8_t" => "u8",
                    component => component.get(..1).unwrap_or_default(),
                };
                format!("{prefix}vec{}", it.operands.get(1).and_then(number).unwrap_or(0))
            }
            Op::TypeMatrix => {
                let columns = it.operands.get(1).and_then(number).unwrap_or(0);
                let rows = self.components(element());
                if rows == columns { format!("mat{columns}") } else { format!("mat{columns}x{rows}") }
            }
            _ => self.scalar_name(ty).to_owned(),
        }
    }

    /// The name of a scalar type or a struct.
    fn scalar_name(&self, ty: u32) -> &'m str {
        let Some(it) = self.global(ty) else { return "?" };
        match it.class.opcode {
            Op::TypeBool => "bool",
            Op::TypeInt => match (bits(it), it.operands.get(1).and_then(number) == Some(1)) {
                (64, true) => "int64_t",
                (64, false) => "uint64_t",
                (16, true) => "int16_t",
                (16, false) => "uint16_t",
                (8, true) => "int8_t",
                (8, false) => "uint8_t",
                (_, true) => "int",
                (_, false) => "uint",
            },
            Op::TypeFloat => match bits(it) {
                64 => "double",
                16 => "float16_t",
                _ => "float",
            },
            _ => self.name(ty),
        }
    }

    /// Number of components of a scalar or vector type.
    pub(super) fn components(&self, ty: u32) -> u32 {
        match self.global(ty) {
            Some(it) if it.class.opcode == Op::TypeVector => it.operands.get(1).and_then(number).unwrap_or(0),
            _ => 1,
        }
    }

    /// The last location that a variable of type `ty` takes, as its own decoration or those of its members say; `None` without one.
    pub(super) fn last_location(&self, variable: u32, ty: u32) -> Option<u32> {
        let last = |first: u32, ty: u32| first.saturating_add(self.sizes(ty).locations.saturating_sub(1));
        if let Some(first) = self.decoration_number(variable, Decoration::Location) {
            return Some(last(first, ty));
        }
        let members = self.global(ty).filter(|it| it.class.opcode == Op::TypeStruct)?.operands.iter().zip(0..);
        let placed = members.filter_map(|(member, at)| {
            let first = self.member_decoration(ty, at, Decoration::Location).flatten().and_then(number)?;
            Some(last(first, member.id_ref_any()?))
        });
        placed.max()
    }

    /// Elements of an array type.
    pub(super) fn array_length(&self, array: &Instruction) -> u32 {
        id(array, 1).and_then(|length| self.constant(length)).unwrap_or(0)
    }
}

/// The id in an instruction's operand number `at`.
pub(super) fn id(instruction: &Instruction, at: usize) -> Option<u32> {
    match instruction.operands.get(at) {
        Some(Operand::IdRef(id)) => Some(*id),
        _ => None,
    }
}

/// The number in an operand.
pub(super) fn number(operand: &Operand) -> Option<u32> {
    match operand {
        Operand::LiteralBit32(number) => Some(*number),
        _ => None,
    }
}

/// Bits of a scalar type.
fn bits(scalar: &Instruction) -> u32 {
    scalar.operands.first().and_then(number).unwrap_or(32)
}

/// Storage class of a variable.
pub(super) fn storage_class(variable: &Instruction) -> Option<StorageClass> {
    match variable.operands.first() {
        Some(Operand::StorageClass(class)) => Some(*class),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deep enough to overflow any stack that is a function call for each level.
    const DEEP: usize = 100_000;

    /// Types. Each is made of the ones before it.
    struct Types(Module);

    impl Types {
        fn add(&mut self, opcode: Op, operands: Vec<Operand>) -> u32 {
            let ty = self.0.types_global_values.len() as u32 + 1;
            self.0.types_global_values.push(Instruction::new(opcode, None, Some(ty), operands));
            ty
        }

        fn made_of(&mut self, opcode: Op, parts: &[u32]) -> u32 {
            self.add(opcode, parts.iter().map(|part| Operand::IdRef(*part)).collect())
        }

        fn float(&mut self) -> u32 {
            self.add(Op::TypeFloat, vec![Operand::LiteralBit32(32)])
        }
    }

    #[test]
    fn arrays_have_names_and_sizes_however_many_dimensions_they_have() {
        let mut types = Types(Module::new());
        let float = types.float();
        let uint = types.add(Op::TypeInt, vec![Operand::LiteralBit32(32), Operand::LiteralBit32(0)]);
        let [one, two] = [1, 2].map(|length| types.add(Op::Constant, vec![Operand::LiteralBit32(length)]));
        let vector = types.add(Op::TypeVector, vec![Operand::IdRef(uint), Operand::LiteralBit32(2)]);
        let table = types.made_of(Op::TypeArray, &[vector, two]);
        let rows = types.made_of(Op::TypeRuntimeArray, &[table]);
        let deep = (0..DEEP).fold(float, |ty, _| types.made_of(Op::TypeArray, &[ty, one]));
        let module = IndexedModule::new(&types.0);
        assert_eq!(module.type_name(rows), "uvec2[][2]");
        assert_eq!(module.type_name(deep), format!("float{}", "[1]".repeat(DEEP)));
        assert_eq!((module.own_bytes(deep), module.sizes(deep).locations), (4, 1));
    }

    #[test]
    fn structs_have_sizes_however_deep_they_are_nested_and_however_often() {
        let mut types = Types(Module::new());
        let float = types.float();
        let deep = (0..DEEP).fold(float, |ty, _| types.made_of(Op::TypeStruct, &[ty]));
        let wide = (0..64).fold(float, |ty, _| types.made_of(Op::TypeStruct, &[ty, ty]));
        let module = IndexedModule::new(&types.0);
        assert_eq!((module.own_bytes(deep), module.sizes(deep).locations, module.block_bytes(deep)), (4, 1, 16));
        assert_eq!((module.own_bytes(wide), module.sizes(wide).locations), (u64::MAX, u32::MAX));
    }

    #[test]
    fn an_array_that_is_made_of_itself_has_a_name_that_ends() {
        let mut types = Types(Module::new());
        types.made_of(Op::TypeRuntimeArray, &[1]);
        assert_eq!(IndexedModule::new(&types.0).type_name(1), "[]");
    }
}
