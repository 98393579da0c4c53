//! Parts of a shader stage that go wrong where its picture is turned.
//!
//! A stage knows of the rotation by the specialization constant of `include/rotation.glsl`. A function may read where the fragment
//! lies, or differentiate to one side: if it also looks at that constant, it is taken to know what it does. So is a vertex stage
//! that looks at it anywhere. What a function hands to another can't be followed, nor can positions that a vertex stage
//! only partly turns.

use super::eyes::EYE;
use super::module::{IndexedModule, id};
use super::module_checks;
use super::text::RefusedStage;
use crate::base::{ShaderStage, StageFacts};
use framewright_graph::shader::UnturnedPart;
use rspirv::dr::{Function, Instruction, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op};
use std::collections::HashSet;

/// The number of the constant that says by how much the picture is turned.
pub(super) const ROTATION: u32 = 100;

/// The constants of `include/rotation.glsl`, from that number on, which pipelines set by their numbers, and behind them the one that stands
/// for the eye in a text of HLSL or Slang.
const CONSTANTS: [&str; 4] = ["framewright_rotation", "framewright_turned_width", "framewright_turned_height", EYE];

/// The number of the constant that stands for the eye.
pub(super) const EYE_CONSTANT: u32 = ROTATION + CONSTANTS.len() as u32 - 1;

/// That a stage which draws has no constant of its own in the place of one of these.
pub(super) fn check_constants(module: &IndexedModule<'_>, stage: ShaderStage) -> Result<(), RefusedStage> {
    if !stage.facts().draws {
        return Ok(());
    }
    for it in &module.module.types_global_values {
        let Some(constant) = it.result_id else { continue };
        let Some(number) = module.decoration_number(constant, Decoration::SpecId) else { continue };
        let own = number.checked_sub(ROTATION).and_then(|at| CONSTANTS.get(at as usize));
        let name = module.name(constant);
        if own.is_some_and(|own| *own != name) {
            let what = format!(
                "`{name}` has the `constant_id` {number}: {ROTATION} to {EYE_CONSTANT} say how pictures are turned and which eye is \
                 drawn for, and would change it; take another number"
            );
            return Err(RefusedStage::named(name, what));
        }
    }
    Ok(())
}

/// The parts that go wrong.
pub(super) fn unturned(module: &IndexedModule<'_>, stage: ShaderStage) -> Vec<UnturnedPart> {
    let rotation = known_by(module);
    let functions = module.module.functions.iter();
    let looks = |function: &&Function| code(function).any(|it| mentions(it, &rotation));
    let knowing: HashSet<u32> = functions.clone().filter(looks).filter_map(module_checks::of).collect();
    let functions = functions.filter(|function| !looks(function));
    let StageFacts { places_vertices, writes_attachments, .. } = stage.facts();
    if places_vertices {
        let all = module.module.functions.len();
        return if functions.count() == all { vec![UnturnedPart::Vertices] } else { Vec::new() };
    }
    if !writes_attachments {
        return Vec::new();
    }
    let places = places(module);
    let (mut reads, mut differentiates) = (false, false);
    for function in functions {
        let is_raw = |it: &Instruction| !is_beyond_y(module, it) && !is_handed_on(function, it, &knowing);
        reads |= code(function).any(|it| mentions(it, &places) && is_raw(it));
        differentiates |= code(function).any(|it| is_sideways(it.class.opcode));
    }
    let found = [(reads, UnturnedPart::FragCoord), (differentiates, UnturnedPart::Derivatives)];
    found.into_iter().filter(|(found, _)| *found).map(|(_, what)| what).collect()
}

fn code(function: &Function) -> impl Iterator<Item = &Instruction> {
    function.blocks.iter().flat_map(|it| &it.instructions)
}

fn mentions(instruction: &Instruction, ids: &HashSet<u32>) -> bool {
    instruction.operands.iter().filter_map(Operand::id_ref_any).any(|id| ids.contains(&id))
}

/// The constant and all constants that follow from it.
fn known_by(module: &IndexedModule<'_>) -> HashSet<u32> {
    let mut known = HashSet::new();
    // SPIR-V declares a constant after those that it is made of.
    for it in &module.module.types_global_values {
        let Some(result) = it.result_id else { continue };
        let is_it = || module.decoration_number(result, Decoration::SpecId) == Some(ROTATION);
        let of_it = it.class.opcode == Op::SpecConstantOp && mentions(it, &known);
        if of_it || it.class.opcode == Op::SpecConstant && is_it() {
            known.insert(result);
        }
    }
    known
}

/// The variables that say where in the picture a fragment or sample lies.
fn places(module: &IndexedModule<'_>) -> HashSet<u32> {
    let is_place = |id: u32| {
        let built_in = module.decoration(id, Decoration::BuiltIn).flatten();
        matches!(built_in, Some(Operand::BuiltIn(BuiltIn::FragCoord | BuiltIn::SamplePosition)))
    };
    module.variables().map(|(id, _)| id).filter(|id| is_place(*id)).collect()
}

/// Whether an instruction only reaches for depth or 1/w, which no rotation changes.
fn is_beyond_y(module: &IndexedModule<'_>, it: &Instruction) -> bool {
    let component = || id(it, 1).and_then(|index| module.constant(index));
    it.class.opcode == Op::AccessChain && component().is_some_and(|component| component >= 2)
}

/// Whether an instruction loads a place that its function only hands to others, which know of the rotation: `frag_coord(position)` of
/// `include/rotation.hlsl`, where the compiler leaves functions as they are.
fn is_handed_on(function: &Function, it: &Instruction, knowing: &HashSet<u32>) -> bool {
    let Some(loaded) = it.result_id.filter(|_| it.class.opcode == Op::Load) else { return false };
    let mut uses = code(function).filter(|it| it.operands.contains(&Operand::IdRef(loaded)));
    uses.all(|it| it.class.opcode == Op::FunctionCall && id(it, 0).is_some_and(|callee| knowing.contains(&callee)))
}

/// Whether an instruction differentiates to one side; the sum over both sides stays what it is.
fn is_sideways(opcode: Op) -> bool {
    matches!(opcode, Op::DPdx | Op::DPdy | Op::DPdxFine | Op::DPdyFine | Op::DPdxCoarse | Op::DPdyCoarse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// ST-5: a shipped file declares a constant by its own number; this is where the numbers stand.
    #[test]
    fn shipped_files_declare_the_constants_of_rotation_and_eye_by_their_numbers() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shaders/include");
        let mut declared = Vec::new();
        for file in std::fs::read_dir(folder).expect("the folder is there") {
            let text = std::fs::read_to_string(file.expect("an entry").path()).expect("a text");
            for line in text.lines().filter(|line| line.contains("constant_id")) {
                // `layout(constant_id = 100) const uint name = 0u;`, or `[[vk::constant_id(100)]] const uint name = 0;`.
                let (before, _) = line.rsplit_once(" = ").expect("it has a value");
                let name = before.rsplit(' ').next().expect("a name").to_owned();
                let number: String = before.chars().filter(char::is_ascii_digit).collect();
                declared.push((name, number.parse::<u32>().expect("a number")));
            }
        }
        for (number, name) in (ROTATION..).zip(CONSTANTS) {
            let numbers: Vec<u32> = declared.iter().filter(|(of, _)| of == name).map(|it| it.1).collect();
            assert!(!numbers.is_empty() && numbers.iter().all(|it| *it == number), "{name}: {numbers:?}, not {number}");
        }
        assert!(declared.iter().all(|(name, _)| CONSTANTS.contains(&&**name)), "{declared:?}");
    }
}
