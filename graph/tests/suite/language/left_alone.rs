//! What transfers and draws leave as it was: bytes behind the last texel, volumes' last levels, planes that nothing tests or writes.

use crate::testing::pipelines::{INPUTS, right};
use crate::testing::plans::compiled;
use framewright_graph::plan;
use framewright_graph::vulkan::{Aspects, Format};

/// Buffers have a multiple of four bytes. What a copy doesn't reach stays what it was: what the file wrote there, else zero.
#[test]
fn a_copy_of_texels_with_odd_bytes_keeps_the_rest_of_the_buffer() {
    let planes = [("", "color"), (", plane: Depth", "depth"), (", plane: Stencil", "stencil")];
    let formats = [
        ("R8_UNORM", 1, 0),
        ("R8G8_UNORM", 2, 0),
        ("R16_SFLOAT", 2, 0),
        ("R16_UINT", 2, 0),
        ("R8G8B8A8_UNORM", 4, 0),
        ("D16_UNORM", 2, 1),
        ("D32_SFLOAT", 4, 1),
        ("D32_SFLOAT_S8_UINT", 4, 1),
        ("D32_SFLOAT_S8_UINT", 1, 2),
    ];
    let mut padded = 0;
    for (format, texel, plane) in formats {
        for (width, height, layers) in [(1, 1, 1), (5, 3, 1), (3, 1, 1), (4, 3, 1), (1, 1, 3), (5, 1, 2)] {
            let bytes: u32 = texel * width * height * layers;
            let rounded = bytes.next_multiple_of(4);
            for filled in [false, true] {
                let fill = if filled { r#"(name: "before", fill: (to: "b", value: 7)),"# } else { "" };
                let text = format!(
                    r#"Pipeline(version: 1,
                        images: [(name: "a", format: {format}, size: Fixed({width}, {height}), layers: {layers}, lifetime: Persistent)],
                        buffers: [(name: "b", bytes: {rounded}), (name: "c", bytes: {rounded})],
                        passes: [{fill} (name: "read_back", copy: (from: (image: "a"{}), to: "b")),
                                 (name: "on", copy: (from: "b", to: "c"))],
                        outputs: [(buffer: "c")])"#,
                    planes[plane].0,
                );
                let plan = compiled(&right(&text, &INPUTS));
                let what = format!("{} of {width}×{height}×{layers} {format}, filled: {filled}", planes[plane].1);
                let fills = plan.steps.iter().filter_map(|step| match &step.work {
                    plan::Work::Fill(fill) => fill.name.as_deref(),
                    _ => None,
                });
                let expected = match (bytes == rounded, filled) {
                    (true, _) => vec![],
                    (false, false) => vec!["read_back (padding)"],
                    (false, true) => vec!["before"],
                };
                assert_eq!(fills.collect::<Vec<_>>(), expected, "{what}");
                padded += u32::from(bytes != rounded);
            }
        }
    }
    assert!(padded > 40, "{padded}");
}

/// What a frame left there stays, and so does what an earlier copy left.
#[test]
fn only_the_first_copy_of_odd_bytes_needs_what_lies_behind_them_filled() {
    let text = |lifetime: &str| {
        format!(
            r#"Pipeline(version: 1,
                images: [(name: "a", format: R8_UNORM, size: Fixed(3, 1), lifetime: Persistent)],
                buffers: [(name: "b", bytes: 4, lifetime: {lifetime}), (name: "c", bytes: 4), (name: "d", bytes: 4)],
                passes: [(name: "one", copy: (from: "a", to: "b")), (name: "then", copy: (from: "b", to: "c")),
                         (name: "two", copy: (from: "a", to: "b")), (name: "last", copy: (from: "b", to: "d"))],
                outputs: [(buffer: "c"), (buffer: "d")])"#
        )
    };
    for (lifetime, fills) in [("Transient", 1), ("Persistent", 0), ("History", 1)] {
        let plan = compiled(&right(&text(lifetime), &INPUTS));
        let count = plan.steps.iter().filter(|step| matches!(step.work, plan::Work::Fill(_))).count();
        assert_eq!(count, fills, "{lifetime}");
    }
}

#[test]
fn volumes_are_scaled_down_to_their_last_level() {
    for (width, height, depth, mips) in [(8, 8, 4, 3), (4, 4, 4, 3), (2, 2, 16, 5), (16, 1, 2, 5), (5, 3, 7, 3)] {
        let text = format!(
            r#"Pipeline(version: 1,
                images: [(name: "v", format: R8G8B8A8_UNORM, size: Fixed({width}, {height}), shape: D3({depth}), mips: {mips}),
                         (name: "flat", format: R8G8B8A8_UNORM, size: Fixed(2, 2))],
                passes: [(name: "first", fill: (to: (image: "v", mip: 0), value: 0.5)),
                         (name: "level", repeat: ("i", {}), blit: (from: (image: "v", mip: "i"), to: (image: "v", mip: "i + 1"))),
                         (name: "show", blit: (from: (image: "v", mip: {}), to: "flat"))],
                outputs: ["flat"])"#,
            mips - 1,
            mips - 1,
        );
        let plan = compiled(&right(&text, &INPUTS));
        let blits = plan.steps.iter().filter(|step| matches!(step.work, plan::Work::Blit(_))).count();
        assert_eq!(blits, mips as usize);
    }
}

/// Depth that is neither tested nor written needs no contents, and stencil that is neither has none either.
#[test]
fn a_plane_that_a_draw_neither_tests_nor_writes_is_left_alone() {
    let planes = |fields: &str| {
        let text = format!(
            r#"Pipeline(version: 1,
                images: [(name: "d", format: D32_SFLOAT_S8_UINT, size: Output, lifetime: Persistent)],
                passes: [(name: "draw", draw: Objects(Opaque), shader: "lit", depth: (image: "d", {fields}))], outputs: ["d"])"#
        );
        let depth = right(&text, &INPUTS).passes.swap_remove(0).depth.expect("it has one");
        depth.planes(Format::D32_SFLOAT_S8_UINT).map(|(plane, ..)| plane).fold(Aspects::empty(), |all, it| all | it)
    };
    let (depth, stencil) = (Aspects::DEPTH, Aspects::STENCIL);
    let untouched = "write: false, test: Always";
    assert_eq!(planes(&format!("{untouched}, stencil: (reference: 3, pass: Replace)")), stencil);
    assert_eq!(planes(&format!("{untouched}, stencil: (test: Equal, reference: 3)")), stencil);
    assert_eq!(planes(&format!("{untouched}, stencil: (clear: 0)")), stencil);
    assert_eq!(planes("write: false, test: Never, stencil: (test: Equal)"), depth | stencil);
    assert_eq!(planes("write: true, test: Always, stencil: (test: Equal)"), depth | stencil);
    assert_eq!(planes("clear: 0.0, write: false, test: Always, stencil: (test: Equal)"), depth | stencil);
    assert_eq!(planes("stencil: (reference: 3)"), depth);
    assert_eq!(planes("write: false, stencil: (reference: 3)"), depth);
}
