//! SPIR-V is judged by the validator wherever a stage comes from. The modules of these tests are made by other means than the GLSL
//! compiler: it compiles a shader, whose module is changed, and takes the place of what was compiled ahead.

use super::library;
use framewright_graph::base::Root;
use framewright_graph::device::{Need, NeedKind};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::{DrawInterface, ShaderInterface, ShaderProblem, Variant};
use framewright_vulkan::{PrecompiledShaders, ShaderLibrary};
use rspirv::binary::Assemble;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Capability, Decoration, ExecutionMode, Op, SourceLanguage, StorageClass};
use std::fs;
use std::path::Path;

const FRAGMENT: &str = "#version 460
layout(set = 0, binding = 0) uniform Params { vec2 scale; float white; } params;
layout(location = 0) out vec4 color;
void main() {
    color = vec4(dFdxFine(gl_FragCoord.x) * params.scale * params.white, 0.0, 1.0);
}
";

const COMPUTE: &str = "#version 460
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer Counts { uint counts[]; };
shared uint sum;
void main() {
    sum = 0u;
    barrier();
    atomicAdd(sum, counts[gl_LocalInvocationIndex]);
    barrier();
    counts[0] = sum;
}
";

/// A stage of the shader `test` with another module than the compiler's, which `change` makes of it.
fn changed(file: &str, text: &str, change: impl Fn(&mut Module)) -> Result<ShaderInterface, ShaderProblem> {
    let folder = tempfile::tempdir().expect("a folder");
    let ahead = folder.path().join("spirv");
    fs::write(folder.path().join(file), text).expect("written");
    let reflected = |precompiled: PrecompiledShaders| {
        let mut library = library(folder.path()).with_precompiled(Some(precompiled));
        if file.ends_with(".comp") { library.compute_interface() } else { library.draw_interface() }
    };
    reflected(PrecompiledShaders::in_folder(&ahead).adding()).expect("what the compiler wrote is valid");
    for entry in fs::read_dir(&ahead).expect("compiled ahead") {
        let path = entry.expect("listed").path();
        if !path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(file)) {
            continue;
        }
        let mut module = rspirv::dr::load_bytes(fs::read(&path).expect("read")).expect("SPIR-V");
        change(&mut module);
        let bytes: Vec<u8> = module.assemble().into_iter().flat_map(u32::to_le_bytes).collect();
        fs::write(&path, bytes).expect("written");
    }
    reflected(PrecompiledShaders::in_folder(&ahead))
}

trait Interfaces {
    fn draw_interface(&mut self) -> Result<ShaderInterface, ShaderProblem>;
    fn compute_interface(&mut self) -> Result<ShaderInterface, ShaderProblem>;
}

impl Interfaces for ShaderLibrary {
    fn draw_interface(&mut self) -> Result<ShaderInterface, ShaderProblem> {
        self.compiled("test", Draw::FullScreen, &Variant::default()).map(|it| it.interface)
    }

    fn compute_interface(&mut self) -> Result<ShaderInterface, ShaderProblem> {
        self.compute("test", &Variant::default()).map(|it| it.interface)
    }
}

/// The refusal of a module.
fn refused(file: &str, text: &str, change: impl Fn(&mut Module)) -> String {
    match changed(file, text, change) {
        Err(ShaderProblem::Unsupported { what }) => what,
        other => panic!("{other:?}"),
    }
}

/// Gives the constant of another value.
fn set_constants(module: &mut Module, from: u32, to: u32) {
    let constants = module.types_global_values.iter_mut().filter(|it| it.class.opcode == Op::Constant);
    for constant in constants.filter(|it| it.operands == [Operand::LiteralBit32(from)]) {
        constant.operands = vec![Operand::LiteralBit32(to)];
    }
}

fn is_decoration(it: &Instruction, wanted: Decoration) -> bool {
    it.operands.contains(&Operand::Decoration(wanted))
}

#[test]
fn a_module_that_vulkan_does_not_allow_is_refused_with_its_place_and_the_rule() {
    let what = refused("test.frag", FRAGMENT, |module| {
        module.capabilities.retain(|it| it.operands != [Operand::Capability(Capability::DerivativeControl)]);
    });
    assert!(what.contains("test.frag") && what.contains("SPIR-V that Vulkan 1.3 doesn't allow: "), "{what}");
    assert!(what.contains("DerivativeControl"), "{what}");

    let what = refused("test.frag", FRAGMENT, |module| {
        module.annotations.retain(|it| !is_decoration(it, Decoration::Block));
    });
    assert!(what.contains("Block"), "{what}");

    let what = refused("test.frag", FRAGMENT, |module| {
        let offset = |it: &&mut Instruction| is_decoration(it, Decoration::Offset);
        let last = module.annotations.iter_mut().filter(offset).last().expect("an offset");
        *last.operands.last_mut().expect("its number") = Operand::LiteralBit32(10);
    });
    assert!(what.contains("test.frag:2: ") && what.contains("`Params`"), "{what}");

    let what = refused("test.frag", FRAGMENT, |module| {
        module
            .execution_modes
            .retain(|it| !it.operands.contains(&Operand::ExecutionMode(ExecutionMode::OriginUpperLeft)));
    });
    assert!(what.contains("OriginUpperLeft"), "{what}");

    let what = refused("test.frag", FRAGMENT, |module| {
        module.entry_points[0].operands.pop();
    });
    assert!(what.contains("interface"), "{what}");
}

#[test]
fn memory_semantics_with_two_orders_are_refused() {
    // AcquireRelease and WorkgroupMemory, with Acquire besides.
    let what = refused("test.comp", COMPUTE, |module| set_constants(module, 0x108, 0x10a));
    assert!(what.contains("Memory Semantics can have at most one of the following bits set"), "{what}");
}

#[test]
fn a_module_that_tells_lines_is_refused_at_its_line() {
    let what = refused("test.comp", COMPUTE, |module| {
        set_constants(module, 0x108, 0x10a);
        let file = module.header.as_ref().expect("a header").bound;
        module.header.as_mut().expect("a header").bound += 1;
        module.debug_string_source.push(Instruction::new(
            Op::String,
            None,
            Some(file),
            vec![Operand::LiteralString("made.slang".to_owned())],
        ));
        let line = vec![Operand::IdRef(file), Operand::LiteralBit32(42), Operand::LiteralBit32(0)];
        let block = module.functions.iter_mut().flat_map(|it| &mut it.blocks).next().expect("a block");
        let at = block.instructions.iter().position(|it| it.class.opcode == Op::ControlBarrier).expect("a barrier");
        block.instructions.insert(at, Instruction::new(Op::Line, None, None, line));
    });
    assert!(what.starts_with("made.slang:42: SPIR-V that Vulkan 1.3 doesn't allow: "), "{what}");
}

#[test]
fn what_glsl_lets_through_and_vulkan_does_not_is_refused_at_its_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "#version 460\nlayout(pixel_center_integer) in vec4 gl_FragCoord;\n\
        layout(location = 0) out vec4 color;\nvoid main() { color = vec4(gl_FragCoord.xy / 64.0, 0.0, 1.0); }\n";
    fs::write(folder.path().join("test.frag"), text).expect("written");
    let refused = library(folder.path()).draw_interface();
    let Err(ShaderProblem::Unsupported { what }) = refused else { panic!("{refused:?}") };
    let place = folder.path().join("test.frag:2");
    assert!(what.starts_with(&format!("{}: SPIR-V that Vulkan 1.3 doesn't allow: ", place.display())), "{what}");
    assert!(what.ends_with("(VUID-StandaloneSpirv-PixelCenterInteger-04654)"), "{what}");
}

#[test]
fn extensions_that_vulkan_1_3_lacks_are_refused_and_others_are_taken() {
    let declaring = |name: &'static str| {
        move |module: &mut Module| {
            let extension = vec![Operand::LiteralString(name.to_owned())];
            module.extensions.push(Instruction::new(Op::Extension, None, None, extension));
        }
    };
    for name in ["SPV_KHR_maximal_reconvergence", "SPV_GOOGLE_user_type", "SPV_KHR_ray_tracing"] {
        let what = refused("test.comp", COMPUTE, declaring(name));
        assert!(
            what.ends_with(&format!("it needs SPIR-V's extension {name}, which isn't supported: do without it")),
            "{what}"
        );
    }
    changed("test.comp", COMPUTE, declaring("SPV_KHR_storage_buffer_storage_class")).expect("part of Vulkan 1.1");
}

/// Slang's number is 11. SPIRV-Tools of 2023 refuse it.
#[test]
fn modules_of_todays_slang_are_accepted() {
    let slang = |module: &mut Module| {
        let source = module.debug_string_source.iter_mut().find(|it| it.class.opcode == Op::Source).expect("a source");
        source.operands = vec![Operand::SourceLanguage(SourceLanguage::Slang), Operand::LiteralBit32(1)];
    };
    for (file, text) in [("test.frag", FRAGMENT), ("test.comp", COMPUTE)] {
        let interface = changed(file, text, slang).unwrap_or_else(|problem| panic!("{problem:?}"));
        assert_eq!(interface.needs, []);
    }
}

#[test]
fn a_word_that_the_validator_does_not_know_is_told_and_does_not_refuse() {
    let interface = changed("test.frag", FRAGMENT, |module| {
        let variable = module.types_global_values.iter().find(|it| {
            it.class.opcode == Op::Variable && it.operands[0] == Operand::StorageClass(StorageClass::Output)
        });
        let on = Operand::IdRef(variable.and_then(|it| it.result_id).expect("an output"));
        let operands = vec![on, Operand::Decoration(Decoration::BankNV), Operand::LiteralBit32(0)];
        module.annotations.push(Instruction::new(Op::Decorate, None, None, operands));
    });
    let needs = interface.expect("it can be used").needs;
    let [Need { kind: NeedKind::Unjudged(words), place }] = &needs[..] else { panic!("{needs:?}") };
    assert!(words.starts_with("Invalid decoration operand: ") && place.ends_with("test.frag"), "{words}, {place}");
}

#[test]
fn every_shipped_shader_is_valid_and_can_be_used() {
    let none = Path::new("/nonexistent");
    let roots = vec![Root::new(none.to_owned())];
    let mut library = ShaderLibrary::new(roots, framewright_passes::shipped::SHADERS, |_| DrawInterface::default());
    let mut refused = Vec::new();
    let shaders = framewright_passes::shipped::SHADERS.iter().filter_map(|(file, _)| file.rsplit_once('.'));
    for (name, ending) in shaders.filter(|(name, _)| !name.contains('/')) {
        let variant = Variant::default();
        let interface = match ending {
            "comp" => library.compute(name, &variant).map(|it| it.interface),
            "frag" => {
                let draws = [Draw::FullScreen, Draw::Objects(DrawList::Opaque), Draw::Sky];
                let all = draws.map(|draw| library.compiled(name, draw, &variant).map(|it| it.interface));
                // What doesn't fit one kind of draw fits another.
                all.into_iter().reduce(|one, other| one.or(other)).expect("several")
            }
            _ => continue,
        };
        match interface {
            Ok(interface) if interface.needs.iter().any(|it| matches!(it.kind, NeedKind::Unjudged(_))) => {
                refused.push(format!("{name}: {:?}", interface.needs));
            }
            Ok(_) => {}
            Err(problem) => refused.push(format!("{name}: {problem:?}")),
        }
    }
    assert!(refused.is_empty(), "{refused:#?}");
}
