//! SPIR-V as tests see it, by themselves and by the tools of `spirv-tools` where they are installed.

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Capability, Op, StorageClass};
use std::fs;
use std::process::{Command, Stdio};

/// Gives a tool SPIR-V, and returns what it writes, if it is there.
pub(super) fn tool(name: &str, arguments: &[&str], spirv: &[u32]) -> Option<Vec<u8>> {
    let bytes: Vec<u8> = spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("in.spv"), bytes).expect("written");
    let mut command = Command::new(name);
    command.args(arguments).arg(path("in.spv")).stdin(Stdio::null());
    if name == "spirv-opt" {
        command.arg("-o").arg(path("out.spv"));
    }
    let Ok(output) = command.output() else {
        assert!(std::env::var_os("CI").is_none(), "`{name}` of spirv-tools isn't there");
        println!("skipped: `{name}` of spirv-tools isn't there");
        return None;
    };
    let said = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{name}: {said}\n{}", disassembled(spirv));
    Some(if name == "spirv-opt" { fs::read(path("out.spv")).expect("it is written") } else { Vec::new() })
}

pub(super) fn valid(spirv: &[u32]) {
    tool("spirv-val", &["--target-env", "vulkan1.3"], spirv);
}

pub(super) fn module(spirv: &[u32]) -> Module {
    rspirv::dr::load_words(spirv).expect("it is SPIR-V")
}

pub(super) fn disassembled(spirv: &[u32]) -> String {
    use rspirv::binary::Disassemble;
    module(spirv).disassemble()
}

/// The instructions of all functions.
pub(super) fn code(module: &Module) -> impl Iterator<Item = &Instruction> + Clone {
    module.functions.iter().flat_map(|it| &it.blocks).flat_map(|it| &it.instructions)
}

pub(super) fn number(operand: Option<&Operand>) -> u32 {
    match operand {
        Some(Operand::LiteralBit32(number)) => *number,
        other => panic!("{other:?}"),
    }
}

/// Image variables by name, with whether they are arrays.
pub(super) fn images(module: &Module) -> Vec<(String, bool)> {
    let global = |id: u32| module.types_global_values.iter().find(|it| it.result_id == Some(id)).expect("declared");
    let operand = |it: &Instruction, at: usize| it.operands[at].id_ref_any().expect("an id");
    let name = |id: u32| {
        let named = |it: &&Instruction| it.class.opcode == Op::Name && it.operands[0] == Operand::IdRef(id);
        match module.debug_names.iter().find(named).map(|it| &it.operands[1]) {
            Some(Operand::LiteralString(name)) => name.clone(),
            other => panic!("{other:?}"),
        }
    };
    let variables = module.types_global_values.iter().filter(|it| {
        it.class.opcode == Op::Variable && it.operands[0] == Operand::StorageClass(StorageClass::UniformConstant)
    });
    let of = |variable: &Instruction| {
        let pointer = global(variable.result_type.expect("a pointer"));
        let image = global(operand(global(operand(pointer, 1)), 0));
        (name(variable.result_id.expect("an id")), number(image.operands.get(3)) == 1)
    };
    let mut found: Vec<_> = variables.map(of).collect();
    found.sort();
    found
}

/// How many coordinates each look-up has, in order: a number of components of their type.
pub(super) fn coordinates(module: &Module) -> Vec<(Op, u32)> {
    let looks_up = |it: &&Instruction| {
        let op = it.class.opcode;
        format!("{op:?}").starts_with("ImageSample") || matches!(op, Op::ImageFetch | Op::ImageGather)
    };
    let components = |value: u32| {
        let all = module.types_global_values.iter().chain(code(module));
        let all = all.chain(module.functions.iter().flat_map(|it| &it.parameters));
        let ty = all.clone().find(|it| it.result_id == Some(value)).and_then(|it| it.result_type).expect("a type");
        let ty = all.clone().find(|it| it.result_id == Some(ty)).expect("declared");
        if ty.class.opcode == Op::TypeVector { number(ty.operands.get(1)) } else { 1 }
    };
    let used = reachable(module);
    let functions = module.functions.iter().filter(|it| used.contains(&it.def.as_ref().and_then(|it| it.result_id)));
    let code = functions.flat_map(|it| &it.blocks).flat_map(|it| &it.instructions);
    code.filter(looks_up).map(|it| (it.class.opcode, components(it.operands[1].id_ref_any().expect("an id")))).collect()
}

/// Functions that are called, by their ids.
pub(super) fn reachable(module: &Module) -> Vec<Option<u32>> {
    let mut found = vec![module.entry_points[0].operands[1].id_ref_any()];
    let mut at = 0;
    while at < found.len() {
        let function = module.functions.iter().find(|it| it.def.as_ref().and_then(|it| it.result_id) == found[at]);
        let code = function.expect("declared").blocks.iter().flat_map(|it| &it.instructions);
        let called = code.filter(|it| it.class.opcode == Op::FunctionCall).map(|it| it.operands[0].id_ref_any());
        let new: Vec<_> = called.filter(|it| !found.contains(it)).collect();
        found.extend(new);
        at += 1;
    }
    found
}

pub(super) fn capabilities(module: &Module) -> Vec<Capability> {
    let of = |it: &Instruction| match it.operands[0] {
        Operand::Capability(capability) => capability,
        _ => panic!("{it:?}"),
    };
    module.capabilities.iter().map(of).collect()
}

/// The instructions that are left of a stage's functions once it is optimised, by name, sorted.
pub(super) fn optimised(spirv: &[u32]) -> Option<Vec<String>> {
    let bytes = tool("spirv-opt", &["-O", "--strip-debug", "--compact-ids"], spirv)?;
    let words: Vec<u32> = bytes.chunks(4).map(|it| u32::from_le_bytes([it[0], it[1], it[2], it[3]])).collect();
    let mut left: Vec<String> = code(&module(&words)).map(|it| format!("{:?}", it.class.opcode)).collect();
    left.sort();
    Some(left)
}
