//! A SPIR-V module with its instructions found by id.

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, StorageClass};
use std::collections::HashMap;

/// A module, indexed.
pub(super) struct Indexed<'m> {
    /// The module itself.
    pub(super) module: &'m Module,
    globals: HashMap<u32, &'m Instruction>,
    own_bytes: HashMap<u32, u64>,
    names: HashMap<u32, &'m str>,
    member_names: HashMap<(u32, u32), &'m str>,
}

impl<'m> Indexed<'m> {
    /// Indexes `module`.
    pub(super) fn new(module: &'m Module) -> Indexed<'m> {
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
        let mut indexed = Indexed { module, globals, own_bytes: HashMap::new(), names, member_names };
        // SPIR-V declares a type after those that it is made of, so each is measured once.
        for it in &module.types_global_values {
            if let Some(ty) = it.result_id {
                let bytes = indexed.measured(it);
                indexed.own_bytes.insert(ty, bytes);
            }
        }
        indexed
    }

    /// Bytes that a variable of a type takes, with each scalar in four; 0 for what isn't a type.
    pub(super) fn own_bytes(&self, ty: u32) -> u64 {
        self.own_bytes.get(&ty).copied().unwrap_or(0)
    }

    fn measured(&self, it: &Instruction) -> u64 {
        let element = || id(it, 0).map_or(0, |element| self.own_bytes(element));
        match it.class.opcode {
            Op::TypeBool | Op::TypeInt | Op::TypeFloat => 4,
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
        self.module.annotations.iter().find_map(|it| match &it.operands[..] {
            [Operand::IdRef(on), Operand::Decoration(kind), rest @ ..]
                if it.class.opcode == Op::Decorate && *on == id && *kind == wanted =>
            {
                Some(rest.first())
            }
            _ => None,
        })
    }

    /// A decoration's number: location, binding, set, stride.
    pub(super) fn decoration_number(&self, id: u32, wanted: Decoration) -> Option<u32> {
        self.decoration(id, wanted).flatten().and_then(number)
    }

    /// The first operand of a decoration of a struct's member.
    pub(super) fn member_decoration(&self, of: u32, member: u32, wanted: Decoration) -> Option<Option<&'m Operand>> {
        self.module.annotations.iter().find_map(|it| match &it.operands[..] {
            [Operand::IdRef(on), Operand::LiteralBit32(index), Operand::Decoration(kind), rest @ ..]
                if *on == of && *index == member && *kind == wanted =>
            {
                Some(rest.first())
            }
            _ => None,
        })
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
        let Some(it) = self.global(ty) else { return "?".to_owned() };
        let element = || id(it, 0).unwrap_or(0);
        match it.class.opcode {
            Op::TypeBool => "bool".to_owned(),
            Op::TypeInt if it.operands.get(1).and_then(number) == Some(1) => "int".to_owned(),
            Op::TypeInt => "uint".to_owned(),
            Op::TypeFloat if it.operands.first().and_then(number) == Some(64) => "double".to_owned(),
            Op::TypeFloat => "float".to_owned(),
            Op::TypeVector => {
                let component = self.type_name(element());
                let prefix = if component == "float" { String::new() } else { component[..1].to_owned() };
                format!("{prefix}vec{}", it.operands.get(1).and_then(number).unwrap_or(0))
            }
            Op::TypeMatrix => {
                let columns = it.operands.get(1).and_then(number).unwrap_or(0);
                let rows = self.components(element());
                if rows == columns { format!("mat{columns}") } else { format!("mat{columns}x{rows}") }
            }
            Op::TypeArray => format!("{}[{}]", self.type_name(element()), self.array_length(it)),
            Op::TypeRuntimeArray => format!("{}[]", self.type_name(element())),
            _ => self.name(ty).to_owned(),
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
        let last = |first: u32, ty: u32| first.saturating_add(self.locations(ty).saturating_sub(1));
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

    /// How many locations a value of type `ty` takes.
    fn locations(&self, ty: u32) -> u32 {
        let Some(it) = self.global(ty) else { return 1 };
        let element = || id(it, 0).map_or(1, |element| self.locations(element));
        match it.class.opcode {
            Op::TypeMatrix => it.operands.get(1).and_then(number).unwrap_or(1),
            Op::TypeArray => self.array_length(it).saturating_mul(element()),
            Op::TypeStruct => {
                let members = it.operands.iter().filter_map(Operand::id_ref_any);
                members.fold(0, |sum: u32, member| sum.saturating_add(self.locations(member)))
            }
            _ => 1,
        }
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

/// Storage class of a variable.
pub(super) fn storage_class(variable: &Instruction) -> Option<StorageClass> {
    match variable.operands.first() {
        Some(Operand::StorageClass(class)) => Some(*class),
        _ => None,
    }
}
