//! Reading what the rendering scope drew at the same position, on devices that can; the others say that they can't.

use crate::frames::{Small, Uses, draw, frame, library, on_each_driver, planned, texels};
use framewright_graph::compile::Options;
use framewright_graph::device::{ImageDescriptor, MemoryNeeds, MemoryProvider};
use framewright_graph::frame::{Blend, Draw};
use framewright_graph::plan::{BindingKind, Image, ImageId, Plan, RenderScope, Role, StepId, Totals, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Accesses, Format, Layout, Stages, StoreOp, Subresources, Usage};
use framewright_vulkan::{Device, Error, Executor, ExecutorOptions};
use std::cell::Cell;

const WHOLE: Subresources = Subresources::WHOLE;
const LOCAL: Layout = Layout::RenderingLocalReadKhr;

const SHADERS: &[(&str, &str)] = &[
    (
        "increase.frag",
        "#version 460
        #ifdef LOCAL_READ_source
        layout(input_attachment_index = 0, set = 0, binding = 0) uniform usubpassInput source;
        #define HERE subpassLoad(source)
        #else
        layout(set = 0, binding = 0) uniform usampler2D source;
        #define HERE texelFetch(source, ivec2(gl_FragCoord.xy), 0)
        #endif
        layout(location = 0) out uint color;
        void main() { color = HERE.r + 500; }",
    ),
    (
        "every_other.frag",
        "#version 460
        layout(location = 0) out uint color;
        void main() {
            if (int(gl_FragCoord.x) % 2 == 1) discard;
            color = 1000 + uint(gl_FragCoord.x) + 10 * uint(gl_FragCoord.y);
        }",
    ),
];

/// `number` draws into `a`, and `increase` draws what it reads there at its own position into the output `b`.
fn in_two_scopes(device: &Device) -> Plan {
    let mut small = Small::default();
    let [a, b] = ["a", "b"].map(|name| small.image(name, Format::R32_UINT, [3, 2]));
    small.pass(draw("number", Draw::FullScreen).draws(a, WHOLE, None));
    let mut pass = draw("increase", Draw::FullScreen).samples("source", a, WHOLE).draws(b, WHOLE, None);
    pass.sampled[0].own_pixel = true;
    small.pass(pass);
    small.image_output(b);
    planned(device, &small.frame, &Options::default())
}

/// The Plan of [`in_two_scopes`] with both passes in one scope.
fn in_one_scope(device: &Device) -> Plan {
    let mut plan = in_two_scopes(device);
    let scopes = plan.steps.iter().filter(|step| matches!(step.work, Work::Render(_))).count();
    if scopes == 1 {
        return plan;
    }
    let a = plan.images.iter().find(|image| *image.name == *"a").expect("it is there").id;
    let second = plan.steps.remove(1);
    let Work::Render(second_scope) = second.work else { panic!("it draws") };
    let first = &mut plan.steps[0];
    first.image_barriers.extend(second.image_barriers.into_iter().filter(|barrier| barrier.image != a));
    first.image_barriers.iter_mut().for_each(|barrier| barrier.needed_by = Some(StepId(0)));
    for barrier in first.image_barriers.iter_mut().filter(|barrier| barrier.image == a) {
        // The frame before leaves it where the scope ends.
        barrier.src_stages |= Stages::COLOR_ATTACHMENT_OUTPUT;
        barrier.src_accesses |= Accesses::COLOR_ATTACHMENT_WRITE;
        barrier.new_layout = LOCAL;
    }
    let Work::Render(scope) = &mut first.work else { panic!("it draws") };
    merge(scope, *second_scope, a);
    let image = &mut plan.images[a.0 as usize];
    image.usage = Usage::COLOR_ATTACHMENT | Usage::INPUT_ATTACHMENT;
    let needs = needs(device, image);
    if let Role::Transient(place) = &mut image.role {
        (place.bytes, place.alignment, place.type_bits) = (needs.bytes, needs.alignment, needs.type_bits);
        place.lifetime = [StepId(0); 2];
    }
    plan.heaps[0].bytes = needs.bytes;
    plan.totals = Totals {
        transient_bytes: needs.bytes,
        placed_bytes: needs.bytes,
        live_peak_bytes: needs.bytes,
        ..Totals::count(&plan.steps)
    };
    plan
}

/// Adds the one pass of `second`, which reads what the one of `scope` draws into `a`.
fn merge(scope: &mut RenderScope, mut second: RenderScope, a: ImageId) {
    scope.attachments[0].layout = LOCAL;
    scope.attachments[0].store = StoreOp::DontCare;
    scope.attachments.append(&mut second.attachments);
    let mut reader = second.passes.remove(0);
    for access in reader.accesses.iter_mut().filter(|access| access.image == a) {
        (access.accesses, access.layout) = (Accesses::INPUT_ATTACHMENT_READ, LOCAL);
        if let Some(binding) = &mut access.binding {
            binding.kind = BindingKind::InputAttachment;
        }
    }
    scope.passes[0].accesses[0].layout = LOCAL;
    reader.local_barrier = true;
    reader.merged = Some(Box::new("it reads its own position".into()));
    scope.passes.push(reader);
    for pass in &mut scope.passes {
        pass.blend = vec![Blend::Replace; 2];
    }
}

fn needs(device: &Device, image: &Image) -> MemoryNeeds {
    let Image { format, shape, extent, mips, layers, samples, usage, sharing, .. } = *image;
    device.memory().image(&ImageDescriptor { format, shape, extent, mips, layers, samples, usage, sharing })
}

#[test]
fn a_pass_reads_what_its_scope_drew_at_its_own_position() {
    let ran = Cell::new(false);
    on_each_driver(|device| {
        let plan = in_one_scope(device);
        let violations = verify(&plan);
        assert!(violations.is_empty(), "{violations:?}\n{}", plan.tree());
        let executor = Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default());
        if !device.summary().local_read {
            match executor.err() {
                Some(ref error @ Error::WithoutFeatures { ref missing, .. }) => {
                    let said = error.to_string();
                    assert!(said.contains(" lacks what the Plan uses: "), "the library opened it: {said}");
                    assert!(said.ends_with("; choose another device"), "{said}");
                    let names: Vec<_> = missing.iter().map(|it| it.name).collect();
                    assert_eq!(names, ["dynamicRenderingLocalRead"], "{missing:?}");
                }
                other => panic!("{other:?}"),
            }
            return eprintln!("SKIPPED: {} has no local reads", device.summary().name);
        }
        let mut executor = executor.expect("an executor");
        for _ in 0..2 {
            frame(&mut executor);
            assert_eq!(texels(&mut executor, "b", 0), [500, 501, 502, 510, 511, 512]);
        }
        ran.set(true);
    });
    assert!(ran.get() || std::env::var_os("CI").is_none(), "no driver here has local reads: SwiftShader does");
}

/// docs/synchronization.md: a pass that draws over what was read at its own position stands behind a local barrier.
#[test]
fn what_was_read_at_its_own_position_is_drawn_over_and_read_again() {
    on_each_driver(|device| {
        let mut small = Small::default();
        let [a, b, c] = ["a", "b", "c"].map(|name| small.image(name, Format::R32_UINT, [3, 2]));
        let increase = |name: &str, target| {
            let mut pass = draw("increase", Draw::FullScreen).samples("source", a, WHOLE).draws(target, WHOLE, None);
            pass.sampled[0].own_pixel = true;
            pass.name = name.into();
            pass
        };
        let mut over = draw("every_other", Draw::FullScreen).draws(a, WHOLE, None);
        if let framewright_graph::frame::Work::Draw { discards, .. } = &mut over.work {
            *discards = true;
        }
        small.pass(draw("number", Draw::FullScreen).draws(a, WHOLE, None));
        small.pass(increase("before", b));
        small.pass(over);
        small.pass(increase("after", c));
        small.image_output(b);
        small.image_output(c);
        let plan = planned(device, &small.frame, &Options::default());
        if device.profile().local_read {
            let Work::Render(scope) = &plan.steps[0].work else { panic!("{}", plan.tree()) };
            let barriers: Vec<(&str, bool)> = scope.passes.iter().map(|it| (&*it.name, it.local_barrier)).collect();
            assert_eq!(barriers, [("number", false), ("before", true), ("every_other", true), ("after", true)]);
        }
        let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default());
        let executor = executor.as_mut().expect("an executor");
        for _ in 0..2 {
            frame(executor);
            assert_eq!(texels(executor, "b", 0), [500, 501, 502, 510, 511, 512]);
            assert_eq!(texels(executor, "c", 0), [1500, 501, 1502, 1510, 511, 1512]);
        }
    });
}

#[test]
fn a_device_without_local_reads_samples_instead() {
    on_each_driver(|device| {
        let plan = in_two_scopes(device);
        let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default());
        let executor = executor.as_mut().expect("an executor");
        frame(executor);
        assert_eq!(texels(executor, "b", 0), [500, 501, 502, 510, 511, 512]);
    });
}
