//! Several draws at once, whose counts a pass of the frame wrote, and their number with them.

use crate::frames::{Small, Uses, dispatch, draw, frame, in_each_way, on_each_driver, planned, texels};
use framewright_graph::compile::{Options, compile};
use framewright_graph::frame::{BufferRole, Draw, Frame, Groups, ImageIndex, IndirectDraws, ParamValue, Pass};
use framewright_graph::plan::Plan;
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Accesses, Format, Stages, Subresources};
use framewright_vulkan::Device;

const WHOLE: Subresources = Subresources::WHOLE;
const ONE: Groups = Groups::Count([1, 1, 1]);
const CLEAR: Option<[f64; 4]> = Some([1.0, 0.0, 0.0, 0.0]);
/// How many draws there are at most. Each draws one texel of a row.
const MOST: u32 = 6;

const SHADERS: &[(&str, &str)] = &[
    (
        "write.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer Commands { uint commands[]; };
        layout(set = 0, binding = 1) writeonly buffer Number { uint number[]; };
        layout(set = 0, binding = 2) uniform Params { uint first; uint stride; uint number_at; uint number; uint indexed; } params;
        void main() {
            for (uint i = 0; i < 6; ++i) {
                uint at = params.first + i * params.stride;
                // Vertices or indices, instances, first vertex or index, vertex offset of indices, first instance.
                commands[at] = 3;
                commands[at + 1] = 1 + i % 2;
                commands[at + 2] = 3 * i;
                if (params.indexed != 0) commands[at + 3] = 0;
                commands[at + 3 + params.indexed] = i;
            }
            number[params.number_at] = params.number;
        }",
    ),
    (
        "indices.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer Indices { uint index[]; };
        void main() { for (uint i = 0; i < 18; ++i) index[i] = i; }",
    ),
    (
        "texel.vert",
        "#version 460
        layout(location = 0) flat out uint seen;
        void main() {
            uint column = gl_VertexIndex / 3, corner = gl_VertexIndex % 3;
            float left = float(column) / 4.0 - 1.0;
            gl_Position = vec4(left + (corner == 1 ? 0.25 : 0.0), float(corner) - 1.0, 0.0, 1.0);
            seen = 10 + gl_InstanceIndex;
        }",
    ),
    (
        "texel.frag",
        "#version 460
        layout(location = 0) flat in uint seen;
        layout(location = 0) out uint color;
        void main() { color = seen; }",
    ),
    (
        "numbered.vert",
        "#version 460
        layout(location = 0) flat out uint seen;
        void main() {
            uint column = gl_VertexIndex / 3, corner = gl_VertexIndex % 3;
            float left = float(column) / 4.0 - 1.0;
            gl_Position = vec4(left + (corner == 1 ? 0.25 : 0.0), float(corner) - 1.0, 0.0, 1.0);
            seen = 50 + gl_DrawID;
        }",
    ),
    (
        "numbered.frag",
        "#version 460
        layout(location = 0) flat in uint seen;
        layout(location = 0) out uint color;
        void main() { color = seen; }",
    ),
];

/// How draws stand in their buffers, and the number that the pass writes for them.
#[derive(Debug, Clone, Copy)]
struct Case {
    draws: IndirectDraws,
    indexed: bool,
    number: u32,
}

impl Case {
    const fn new(draws: IndirectDraws, indexed: bool) -> Case {
        Case { draws, indexed, number: MOST }
    }

    /// How many are drawn.
    fn drawn(self) -> u32 {
        if self.draws.count.is_some() { self.number.min(self.draws.draws) } else { self.draws.draws }
    }

    /// What the draws leave in the row.
    fn row(self) -> Vec<u32> {
        // The second of two instances is on top.
        (0..8).map(|column| if column < self.drawn() { 10 + column + column % 2 } else { 1 }).collect()
    }
}

const SIDE_BY_SIDE: IndirectDraws = IndirectDraws { draws: MOST, ..IndirectDraws::ONE };
const APART: IndirectDraws = IndirectDraws { draws: MOST, offset: 12, stride: Some(32), count: None };

fn row(small: &mut Small) -> ImageIndex {
    let row = small.image("row", Format::R32_UINT, [8, 1]);
    small.image_output(row);
    row
}

/// A frame whose counts a pass writes.
fn written(small: &mut Small, case: Case) -> impl Fn(&str, Draw) -> Pass + use<> {
    let Case { draws, indexed, number } = case;
    let (commands, numbers) = (small.buffer("commands", 80), small.buffer("numbers", 4));
    let write = dispatch("write", ONE).block("Commands", commands, (false, true));
    let mut write = write.block("Number", numbers, (false, true));
    let words = |bytes: u64| i64::try_from(bytes / 4).expect("they are few");
    for (name, value) in [
        ("first", words(draws.offset)),
        ("stride", words(draws.stride(indexed).into())),
        ("number_at", words(draws.count.unwrap_or(0))),
        ("number", number.into()),
        ("indexed", indexed.into()),
    ] {
        write.params.push((name.into(), ParamValue::Integer(value)));
    }
    small.pass(write);
    let indices = indexed.then(|| small.buffer("indices", 18));
    if let Some(indices) = indices {
        small.pass(dispatch("indices", ONE).block("Indices", indices, (false, true)));
    }
    move |name, drawn: Draw| {
        let pass = draw(name, drawn).takes(commands, BufferRole::Indirect);
        let pass = if drawn.is_counted() { pass.takes(numbers, BufferRole::Count) } else { pass };
        indices.into_iter().fold(pass, |pass, indices| pass.takes(indices, BufferRole::Index))
    }
}

/// All draws at once.
fn at_once(case: Case, shader: &str) -> Frame {
    let mut small = Small::default();
    let row = row(&mut small);
    let pass = written(&mut small, case);
    let pass = pass(shader, Draw::Indirects(case.draws));
    small.pass(pass.draws(row, WHOLE, CLEAR));
    small.frame
}

/// The same draws, one by one.
fn one_by_one(case: Case) -> Frame {
    let mut small = Small::default();
    let row = row(&mut small);
    let pass = written(&mut small, case);
    for number in 0..case.drawn() {
        let offset = case.draws.offset + u64::from(number * case.draws.stride(case.indexed));
        let draws = IndirectDraws { offset, ..IndirectDraws::ONE };
        let clear = if number == 0 { CLEAR } else { None };
        let pass = Pass { name: format!("draw {number}").into(), ..pass("texel", Draw::Indirects(draws)) };
        small.pass(pass.draws(row, WHOLE, clear));
    }
    small.frame
}

fn drawn(device: &Device, frame_of: &Frame, row: &[u32]) {
    in_each_way(device, frame_of, SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "row", 0), row);
    });
}

/// Why a device doesn't draw it; `None` if it does.
fn refused(device: &Device, frame: &Frame) -> Option<String> {
    let errors = compile(frame, &device.profile(), &mut device.memory(), &Options::default()).err()?;
    Some(errors.iter().map(|error| format!("{} {}", error.code, error.message)).collect())
}

fn has(device: &Device, feature: &str) -> bool {
    device.profile().has_feature(feature)
}

#[test]
fn do_11_several_indirect_draws_at_once_are_the_same_as_one_by_one() {
    on_each_driver(|device| {
        for case in [
            Case::new(SIDE_BY_SIDE, false),
            Case::new(SIDE_BY_SIDE, true),
            Case::new(APART, false),
            Case::new(APART, true),
            Case::new(IndirectDraws { draws: 4, ..APART }, true),
        ] {
            println!("{case:?}");
            drawn(device, &at_once(case, "texel"), &case.row());
            drawn(device, &one_by_one(case), &case.row());
        }
    });
}

#[test]
fn do_11_a_pass_writes_how_many_draws_there_are() {
    on_each_driver(|device| {
        for (draws, indexed, number) in [
            (IndirectDraws { count: Some(0), ..SIDE_BY_SIDE }, false, 4),
            (IndirectDraws { count: Some(8), ..SIDE_BY_SIDE }, true, 1),
            (IndirectDraws { count: Some(12), ..APART }, false, 9),
            (IndirectDraws { count: Some(4), ..APART }, true, 5),
            (IndirectDraws { count: Some(0), ..SIDE_BY_SIDE }, false, 0),
        ] {
            let case = Case { draws, indexed, number };
            println!("{case:?}");
            let at_once = at_once(case, "texel");
            if has(device, "drawIndirectCount") {
                drawn(device, &at_once, &case.row());
                let same = case.drawn() > 0;
                same.then(|| drawn(device, &one_by_one(case), &case.row()));
                reads_the_number(device, &at_once);
            } else {
                let name = &device.profile().name;
                let said = format!(
                    "E1116 pass `texel` can't be drawn on `{name}`: a number of draws that a buffer holds needs the feature drawIndirectCount"
                );
                assert_eq!(refused(device, &at_once), Some(said));
            }
        }
    });
}

/// The number of draws is waited for, as the counts are. Without that `verify` finds a hazard.
fn reads_the_number(device: &Device, frame: &Frame) {
    let plan = planned(device, frame, &Options::default());
    let read = (Stages::DRAW_INDIRECT, Accesses::INDIRECT_COMMAND_READ);
    let waits = |plan: &Plan| {
        let barriers = plan.steps.iter().flat_map(|step| &step.memory_barriers);
        barriers.filter(|it| it.dst_stages.contains(read.0) && it.dst_accesses.contains(read.1)).count()
    };
    assert!(waits(&plan) > 0, "{}", plan.tree());
    let number = plan.buffers.iter().find(|buffer| *buffer.name == *"numbers").expect("it is read").id;
    let mut wrong = plan.clone();
    for barrier in wrong.steps.iter_mut().flat_map(|step| &mut step.memory_barriers) {
        if barrier.dst_stages.contains(read.0) {
            (barrier.dst_stages, barrier.dst_accesses) = (Stages::VERTEX_INPUT, Accesses::INDEX_READ);
        }
    }
    let found = verify(&wrong).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    assert!(found.contains("numbers"), "{found}");
    let mut wrong = plan.clone();
    wrong.buffers[number.0 as usize].bytes = 4;
    let buffer = verify(&wrong).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    let at =
        wrong.steps.iter().find_map(|step| step.work.passes().iter().find_map(|pass| pass.draw?.indirect()?.count));
    let too_small = at.is_some_and(|at| at > 0);
    assert_eq!(buffer.contains("has 4 bytes, and pass `texel` reads "), too_small, "{buffer}");
}

#[test]
fn do_11_shaders_know_the_number_of_their_draw() {
    on_each_driver(|device| {
        if has(device, "shaderDrawParameters") {
            let frame = at_once(Case::new(SIDE_BY_SIDE, true), "numbered");
            drawn(device, &frame, &[50, 51, 52, 53, 54, 55, 1, 1]);
        }
    });
}

#[test]
fn do_11_more_indirect_draws_than_a_device_makes_are_refused_by_feature_and_limit() {
    on_each_driver(|device| {
        let frame = at_once(Case::new(SIDE_BY_SIDE, false), "texel");
        let mut profile = device.profile();
        profile.name = "mine".to_owned();
        let refused = |profile: &_| {
            let errors = compile(&frame, profile, &mut device.memory(), &Options::default()).expect_err("too many");
            errors.iter().map(|error| format!("{} {}", error.code, error.message)).collect::<String>()
        };
        profile.limits.as_mut().expect("they are known").indirect_draws = 5;
        let said =
            "E1116 pass `texel` can't be drawn on `mine`: it makes 6 draws, and 5 are allowed (maxDrawIndirectCount)";
        assert_eq!(refused(&profile), said);
        profile.features.as_mut().expect("they are known").retain(|name| name != "multiDrawIndirect");
        let said = "E1116 pass `texel` can't be drawn on `mine`: several indirect draws at once needs the feature multiDrawIndirect";
        assert_eq!(refused(&profile), said);
    });
}

#[test]
fn counts_of_draws_that_stand_where_none_can_are_refused() {
    for (draws, indexed, said) in [
        (IndirectDraws { stride: Some(16), ..SIDE_BY_SIDE }, true, "at least 20, and not 16"),
        (IndirectDraws { stride: Some(18), ..SIDE_BY_SIDE }, false, "at least 16, and not 18"),
        (
            IndirectDraws { offset: 6, ..SIDE_BY_SIDE },
            false,
            "the first draw stands at a multiple of 4 bytes, not at 6",
        ),
        (
            IndirectDraws { count: Some(2), ..SIDE_BY_SIDE },
            false,
            "the number of draws stands at a multiple of 4 bytes, not at 2",
        ),
        (IndirectDraws { draws: 0, ..SIDE_BY_SIDE }, false, "there is no draw"),
    ] {
        assert!(
            draws.fault(indexed).is_some_and(|fault| fault.contains(said)),
            "{draws:?}: {:?}",
            draws.fault(indexed)
        );
    }
    assert_eq!((SIDE_BY_SIDE.end(false), APART.end(true)), (96, 12 + 5 * 32 + 20));
}
