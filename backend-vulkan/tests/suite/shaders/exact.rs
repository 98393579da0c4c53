//! What the SPIR-V of shipped shaders says to drivers: which sums they may not fuse with products; and what one of them gets wrong.

use framewright_graph::base::Root;
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::Variant;
use framewright_passes::draw::interfaces;
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::ShaderLibrary;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op, StorageClass};
use std::collections::{HashMap, HashSet};

/// Arithmetic that a compiler may fuse with other arithmetic, unless it is decorated.
const FUSED: [Op; 11] = [
    Op::FAdd,
    Op::FSub,
    Op::FMul,
    Op::FDiv,
    Op::FNegate,
    Op::VectorTimesScalar,
    Op::MatrixTimesScalar,
    Op::VectorTimesMatrix,
    Op::MatrixTimesVector,
    Op::MatrixTimesMatrix,
    Op::Dot,
];

fn ids(instruction: &Instruction) -> impl Iterator<Item = u32> + '_ {
    instruction.operands.iter().filter_map(Operand::id_ref_any)
}

/// The arithmetic that the outputs of a stage are made of, but for the position of its vertices: followed backwards through variables
/// and calls.
fn of_outputs(module: &Module) -> Vec<&Instruction> {
    let decorated = |id: u32, with: &dyn Fn(&Instruction) -> bool| {
        module.annotations.iter().any(|it| it.operands.first() == Some(&Operand::IdRef(id)) && with(it))
    };
    let position = |it: &Instruction| it.operands.contains(&Operand::BuiltIn(BuiltIn::Position));
    let outputs = module.types_global_values.iter().filter_map(|it| {
        let output = it.operands.first() == Some(&Operand::StorageClass(StorageClass::Output));
        let id = it.result_id.filter(|_| it.class.opcode == Op::Variable && output)?;
        // The block that holds the position is decorated by its members.
        let pointed = module.types_global_values.iter().find(|ty| ty.result_id == it.result_type)?.operands.get(1)?;
        (!decorated(id, &position) && !decorated(pointed.id_ref_any()?, &position)).then_some(id)
    });
    let mut made: HashMap<u32, &Instruction> = HashMap::new();
    // What a variable, a parameter or the result of a call may hold.
    let mut flows: HashMap<u32, Vec<u32>> = HashMap::new();
    let mut chains: HashMap<u32, u32> = HashMap::new();
    let parameters: HashMap<u32, Vec<u32>> = module
        .functions
        .iter()
        .filter_map(|it| Some((it.def_id()?, it.parameters.iter().filter_map(|it| it.result_id).collect())))
        .collect();
    for function in &module.functions {
        for it in function.blocks.iter().flat_map(|block| &block.instructions) {
            let named: Vec<u32> = ids(it).collect();
            if let Some(result) = it.result_id {
                made.insert(result, it);
            }
            match (it.class.opcode, &named[..]) {
                (Op::AccessChain, [base, ..]) => {
                    chains.insert(it.result_id.expect("a pointer"), *base);
                }
                (Op::Store, [to, value]) => {
                    let to = chains.get(to).unwrap_or(to);
                    flows.entry(*to).or_default().push(*value);
                }
                (Op::FunctionCall, [called, given @ ..]) => {
                    for (parameter, given) in parameters[called].iter().zip(given) {
                        let given = chains.get(given).unwrap_or(given);
                        flows.entry(*parameter).or_default().push(*given);
                        flows.entry(*given).or_default().push(*parameter);
                    }
                    flows.entry(it.result_id.expect("a result")).or_default().push(*called);
                }
                (Op::ReturnValue, [value]) => flows.entry(function.def_id().expect("an id")).or_default().push(*value),
                _ => {}
            }
        }
    }
    let (mut seen, mut next): (HashSet<u32>, Vec<u32>) = (HashSet::new(), outputs.collect());
    let mut found = Vec::new();
    while let Some(id) = next.pop() {
        if !seen.insert(id) {
            continue;
        }
        next.extend(flows.get(&id).into_iter().flatten());
        next.extend(chains.get(&id));
        if let Some(it) = made.get(&id).filter(|it| it.class.opcode != Op::FunctionCall) {
            found.extend(FUSED.contains(&it.class.opcode).then_some(*it));
            next.extend(ids(it));
        }
    }
    found
}

/// What a compiler may fuse of the sums that motion vectors are made of, stage by stage.
fn free(library: &mut ShaderLibrary, name: &str, draw: Draw) -> Vec<String> {
    let shader = library.compiled(name, draw, &Variant::default()).expect("it compiles");
    let stages = [shader.fragment.as_ref().expect("a fragment stage"), &shader.vertex];
    // The sky's vertex stage is that of every sky: there now and then begin with the direction.
    let stages = stages.into_iter().take(if draw == Draw::Sky { 1 } else { 2 });
    stages
        .flat_map(|spirv| {
            let module = rspirv::dr::load_words(spirv).expect("SPIR-V");
            let found = of_outputs(&module);
            assert!(found.len() > 1, "{name}: {found:?}");
            let is_exact = |it: &&Instruction| {
                module.annotations.iter().any(|of| {
                    ids(of).next() == it.result_id
                        && of.operands.contains(&Operand::Decoration(Decoration::NoContraction))
                })
            };
            let free = found.into_iter().filter(|it| !is_exact(it));
            free.map(|it| format!("{:?} in {name}", it.class.opcode)).collect::<Vec<_>>()
        })
        .collect()
}

/// Now and then are the same sums of the same numbers, and their difference is 0, only where neither is fused in its own way.
#[test]
fn what_stands_still_is_moved_by_exactly_nothing_on_every_driver() {
    let mut shipped = ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
    // Without the word the test sees what is missing.
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("include")).expect("made");
    for (file, text) in SHADERS {
        std::fs::write(folder.path().join(file), text.replace("precise ", "")).expect("written");
    }
    let mut imprecise = ShaderLibrary::new(vec![Root::new(folder.path().to_owned())], &[], interfaces());
    for (name, draw) in [
        ("motion", Draw::Objects(DrawList::Opaque)),
        ("motion_masked", Draw::Objects(DrawList::Masked)),
        ("motion_sky", Draw::Sky),
    ] {
        assert_eq!(free(&mut shipped, name, draw), Vec::<String>::new());
        assert!(free(&mut imprecise, name, draw).len() > 3, "{name}");
    }
}

/// Lavapipe 22.3.6 makes such a vector black: docs/drivers.md.
#[test]
fn no_shipped_shader_selects_a_vector_by_a_specialization_constant() {
    let mut library = ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
    let draws = [Draw::FullScreen, Draw::Objects(DrawList::Opaque), Draw::Objects(DrawList::Masked), Draw::Sky];
    let mut looked_at = 0;
    for (file, _) in SHADERS {
        let stages = if let Some(name) = file.strip_suffix(".comp") {
            vec![library.compute(name, &Variant::default()).expect("it is shipped").compute]
        } else if let Some(name) = file.strip_suffix(".frag") {
            let drawn = draws.into_iter().filter_map(|draw| library.compiled(name, draw, &Variant::default()).ok());
            drawn.flat_map(|shader| [Some(shader.vertex), shader.fragment]).flatten().collect()
        } else {
            continue;
        };
        assert!(!stages.is_empty(), "{file} compiles for no draw");
        for spirv in stages {
            let module = rspirv::dr::load_words(&spirv).expect("SPIR-V");
            let vector = |ty: Option<u32>| {
                let declared = module.types_global_values.iter().find(|it| it.result_id == ty && ty.is_some());
                declared.is_some_and(|it| it.class.opcode == Op::TypeVector)
            };
            let selects = module.types_global_values.iter().filter(|it| {
                it.class.opcode == Op::SpecConstantOp
                    && it.operands.first() == Some(&Operand::LiteralSpecConstantOpInteger(Op::Select))
                    && vector(it.result_type)
            });
            assert_eq!(selects.count(), 0, "{file}");
            looked_at += 1;
        }
    }
    assert!(looked_at > 60, "{looked_at} stages");
}
