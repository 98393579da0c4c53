//! SPIR-V that other compilers made: what is read off it, and what is refused.

use super::*;
use framewright_graph::base::FilePath;
use framewright_graph::frame::EyeForm;
use framewright_graph::shader::{EyeSource, GivenNames};
use rspirv::binary::Assemble;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{ExecutionModel, Op};

/// The modules of tests/shaders/spirv, made by its make.sh.
const MODULES: [(&str, &[u8]); 11] = [
    ("post_hlsl.spv", include_bytes!("../../../../tests/shaders/spirv/post_hlsl.spv")),
    ("post_hlsl_vertices.spv", include_bytes!("../../../../tests/shaders/spirv/post_hlsl_vertices.spv")),
    ("post_stripped.spv", include_bytes!("../../../../tests/shaders/spirv/post_stripped.spv")),
    ("post_wgsl.spv", include_bytes!("../../../../tests/shaders/spirv/post_wgsl.spv")),
    ("old_block.spv", include_bytes!("../../../../tests/shaders/spirv/old_block.spv")),
    ("sized_by_constants.spv", include_bytes!("../../../../tests/shaders/spirv/sized_by_constants.spv")),
    ("post_dxc.spv", include_bytes!("../../../../tests/shaders/spirv/post_dxc.spv")),
    ("post_slang.spv", include_bytes!("../../../../tests/shaders/spirv/post_slang.spv")),
    ("bytes_slang.spv", include_bytes!("../../../../tests/shaders/spirv/bytes_slang.spv")),
    ("append_dxc.spv", include_bytes!("../../../../tests/shaders/spirv/append_dxc.spv")),
    ("sampled_twice.spv", include_bytes!("../../../../tests/shaders/spirv/sampled_twice.spv")),
];

/// What stands in for shipped shaders: the usual vertex stage hands a place over.
const USUAL: &[(&str, &str)] = &[(
    "full_screen.vert",
    "#version 460\nlayout(location = 0) out vec2 uv; void main() { uv = vec2(0.0); gl_Position = vec4(0.0); }\n",
)];

fn bytes_of(name: &str) -> &'static [u8] {
    MODULES.iter().find(|(known, _)| *known == name).expect("a module").1
}

/// A library of these modules, which the program brings.
fn of_modules(modules: &[(&str, &[u8])]) -> ShaderLibrary {
    let modules = modules.iter().map(|(name, bytes)| ((*name).into(), (*bytes).into()));
    ShaderLibrary::new(Vec::new(), USUAL, |_| DrawInterface::default()).with_spirv(modules)
}

fn drawn_by(name: &str) -> Result<ShaderInterface, ShaderProblem> {
    of_modules(&MODULES).draw_shader(name, Draw::FullScreen, &Variant::default())
}

fn computed_by(name: &str) -> Result<ShaderInterface, ShaderProblem> {
    of_modules(&MODULES).compute_shader(name, &Variant::default())
}

fn names(interface: &ShaderInterface) -> Vec<&str> {
    interface.bindings.iter().map(|it| it.name.as_str()).collect()
}

fn members(interface: &ShaderInterface) -> Vec<(&str, u32, &str)> {
    let block = interface.bindings.iter().find_map(|it| it.kind.uniform_block()).expect("a block");
    block.members.iter().map(|it| (it.name.as_str(), it.offset, it.ty.as_str())).collect()
}

/// A module that is changed.
fn changed(name: &str, change: impl Fn(&mut Module)) -> Vec<u8> {
    let mut module = rspirv::dr::load_bytes(bytes_of(name)).expect("SPIR-V");
    change(&mut module);
    module.assemble().into_iter().flat_map(u32::to_le_bytes).collect()
}

fn bad(bytes: &[u8]) -> String {
    match of_modules(&[("test.spv", bytes)]).draw_shader("test.spv", Draw::FullScreen, &Variant::default()) {
        Err(ShaderProblem::BadModule { what }) => what,
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_image_and_its_sampler_are_two_bindings_that_know_of_each_other() {
    let interface = drawn_by("fragment post_hlsl.spv").expect("read");
    assert_eq!(names(&interface), ["source", "linear_clamp", "params"]);
    assert!(interface.bindings[0].separate && interface.bindings[0].kind.is_sampled());
    assert_eq!(interface.bindings[1].kind.sampler(), Some((&["source".to_owned()][..], false)));
    assert_eq!(members(&interface), [("factor", 0, "float"), ("tint", 4, "vec3")]);
}

#[test]
fn every_compiler_tells_the_same_of_one_effect() {
    for name in ["post_hlsl.spv", "post_dxc.spv", "post_slang.spv"] {
        let interface = drawn_by(&format!("fragment {name}")).unwrap_or_else(|problem| panic!("{name}: {problem:?}"));
        assert_eq!(names(&interface), ["source", "linear_clamp", "params"], "{name}");
        let kept: Vec<_> = members(&interface).into_iter().map(|(name, _, ty)| (name, ty)).collect();
        assert_eq!(kept, [("factor", "float"), ("tint", "vec3")], "{name}");
    }
    let [count, of_wgsl] = ["post_slang.spv:count", "post_wgsl.spv:count"].map(|name| computed_by(name).expect("read"));
    assert_eq!((names(&count), count.workgroup_size), (vec!["counts"], of_wgsl.workgroup_size));
}

#[test]
fn a_capability_that_only_another_entry_point_needs_is_none_of_its_own() {
    let waves = Operand::Capability(rspirv::spirv::Capability::GroupNonUniformArithmetic);
    let declares = |module: &Module| module.capabilities.iter().any(|it| it.operands[0] == waves);
    assert!(declares(&rspirv::dr::load_bytes(bytes_of("post_slang.spv")).expect("SPIR-V")));
    let tinted = of_modules(&MODULES).compiled("post_slang.spv:tinted", Draw::FullScreen, &Variant::default());
    let fragment = tinted.expect("read").fragment.expect("colours");
    assert!(!declares(&rspirv::dr::load_words(fragment).expect("SPIR-V")));
}

#[test]
fn what_a_module_holds_for_debuggers_and_readers_alone_is_no_hindrance() {
    let interface = computed_by("append_dxc.spv").expect("read");
    assert_eq!(names(&interface), ["items", "large", "params", "counter.var.large"]);
    let storage: Vec<_> = interface.bindings.iter().filter_map(|it| it.kind.storage()).collect();
    assert_eq!(storage, [(true, false), (true, true), (true, true)]);
}

#[test]
fn a_buffer_that_is_read_by_several_types_is_one() {
    let module = rspirv::dr::load_bytes(bytes_of("bytes_slang.spv")).expect("SPIR-V");
    let named = |name: &str| {
        let name = Operand::LiteralString(name.to_owned());
        module.debug_names.iter().filter(|it| it.operands.get(1) == Some(&name)).count()
    };
    assert_eq!(named("numbers"), 2, "a variable for each type");
    let interface = computed_by("bytes_slang.spv").expect("read");
    let found: Vec<_> = interface.bindings.iter().map(|it| (it.name.as_str(), it.kind.storage())).collect();
    assert_eq!(found, [("numbers", Some((true, false))), ("sums", Some((true, true)))]);
}

#[test]
fn one_sampler_may_sample_several_images_and_another_compare() {
    let interface = drawn_by("fragment sampled_twice.spv").expect("read");
    let samplers: Vec<_> = interface.bindings.iter().filter_map(|it| it.kind.sampler()).collect();
    let named = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    assert_eq!(samplers, [(&named(&["light", "noise"])[..], false), (&named(&["shadow"])[..], true)]);
    let compared: Vec<_> = interface.bindings.iter().filter(|it| it.kind.is_compared()).map(|it| &*it.name).collect();
    assert_eq!(compared, ["shadow"]);
}

#[test]
fn an_entry_point_is_seen_alone() {
    let tinted = drawn_by("post_wgsl.spv:tinted").expect("read");
    assert_eq!(names(&tinted), ["binding 0", "binding 1", "params"]);
    assert_eq!(members(&tinted), [("offset 0", 0, "float"), ("offset 16", 16, "vec3")]);
    let texel = drawn_by("post_wgsl.spv:first_texel").expect("read");
    assert_eq!(names(&texel), ["binding 0", "params"]);
    let [count, clear] = ["count", "clear"].map(|name| computed_by(&format!("post_wgsl.spv:{name}")).expect("read"));
    assert_eq!((names(&count), count.workgroup_size), (vec!["binding 3"], Some([64, 1, 1])));
    assert_eq!(clear.workgroup_size, Some([8, 4, 1]));
}

#[test]
fn a_pass_may_name_by_place_what_has_a_name() {
    let given = GivenNames { bindings: vec!["binding 0".into()], params: vec!["offset 4".into()] };
    let variant = Variant { given, ..Variant::default() };
    let interface =
        of_modules(&MODULES).draw_shader("fragment post_hlsl.spv", Draw::FullScreen, &variant).expect("read");
    assert_eq!(names(&interface), ["binding 0", "linear_clamp", "params"]);
    assert_eq!(interface.bindings[1].kind.sampler().expect("a sampler").0, ["binding 0"]);
    assert_eq!(members(&interface), [("factor", 0, "float"), ("offset 4", 4, "vec3")]);
}

#[test]
fn blocks_of_before_spirv_1_3_are_storage_blocks_and_what_is_unused_is_none_of_a_passs() {
    let interface = computed_by("old_block.spv").expect("read");
    let found: Vec<_> = interface.bindings.iter().map(|it| (it.name.as_str(), it.kind.storage())).collect();
    assert_eq!(found, [("From", Some((true, false))), ("To", Some((true, true)))]);
}

#[test]
fn the_size_of_workgroups_may_be_said_by_constants() {
    assert_eq!(computed_by("sized_by_constants.spv").expect("read").workgroup_size, Some([16, 4, 1]));
}

#[test]
fn a_stage_of_another_module_is_joined_and_the_usual_one_else() {
    let own = "vertex post_hlsl_vertices.spv:VSMain, fragment post_hlsl.spv";
    let draw =
        |name: &str| of_modules(&MODULES).draw_shader(name, Draw::FullScreen, &Variant::default()).expect("read");
    assert_eq!(draw(own).own_vertices.as_deref(), Some("post_hlsl_vertices.spv"));
    assert_eq!(draw("post_hlsl.spv").own_vertices, None);
    assert_eq!(draw("post_hlsl.spv"), draw("fragment post_hlsl.spv:PSMain"));
}

#[test]
fn an_entry_point_that_is_missing_or_not_the_only_one_is_an_error_that_lists_them() {
    let point = |problem: Result<ShaderInterface, ShaderProblem>| match problem {
        Err(ShaderProblem::EntryPoint { file, stage, named, of_stage, others }) => {
            assert_eq!(*file, *"post_wgsl.spv");
            (stage, named, of_stage.into_vec(), others.len())
        }
        other => panic!("{other:?}"),
    };
    let both = vec!["tinted".to_owned(), "first_texel".to_owned()];
    assert_eq!(point(drawn_by("post_wgsl.spv")), ("fragment", None, both.clone(), 2));
    let named = |name: &str| Some(name.to_owned());
    assert_eq!(point(drawn_by("post_wgsl.spv:tintet")), ("fragment", named("tintet"), both.clone(), 2));
    // It is there, and of another stage.
    assert_eq!(point(drawn_by("post_wgsl.spv:count")), ("fragment", named("count"), both, 2));
    let vertices = drawn_by("vertex post_wgsl.spv, fragment post_hlsl.spv");
    assert_eq!(point(vertices), ("vertex", None, Vec::new(), 4));
}

#[test]
fn a_module_that_is_no_whole_one_is_refused() {
    let whole = bytes_of("post_hlsl.spv");
    assert!(bad(&whole[..whole.len() - 12]).contains("it is cut off: instruction"));
    // Cut between two instructions.
    assert!(bad(&whole[..whole.len() - 4]).ends_with("it is cut off: its last function has no end"));
    let functions = changed("post_hlsl.spv", |module| module.functions.clear());
    assert!(bad(&functions).ends_with("the function of its entry point `PSMain` isn't there"));
    let mut later = whole.to_vec();
    later[5] = 0;
    later[6] = 2;
    assert!(bad(&later).contains("it is SPIR-V 2.0: versions 1.0 to 1.6 are taken"));
    assert!(bad(b"#version 460").ends_with("it doesn't begin as SPIR-V does"));
}

#[test]
fn modules_that_would_lead_readers_astray_are_refused() {
    let broken = |change: &dyn Fn(&mut Module)| bad(&changed("post_hlsl.spv", change));
    let twice = broken(&|module| {
        let first = module.types_global_values[0].clone();
        module.types_global_values.push(first);
    });
    assert!(twice.contains(" twice"), "{twice}");
    let beyond = broken(&|module| module.header.as_mut().expect("a header").bound = 3);
    assert!(beyond.contains("says that all are below 3"), "{beyond}");
    let circle = broken(&|module| {
        let array = Instruction::new(Op::TypeRuntimeArray, None, Some(70), vec![Operand::IdRef(70)]);
        module.header.as_mut().expect("a header").bound = 1000;
        module.types_global_values.push(Instruction {
            result_id: Some(900),
            operands: vec![Operand::IdRef(900)],
            ..array
        });
    });
    assert!(circle.contains("its id 900 is made of 900, which doesn't stand before it"), "{circle}");
    let deep = broken(&|module| {
        module.header.as_mut().expect("a header").bound = 2000;
        let float = module.types_global_values.iter().find(|it| it.class.opcode == Op::TypeFloat);
        let mut last = float.and_then(|it| it.result_id).expect("a type");
        for id in 1000..1100 {
            let array = Instruction::new(Op::TypeRuntimeArray, None, Some(id), vec![Operand::IdRef(last)]);
            module.types_global_values.push(array);
            last = id;
        }
    });
    assert!(deep.contains("more than 64 deep"), "{deep}");
    let calls = broken(&|module| {
        module.header.as_mut().expect("a header").bound = 2000;
        let function = &mut module.functions[0];
        let (def, blocks) = (function.def.clone().expect("a function"), &mut function.blocks);
        let call = Instruction::new(
            Op::FunctionCall,
            def.result_type,
            Some(1500),
            vec![Operand::IdRef(def.result_id.expect("an id"))],
        );
        blocks[0].instructions.insert(0, call);
    });
    assert!(calls.contains("calls itself"), "{calls}");
}

#[test]
fn a_truncated_or_garbled_module_never_ends_the_program() {
    let read = |bytes: &[u8]| {
        let mut library = of_modules(&[("test.spv", bytes)]);
        // No vertex stage: nothing is compiled.
        _ = library.draw_shader("vertex test.spv, fragment test.spv", Draw::FullScreen, &Variant::default());
        _ = library.compute_shader("test.spv", &Variant::default());
        let both = Variant {
            eye: Some(EyeSource::InstanceParity),
            form: Some(EyeForm::Layers),
            eyes: vec![("source".into(), EyeForm::Layers, None)],
            ..Variant::default()
        };
        _ = library.draw_shader("vertex test.spv, fragment test.spv", Draw::FullScreen, &both);
    };
    for (_, whole) in MODULES {
        for length in (0..whole.len()).step_by(4) {
            read(&whole[..length]);
        }
        for at in (20..whole.len()).step_by(4) {
            let mut garbled = whole.to_vec();
            garbled[at] = garbled[at].wrapping_add(1);
            read(&garbled);
        }
    }
}

#[test]
fn a_draw_for_both_eyes_takes_modules_in_each_way() {
    let ways = [
        (EyeSource::ViewIndex, EyeForm::Layers),
        (EyeSource::InstanceParity, EyeForm::Layers),
        (EyeSource::InstanceParity, EyeForm::Halves),
        (EyeSource::InstanceBit, EyeForm::Halves),
    ];
    let name = "vertex post_hlsl_vertices.spv, fragment post_hlsl.spv";
    for (source, form) in ways {
        let eyes = if form == EyeForm::Layers { vec![("source".into(), form, None)] } else { Vec::new() };
        let variant = Variant { eye: Some(source), form: Some(form), eyes, ..Variant::default() };
        let drawn = of_modules(&MODULES).draw_shader(name, Draw::FullScreen, &variant);
        let alone = of_modules(&MODULES).draw_shader(name, Draw::FullScreen, &Variant::default());
        let [drawn, alone] = [drawn, alone].map(|it| it.unwrap_or_else(|problem| panic!("{problem:?}")));
        assert_eq!((drawn.bindings, drawn.outputs), (alone.bindings, alone.outputs));
    }
}

/// Instructions with lines of SPIR-V's own or of a set for debuggers, and modules that hold their text (DO-3).
#[test]
fn a_module_that_tells_lines_is_placed_in_its_source() {
    let modules: [(&str, &[u8]); 4] = [
        ("text.spv", include_bytes!("../../../../tests/shaders/spirv/discard_text.spv")),
        ("text_of_set.spv", include_bytes!("../../../../tests/shaders/spirv/discard_gvs.spv")),
        ("lines.spv", include_bytes!("../../../../tests/shaders/spirv/discard_dxc.spv")),
        ("lines_of_set.spv", include_bytes!("../../../../tests/shaders/spirv/discard_dxc_set.spv")),
    ];
    for (name, _) in modules {
        let drawn = of_modules(&modules).draw_shader(name, Draw::FullScreen, &Variant::default());
        let interface = drawn.unwrap_or_else(|problem| panic!("{name}: {problem:?}"));
        assert!(interface.discards, "{name}");
        assert_eq!(interface.leaves_out_at.as_deref(), Some("discard.hlsl:5"), "{name}");
    }
    // Without lines the module itself is all that is known.
    let stripped = of_modules(&MODULES).draw_shader("post_stripped.spv", Draw::FullScreen, &Variant::default());
    assert_eq!(stripped.expect("read").leaves_out_at, None);
}

#[test]
fn files_are_found_as_glsl_is_and_are_part_of_a_digest() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("effects")).expect("made");
    fs::write(folder.path().join("effects/post.spv"), bytes_of("post_hlsl.spv")).expect("written");
    let mut library = library(folder.path()).with_spirv([("post.spv".into(), bytes_of("post_wgsl.spv").into())]);
    let from = FilePath::from("effects/glow.ron");
    let mut find = |from: &FilePath, name: &str| library.find(from, &name.into(), Some(Draw::FullScreen));
    assert_eq!(find(&from, "post.spv:PSMain").as_deref(), Ok("effects/post.spv:PSMain"));
    // The program's own comes behind the folders.
    assert_eq!(find(&"glow.ron".into(), "post.spv").as_deref(), Ok("post.spv"));
    let stages = "vertex plain, fragment post.spv";
    assert!(matches!(find(&from, stages), Err(ShaderProblem::Missing { .. })));
    let missing = find(&from, "past.spv").expect_err("missing");
    let ShaderProblem::Missing { known, .. } = missing else { panic!("{missing:?}") };
    assert_eq!(known, ["post.spv"]);
    assert_eq!(library.own_files(&from, "post.spv:PSMain"), [bytes_of("post_hlsl.spv")]);
    assert_eq!(library.own_files(&"glow.ron".into(), "post.spv"), [bytes_of("post_wgsl.spv")]);
}

#[test]
fn decorations_of_groups_count_at_each_member() {
    let grouped = changed("old_block.spv", |module| {
        module.header.as_mut().expect("a header").bound = 2000;
        // All that are in set 0 are so by a group.
        let set = |it: &Instruction| {
            it.operands.get(1) == Some(&Operand::Decoration(rspirv::spirv::Decoration::DescriptorSet))
        };
        let members: Vec<Operand> =
            module.annotations.iter().filter(|it| set(it)).map(|it| it.operands[0].clone()).collect();
        let mut in_set = module.annotations.iter().find(|it| set(it)).expect("one").clone();
        in_set.operands[0] = Operand::IdRef(1900);
        module.annotations.retain(|it| !set(it));
        module.annotations.push(in_set);
        module.annotations.push(Instruction::new(Op::DecorationGroup, None, Some(1900), Vec::new()));
        let all = [vec![Operand::IdRef(1900)], members].concat();
        module.annotations.push(Instruction::new(Op::GroupDecorate, None, None, all));
    });
    let interface =
        of_modules(&[("test.spv", &grouped)]).compute_shader("test.spv", &Variant::default()).expect("read");
    assert_eq!(names(&interface), ["From", "To"]);
}

#[test]
fn an_entry_point_of_another_stage_alone_is_none() {
    let vertex = changed("post_hlsl.spv", |module| {
        module.entry_points[0].operands[0] = Operand::ExecutionModel(ExecutionModel::Geometry);
    });
    let refused = of_modules(&[("test.spv", &vertex)]).draw_shader("test.spv", Draw::FullScreen, &Variant::default());
    let Err(ShaderProblem::EntryPoint { others, .. }) = refused else { panic!("{refused:?}") };
    assert_eq!(*others, [("PSMain".to_owned(), "geometry")]);
}
