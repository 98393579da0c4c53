//! Images whose contents come from files: what a frame may say of them, and what a Plan says then.

use crate::testing::plans::{self, compiled, on, refused_on};
use crate::testing::raster::{self, Raster};
use framewright_graph::base::Span;
use framewright_graph::device::{Profile, Queues};
use framewright_graph::frame::{
    Blend, Buffer, BufferIndex, BufferRole, BufferUse, ColorSpace, Frame, Groups, ImageIndex, Lifetime, Pass, Resource,
    SampledImage, Storage, TextureFile, TextureInfo, TextureProblem, Work,
};
use framewright_graph::plan::{FirstContents, Plan, Resource as Planned, Role};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{
    AddressMode, FillValue, Filter, Format, Layout, Sampler, Shape, Sharing, Stages, Subresources, Usage,
};
use std::sync::Arc;

fn file(color_space: ColorSpace) -> Lifetime {
    Lifetime::File(Arc::new(TextureFile::picture("textures/grain.png", color_space)))
}

/// A full-screen draw that samples `grain`, and the output that it draws.
fn frame() -> Frame {
    let mut raster = Raster::default();
    let grain = raster.image("grain", Format::R8G8B8A8_UNORM, 1);
    let screen = raster.image("screen", Format::R8G8B8A8_SRGB, 1);
    raster.full_screen("film").sample(grain).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.images[0].lifetime = file(ColorSpace::Linear);
    frame
}

fn refused(change: impl FnOnce(&mut Frame)) -> Vec<String> {
    let mut frame = frame();
    change(&mut frame);
    plans::refused(&frame)
}

#[test]
fn a_texture_from_a_file_has_memory_of_its_own_one_layout_and_no_barrier() {
    let plan = compiled(&frame());
    let grain = plan.images.iter().find(|image| &*image.name == "grain").expect("it is planned");
    assert_eq!(grain.usage, Usage::SAMPLED | Usage::TRANSFER_DST);
    let Role::Persistent { becomes, initial: FirstContents::File(file), before, after } = &grain.role else {
        panic!("{:?}", grain.role)
    };
    assert_eq!((*becomes, &*file.path), (grain.id.0, "textures/grain.png"));
    assert_eq!((before.layout, before), (Layout::ShaderReadOnlyOptimal, after));
    for step in &plan.steps {
        let mut barriers = step.image_barriers.iter().chain(&step.releases);
        assert!(barriers.all(|barrier| barrier.image != grain.id));
        assert!(
            step.memory_barriers
                .iter()
                .flat_map(|it| &it.hand_overs)
                .flatten()
                .all(|it| *it != Planned::Image(grain.id))
        );
    }
}

#[test]
fn a_plan_with_a_texture_survives_its_json_form_and_names_the_file_in_the_tree() {
    let plan = compiled(&frame());
    let json = plan.to_json().expect("it has one");
    assert!(
        json.contains("\"path\": \"textures/grain.png\"") && json.contains("\"color_space\": \"LINEAR\""),
        "{json}"
    );
    assert_eq!(Plan::from_json(&json).expect("it is read"), plan);
    assert!(plan.tree().contains("the file `textures/grain.png` (linear), only read"), "{}", plan.tree());
}

#[test]
fn several_queues_sample_a_texture_at_once_without_handing_it_over() {
    let mut frame = frame();
    let mut raster = Pass::new("count", Work::Dispatch { shader: "count".into(), groups: Groups::Count([8, 8, 1]) });
    let lifetime = Lifetime::Persistent { initial: FillValue::Bits([0; 4]) };
    frame.buffers.push(Buffer { name: "sums".into(), span: Span::NONE, bytes: 1024, lifetime });
    raster.sampled = vec![SampledImage { stages: Stages::COMPUTE_SHADER, ..frame.passes[0].sampled[0].clone() }];
    raster.buffers = vec![BufferUse {
        binding: Some("sums".into()),
        buffer: BufferIndex(0),
        frames_ago: 0,
        span: Span::NONE,
        role: BufferRole::Storage { read: false, write: true },
        stages: Stages::COMPUTE_SHADER,
    }];
    frame.passes.insert(0, raster);
    let queues = Queues { compute: true, transfer: true, sharing: Sharing::Exclusive, wait_bytes: 0 };
    let plan = on(&frame, &Profile { queues, ..raster::device() }).expect("a Plan");
    assert_eq!(verify(&plan), []);
    assert!(plan.steps.iter().any(|step| step.queue != plan.steps[0].queue), "{}", plan.tree());
    assert_eq!(plan.images[0].sharing, Sharing::Concurrent);
    assert!(plan.steps.iter().flat_map(|step| &step.image_barriers).all(|barrier| barrier.image.0 != 0));
}

#[test]
fn a_texture_is_only_sampled() {
    let only_sampled = |errors: Vec<String>, pass: &str| {
        assert_eq!(errors, [format!("`{pass}` does more with `grain` than sample it: it comes from a file")]);
    };
    let whole = Subresources::WHOLE;
    let (binding, image, span) = ("grain".into(), ImageIndex(0), Span::NONE);
    let stored = Storage {
        binding,
        image,
        range: whole,
        span,
        read: true,
        write: false,
        eye: None,
        stages: Stages::FRAGMENT_SHADER,
    };
    only_sampled(refused(|frame| frame.passes[0].storage.push(stored)), "film");
    only_sampled(refused(|frame| frame.passes[0].color[0].image = image), "film");
    let forward = Work::Forward { from: image, to: ImageIndex(1), because: "grain = false".to_owned() };
    only_sampled(refused(|frame| frame.passes.push(Pass::new("forward", forward))), "forward");
    let errors = refused(|frame| frame.outputs[0].resource = Resource::Image(image));
    assert_eq!(errors, ["`grain` is an output and comes from a file: no pass makes it"]);
}

#[test]
fn an_image_that_no_file_can_fill_is_refused() {
    let of_image = |change: fn(&mut framewright_graph::frame::Image)| refused(|frame| change(&mut frame.images[0]));
    let wrong = "comes from a file and";
    assert_eq!(of_image(|image| image.samples = 4), [format!("`grain` {wrong} is multisampled")]);
    assert_eq!(of_image(|image| image.layers = 2), [format!("`grain` {wrong} has layers")]);
    let format = |why: &str| [format!("`grain` {wrong} is {why}")];
    assert_eq!(of_image(|image| image.format = Format::R32_UINT), format("R32_UINT: a picture holds no integers"));
    assert_eq!(of_image(|image| image.format = Format::D32_SFLOAT), format("D32_SFLOAT: a picture holds no depth"));
    assert_eq!(
        of_image(|image| image.format = Format::R8G8B8A8_SRGB),
        format("R8G8B8A8_SRGB: its values are linear, and the format decodes sRGB")
    );
    let buffer = refused(|frame| {
        let lifetime = file(ColorSpace::Linear);
        frame.buffers.push(Buffer { name: "table".into(), span: Span::NONE, bytes: 4, lifetime });
    });
    assert_eq!(buffer, ["`table` is a buffer and comes from a file, which only images can"]);
}

#[test]
fn a_plan_that_writes_a_texture_is_wrong() {
    let right = compiled(&frame());
    let found = |change: fn(&mut Plan)| {
        let mut plan = right.clone();
        change(&mut plan);
        verify(&plan).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let used = found(|plan| plan.images[0].usage |= Usage::STORAGE);
    assert!(used.contains("comes from a file and has samples, layers or uses"), "{used}");
    let format = found(|plan| plan.images[0].format = Format::R32_UINT);
    assert!(format.contains("has initial contents of another kind than its format"), "{format}");
    let written = found(|plan| {
        let target = framewright_graph::plan::Side::Image {
            image: plan.images[0].id,
            range: Subresources::all(Format::R8G8B8A8_UNORM, 1, 1),
            extent: [64, 64, 1],
            layout: Layout::TransferDstOptimal,
        };
        let cause = framewright_graph::plan::Cause::Written(None);
        let value = FillValue::Color([0.0; 4]);
        let fill = framewright_graph::plan::Fill { name: Some("wipe".into()), cause, target, value };
        let mut step = plan.steps[0].clone();
        step.image_barriers.clear();
        step.work = framewright_graph::plan::Work::Fill(fill);
        plan.steps.push(step);
    });
    assert!(written.contains("is written, and its contents are a file's"), "{written}");
}

#[test]
fn a_device_without_the_format_gets_one_that_holds_as_much() {
    let mut frame = frame();
    frame.images[0].format = Format::R16G16B16A16_UNORM;
    let mut device = raster::device();
    device.formats.retain(|support| support.format != Format::R16G16B16A16_UNORM);
    let plan = on(&frame, &device).expect("a Plan");
    assert_eq!(plan.images[0].format, Format::R32G32B32A32_SFLOAT);
    assert!(
        plan.notes.iter().any(|note| &*note.subject == "grain" && note.text.contains("is made")),
        "{:?}",
        plan.notes
    );
}

#[test]
fn a_strip_of_squares_makes_a_three_dimensional_image_and_nothing_else_does() {
    let info = |extent| TextureInfo::picture(extent, Format::R8G8B8A8_UNORM);
    assert_eq!(info([256, 16]).image_extent(Shape::D3), Ok([16; 3]));
    assert_eq!(info([256, 16]).image_extent(Shape::D2), Ok([256, 16, 1]));
    let problem = info([255, 16]).image_extent(Shape::D3).expect_err("no strip");
    assert_eq!(problem, TextureProblem::Size { found: [255, 16], expected: [256, 16], strip: true });
    assert_eq!(problem.to_string(), "is 255×16, and 256×16 are needed: a strip of one square for each slice");
}

#[test]
fn a_sampler_stands_in_the_plan_and_the_tree_says_what_is_unusual() {
    let mut frame = frame();
    let sampler =
        Sampler { mips: Filter::Linear, address: AddressMode::MirroredRepeat, ..Sampler::new(Filter::Linear) };
    frame.passes[0].sampled[0].sampler = sampler;
    let plan = compiled(&frame);
    let json = plan.to_json().expect("it has one");
    assert_eq!(Plan::from_json(&json).expect("it is read"), plan);
    let said = "source0 = `grain`, sampled, LINEAR, between mip levels too, MIRRORED_REPEAT";
    assert!(plan.tree().contains(said), "{}", plan.tree());
}

#[test]
fn a_mean_between_mip_levels_needs_a_format_that_can_be_filtered() {
    let mut frame = frame();
    frame.passes[0].sampled[0].sampler.mips = Filter::Linear;
    let mut device = raster::device();
    device.formats.iter_mut().for_each(|support| support.linear_filter = false);
    let errors = refused_on(&frame, &device);
    assert!(errors[0].starts_with("`film` can't filter `grain`"), "{errors:?}");
}
