//! Devices that the program made with exactly what a Plan uses (DO-11): they draw it in silence, and without any of it the Plan is
//! refused by name before anything is recorded.

use crate::adopted::{adopted_with, made_with};
use crate::frames::{Shaders, Small, Uses, draw, frame, library, on_each_driver, planned, texels, words};
use framewright_graph::base::Span;
use framewright_graph::compile::Options;
use framewright_graph::device::EVERY_PLAN_USES;
use framewright_graph::frame::{Blend, DepthTarget, Draw, Frame, Lifetime, Work};
use framewright_graph::plan::{Plan, UsedFeature};
use framewright_graph::vulkan::{CompareOp, Format, Subresources};
use framewright_vulkan::{Device, DeviceFeatures, Error, Executor, ExecutorOptions};

const WHOLE: Subresources = Subresources::WHOLE;

const SHADERS: Shaders = &[
    (
        "much.frag",
        "#version 460
        layout(set = 0, binding = 0, std430) buffer Seen { uint seen[]; };
        layout(location = 0) out vec4 replaced;
        layout(location = 1) out vec4 added;
        void main() {
            if (gl_FragCoord.x > 1.0) { discard; }
            seen[0] = 7 + gl_SampleID;
            replaced = added = vec4(0.4);
        }",
    ),
    (
        "little.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() { color = vec4(1.0); }",
    ),
];

/// A draw that uses each feature of the minimum that Plans may do without.
fn much() -> Frame {
    let mut small = Small::default();
    let depth = small.image("depth", Format::D32_SFLOAT_S8_UINT, [2, 1]);
    let [replaced, added] = ["replaced", "added"].map(|name| small.image(name, Format::R8G8B8A8_UNORM, [2, 1]));
    let seen = small.buffer_with("seen", 1, Lifetime::Transient);
    let clear = Some([0.2; 4]);
    let mut pass = draw("much", Draw::FullScreen)
        .draws(replaced, WHOLE, clear)
        .draws(added, WHOLE, clear)
        .block("Seen", seen, (false, true))
        .tests(DepthTarget {
            image: depth,
            range: WHOLE,
            span: Span::NONE,
            clear: Some(1.0),
            test: CompareOp::Less,
            write: true,
            stencil: None,
        });
    pass.color[1].blend = Blend::Additive;
    let shader = "much".into();
    pass.work = Work::Draw { draw: Draw::FullScreen, shader, discards: true, per_sample: false };
    small.pass(pass);
    small.image_output(replaced);
    small.image_output(added);
    small.buffer_output(seen);
    small.frame
}

/// A draw that uses none of them but for its rendering scope.
fn little() -> Frame {
    let mut small = Small::default();
    let color = small.image("color", Format::R8G8B8A8_UNORM, [2, 1]);
    small.pass(draw("little", Draw::FullScreen).draws(color, WHOLE, None));
    small.image_output(color);
    small.frame
}

/// Makes a device with these features alone, and has it used.
fn on_device_with<T>(like: &Device, used: &[UsedFeature], then: impl FnOnce(&Device) -> T) -> T {
    let (instance, physical) = like.raw_physical();
    // SAFETY: the physical device belongs to the instance.
    let mut exact = unsafe { DeviceFeatures::exactly(instance, physical, &names(used)) }.expect("the device has them");
    let extensions = exact.extensions().to_vec();
    let mut chain = exact.chain();
    let raw = made_with(like, &mut chain, &extensions);
    let device = adopted_with(like, &raw, &chain, &extensions, &[0], None).expect("it has what each Plan uses");
    let made = then(&device);
    drop(device);
    // SAFETY: nothing made from it is left.
    unsafe { raw.destroy_device(None) };
    made
}

fn names(used: &[UsedFeature]) -> Vec<&'static str> {
    used.iter().map(|it| it.name).collect()
}

#[test]
fn do_11_a_name_that_no_plan_lists_is_a_slip_and_not_the_devices_fault() {
    on_each_driver(|like| {
        let (instance, physical) = like.raw_physical();
        let refused = |name| {
            // SAFETY: the physical device belongs to the instance.
            let made = unsafe { DeviceFeatures::exactly(instance, physical, &["synchronization2", name]) };
            made.map(drop).expect_err("there is no such feature").to_string()
        };
        let how = ": take the names of `Plan::features`";
        assert_eq!(refused("multivew"), format!("no Plan uses a feature multivew (did you mean multiview?){how}"));
        assert_eq!(refused("luck"), format!("no Plan uses a feature luck{how}"));
    });
}

/// Executes a Plan with these features alone; what is said if it is refused.
fn executed(like: &Device, plan: &Plan, used: &[UsedFeature], then: impl FnOnce(&mut Executor)) -> Result<(), Error> {
    on_device_with(like, used, |device| {
        let mut executor = Executor::new(device, plan, &mut library(SHADERS), &ExecutorOptions::default())?;
        frame(&mut executor);
        frame(&mut executor);
        then(&mut executor);
        Ok(())
    })
}

#[test]
fn do_11_a_device_with_exactly_what_a_plan_uses_draws_and_without_any_of_it_the_plan_is_refused_by_name() {
    on_each_driver(|like| {
        let plan = planned(like, &much(), &Options::default());
        let used = plan.features(&mut library(SHADERS)).expect("its shaders are right");
        assert_eq!(
            names(&used),
            [
                "dynamicRendering",
                "fragmentStoresAndAtomics",
                "hostQueryReset",
                "independentBlend",
                "maintenance4",
                "sampleRateShading",
                "separateDepthStencilLayouts",
                "shaderTerminateInvocation",
                "synchronization2",
                "timelineSemaphore",
            ]
        );
        let drawn = executed(like, &plan, &used, |executor| {
            assert_eq!(texels(executor, "replaced", 0), [0x6666_6666, 0x3333_3333]);
            assert_eq!(texels(executor, "added", 0), [0x9999_9999, 0x3333_3333]);
            assert_eq!(words(executor, "seen"), [7]);
        });
        drawn.expect("it has all that the Plan uses");
        for left_out in used.iter().filter(|it| !EVERY_PLAN_USES.contains(&it.name)) {
            let others: Vec<_> = used.iter().filter(|it| *it != left_out).cloned().collect();
            let refused = executed(like, &plan, &others, |_| ()).expect_err(left_out.name);
            let said = refused.to_string();
            assert!(said.contains(left_out.name), "{}: {said}", left_out.name);
            for other in &others {
                assert!(!said.contains(other.name), "{}: {said}", left_out.name);
            }
        }
    });
}

#[test]
fn do_11_what_a_plan_does_not_use_may_be_off_and_the_devices_profile_says_so() {
    on_each_driver(|like| {
        let plan = planned(like, &little(), &Options::default());
        let used = plan.features(&mut library(SHADERS)).expect("its shaders are right");
        let least: Vec<_> = EVERY_PLAN_USES.into_iter().chain(["dynamicRendering"]).collect();
        assert!(names(&used).iter().all(|name| least.contains(name)), "{used:?}");
        let drawn = executed(like, &plan, &used, |executor| {
            assert_eq!(texels(executor, "color", 0), [u32::MAX; 2]);
        });
        drawn.expect("it has all that the Plan uses");
        on_device_with(like, &used, |device| {
            let profile = device.profile();
            assert!(profile.has_feature("dynamicRendering") && !profile.has_feature("sampleRateShading"));
            assert!(like.profile().has_feature("sampleRateShading"));
        });
    });
}
