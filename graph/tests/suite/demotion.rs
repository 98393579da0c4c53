//! Full-screen draws gain nothing from several samples, so they move to images of one.

use crate::testing::plans::planned;
use crate::testing::raster::{self, Raster};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Blend, Frame};
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::Format::R16G16B16A16_SFLOAT;

/// Objects in an image of 4 samples, with `strength` blurs: to and fro between that image and one of one sample.
fn blurred(strength: u32) -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", R16G16B16A16_SFLOAT, 4);
    let other = raster.image("other", R16G16B16A16_SFLOAT, 1);
    let screen = raster.image("screen", R16G16B16A16_SFLOAT, 1);
    raster.objects("opaque").clear(color);
    let [mut from, mut to] = [color, other];
    for draw in 1..strength {
        raster.full_screen(&format!("blur {draw}")).sample(from).color(to, Blend::Replace);
        (from, to) = (to, from);
    }
    raster.full_screen("last blur").sample(from).color(screen, Blend::Replace);
    raster.output(screen)
}

fn compiled(frame: &Frame, demote: bool) -> Plan {
    planned(frame, &raster::device(), &Options { demote, ..Options::default() }).expect("the frame is valid")
}

/// IQ-9: a blur of strength 5 takes three resolves as it is written, and one where its draws are moved; both Plans can be
/// had.
#[test]
fn a_blur_onto_a_multisampled_image_takes_one_resolve_instead_of_three() {
    let frame = blurred(5);
    let [moved, written] = [true, false].map(|demote| compiled(&frame, demote));
    assert_eq!((moved.totals.resolves, written.totals.resolves), (1, 3), "{}\n{}", moved.tree(), written.tree());
    let said = |plan: &Plan| plan.notes.iter().filter(|note| note.text.contains("1 sample instead of 4")).count();
    assert_eq!((said(&moved), said(&written)), (2, 0), "each draw that moved says so:\n{}", moved.tree());
}

/// IQ-9: objects drawn after it need the samples, so the draws before them stay.
#[test]
fn a_full_screen_draw_stays_multisampled_where_objects_are_drawn_onto_it() {
    let mut raster = Raster::default();
    let [source, screen] = ["source", "screen"].map(|name| raster.image(name, R16G16B16A16_SFLOAT, 1));
    let color = raster.image("color", R16G16B16A16_SFLOAT, 4);
    raster.objects("opaque").clear(source);
    raster.full_screen("backdrop").sample(source).color(color, Blend::Replace);
    raster.objects("glass").color(color, Blend::Alpha);
    raster.full_screen("show").sample(color).color(screen, Blend::Replace);
    let frame = raster.output(screen);
    let [moved, written] = [true, false].map(|demote| compiled(&frame, demote));
    assert_eq!((moved.totals.resolves, written.totals.resolves), (1, 1));
    assert!(moved.images.iter().any(|image| image.samples == 4), "{}", moved.tree());
}
