//! Claims of the shipped `image_quality`, on a real driver: each row of the requirements with the test that shows it, and a
//! change of one line that was seen to turn it red.
//!
//! | row | test | what turns it red |
//! |---|---|---|
//! | IQ-1 | `dynamic_resolution` | `part.glsl`: `uv_clamp` gives `uv` back |
//! | IQ-1 | `dynamic_resolution`, `graph/tests/suite/language/dynamic_sizes.rs` | `model/area.rs`: `LEAST_PART` 1 |
//! | IQ-1 | `plans::the_scene_is_drawn_at_the_scaled_size_and_one_draw_brings_it_to_the_screen`, `scale` | size of `color` `Output` |
//! | IQ-2 | `plans::with_nothing_to_do_objects_are_drawn_straight_into_the_screen` | `map` for every operator |
//! | IQ-3 | `plans::a_view_that_allows_nothing_takes_the_direct_path` | `view.allows_msaa` left out |
//! | IQ-3 | `plans::a_view_brings_effects_of_its_own_or_takes_the_users` | `entries/views.rs`: `set.iter().flatten().take(0)` |
//! | IQ-4 | `pictures::scale_two_is_the_mean_of_two_by_two_pixels`, `scale` | `scale.glsl`: `end = begin + pixels` |
//! | IQ-4 | `pictures::light_is_averaged_before_tone_mapping_or_what_is_shown_after_it` | size of `scaled` for `mapped != 'pixels'` |
//! | IQ-5 | `graph/tests/suite/compile_raster.rs`, `graph/tests/suite/shipped_devices.rs`, `cli/tests/suite/every_device.rs`, `cli/tests/suite/plans.rs` | `compile/fit/samples.rs`: `chosen` is what was wanted |
//! | IQ-4, IQ-6 | `samples::pictures_of_256_samples_show_what_rays_meet` | `scene/model/camera.rs`: `vertical_fov` times 0.51 |
//! | IQ-6 | `samples::a_fragment_shader_runs_once_a_texel_whatever_the_samples` | `backend-vulkan/src/pipeline/graphics.rs`: `sample_shading_enable(true)`, with a share of 1 |
//! | IQ-6 | `samples::edges_improve_with_samples_and_with_scale` | samples of `color` 1 |
//! | IQ-6 | `samples::edges_of_holes_improve_with_samples_only_where_alpha_says_how_many_are_covered`, `alpha_coverage` | `alpha_coverage.glsl`: `+ 0.5` left out |
//! | IQ-7 | `plans::multisampled_colour_is_resolved_before_what_samples_it`, `texture_declarations` | samples of `color` 1 |
//! | IQ-8 | `plans::a_resolve_serves_every_reader_until_the_next_write` | `post.ron`: objects are drawn before `show_light` |
//! | IQ-9 | `plans::a_blur_of_five_draws_takes_one_resolve_where_the_file_asks_for_three` | `shown` with one sample |
//! | IQ-7, IQ-9, IQ-16, IQ-22 | `frames_by_hand` | `compile/adapt/demote.rs`: nothing moves; `compile/scope/builder.rs`: nothing folds |
//! | IQ-10 | `graph/tests/suite/depth_ladder.rs` | `compile/adapt/resolve.rs`: depth without a word is averaged where it is sampled, or where it leaves the frame |
//! | IQ-11 | `graph/tests/suite/depth_ladder.rs` | `compile/adapt/resolve.rs`: depth is resolved for any number of samples |
//! | IQ-11 | `graph/tests/suite/language/samplers.rs` | `expand/shader/sampled_images.rs`: depth is filtered as colour is |
//! | IQ-12 | `graph/tests/suite/depth_ladder.rs` | `compile/adapt/depth_only.rs`: `writers` are cleared for every `start`, so that one is left |
//! | IQ-12: refused | `graph/tests/suite/depth_ladder.rs` | `compile/adapt/depth_only.rs`: `Draw::Custom` is let through |
//! | IQ-12, IQ-24 | `cli/tests/suite/image_quality.rs`, `depth_stripes`, `frames_by_hand` | `depth_stripes.ron`: `"depth"` for `Resolved("depth")` |
//! | IQ-13 | `cli/tests/suite/depth_ladder.rs` | `lit_masked.frag`: no `fades_out`, or no cut-off, with `DEPTH_ONLY` |
//! | IQ-13 | `depth_only::depth_drawn_again_keeps_instances_holes_and_fading` | `material.glsl`: without the object's own colour; `lit_masked.frag`: no cut-off with `DEPTH_ONLY` |
//! | IQ-14 | `cli/tests/suite/depth_ladder.rs` | `depth_resolve_min.frag`: `greatest_depth` |
//! | IQ-14 | `graph/tests/suite/depth_ladder.rs` | `compile/adapt/resolve.rs`: modes that were refuted are taken |
//! | IQ-14 | `depth::each_way_to_see_depth_has_its_error_and_every_sample_the_least` | `each_sample` left out |
//! | IQ-15 | `graph/tests/suite/depth_ladder.rs` | `compile/retain.rs`: what is written is stored even if nobody comes next |
//! | IQ-16 | `plans::stripes_take_one_resolve_as_a_blend_and_two_as_a_copy`, `depth_stripes` | `stripes_back` off |
//! | IQ-16 | `pictures::both_forms_of_the_stripes_draw_the_same_picture` | `depth_stripes.ron`: `blend` left out |
//! | IQ-17 | `plans::a_blur_takes_as_many_draws_as_its_strength_and_works_on_8_bits`, `effects` | format of `shown` `Like("color")` |
//! | IQ-18 | `plans::nothing_is_loaded_that_was_not_kept_or_is_drawn_over` | `compile/adapt/pass.rs`: `Start::Discard` only of images that nobody wrote before |
//! | IQ-19 | `plans::colour_is_floating_point_only_where_something_makes_use_of_it` | `scene.peak_radiance` left out |
//! | IQ-20 | `samples::a_lamp_does_not_spoil_edges_where_bright_samples_weigh_less`, `resolves` | `weighted_resolve.glsl`: weight 1 |
//! | IQ-20 | `resolves` | `resolves.ron`: `resolve` left out |
//! | IQ-20 | `graph/tests/suite/weighted_resolve.rs` | `compile/adapt/resolve.rs`: `Weighted` is averaged like any other |
//! | IQ-21 | `pictures::tone_mapping_without_hdr_makes_one_half_of_white`, `tone_mapping_operators` | `tone_mapping.glsl`: `radiance / (2.0 + radiance)` |
//! | IQ-21 | `pictures::the_white_point_decides_how_much_is_compressed`, `twin_tone_mapping` | `tone_mapping.glsl`: `radiance / white` |
//! | IQ-22 | `plans::tone_mapping_is_the_resolving_draw_if_samples_are_mapped` | `tone_mapping.ron`: `Resolved("source")` for `Samples("source")` |
//! | IQ-22 | `samples::a_lamp_does_not_spoil_edges_where_samples_are_tone_mapped`, `resolves` | the same |
//! | IQ-23 | `pictures::the_over_bright_view_is_what_is_beyond_white`, `effects` | `over_bright.frag`: `- 0.5` |
//! | IQ-24 | `plans::the_listing_shows_resolves_in_their_place`, `cli/tests/suite/image_quality.rs` | `stripes_back` off |
//! | IQ-25: order | `plans::with_nothing_to_do_objects_are_drawn_straight_into_the_screen` | `sky` behind `transparent` |
//! | IQ-25: order | `passes/tests/suite/draw_lists.rs` | `draw/lists.rs`: `a` and `b` exchanged where depths are compared |
//! | IQ-25: alpha clip | `shadows` | `lit_masked.frag`: `is_hole = false` |
//! | IQ-25: cross-fade | `cross_fade` | `cross_fade.glsl`: `threshold > share + 0.2` |
//! | IQ-25: shadows | `shadows`, `passes/tests/suite/cascades.rs` | `sun_shadow.glsl`: `caster < depth`; `cascades.rs`: places not rounded to texels |
//! | IQ-25: size of shadows | `shadows` | `tests/pipelines/shadows.ron`: size of `shadow` `Scaled("render_scale")`, or `reach` times it |
//!
//! Where no file is named it is `image_quality.ron`.

mod depth;
mod formats;
mod frames_by_hand;
mod pictures;
mod plans;
mod samples;

use framewright_graph::compile::Options;
use framewright_graph::plan::{Image, Plan, Work};
use framewright_passes::scene::{AlphaMode, Material, Scene};
use framewright_tests::render::{self, Setup, device, library};
use framewright_tests::shapes::{material, scene, square};
use glam::{Mat4, Vec3};
use std::error::Error;

const PIPELINE: &str = "examples/pipelines/image_quality.ron";
/// Everything off.
const DIRECT: [(&str, &str); 3] = [("msaa", "1"), ("hdr", "false"), ("tone_mapping", "clip")];

/// How many samples along each axis of a pixel converge.
const MANY: u32 = 16;

type Set<'a> = &'a [(&'a str, &'a str)];

/// A slanted square that shines so much before nothing.
fn shining(emissive: [f32; 3]) -> Scene {
    let lamp = Material { emissive, ..material([0.0, 0.0, 0.0, 1.0]) };
    let place = Mat4::from_rotation_z(0.3) * Mat4::from_scale(Vec3::splat(1.4));
    scene(vec![square()], vec![lamp], vec![(0, 0, place)])
}

/// That, with a pane of glass before its right half.
fn shining_behind_glass(emissive: [f32; 3]) -> Scene {
    let Scene { mut materials, mut objects, meshes, .. } = shining(emissive);
    materials.push(Material { alpha: AlphaMode::Blend, emissive: [0.1, 0.0, 0.2], ..material([0.0, 0.0, 0.0, 0.5]) });
    let glass = Mat4::from_translation(Vec3::new(1.0, 0.0, 1.0)) * Mat4::from_rotation_z(-0.2);
    let mut objects: Vec<_> =
        objects.drain(..).map(|object| (object.mesh, object.material, object.transform.as_mat4())).collect();
    objects.push((0, 1, glass));
    scene(meshes, materials, objects)
}

/// The Plan of a pipeline for the device here, demoted or as the file says.
fn plan_of(pipeline: &str, set: Set<'_>, scene: &Scene, demote: bool) -> Result<Option<Plan>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let mut shaders = library();
    let setup = Setup { pipeline, set, scene, extent: [65, 47] };
    render::plan(device, &setup, &mut shaders, &Options { demote, ..Options::default() }).map(Some)
}

fn plan(set: Set<'_>) -> Result<Option<Plan>, Box<dyn Error>> {
    plan_of(PIPELINE, set, &shining_behind_glass([4.0; 3]), true)
}

/// The work of a frame, in its order: passes by name, and `(resolve)`.
fn listing(plan: &Plan) -> Vec<String> {
    let mut listing = Vec::new();
    for step in &plan.steps {
        match &step.work {
            Work::Render(scope) => {
                listing.extend(scope.passes.iter().map(|pass| pass.name.to_string()));
                let resolved = scope.color().iter().filter(|color| color.resolve.is_some());
                listing.extend(resolved.map(|_| "(resolve)".to_owned()));
            }
            Work::Resolve(_) => listing.push("(resolve)".to_owned()),
            Work::Dispatch(pass) | Work::Custom(pass) => listing.push(pass.name.to_string()),
            Work::Copy(_) | Work::Blit(_) | Work::Fill(_) => listing.push("(transfer)".to_owned()),
            Work::Export => {}
        }
    }
    listing
}

/// The image that a pass draws colour into. It may have another name: a forwarded image has that of its receiver.
fn drawn_by<'p>(plan: &'p Plan, pass: &str) -> Option<&'p Image> {
    plan.steps.iter().find_map(|step| match &step.work {
        Work::Render(scope) if scope.passes.iter().any(|it| &*it.name == pass) => {
            plan.images.get(scope.color().first()?.image.0 as usize)
        }
        _ => None,
    })
}

/// A picture in linear light: three channels a pixel.
struct Picture {
    width: usize,
    pixels: Vec<[f64; 3]>,
}

/// The picture of a scene.
fn picture(set: Set<'_>, scene: &Scene, extent: [u32; 2]) -> Result<Option<Picture>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let outputs = render::render(device, &Setup { pipeline: PIPELINE, set, scene, extent })?;
    let [first, ..] = &outputs[..] else { return Err("no output".into()) };
    let pixels = first.bytes.as_chunks::<4>().0.iter().map(|[r, g, b, _]| [*r, *g, *b].map(decoded)).collect();
    Ok(Some(Picture { width: extent[0] as usize, pixels }))
}

/// IEC 61966-2-1: an 8-bit step as linear light, and back, in steps.
fn decoded(step: u8) -> f64 {
    match f64::from(step) / 255.0 {
        low if low <= 0.04045 => low / 12.92,
        high => ((high + 0.055) / 1.055).powf(2.4),
    }
}

fn encoded(light: f64) -> f64 {
    match light {
        low if low <= 0.003_130_8 => 255.0 * 12.92 * low,
        high => 255.0 * (1.055 * high.powf(1.0 / 2.4) - 0.055),
    }
}

impl Picture {
    /// Half or another part of the size: the mean of squares of `times` by `times` pixels, in light.
    fn shrunk(&self, times: usize) -> Picture {
        let (width, height) = (self.width / times, self.pixels.len() / self.width / times);
        let block = |x: usize, y: usize| {
            let all = (0..times * times).map(|at| (times * y + at / times) * self.width + times * x + at % times);
            all.fold([0.0; 3], |sum, at| [0, 1, 2].map(|channel| sum[channel] + self.pixels[at][channel]))
                .map(|sum| sum / (times * times) as f64)
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| block(x, y)).collect();
        Picture { width, pixels }
    }

    /// The greatest difference from another, in 8-bit steps.
    fn steps_from(&self, other: &Picture) -> f64 {
        assert_eq!((self.width, self.pixels.len()), (other.width, other.pixels.len()));
        let all = self.pixels.iter().flatten().zip(other.pixels.iter().flatten());
        all.map(|(a, b)| (encoded(*a) - encoded(*b)).abs()).fold(0.0, f64::max)
    }

    /// The same of what is left of each difference once it is smaller by so much light.
    fn steps_beyond(&self, other: &Picture, light: f64) -> f64 {
        assert_eq!((self.width, self.pixels.len()), (other.width, other.pixels.len()));
        let all = self.pixels.iter().flatten().zip(other.pixels.iter().flatten());
        let left = |(a, b): (&f64, &f64)| encoded((a.max(*b) - light).max(a.min(*b))) - encoded(a.min(*b));
        all.map(left).fold(0.0, f64::max)
    }

    /// Root of the mean squared difference from another, in light.
    fn error_from(&self, other: &Picture) -> f64 {
        assert_eq!((self.width, self.pixels.len()), (other.width, other.pixels.len()));
        let all = self.pixels.iter().flatten().zip(other.pixels.iter().flatten());
        (all.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / (3 * self.pixels.len()) as f64).sqrt()
    }
}
