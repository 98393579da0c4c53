//! The file of a draw source's interfaces: what is written is read again, and every mistake is told at its place.

use framewright_graph::base::{self, Sources};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::{
    Attribute, BindingFlags, DescriptorType, DrawInterface, DrawInterfaces, DrawKind, ProgramBinding, ProgramSet,
    SuppliedKind, SuppliedResource, VertexBuffer, VertexRate,
};
use framewright_graph::vulkan::{PrimitiveTopology, Stages, VertexFormat};
use proptest::prelude::*;
use std::collections::BTreeMap;

fn read(text: &str) -> Result<DrawInterfaces, String> {
    let mut sources = Sources::default();
    let read = DrawInterfaces::read(&mut sources, "engine.ron", "engine.ron", text.to_owned());
    read.map_err(|mistakes| base::render(&sources, &mistakes))
}

fn engine(draw: Draw) -> DrawInterface {
    let camera = SuppliedResource::new(1, 0, "camera", SuppliedKind::UniformBlock);
    match draw {
        Draw::Objects(_) => DrawInterface {
            vertex_buffers: vec![VertexBuffer::of_vertices(20)],
            attributes: vec![Attribute::new("place", 3, 0), Attribute::new("tangent", 2, 12)],
            supplied: vec![camera, SuppliedResource::new(3, 7, "detail", SuppliedKind::SampledImage).with_count(64)],
            ..DrawInterface::default()
        },
        Draw::Sky | Draw::Custom => DrawInterface { supplied: vec![camera], ..DrawInterface::default() },
        _ => DrawInterface::default(),
    }
}

/// All that the engine tells.
fn interfaces() -> DrawInterfaces {
    let compute = DrawInterface {
        supplied: vec![SuppliedResource::new(2, 1, "counters", SuppliedKind::StorageBlock)],
        ..DrawInterface::default()
    };
    DrawInterfaces::from(engine).with(DrawKind::Compute, compute).with_custom_passes(["grass", "hair-2"])
}

const ENGINE: &str = r#"Interface(
    version: 1,
    draws: [
        (
            of: [Objects(Opaque), Objects(Masked), Objects(Transparent)],
            vertex_stride: 20,
            attributes: [
                (name: "place", components: 3, offset: 0),
                (name: "tangent", components: 2, offset: 12),
            ],
            supplied: [
                (name: "camera", set: 1, binding: 0, kind: UniformBlock),
                (name: "detail", set: 3, binding: 7, kind: SampledImage, count: 64),
            ],
        ),
        (
            of: [Sky, Custom],
            vertex_stride: 0,
            attributes: [
            ],
            supplied: [
                (name: "camera", set: 1, binding: 0, kind: UniformBlock),
            ],
        ),
        (
            of: [Compute],
            vertex_stride: 0,
            attributes: [
            ],
            supplied: [
                (name: "counters", set: 2, binding: 1, kind: StorageBlock),
            ],
        ),
    ],
    custom: ["grass", "hair-2"],
)
"#;

#[test]
fn an_engine_writes_its_interfaces_and_reads_them_again() {
    let interfaces = interfaces();
    assert_eq!(interfaces.to_ron(), ENGINE);
    assert_eq!(read(ENGINE), Ok(interfaces.clone()));
    for kind in DrawKind::ALL {
        let draw = match kind {
            DrawKind::Objects(list) => Draw::Objects(list),
            DrawKind::Sky => Draw::Sky,
            DrawKind::Custom => Draw::Custom,
            DrawKind::Compute => continue,
            _ => Draw::FullScreen,
        };
        assert_eq!(interfaces.of(draw), engine(draw), "{kind}");
    }
    assert_eq!(interfaces.of(Draw::Vertices { count: 3, instances: 1 }), DrawInterface::default());
    // DO-12: draws of a pass's own vertices see resources, and bring their vertices themselves.
    let (own, objects) = (DrawKind::Vertices, engine(Draw::Objects(DrawList::Opaque)));
    let with_own = interfaces.clone().with(own, objects.clone());
    let seen = DrawInterface { supplied: objects.supplied, ..DrawInterface::default() };
    for draw in [Draw::Vertices { count: 6, instances: 2 }, Draw::Indirect] {
        assert_eq!(with_own.of(draw), seen);
    }
    assert_eq!(read(&with_own.to_ron()), Ok(with_own));
    assert_eq!(interfaces.of_kind(DrawKind::Compute).supplied[0].name, "counters");
    let told = DrawInterfaces::from(|_| engine(Draw::Sky));
    assert_eq!(
        told.of_kind(DrawKind::Compute),
        DrawInterface::default(),
        "a function of draws says nothing of compute passes"
    );
}

#[test]
fn a_file_that_knows_nothing_of_compute_passes_brings_them_nothing() {
    let old = ENGINE.replacen("of: [Compute]", "of: [FullScreen]", 1);
    assert_eq!(read(&old).expect("right").of_kind(DrawKind::Compute), DrawInterface::default());
}

#[test]
fn names_of_custom_passes_are_known_only_if_they_are_told() {
    let without = DrawInterfaces::from(engine);
    assert_eq!(read(&without.to_ron()).expect("right").custom_passes(), None);
    let none = without.with_custom_passes([""; 0]);
    assert_eq!(read(&none.to_ron()).expect("right").custom_passes(), Some(&[][..]));
}

/// The file with a mistake in it.
#[track_caller]
fn wrong(right: &str, mistake: &str, place: &str, said: &[&str]) {
    assert!(ENGINE.contains(right), "the file doesn't hold {right}");
    let rendered = read(&ENGINE.replacen(right, mistake, 1)).expect_err(mistake);
    for words in [&format!(" engine.ron:{place}\n")[..]].iter().chain(said) {
        assert!(rendered.contains(words), "`{words}` is not in\n{rendered}");
    }
    assert_eq!(rendered.matches("error: ").count(), 1, "{rendered}");
}

#[test]
fn each_mistake_is_told_at_its_place() {
    wrong("Interface(", "Interfaces(", "1:1", &["expected `Interface(…)`, found `Interfaces`"]);
    wrong("version: 1", "version: 2", "2:14", &["this interface is written in version 2", "reads version 1"]);
    wrong("    version: 1,\n", "", "1:1", &["the interface lacks the field `version`", "an interface is `Interface("]);
    wrong("draws: [", "drawn: [", "3:5", &["the interface has no field `drawn`", "did you mean `draws`?"]);
    wrong("Objects(Masked)", "Objects(Opaque)", "5:35", &["`Objects(Opaque)` stands here twice", "first here"]);
    wrong("of: [Sky, ", "of: [Objects(Masked), ", "17:18", &["`Objects(Masked)` stands here twice"]);
    wrong("of: [Sky, Custom]", "of: []", "17:17", &["is for one kind of draw at least", "`Sky`"]);
    wrong("[Sky", "[Skye", "17:18", &["`Skye` is not a kind of draw", "did you mean `Sky`?"]);
    wrong("Objects(Masked)", "Objects(Maskd)", "5:43", &["`Maskd` is not a draw list", "did you mean `Masked`?"]);
    wrong("[Sky", "[Casters(Transparent)", "17:26", &["`Transparent` is not a draw list", "`Opaque` or `Masked`"]);
    wrong("[Compute", "[Computed", "26:18", &["`Computed` is not a kind of draw", "did you mean `Compute`?"]);
    let compute = "of: [Compute],\n            vertex_stride: ";
    let said = &["compute passes have no vertices", "an entry of its own"];
    wrong(&format!("{compute}0"), &format!("{compute}4"), "27:28", said);
    let pushed = "of: [Compute],\n            push_constants: [(bytes: 16)],\n            vertex_stride: ";
    let said = &["compute passes have no push constants", "an entry of its own"];
    wrong(compute, pushed, "27:29", said);
    let compute = "of: [Compute],\n            vertex_stride: ";
    let (own, said) =
        (compute.replace("Compute", "Vertices"), ["vertices have none of a draw source", "give `Vertices` an entry"]);
    wrong(&format!("{compute}0"), &format!("{own}4"), "27:28", &said);
    let said = ["vertices have no push constants of a draw source", "give `Vertices` an entry of its own"];
    wrong(compute, &pushed.replace("Compute", "Vertices"), "27:29", &said);
    let full_screen = "of: [FullScreen],\n            topology: LineList,\n            vertex_stride: ";
    let said = &["full-screen passes have no vertices", "give `FullScreen` an entry of its own"];
    wrong(compute, full_screen, "27:23", said);
    let full_screen = "of: [FullScreen],\n            vertex_stride: 4";
    wrong(&format!("{compute}0"), full_screen, "27:28", said);
    wrong("vertex_stride: 20", "vertex_stride: -4", "6:28", &["the stride can't be -4"]);
    wrong("vertex_stride: 20", "vertex_stride: 16", "9:17", &["`tangent` doesn't fit vertices of 16 bytes"]);
    wrong("offset: 12", "offset: 13", "9:17", &["`tangent` doesn't fit vertices of 20 bytes"]);
    wrong("offset: 12", "offset: 4294967292", "9:17", &["`tangent` doesn't fit vertices of 20 bytes"]);
    wrong("components: 2", "components: 5", "9:17", &["`tangent` has 5 components; it can have 1 to 4"]);
    wrong("components: 2", "components: 1.5", "9:47", &["expected a whole number, found `1.5`"]);
    wrong("\"tangent\"", "\"place\"", "9:17", &["`place` is the name of two attributes", "first here"]);
    wrong("\"tangent\"", "\"tan gent\"", "9:17", &["`tan gent` can't be a name in shaders"]);
    wrong("\"tangent\"", "\"tan\\u{202e}gent\"", "9:24", &["names take no escapes"]);
    wrong("\"tangent\"", "\"tan\u{202e}gent\"", "9:17", &["`tan\\u{202e}gent` can't be a name in shaders"]);
    wrong("set: 3", "set: 0", "13:17", &["`detail` can't be brought along in set 0: a draw source has sets 1 to 3"]);
    wrong("set: 3", "set: 4", "13:17", &["`detail` can't be brought along in set 4"]);
    wrong("binding: 7", "binding: 256", "13:17", &["`detail` at binding 256: bindings go up to 255"]);
    wrong("binding: 7", "binding: 5000000000", "13:51", &["the binding can't be 5000000000"]);
    wrong("set: 3, binding: 7", "set: 1, binding: 0", "13:17", &["`detail` is brought along where something else is"]);
    wrong("\"detail\"", "\"camera\"", "13:17", &["`camera` is the name of two resources", "first here"]);
    wrong("SampledImage", "SampledImages", "13:60", &["is not a kind of resource", "did you mean `SampledImage`?"]);
    wrong("kind: SampledImage", "stage: SampledImage", "13:54", &["a resource has no field `stage`"]);
    wrong("count: 64", "count: 0", "13:17", &["`detail` is brought along 0 times; once is the least"]);
    wrong("count: 64", "count: -1", "13:81", &["the count can't be -1"]);
    wrong("kind: SampledImage", "kind: StorageBlock", "13:17", &["`detail` is brought along 64 times, as only a `Sam"]);
    wrong("\"hair-2\"", "\"grass\"", "35:23", &["`grass` is the name of more than one custom pass"]);
    wrong("\"hair-2\"", "\"2\"", "35:23", &["`2` can't be the name of a custom pass"]);
}

#[test]
fn all_mistakes_are_told_at_once() {
    let text = ENGINE.replace("set: 3", "set: 9").replace("[Sky", "[Skye").replace("\"grass\"", "\"\"");
    assert_eq!(read(&text).expect_err("wrong").matches("error: ").count(), 3);
}

#[test]
fn a_file_that_is_empty_too_large_or_full_of_mistakes_is_refused_quickly() {
    assert!(read("  \n").expect_err("empty").contains("the file is empty"));
    let large = format!("Interface(version: 1, draws: [{}])", " ".repeat(1 << 20));
    assert!(read(&large).expect_err("large").contains("an interface has at most 1048576"));
    let many = format!(
        "Interface(version: 1, draws: [(of: [Sky], supplied: [{}])])",
        "(name: \"a\", set: 1, binding: 0, kind: UniformBlock),".repeat(18_000)
    );
    assert!(read(&many).expect_err("many").contains("`a` is brought along where something else is"));
}

fn interface() -> impl Strategy<Value = DrawInterface> {
    let kind = prop::sample::select(SuppliedKind::NAMED.map(|(_, kind)| kind).to_vec());
    let named = ("[A-Za-z_][A-Za-z0-9_]{0,9}", kind, 1_u32..100);
    let supplied = prop::collection::btree_map((1_u32..4, 0_u32..256), named, 0..6);
    let format = prop::sample::select(VertexFormat::NAMED.iter().map(|(_, format)| *format).collect::<Vec<_>>());
    let attribute = (format, 1_u32..5, 0_u32..3, prop::option::of(0_u32..16));
    let attributes = prop::collection::btree_map("[A-Za-z_][A-Za-z0-9_]{0,9}", attribute, 0..6);
    let rate = prop_oneof![Just(VertexRate::Vertex), (1_u32..5).prop_map(|divisor| VertexRate::Instance { divisor }),];
    let buffers = prop::collection::vec((rate, 1_u32..9), 0..4);
    (supplied, attributes, buffers, prop::bool::ANY).prop_map(|(supplied, named, buffers, strips)| {
        let mut interface = DrawInterface::default();
        if strips {
            (interface.topology, interface.primitive_restart) = (Some(PrimitiveTopology::TriangleStrip), true);
        }
        let buffer = |(rate, more)| VertexBuffer { stride: 8 * more, rate };
        interface.vertex_buffers.extend(buffers.into_iter().map(buffer));
        for (name, (format, locations, buffer, location)) in named {
            let Some(VertexBuffer { stride, .. }) = interface.vertex_buffers.get_mut(buffer as usize) else { continue };
            let offset = stride.next_multiple_of(8);
            *stride = (offset + locations * format.bytes()).next_multiple_of(8);
            let name = name.into();
            interface.attributes.push(Attribute { name, format, locations, location, buffer, offset });
        }
        let by_name: BTreeMap<String, SuppliedResource> = supplied
            .into_iter()
            .map(|((set, binding), (name, kind, count))| {
                let count = if kind == SuppliedKind::SampledImage { count } else { 1 };
                (name.clone(), SuppliedResource { set, binding, name: name.into(), kind, count })
            })
            .collect();
        interface.supplied.extend(by_name.into_values());
        interface
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn what_is_written_is_read_again(
        draws in prop::collection::btree_map(prop::sample::select(DrawKind::ALL.to_vec()), interface(), 0..9),
        custom in prop::option::of(prop::collection::btree_set("[a-z_][a-z0-9_-]{5,9}", 0..4)),
    ) {
        let all = draws.into_iter().fold(DrawInterfaces::default(), |all, (kind, draws)| all.with(kind, draws));
        let all = match &custom {
            Some(names) => names.iter().fold(all, |all, name| all.with_custom(name.as_str(), DrawInterface::default())),
            None => all,
        };
        let all = match custom {
            Some(names) => all.with_custom_passes(names),
            None => all,
        };
        prop_assert_eq!(read(&all.to_ron()), Ok(all));
    }
}

#[test]
fn a_list_decides_what_objects_bring() {
    let masked = Draw::Objects(DrawList::Masked);
    let only = |draw: Draw| if draw == masked { engine(masked) } else { DrawInterface::default() };
    let interfaces = DrawInterfaces::from(only);
    assert_eq!(interfaces.of(masked), engine(masked));
    assert_eq!(interfaces.of(Draw::Objects(DrawList::Opaque)), DrawInterface::default());
}

/// Sets that a program binds itself, as a file holds them (DO-5).
const SETS: &str = r#"Interface(
    version: 1,
    draws: [
    ],
    sets: [
        (
            set: 2,
            bindings: [
                (binding: 0, kind: CombinedImageSampler, count: 1024, stages: [Fragment], flags: [PartiallyBound, UpdateAfterBind, VariableDescriptorCount]),
            ],
        ),
        (
            set: 3,
            bindings: [
                (binding: 0, kind: UniformBufferDynamic),
                (binding: 4, kind: StorageBuffer, stages: [Vertex, Compute]),
            ],
        ),
    ],
)
"#;

#[test]
fn sets_of_a_program_are_written_and_read_again() {
    let flags = BindingFlags {
        partially_bound: true,
        update_after_bind: true,
        update_unused_while_pending: false,
        variable_count: true,
    };
    let table = ProgramBinding::new(0, DescriptorType::CombinedImageSampler).with_count(1024);
    let table = table.with_stages(Stages::FRAGMENT_SHADER).with_flags(flags);
    let frame = [
        ProgramBinding::new(0, DescriptorType::UniformBufferDynamic),
        ProgramBinding::new(4, DescriptorType::StorageBuffer)
            .with_stages(Stages::VERTEX_SHADER | Stages::COMPUTE_SHADER),
    ];
    let interfaces =
        DrawInterfaces::default().with_set(ProgramSet::new(3, frame)).with_set(ProgramSet::new(2, [table]));
    assert_eq!(interfaces.to_ron(), SETS);
    assert_eq!(read(SETS), Ok(interfaces));
}

/// What shaders follow beside bindings that bound them: rays and addresses (DO-4).
#[test]
fn do_4_acceleration_structures_and_addresses_are_written_and_read_again() {
    const TRACED: &str = r#"Interface(
    version: 1,
    draws: [
    ],
    sets: [
        (
            set: 1,
            bindings: [
                (binding: 0, kind: AccelerationStructure, stages: [Fragment]),
            ],
        ),
    ],
    addresses: true,
)
"#;
    let scene = ProgramBinding::new(0, DescriptorType::AccelerationStructure).with_stages(Stages::FRAGMENT_SHADER);
    let interfaces = DrawInterfaces::default().with_set(ProgramSet::new(1, [scene]));
    assert!(!interfaces.addresses());
    let interfaces = interfaces.with_addresses();
    assert_eq!(interfaces.to_ron(), TRACED);
    assert_eq!(read(TRACED), Ok(interfaces.clone()));
    let none = read(&TRACED.replace("addresses: true", "addresses: false")).expect("an interface");
    assert!(!none.addresses() && none.sets() == interfaces.sets());
    let shown = read(&TRACED.replace("addresses: true", "addresses: all")).expect_err("a mistake");
    assert!(shown.contains("13:16"), "{shown}");
    let shown = read(&TRACED.replace("Structure,", "Structure, count: 17,")).expect_err("a mistake");
    assert!(shown.contains("17 acceleration structures; every device that has such allows 16"), "{shown}");
}

#[test]
fn every_mistake_in_a_set_of_a_program_is_told_at_its_place() {
    let wrong = |old: &str, new: &str, place: &str, said: &str| {
        assert!(SETS.contains(old), "{old}");
        let shown = read(&SETS.replacen(old, new, 1)).expect_err("a mistake");
        assert!(shown.contains(place) && shown.contains(said), "`{said}` at {place} is not in\n{shown}");
    };
    wrong("set: 2", "set: 0", "7:18", "set 0 can't be the program's: those are 1 to 3");
    wrong("set: 2", "set: 4", "7:18", "set 4 can't be the program's");
    wrong("set: 3", "set: 2", "13:18", "set 2 stands here twice");
    wrong("set: 2", "set: -1", "7:18", "the number of the set can't be -1");
    wrong("CombinedImageSampler", "Texture", "9:36", "a type of descriptors");
    wrong("count: 1024", "count: 0", "9:17", "binding 0 has no descriptors; one is the least");
    wrong("count: 1024", "count: 500001", "7:18", "500001 descriptors that are updated after they were bound");
    wrong("stages: [Fragment]", "stages: []", "9:17", "binding 0 is for no stage");
    wrong("[Fragment]", "[Pixel]", "9:80", "a stage");
    wrong("PartiallyBound", "Partially", "9:99", "a flag");
    wrong("binding: 4", "binding: 0", "16:17", "binding 0 stands here twice");
    wrong("binding: 4", "binding: 256", "16:17", "bindings go up to 255");
    wrong(
        "UniformBufferDynamic",
        "UniformBufferDynamic, flags: [UpdateAfterBind]",
        "15:17",
        "which can neither be updated after it was bound nor have a variable count",
    );
    wrong(
        "UniformBufferDynamic",
        "StorageBuffer, flags: [VariableDescriptorCount]",
        "15:17",
        "binding 0 has a variable count, as only the last one can",
    );
    wrong("UniformBufferDynamic", "UniformBufferDynamic, count: 9", "13:18", "every device that has such allows 8");
    wrong(
        "draws: [",
        "draws: [(of: [Sky], supplied: [(name: \"sun\", set: 2, binding: 0, kind: UniformBlock)])",
        "7:18",
        "set 2 is the draw source's: it brings resources in it along for `Sky`",
    );
}
