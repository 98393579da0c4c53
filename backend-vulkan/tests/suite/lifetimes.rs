//! Memory that changes hands too early shows: a shipped pipeline under poison, as compiled and with one lifetime cut short.

use crate::testing::{device, findings};
use framewright_graph::compile::Options;
use framewright_graph::plan::{Image, ImageId, Placement, Plan, Role};
use framewright_graph::verify::verify;
use framewright_passes::draw::{SceneDrawSource, interfaces};
use framewright_passes::scene::{Scene, load};
use framewright_passes::shipped::SHADERS;
use framewright_tests::render::{Setup, in_repository, plan};
use framewright_vulkan::{Device, Executor, ExecutorOptions, ShaderLibrary};

const EXTENT: [u32; 2] = [160, 90];

fn library() -> ShaderLibrary {
    ShaderLibrary::new(Vec::new(), SHADERS, interfaces())
}

fn soft_focus(device: &Device, scene: &Scene, options: &Options) -> Plan {
    let setup = Setup { pipeline: "examples/pipelines/soft_focus.ron", set: &[], scene, extent: EXTENT };
    plan(device, &setup, &mut library(), options).expect("the shipped pipeline compiles")
}

/// The second of two frames, so that what crosses frames counts too.
fn picture(device: &Device, scene: &Scene, plan: &Plan, poison: bool) -> Vec<u8> {
    let options = ExecutorOptions { poison, ..ExecutorOptions::default() };
    // SAFETY: the only driver that this is called on with a wrong Plan is lavapipe, which executes in order.
    let executor = unsafe { Executor::with_hazards(device, plan, &mut library(), &options) };
    let mut executor = executor.expect("the Plan is well formed");
    let mut draws = SceneDrawSource::new(device, scene, EXTENT).expect("the scene fits the device");
    for _ in 0..2 {
        executor.frame(&mut draws).expect("the frame is drawn");
    }
    executor.read(0).expect("the output can be read").bytes
}

fn transients(plan: &Plan) -> impl Iterator<Item = (&Image, &Placement)> {
    plan.images.iter().filter_map(|image| match &image.role {
        Role::Transient(placement) => Some((image, placement)),
        Role::External { .. } | Role::Persistent { .. } => None,
    })
}

/// Pairs of images of which the second begins in the very step in which the first ends: were the first one's lifetime a
/// step shorter, the second could take its memory.
fn handed_over_too_early(plan: &Plan) -> Vec<(ImageId, ImageId)> {
    let pairs = transients(plan).flat_map(|early| transients(plan).map(move |late| (early, late)));
    pairs
        .filter(|((_, early), (_, late))| {
            early.heap == late.heap
                && late.bytes <= early.bytes
                && early.lifetime[0] < early.lifetime[1]
                && late.lifetime[0] == early.lifetime[1]
        })
        .map(|((early, _), (late, _))| (early.id, late.id))
        .collect()
}

#[test]
fn a_lifetime_cut_short_by_a_step_changes_the_poisoned_picture_and_is_a_violation() {
    let Some(device) = device() else { return };
    let scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron")).expect("the shipped scene loads");
    let clean = picture(device, &scene, &soft_focus(device, &scene, &Options::default()), false);
    let plan = soft_focus(device, &scene, &Options { poison: true, ..Options::default() });
    assert!(plan.totals.placed_bytes < plan.totals.transient_bytes, "images share memory: {:?}", plan.totals);
    assert!(clean == picture(device, &scene, &plan, true), "poison changes the picture");
    assert_eq!(findings(&device.messages()).len(), 0);

    let pairs = handed_over_too_early(&plan);
    assert!(!pairs.is_empty(), "{}", plan.tree());
    for (early, late) in pairs {
        let mut cut = plan.clone();
        let Role::Transient(taken) = plan.image(early).role.clone() else { continue };
        let Role::Transient(place) = &mut cut.images[late.0 as usize].role else { continue };
        place.offset = taken.offset;
        let (early, late) = (&plan.image(early).name, &plan.image(late).name);
        let said: Vec<String> = verify(&cut).iter().map(ToString::to_string).collect();
        assert!(said.iter().any(|text| text.contains(&**early) && text.contains(&**late)), "{early}, {late}: {said:?}");
        assert!(clean != picture(device, &scene, &cut, true), "`{late}` takes the memory of `{early}` unseen");
    }
}
