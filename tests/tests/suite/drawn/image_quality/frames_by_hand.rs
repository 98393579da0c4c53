//! Work of a frame, against what one would write by hand for the same choices: no full-screen draw, copy or resolve more.
//!
//! The scene has opaque objects, a sky and glass. Each expected frame is counted from what its choices need, not from a Plan.

use crate::drawn::image_quality::{DIRECT, Set, listing, plan};
use std::error::Error;

/// Rendering scopes, passes in them, and resolves, each of which is folded into a scope. Nothing is copied.
fn demand(set: Set<'_>, [scopes, passes, resolves]: [u32; 3]) -> Result<(), Box<dyn Error>> {
    let Some(plan) = plan(set)? else { return Ok(()) };
    let (totals, listing) = (&plan.totals, listing(&plan));
    let found = [totals.scopes, totals.passes + totals.inserted_passes, totals.resolves];
    assert_eq!(found, [scopes, passes, resolves], "{set:?}: {listing:?}");
    assert_eq!((totals.folded_resolves, totals.copies, totals.fills), (resolves, 0, 0), "{set:?}: {listing:?}");
    let entries = listing.iter().filter(|entry| **entry != "(resolve)");
    assert_eq!(entries.count(), passes as usize, "{set:?}: {listing:?}");
    Ok(())
}

/// One scope: opaque objects, sky and glass into the screen.
#[test]
fn with_everything_off_it_is_the_scene_alone() -> Result<(), Box<dyn Error>> {
    demand(&DIRECT, [1, 3, 0])
}

/// The scene (3 passes), its samples averaged at the end of the scope; tone mapping of that into the screen (1).
#[test]
fn samples_and_tone_mapping_take_one_resolve_and_one_draw() -> Result<(), Box<dyn Error>> {
    demand(&[("mapped", "pixels")], [2, 4, 1])
}

/// The scene (3), averaged; then five blurs (5), each in a scope of its own, since it reads what the one before drew.
#[test]
fn a_blur_takes_one_resolve_and_its_own_draws() -> Result<(), Box<dyn Error>> {
    demand(&[("hdr", "false"), ("tone_mapping", "clip"), ("blur", "5")], [6, 8, 1])
}

/// Opaque objects once more for depth of one sample (1), before all else; then one scope of opaque objects, sky, stripes
/// that are blended, and glass (4), averaged; tone mapping (1).
#[test]
fn stripes_that_are_blended_stay_in_the_scope_of_the_scene() -> Result<(), Box<dyn Error>> {
    demand(&[("mapped", "pixels"), ("depth_stripes", "blended")], [3, 6, 1])
}

/// Opaque objects and sky (2), averaged; depth of one sample (1); stripes that sample both (1); those back into all samples
/// and glass (2), averaged; tone mapping (1).
#[test]
fn stripes_that_sample_the_colour_take_two_scopes_and_a_resolve_more() -> Result<(), Box<dyn Error>> {
    demand(&[("mapped", "pixels"), ("depth_stripes", "copied")], [5, 7, 2])
}

/// The choice of the file itself: the scene (3), whose samples are kept; the draw that maps each of them and averages (1).
#[test]
fn tone_mapping_of_samples_takes_no_resolve_and_one_draw() -> Result<(), Box<dyn Error>> {
    demand(&[], [2, 4, 0])
}

/// The scene (3), whose samples are kept; the draw that maps each of them and averages (1); three blurs (3).
#[test]
fn where_samples_are_tone_mapped_nothing_else_resolves_them() -> Result<(), Box<dyn Error>> {
    demand(&[("mapped", "samples"), ("blur", "3")], [5, 7, 0])
}

/// The scene (3), averaged; tone mapping (1), blur (1) and scaling (1), each of which reads neighbours of the one before or
/// another size.
#[test]
fn a_scale_takes_one_draw_more() -> Result<(), Box<dyn Error>> {
    demand(&[("render_scale", "0.5"), ("mapped", "texels"), ("blur", "1")], [4, 6, 1])
}
