//! The eye in the code of a module: in place of constants that stand for it and of the index of a view, and the number of an instance
//! without the eye that it tells.

use super::module::id;
use super::text::RefusedStage;
use framewright_graph::shader::EyeSource;
use rspirv::dr::{Builder, Function, Instruction, Operand};
use rspirv::spirv::{Op, StorageClass, Word};
use std::collections::{HashMap, HashSet};

/// The largest number of an instance of one eye, where the highest bit says which eye.
const WITHOUT_BIT: u32 = 0x7fff_ffff;

/// Where the eye comes from.
#[derive(Clone, Copy)]
enum Source {
    Variable(Word),
    Constant(Word),
}

/// What is put in place of what.
pub(super) struct EyeValues {
    eye: Source,
    /// Specialization constants that stand for the eye.
    pub(super) constants: Vec<Word>,
    /// Input variables that hold the index of a view.
    pub(super) views: Vec<Word>,
    /// Input variables that hold numbers of instances.
    pub(super) instances: Vec<Word>,
    /// How these numbers tell the eye.
    pub(super) counted: Option<EyeSource>,
    /// Private variables that begin with a value that the eye decides: the variable, and that value. The entry point sets them.
    begun: Vec<(Word, Word)>,
    /// What follows from the eye, in its order: it is calculated where it is used.
    following: Vec<Instruction>,
}

impl EyeValues {
    /// The eye that a variable holds.
    pub(super) fn of(variable: Word) -> EyeValues {
        EyeValues::from(Source::Variable(variable))
    }

    /// One eye.
    pub(super) fn constant(value: Word) -> EyeValues {
        EyeValues::from(Source::Constant(value))
    }

    fn from(eye: Source) -> EyeValues {
        EyeValues {
            eye,
            constants: Vec::new(),
            views: Vec::new(),
            instances: Vec::new(),
            counted: None,
            begun: Vec::new(),
            following: Vec::new(),
        }
    }

    /// Puts it into all functions.
    ///
    /// # Errors
    /// What can't depend on the eye.
    pub(super) fn put(&mut self, builder: &mut Builder) -> Result<(), RefusedStage> {
        self.take_constants(builder)?;
        let mut functions = std::mem::take(&mut builder.module_mut().functions);
        for function in &mut functions {
            self.loads(builder, function)?;
            self.calculate(builder, function);
        }
        let module = builder.module_mut();
        module.functions = functions;
        let gone: HashSet<Word> = self.views.iter().copied().chain(self.replaced()).collect();
        module.types_global_values.retain(|it| it.result_id.is_none_or(|id| !gone.contains(&id)));
        let names = |it: &Instruction| id(it, 0).is_some_and(|of| gone.contains(&of));
        module.annotations.retain(|it| !names(it));
        module.debug_names.retain(|it| !names(it));
        for point in &mut module.entry_points {
            point.operands.retain(|it| it.id_ref_any().is_none_or(|id| !gone.contains(&id)));
        }
        Ok(())
    }

    /// The constants that stand for the eye, and all that follows from them.
    fn replaced(&self) -> impl Iterator<Item = Word> {
        self.constants.iter().copied().chain(self.following.iter().filter_map(|it| it.result_id))
    }

    /// Finds what follows from the constants.
    fn take_constants(&mut self, builder: &mut Builder) -> Result<(), RefusedStage> {
        let mut known: HashSet<Word> = self.constants.iter().copied().collect();
        if known.is_empty() {
            return Ok(());
        }
        for it in &mut builder.module_mut().types_global_values {
            let follows = it.operands.iter().filter_map(Operand::id_ref_any).any(|id| known.contains(&id));
            if !follows {
                continue;
            }
            match it.class.opcode {
                Op::SpecConstantOp | Op::SpecConstantComposite | Op::ConstantComposite => {
                    known.extend(it.result_id);
                    self.following.push(it.clone());
                }
                Op::Variable if it.operands.first() == Some(&Operand::StorageClass(StorageClass::Private)) => {
                    let value = it.operands.pop().and_then(|value| value.id_ref_any());
                    self.begun.extend(it.result_id.zip(value));
                }
                _ => {
                    let what = "the length of an array, or a type, depends on the eye that is drawn for: it is one of both eyes'";
                    return Err(RefusedStage::beginning(&["eye_index", "scale_offset"], what.to_owned()));
                }
            }
        }
        Ok(())
    }

    /// Puts the eye in place of what is loaded as the index of a view, and an eye's own number in place of that of an instance.
    fn loads(&self, builder: &mut Builder, function: &mut Function) -> Result<(), RefusedStage> {
        let is_own = |operand: &Operand| {
            operand.id_ref_any().is_some_and(|id| self.views.contains(&id) || self.instances.contains(&id))
        };
        for block in &mut function.blocks {
            if !block.instructions.iter().any(|it| it.operands.iter().any(is_own)) {
                continue;
            }
            let given = std::mem::take(&mut block.instructions);
            for mut it in given {
                let from = id(&it, 0).filter(|_| it.class.opcode == Op::Load && is_own(&it.operands[0]));
                match from {
                    None if !it.operands.iter().any(is_own) => block.instructions.push(it),
                    None => {
                        let what =
                            "it hands the index of a view, or the number of an instance, to a function as a variable";
                        let words: &'static [&'static str] =
                            &["SV_ViewID", "SV_InstanceID", "gl_ViewIndex", "gl_InstanceIndex"];
                        return Err(RefusedStage::beginning(words, what.to_owned()));
                    }
                    Some(from) if self.views.contains(&from) => {
                        let (ty, result) = (it.result_type.unwrap_or(0), it.result_id.unwrap_or(0));
                        self.eye(builder, &mut block.instructions, ty, result);
                    }
                    Some(_) => {
                        let (ty, result, raw) = (it.result_type.unwrap_or(0), it.result_id, builder.id());
                        it.result_id = Some(raw);
                        block.instructions.push(it);
                        let (op, number) = match self.counted {
                            Some(EyeSource::InstanceParity) => (Op::ShiftRightLogical, 1),
                            _ => (Op::BitwiseAnd, WITHOUT_BIT),
                        };
                        let number = builder.constant_bit32(ty, number);
                        let operands = vec![Operand::IdRef(raw), Operand::IdRef(number)];
                        block.instructions.push(Instruction::new(op, Some(ty), result, operands));
                    }
                }
            }
        }
        Ok(())
    }

    /// The eye as the value `result` of a type, an integer of 32 bits.
    fn eye(&self, builder: &mut Builder, made: &mut Vec<Instruction>, ty: Word, result: Word) {
        let int = builder.type_int(32, 1);
        let value = match self.eye {
            Source::Constant(value) => value,
            Source::Variable(variable) => {
                let value = if ty == int { result } else { builder.id() };
                made.push(Instruction::new(Op::Load, Some(int), Some(value), vec![Operand::IdRef(variable)]));
                value
            }
        };
        if value != result {
            let op = if ty == int { Op::CopyObject } else { Op::Bitcast };
            made.push(Instruction::new(op, Some(ty), Some(result), vec![Operand::IdRef(value)]));
        }
    }

    /// Calculates at the beginning of a function what of the eye it uses.
    fn calculate(&self, builder: &mut Builder, function: &mut Function) {
        let mut used = HashSet::new();
        let ids = function.all_inst_iter().flat_map(|it| &it.operands);
        used.extend(ids.filter_map(Operand::id_ref_any));
        let replaced: HashSet<Word> = self.replaced().collect();
        if used.is_disjoint(&replaced) {
            return;
        }
        let (made, values) = self.calculated(builder, &used);
        let Some(first) = function.blocks.first_mut() else { return };
        let variables = first.instructions.iter().rposition(|it| it.class.opcode == Op::Variable);
        let at = variables.map_or(0, |last| last + 1);
        // A variable of the function's can't begin with what isn't known before.
        let mut begun = Vec::new();
        for it in &mut first.instructions[..at] {
            let value = it.operands.get(1).and_then(Operand::id_ref_any).filter(|value| values.contains_key(value));
            if let (Op::Variable, Some(value), Some(variable)) = (it.class.opcode, value, it.result_id) {
                it.operands.truncate(1);
                let operands = vec![Operand::IdRef(variable), Operand::IdRef(value)];
                begun.push(Instruction::new(Op::Store, None, None, operands));
            }
        }
        first.instructions.splice(at..at, begun);
        for it in function.blocks.iter_mut().flat_map(|block| &mut block.instructions) {
            for operand in it.operands.iter_mut().filter_map(Operand::id_ref_any_mut) {
                *operand = values.get(operand).copied().unwrap_or(*operand);
            }
        }
        if let Some(first) = function.blocks.first_mut() {
            first.instructions.splice(at..at, made);
        }
    }

    /// Instructions that calculate what is wanted, and by what stood for it the value.
    fn calculated(&self, builder: &mut Builder, wanted: &HashSet<Word>) -> (Vec<Instruction>, HashMap<Word, Word>) {
        let mut needed = wanted.clone();
        for it in self.following.iter().rev() {
            if it.result_id.is_some_and(|id| needed.contains(&id)) {
                needed.extend(it.operands.iter().filter_map(Operand::id_ref_any));
            }
        }
        let (mut made, mut values) = (Vec::new(), HashMap::new());
        let int = builder.type_int(32, 1);
        for constant in self.constants.iter().filter(|constant| needed.contains(*constant)) {
            let value = builder.id();
            self.eye(builder, &mut made, int, value);
            values.insert(*constant, value);
        }
        for it in self.following.iter().filter(|it| it.result_id.is_some_and(|id| needed.contains(&id))) {
            let mut calculated = it.clone();
            let value = builder.id();
            let op = match calculated.operands.first() {
                Some(Operand::LiteralSpecConstantOpInteger(op)) => Some(*op),
                _ => None,
            };
            if op.is_some() {
                calculated.operands.remove(0);
            }
            for operand in calculated.operands.iter_mut().filter_map(Operand::id_ref_any_mut) {
                *operand = values.get(operand).copied().unwrap_or(*operand);
            }
            let op = op.unwrap_or(Op::CompositeConstruct);
            made.push(Instruction::new(op, it.result_type, Some(value), calculated.operands));
            values.extend(it.result_id.map(|was| (was, value)));
        }
        (made, values)
    }

    /// Sets the variables that begin with what follows from the eye, in the block that is being built.
    pub(super) fn initialise(&self, builder: &mut Builder) -> Result<(), rspirv::dr::Error> {
        let wanted: HashSet<Word> = self.begun.iter().map(|(_, value)| *value).collect();
        let (made, values) = self.calculated(builder, &wanted);
        for it in made {
            builder.insert_into_block(rspirv::dr::InsertPoint::End, it)?;
        }
        for (variable, value) in &self.begun {
            builder.store(*variable, values.get(value).copied().unwrap_or(*value), None, [])?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rspirv::spirv::FunctionControl;

    /// ST-5: what a function is handed as a variable can't be replaced by the eye.
    #[test]
    fn the_index_of_a_view_is_handed_to_no_function_as_a_variable() {
        let put = |hands: bool| {
            let mut builder = Builder::new();
            let (void, int) = (builder.type_void(), builder.type_int(32, 1));
            let pointer = builder.type_pointer(None, StorageClass::Input, int);
            let private = builder.type_pointer(None, StorageClass::Private, int);
            let view = builder.variable(pointer, None, StorageClass::Input, None);
            let eye = builder.variable(private, None, StorageClass::Private, None);
            let takes = builder.type_function(void, [pointer]);
            let callee = builder.begin_function(void, None, FunctionControl::NONE, takes).expect("a function");
            builder.function_parameter(pointer).expect("in a function");
            builder.begin_block(None).expect("a block");
            match hands {
                true => _ = builder.function_call(void, None, callee, [view]).expect("in a block"),
                false => _ = builder.load(int, None, view, None, []).expect("in a block"),
            }
            builder.ret().expect("in a block");
            builder.end_function().expect("in a function");
            let mut values = EyeValues::of(eye);
            values.views.push(view);
            values.put(&mut builder).err().map(|refused| refused.what)
        };
        let what = put(true).expect("refused");
        assert!(what.starts_with("it hands the index of a view, or the number of an instance"), "{what}");
        assert_eq!(put(false), None);
    }
}
