//! What a stage does with the fourth component of the images that it samples, read off its SPIR-V.
//!
//! Values are followed from the image to where they go, through variables and functions, whichever way the code takes.
//! Conservative: it may report a read that doesn't happen, and never misses one. The code is not optimised: swizzles stand right behind what is
//! sampled, and helpers are functions.

use super::module::{IndexedModule, id, number, storage_class};
use framewright_graph::shader::AlphaUse;
use rspirv::dr::{Function, Instruction, Operand};
use rspirv::spirv::{GlslStd450Op, Op, StorageClass};
use std::collections::HashMap;

/// The component that is followed.
const ALPHA: u32 = 3;

/// Calls are followed so deep; alpha that is handed on deeper counts as read.
const DEEPEST: u32 = 64;

/// What steers the code and does nothing else.
const BRANCHES: [Op; 7] =
    [Op::Branch, Op::BranchConditional, Op::Switch, Op::SelectionMerge, Op::LoopMerge, Op::Return, Op::Unreachable];

/// What becomes of the alpha of the image variable `image`; `None`: nothing. `colors`: whether the fourth component of the
/// stage's outputs is alpha.
pub(super) fn used(module: &IndexedModule<'_>, image: u32, colors: bool) -> Option<AlphaUse> {
    let mut flow = Flow::new(module, image, colors);
    let main = module.module.entry_points.first().and_then(|entry| id(entry, 1))?;
    // What a function leaves in a global variable may be found by one that was followed before.
    while std::mem::take(&mut flow.found) && flow.used != Some(AlphaUse::Read) {
        flow.known.clear();
        flow.follow(main, &[]);
    }
    flow.used
}

/// What an id stands for, as far as the image is concerned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Tracked {
    /// The image itself, or a pointer to it.
    Image,
    /// A scalar that depends on its alpha, a vector of which the fourth component and no other does, or a pointer to either.
    Alpha,
}

/// What a function makes of what it is given.
#[derive(Debug, Clone, Default)]
struct CallResult {
    returned: Option<Tracked>,
    /// What it leaves behind its parameters.
    parameters: Vec<Option<Tracked>>,
}

/// A function, and what it is given.
type Call = (u32, Vec<Option<Tracked>>);

struct Flow<'m> {
    module: &'m IndexedModule<'m>,
    functions: HashMap<u32, &'m Function>,
    /// Types of results.
    types: HashMap<u32, u32>,
    /// Pointers to parts of what others point to.
    chains: HashMap<u32, &'m Instruction>,
    /// The image, and global variables.
    globals: HashMap<u32, Tracked>,
    known: HashMap<Call, CallResult>,
    colors: bool,
    used: Option<AlphaUse>,
    /// Functions that are being followed.
    depth: u32,
    /// Whether a global variable turned out to depend on alpha.
    found: bool,
}

/// A function that is being followed.
struct CallFrame {
    locals: HashMap<u32, Tracked>,
    returned: Option<Tracked>,
    /// Whether alpha decides which way the code takes.
    decided: bool,
    is_main: bool,
    found: bool,
}

impl<'m> Flow<'m> {
    fn new(module: &'m IndexedModule<'m>, image: u32, colors: bool) -> Flow<'m> {
        let all = &module.module.functions;
        let functions = all.iter().filter_map(|it| Some((it.def.as_ref()?.result_id?, it))).collect();
        let is_chain = |it: &&Instruction| matches!(it.class.opcode, Op::AccessChain | Op::InBoundsAccessChain);
        let chains = module.code().filter(is_chain).filter_map(|it| Some((it.result_id?, it))).collect();
        let code = module.code().chain(all.iter().flat_map(|it| &it.parameters));
        let variables = module.variables().map(|(_, it)| it);
        let types = code.chain(variables).filter_map(|it| Some((it.result_id?, it.result_type?))).collect();
        let globals = HashMap::from([(image, Tracked::Image)]);
        let known = HashMap::new();
        Flow { module, functions, types, chains, globals, known, colors, used: None, depth: 0, found: true }
    }

    /// Follows a function; GLSL has no recursion.
    fn follow(&mut self, function: u32, given: &[Option<Tracked>]) -> CallResult {
        let key = (function, given.to_vec());
        if let Some(made) = self.known.get(&key) {
            return made.clone();
        }
        let Some(code) = self.functions.get(&function).copied() else { return CallResult::default() };
        if self.depth == DEEPEST {
            self.read();
            return CallResult::default();
        }
        self.depth += 1;
        let parameters: Vec<u32> = code.parameters.iter().filter_map(|it| it.result_id).collect();
        let known = parameters.iter().zip(given).filter_map(|(parameter, given)| Some((*parameter, (*given)?)));
        let (is_main, locals) = (given.is_empty() && self.is_entry(function), known.collect());
        let mut frame = CallFrame { locals, returned: None, decided: false, is_main, found: true };
        while std::mem::take(&mut frame.found) && self.used != Some(AlphaUse::Read) {
            code.blocks.iter().flat_map(|it| &it.instructions).for_each(|it| self.step(&mut frame, it));
        }
        let parameters = parameters.iter().map(|parameter| frame.locals.get(parameter).copied()).collect();
        self.depth -= 1;
        let made = CallResult { returned: frame.returned, parameters };
        self.known.insert(key, made.clone());
        made
    }

    fn is_entry(&self, function: u32) -> bool {
        self.module.module.entry_points.iter().any(|entry| id(entry, 1) == Some(function))
    }

    fn step(&mut self, frame: &mut CallFrame, it: &Instruction) {
        if it.class.opcode == Op::FunctionCall && !frame.decided {
            return self.call(frame, it);
        }
        let of: Vec<Option<Tracked>> = it.operands.iter().map(|it| self.of(frame, it.id_ref_any()?)).collect();
        if frame.decided && !self.stays_inside(frame, it) {
            return self.read();
        }
        if let Some(Some(Tracked::Image)) = of.first() {
            return self.of_image(frame, it);
        }
        if !of.contains(&Some(Tracked::Alpha)) {
            return;
        }
        let is_alpha = |at: usize| of.get(at).copied().flatten() == Some(Tracked::Alpha);
        let literal = |at: usize| it.operands.get(at).and_then(number);
        match it.class.opcode {
            Op::Store if is_alpha(1) => id(it, 0).into_iter().for_each(|pointer| self.left_in(frame, pointer)),
            Op::Store | Op::SelectionMerge | Op::LoopMerge => {}
            Op::BranchConditional | Op::Switch if !frame.is_main => {
                frame.found |= !frame.decided;
                frame.decided = true;
            }
            Op::ReturnValue => self.returned(frame, it),
            Op::AccessChain | Op::InBoundsAccessChain => {
                let component = it.operands.get(1).and_then(Operand::id_ref_any);
                self.component(frame, it, component.and_then(|index| self.module.constant(index)));
            }
            Op::CompositeExtract => self.component(frame, it, literal(1)),
            Op::CompositeInsert if literal(2) == Some(ALPHA) => self.made(frame, it),
            Op::CompositeInsert if !is_alpha(0) => self.made(frame, it),
            // Only the fourth component of four may depend on it.
            Op::CompositeConstruct => {
                let last = it.operands.len() - 1;
                let scalar = it.operands[last].id_ref_any().is_some_and(|last| self.components_of(last) == 1);
                let only = (0..last).all(|at| !is_alpha(at)) && scalar;
                if only { self.made(frame, it) } else { self.read() }
            }
            Op::VectorShuffle => self.shuffle(frame, it, [is_alpha(0), is_alpha(1)]),
            // The scalar would reach all components.
            Op::VectorTimesScalar if !is_alpha(1) => self.made(frame, it),
            _ if is_component_wise(it) => {
                let same = |at: usize| {
                    it.operands[at].id_ref_any().map(|id| self.components_of(id)) == Some(self.components(it))
                };
                if (0..of.len()).all(|at| !is_alpha(at) || same(at)) { self.made(frame, it) } else { self.read() }
            }
            _ => self.read(),
        }
    }

    fn of(&self, frame: &CallFrame, id: u32) -> Option<Tracked> {
        frame.locals.get(&id).or_else(|| self.globals.get(&id)).copied()
    }

    /// Whether an instruction in a function in which alpha decides the way has no effect but on the function's own scalars,
    /// all of which depend on alpha then.
    fn stays_inside(&mut self, frame: &mut CallFrame, it: &Instruction) -> bool {
        let to = match it.class.opcode {
            Op::Store => id(it, 0),
            Op::Phi => it.result_id,
            Op::ReturnValue => id(it, 0),
            Op::AccessChain | Op::InBoundsAccessChain | Op::Label | Op::Variable => return true,
            opcode => return is_component_wise(it) || BRANCHES.contains(&opcode),
        };
        let Some(to) = to.filter(|to| self.components_of(*to) == 1 && self.module.global(*to).is_none()) else {
            // A constant that is returned is no less decided by alpha.
            let constant = it.class.opcode == Op::ReturnValue && to.is_some_and(|to| self.components_of(to) <= 1);
            if constant {
                frame.returned = Some(Tracked::Alpha);
            }
            return constant;
        };
        frame.found |= frame.locals.insert(to, Tracked::Alpha).is_none();
        true
    }

    /// What stands for the image is handed on, or looked up.
    fn of_image(&mut self, frame: &mut CallFrame, it: &Instruction) {
        match it.class.opcode {
            Op::Load | Op::Image | Op::SampledImage | Op::CopyObject => {
                let result = it.result_id.filter(|result| frame.locals.insert(*result, Tracked::Image).is_none());
                frame.found |= result.is_some();
            }
            Op::ImageGather if id(it, 2).is_none_or(|it| self.module.constant(it).is_none_or(|it| it == ALPHA)) => {
                self.read()
            }
            Op::ImageGather | Op::ImageDrefGather => {}
            _ if self.components(it) == 4 => self.made(frame, it),
            // A query of the image itself reads no texel.
            _ => {}
        }
    }

    /// Arguments become parameters, and what is returned the result.
    fn call(&mut self, frame: &mut CallFrame, it: &Instruction) {
        let Some(callee) = id(it, 0) else { return };
        let arguments: Vec<u32> = it.operands.iter().skip(1).filter_map(Operand::id_ref_any).collect();
        let given: Vec<Option<Tracked>> = arguments.iter().map(|argument| self.of(frame, *argument)).collect();
        let CallResult { returned, parameters } = self.follow(callee, &given);
        for ((argument, given), left) in arguments.into_iter().zip(given).zip(parameters) {
            if given.is_none() && left == Some(Tracked::Alpha) {
                self.left_in(frame, argument);
            }
        }
        if returned == Some(Tracked::Alpha) {
            self.made(frame, it);
        }
    }

    /// What a pointer points to depends on alpha.
    fn left_in(&mut self, frame: &mut CallFrame, pointer: u32) {
        if let Some(chain) = self.chains.get(&pointer) {
            let component = id(chain, 1).and_then(|index| self.module.constant(index));
            return match id(chain, 0).filter(|base| self.components_of(*base) == 4) {
                Some(base) if component == Some(ALPHA) => self.left_in(frame, base),
                _ => self.read(),
            };
        }
        if !matches!(self.components_of(pointer), 1 | 4) {
            return self.read();
        }
        match self.module.global(pointer).and_then(storage_class) {
            Some(StorageClass::Output) if self.colors && self.components_of(pointer) == 4 => {
                self.used = self.used.max(Some(AlphaUse::Passed));
            }
            Some(StorageClass::Private) => self.found |= self.globals.insert(pointer, Tracked::Alpha).is_none(),
            Some(_) => self.read(),
            None => frame.found |= frame.locals.insert(pointer, Tracked::Alpha).is_none(),
        }
    }

    fn returned(&mut self, frame: &mut CallFrame, it: &Instruction) {
        if id(it, 0).and_then(|value| self.of(frame, value)) == Some(Tracked::Alpha) {
            frame.returned = Some(Tracked::Alpha);
        }
    }

    /// One component of a vector, or a pointer to it.
    fn component(&mut self, frame: &mut CallFrame, it: &Instruction, component: Option<u32>) {
        match (component, it.operands.len()) {
            (Some(ALPHA), 2) => self.made(frame, it),
            (Some(0..ALPHA), 2) => {}
            _ => self.read(),
        }
    }

    /// Components of two vectors in another order.
    fn shuffle(&mut self, frame: &mut CallFrame, it: &Instruction, alpha: [bool; 2]) {
        let first = id(it, 0).map_or(0, |first| self.components_of(first));
        let is_alpha = |component: u32| match component.checked_sub(first) {
            None => alpha[0] && component == ALPHA,
            Some(component) => alpha[1] && component == ALPHA,
        };
        let taken = (2..it.operands.len()).filter(|at| number(&it.operands[*at]).is_some_and(is_alpha));
        match (&taken.collect::<Vec<_>>()[..], it.operands.len()) {
            ([], _) => {}
            // The last of four.
            ([5], 6) => self.made(frame, it),
            _ => self.read(),
        }
    }

    fn read(&mut self) {
        self.used = Some(AlphaUse::Read);
    }

    /// The result depends on alpha.
    fn made(&mut self, frame: &mut CallFrame, it: &Instruction) {
        let Some(result) = it.result_id else { return };
        match self.components(it) {
            1 | 4 => frame.found |= frame.locals.insert(result, Tracked::Alpha).is_none(),
            _ => self.read(),
        }
    }

    fn components(&self, it: &Instruction) -> u32 {
        it.result_id.map_or(0, |result| self.components_of(result))
    }

    /// Components of a value, or of what a pointer points to; 0 of what is neither a scalar nor a vector.
    fn components_of(&self, value: u32) -> u32 {
        let ty = self.types.get(&value).copied().or_else(|| self.module.global(value)?.result_type);
        let ty = ty.and_then(|ty| self.module.global(ty)).and_then(|ty| match ty.class.opcode {
            Op::TypePointer => id(ty, 1).and_then(|ty| self.module.global(ty)),
            _ => Some(ty),
        });
        match ty.map(|ty| (ty.class.opcode, ty.result_id)) {
            Some((Op::TypeBool | Op::TypeInt | Op::TypeFloat | Op::TypeVector, Some(ty))) => self.module.components(ty),
            _ => 0,
        }
    }
}

/// Whether each component of a result depends on the same components of the operands alone.
fn is_component_wise(it: &Instruction) -> bool {
    use GlslStd450Op::*;
    match it.class.opcode {
        Op::ExtInst => {
            let known = [
                FAbs,
                FSign,
                Floor,
                Ceil,
                Fract,
                Pow,
                Exp,
                Log,
                Exp2,
                Log2,
                Sqrt,
                InverseSqrt,
                FMin,
                UMin,
                SMin,
                FMax,
                UMax,
                SMax,
                FClamp,
                UClamp,
                SClamp,
                FMix,
                Step,
                SmoothStep,
                Fma,
                NMin,
                NMax,
                NClamp,
            ];
            let number = it.operands.get(1);
            matches!(number, Some(Operand::LiteralExtInstInteger(number)) if known.iter().any(|op| *op as u32 == *number))
        }
        Op::Load | Op::CopyObject | Op::Phi | Op::Select | Op::Bitcast => true,
        Op::FNegate | Op::FAdd | Op::FSub | Op::FMul | Op::FDiv | Op::FRem | Op::FMod => true,
        Op::SNegate | Op::IAdd | Op::ISub | Op::IMul | Op::UDiv | Op::SDiv | Op::UMod | Op::SRem | Op::SMod => true,
        Op::ConvertFToU | Op::ConvertFToS | Op::ConvertUToF | Op::ConvertSToF => true,
        Op::ShiftLeftLogical | Op::ShiftRightLogical | Op::ShiftRightArithmetic => true,
        Op::BitwiseAnd | Op::BitwiseOr | Op::BitwiseXor | Op::Not => true,
        Op::LogicalAnd | Op::LogicalOr | Op::LogicalNot | Op::LogicalEqual | Op::LogicalNotEqual => true,
        Op::IsNan | Op::IsInf | Op::IEqual | Op::INotEqual => true,
        Op::UGreaterThan | Op::UGreaterThanEqual | Op::ULessThan | Op::ULessThanEqual => true,
        Op::SGreaterThan | Op::SGreaterThanEqual | Op::SLessThan | Op::SLessThanEqual => true,
        Op::FOrdEqual | Op::FUnordNotEqual | Op::FOrdNotEqual | Op::FUnordEqual => true,
        Op::FOrdGreaterThan | Op::FOrdGreaterThanEqual | Op::FOrdLessThan | Op::FOrdLessThanEqual => true,
        _ => false,
    }
}
