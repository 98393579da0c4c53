//! What a fragment stage may leave as it was: samples that it leaves out, and outputs that it doesn't set on every path.
//!
//! An output counts as set where each path through the control flow graph, from the beginning of the entry point to its end,
//! stores to all its components, in the entry point itself or in functions that it calls. A path that ends the invocation has
//! no outputs. Both ways of a branch count as taken, whatever is known of its condition, but for one on a constant. A loop may end before
//! its first round. An output is perhaps set if it is set where each loop has a round, and an index takes all its values.

use super::module::{IndexedModule, id, storage_class};
use framewright_graph::shader::UnsetOutput;
use rspirv::dr::{Function, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op, StorageClass};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// Words of a text that discard fragments.
pub(super) const DISCARDS: &[&str] = &["discard", "demote", "terminateInvocation"];
/// Words of a text that leave samples out.
pub(super) const MASKS_SAMPLES: &[&str] = &["gl_SampleMask"];

/// Whether it writes the mask of covered samples.
pub(super) fn writes_sample_mask(module: &IndexedModule<'_>, used: &HashSet<u32>) -> bool {
    sample_masks(module, used).any(|class| class == StorageClass::Output)
}

/// Whether it writes the mask of covered samples, or reads it.
pub(super) fn uses_sample_mask(module: &IndexedModule<'_>, used: &HashSet<u32>) -> bool {
    sample_masks(module, used).next().is_some()
}

/// The storage classes of the masks of samples that it uses.
fn sample_masks(module: &IndexedModule<'_>, used: &HashSet<u32>) -> impl Iterator<Item = StorageClass> {
    let masks =
        module.variables().filter(|(id, _)| used.contains(id) && built_in(module, *id) == Some(BuiltIn::SampleMask));
    masks.filter_map(|(_, it)| storage_class(it))
}

fn built_in(module: &IndexedModule<'_>, id: u32) -> Option<BuiltIn> {
    match module.decoration(id, Decoration::BuiltIn) {
        Some(Some(Operand::BuiltIn(built_in))) => Some(*built_in),
        _ => None,
    }
}

/// The outputs of a fragment stage, its depth included, that aren't set on every path, by location; depth comes first.
pub(super) fn unset(module: &IndexedModule<'_>) -> Vec<UnsetOutput> {
    let outputs = Outputs::of(module);
    let entry = module.module.entry_points.first().and_then(|entry| id(entry, 1));
    let (Some(entry), false) = (entry, outputs.variables.is_empty()) else { return Vec::new() };
    let functions: HashMap<u32, &Function> =
        module.module.functions.iter().filter_map(|it| Some((it.def.as_ref()?.result_id?, it))).collect();
    let order = callees_first(entry, &functions);
    let mut ever = Set::none(outputs.bits);
    // What the entry point itself reads of outputs where no path has set it.
    let mut read_before: Vec<Range<usize>> = Vec::new();
    let [always, perhaps] = [Rounds::AnyNumber, Rounds::AtLeastOne].map(|rounds| {
        let mut always = HashMap::new();
        // A function is looked at after those that it calls.
        for function in order.iter().filter_map(|number| functions.get(number).copied()) {
            let paths = Paths::of(module, function, &outputs, (&always, rounds), &mut ever);
            let number = function.def.as_ref().and_then(|def| def.result_id);
            let (set, read) = paths.set_at_the_end();
            if number == Some(entry) && rounds == Rounds::AtLeastOne {
                read_before = read;
            }
            always.extend(number.map(|number| (number, set)));
        }
        always.remove(&entry).unwrap_or_else(|| Set::none(outputs.bits))
    });
    let mut unset: Vec<UnsetOutput> = Vec::new();
    for output in &outputs.variables {
        let own = output.first..output.first + output.elements() * output.components;
        if read_before.iter().any(|read| own.contains(&read.start)) {
            let name = module.name(output.variable).to_owned();
            let what = format!("reads `{name}` before it sets it");
            unset.push(UnsetOutput { location: output.location, name, what, refused: true, place: None });
        } else {
            unset.extend(output.unset(module, [&always, &perhaps, &ever]));
        }
    }
    unset.sort_by_key(|it| it.location);
    unset
}

/// Functions that the entry point calls, directly or not, each behind those that it calls; the entry point is last.
fn callees_first(entry: u32, functions: &HashMap<u32, &Function>) -> Vec<u32> {
    let callees = |number: u32| -> Vec<u32> {
        let code = functions.get(&number).into_iter().flat_map(|it| &it.blocks).flat_map(|it| &it.instructions);
        code.filter(|it| it.class.opcode == Op::FunctionCall).filter_map(|it| id(it, 0)).collect()
    };
    let (mut order, mut seen) = (Vec::new(), HashSet::from([entry]));
    let mut open = vec![(entry, callees(entry))];
    while let Some((number, left)) = open.last_mut() {
        match left.pop() {
            Some(callee) if seen.insert(callee) => open.push((callee, callees(callee))),
            Some(_) => {}
            None => {
                order.push(*number);
                open.pop();
            }
        }
    }
    order
}

/// A set of components of outputs.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Set(Vec<u64>);

impl Set {
    fn none(bits: usize) -> Set {
        Set(vec![0; bits.div_ceil(64)])
    }

    fn all(bits: usize) -> Set {
        Set(vec![u64::MAX; bits.div_ceil(64)])
    }

    fn add(&mut self, bits: Range<usize>) {
        bits.for_each(|bit| self.0[bit / 64] |= 1 << (bit % 64));
    }

    fn add_all_of(&mut self, other: &Set) {
        self.0.iter_mut().zip(&other.0).for_each(|(own, other)| *own |= other);
    }

    fn keep_those_of(&mut self, other: &Set) {
        self.0.iter_mut().zip(&other.0).for_each(|(own, other)| *own &= other);
    }

    fn has(&self, bit: usize) -> bool {
        self.0[bit / 64] >> (bit % 64) & 1 == 1
    }
}

/// An output, as a row of components: those of a vector, and of the elements of an array one after the other.
struct Output {
    variable: u32,
    location: Option<u32>,
    /// The lengths of an array, the outermost first.
    lengths: Vec<usize>,
    components: usize,
    first: usize,
}

impl Output {
    /// Those of its elements that aren't set on every path, with how much of them is set on every path, is so perhaps, and is set
    /// on any.
    fn unset(&self, module: &IndexedModule<'_>, [always, perhaps, ever]: [&Set; 3]) -> Vec<UnsetOutput> {
        let name = module.name(self.variable);
        let element = |number: usize| {
            let first = self.first + number * self.components;
            let lacks = |set: &Set| (0..self.components).filter(|at| !set.has(first + at)).collect::<Vec<_>>();
            let (never, sometimes, refused) = (lacks(ever), lacks(always), !lacks(perhaps).is_empty());
            if sometimes.is_empty() {
                return None;
            }
            let lacking = if never.is_empty() { &sometimes } else { &never };
            let place = if self.lengths.is_empty() { String::new() } else { format!("[{number}]") };
            let letters = match lacking.len() == self.components {
                true => String::new(),
                false => format!(".{}", lacking.iter().filter_map(|at| "xyzw".get(*at..=*at)).collect::<String>()),
            };
            let what = match never.is_empty() {
                true => format!("doesn't set `{name}{place}{letters}` on every path"),
                false => format!("never sets `{name}{place}{letters}`"),
            };
            let location =
                self.location.map(|location| location.saturating_add(u32::try_from(number).unwrap_or(u32::MAX)));
            Some(UnsetOutput { location, name: name.to_owned(), what, refused, place: None })
        };
        (0..self.elements()).filter_map(element).collect()
    }

    /// How many vectors or scalars it consists of.
    fn elements(&self) -> usize {
        self.lengths.iter().product()
    }
}

/// The outputs whose values count: those with a location, and the depth.
struct Outputs {
    variables: Vec<Output>,
    by_id: HashMap<u32, usize>,
    bits: usize,
}

impl Outputs {
    fn of(module: &IndexedModule<'_>) -> Outputs {
        let mut outputs = Outputs { variables: Vec::new(), by_id: HashMap::new(), bits: 0 };
        for (variable, it) in module.variables().filter(|(_, it)| storage_class(it) == Some(StorageClass::Output)) {
            let location = module.decoration_number(variable, Decoration::Location);
            if location.is_none() && built_in(module, variable) != Some(BuiltIn::FragDepth) {
                continue;
            }
            // A variable that is initialised is set.
            let initialised = it.operands.len() > 1;
            let Some(mut ty) = module.pointee(it).filter(|_| !initialised) else { continue };
            let mut lengths = Vec::new();
            while ty.class.opcode == Op::TypeArray {
                lengths.push(module.array_length(ty) as usize);
                let Some(element) = id(ty, 0).and_then(|element| module.global(element)) else { break };
                ty = element;
            }
            let components = ty.result_id.map_or(1, |ty| module.components(ty)) as usize;
            let bits = lengths.iter().fold(components, |bits, length| bits.saturating_mul(*length));
            // The number of outputs is bounded elsewhere.
            if bits > MOST_COMPONENTS {
                continue;
            }
            outputs.by_id.insert(variable, outputs.variables.len());
            outputs.variables.push(Output { variable, location, lengths, components, first: outputs.bits });
            outputs.bits += bits;
        }
        outputs
    }

    /// The components that `pointer`, an output or a part of one, points to; `None`: it points to something else.
    fn pointed_to(&self, pointer: u32, chains: &HashMap<u32, (u32, Vec<Index>)>) -> Option<(Range<usize>, bool)> {
        let (variable, path) = chains.get(&pointer).map_or((pointer, &[][..]), |(variable, path)| (*variable, path));
        let output = &self.variables[*self.by_id.get(&variable)?];
        let whole = output.first..output.first + output.elements() * output.components;
        let (mut known, mut range) = (true, whole.clone());
        let mut sizes = output.lengths.iter().copied().chain([output.components]);
        for index in path {
            let Some(count) = sizes.next() else { return Some((whole, false)) };
            let length = range.len() / count.max(1);
            match index {
                Index::Constant(at) if (*at as usize) < count => {
                    let first = range.start + *at as usize * length;
                    range = first..first + length;
                }
                Index::Constant(_) | Index::Unknown => {
                    known = false;
                    break;
                }
            }
        }
        Some((range, known))
    }
}

/// More components than the outputs of any stage that is taken.
const MOST_COMPONENTS: usize = 256 * 4;

/// An index into an array or a vector.
#[derive(Debug, Clone, Copy)]
enum Index {
    Constant(u32),
    Unknown,
}

/// How many rounds a loop is taken to have, and which of its values an index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rounds {
    /// Any number, and any of them.
    AnyNumber,
    /// One at least, and all of them; a function sets what a pointer that it is given points to.
    AtLeastOne,
}

/// The control flow graph of a function, with what is set in each block.
struct Paths {
    blocks: Vec<Block>,
    bits: usize,
}

/// A block: what it sets, where it leads to, and how it ends.
struct Block {
    sets: Set,
    /// What it reads, each with what it has set before.
    reads: Vec<(Range<usize>, Set)>,
    next: Vec<usize>,
    returns: bool,
}

impl Paths {
    /// `always`: what each function sets that this one calls. All that may be set is added to `ever`.
    fn of(
        module: &IndexedModule<'_>,
        function: &Function,
        outputs: &Outputs,
        (always, rounds): (&HashMap<u32, Set>, Rounds),
        ever: &mut Set,
    ) -> Paths {
        let bits = outputs.bits;
        let label = |block: &rspirv::dr::Block| block.label.as_ref().and_then(|label| label.result_id);
        let numbers: HashMap<u32, usize> =
            function.blocks.iter().enumerate().filter_map(|(number, block)| Some((label(block)?, number))).collect();
        let mut chains: HashMap<u32, (u32, Vec<Index>)> = HashMap::new();
        let mut blocks: Vec<Block> = Vec::with_capacity(function.blocks.len());
        // The header of each loop, the block behind it, and the one that leads to its next round.
        let mut loops = Vec::new();
        for block in &function.blocks {
            let (mut sets, mut next, mut returns) = (Set::none(bits), Vec::new(), false);
            let mut reads = Vec::new();
            let mut leads_to = |label: Option<u32>| next.extend(label.and_then(|label| numbers.get(&label).copied()));
            for it in &block.instructions {
                match it.class.opcode {
                    Op::AccessChain | Op::InBoundsAccessChain => {
                        let (Some(base), Some(result)) = (id(it, 0), it.result_id) else { continue };
                        let (variable, mut path) = chains.get(&base).cloned().unwrap_or((base, Vec::new()));
                        if outputs.by_id.contains_key(&variable) {
                            path.extend(it.operands.iter().skip(1).map(|index| index_of(module, index)));
                            chains.insert(result, (variable, path));
                        }
                    }
                    Op::CopyObject => {
                        let (Some(base), Some(result)) = (id(it, 0), it.result_id) else { continue };
                        let copied = chains.get(&base).cloned().unwrap_or((base, Vec::new()));
                        if outputs.by_id.contains_key(&copied.0) {
                            chains.insert(result, copied);
                        }
                    }
                    Op::Store | Op::CopyMemory => {
                        let Some((range, known)) = id(it, 0).and_then(|to| outputs.pointed_to(to, &chains)) else {
                            continue;
                        };
                        ever.add(range.clone());
                        if known || rounds == Rounds::AtLeastOne {
                            sets.add(range);
                        }
                    }
                    Op::Load => {
                        let range = id(it, 0).and_then(|from| outputs.pointed_to(from, &chains));
                        reads.extend(range.map(|(range, _)| (range, sets.clone())));
                    }
                    Op::FunctionCall => {
                        if let Some(called) = id(it, 0).and_then(|callee| always.get(&callee)) {
                            sets.add_all_of(called);
                        }
                        // What is handed over may be set, or not.
                        let handed = it.operands.iter().skip(1).filter_map(Operand::id_ref_any);
                        for (range, _) in handed.filter_map(|it| outputs.pointed_to(it, &chains)) {
                            ever.add(range.clone());
                            if rounds == Rounds::AtLeastOne {
                                sets.add(range);
                            }
                        }
                    }
                    // What follows has no effect.
                    Op::DemoteToHelperInvocation => sets = Set::all(bits),
                    Op::LoopMerge => loops.push((blocks.len(), id(it, 0), id(it, 1))),
                    Op::Branch => leads_to(id(it, 0)),
                    Op::BranchConditional => {
                        let condition =
                            id(it, 0).and_then(|condition| module.global(condition)).map(|it| it.class.opcode);
                        if condition != Some(Op::ConstantFalse) {
                            leads_to(id(it, 1));
                        }
                        if condition != Some(Op::ConstantTrue) {
                            leads_to(id(it, 2));
                        }
                    }
                    Op::Switch => it.operands.iter().skip(1).for_each(|to| {
                        if let Operand::IdRef(label) = to {
                            leads_to(Some(*label));
                        }
                    }),
                    Op::Return | Op::ReturnValue => returns = true,
                    _ => {}
                }
            }
            blocks.push(Block { sets, reads, next, returns });
        }
        for (header, behind, again) in loops.into_iter().filter(|_| rounds == Rounds::AtLeastOne) {
            let number = |label: Option<u32>| label.and_then(|label| numbers.get(&label).copied());
            let (Some(behind), Some(again)) = (number(behind), number(again)) else { continue };
            // The condition stands in the header, or right behind it.
            let first = match blocks[header].next[..] {
                [next] => next,
                _ => header,
            };
            if blocks[first].next.len() > 1 && blocks[first].next.contains(&behind) {
                blocks[first].next.retain(|next| *next != behind);
                blocks[again].next.push(behind);
            }
        }
        Paths { blocks, bits }
    }

    /// What is set on every path through the function that returns; all, if none does. And what it reads although no component of it
    /// is set on every path to there. (A load of a whole vector may be meant to read a part of it.)
    fn set_at_the_end(&self) -> (Set, Vec<Range<usize>>) {
        let mut at_the_end = Set::all(self.bits);
        if self.blocks.is_empty() {
            return (Set::none(self.bits), Vec::new());
        }
        // What is set where each block begins; `None`: no path was found to it yet.
        let mut before: Vec<Option<Set>> = vec![None; self.blocks.len()];
        before[0] = Some(Set::none(self.bits));
        let (mut open, mut is_open) = (vec![0], vec![false; self.blocks.len()]);
        while let Some(number) = open.pop() {
            is_open[number] = false;
            let Some(mut set) = before[number].clone() else { continue };
            let block = &self.blocks[number];
            set.add_all_of(&block.sets);
            for next in &block.next {
                let known = before[*next].take();
                let mut met = known.clone().unwrap_or_else(|| set.clone());
                met.keep_those_of(&set);
                if known.as_ref() != Some(&met) && !std::mem::replace(&mut is_open[*next], true) {
                    open.push(*next);
                }
                before[*next] = Some(met);
            }
        }
        let mut read = Vec::new();
        for (block, before) in self.blocks.iter().zip(before) {
            let Some(mut set) = before else { continue };
            let unset = |range: &Range<usize>, own: &Set| range.clone().all(|bit| !set.has(bit) && !own.has(bit));
            read.extend(block.reads.iter().filter(|(range, own)| unset(range, own)).map(|(range, _)| range.clone()));
            if block.returns {
                set.add_all_of(&block.sets);
                at_the_end.keep_those_of(&set);
            }
        }
        (at_the_end, read)
    }
}

/// The index that an operand of an access chain is.
fn index_of(module: &IndexedModule<'_>, operand: &Operand) -> Index {
    let constant = operand.id_ref_any().and_then(|index| module.global(index));
    let constant = constant.filter(|it| it.class.opcode == Op::Constant).and_then(|it| it.result_id);
    constant.and_then(|index| module.constant(index)).map_or(Index::Unknown, Index::Constant)
}
