//! Images in compressed formats (DO-7): textures of files that hold all of their parts, or imported; only sampled; and decoded
//! where a device lacks the format.

use crate::testing::pipelines::{INPUTS, right};
use crate::testing::plans::{compiled, image, on, refused, refused_on, shipped};
use crate::testing::raster::{self, Raster};
use framewright_graph::base::Span;
use framewright_graph::device::Profile;
use framewright_graph::frame::{
    Blend, ColorSpace, Frame, Image, ImageIndex, Lifetime, Pass, Resource, TextureFile, TextureInfo, TextureProblem,
    TransferUse, WantedTexels, Work, becomes,
};
use framewright_graph::plan::{FirstContents, Plan, Role};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{self, *};
use framewright_graph::vulkan::{Accesses, Layout, Numeric, Shape, Stages, State, Subresources, Usage};
use std::sync::Arc;

/// A texture file that holds such texels.
fn stored(format: Format) -> Lifetime {
    let srgb = format.numeric() == Numeric::Srgb;
    let color_space = if srgb { ColorSpace::Srgb } else { ColorSpace::Linear };
    Lifetime::File(Arc::new(TextureFile { stored: true, ..TextureFile::picture("wood.ktx2", color_space) }))
}

/// A full-screen draw that samples `wood`, which is a texture file's, and the output that it draws.
fn frame(format: Format) -> Frame {
    let mut raster = Raster::default();
    let wood = raster.image("wood", format, 1);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.full_screen("film").sample(wood).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    let image = &mut frame.images[0];
    (image.lifetime, image.extent, image.mips) = (stored(format), [20, 12, 1], 3);
    frame
}

/// The device for tests, without formats that a feature brings.
fn without(feature: &str) -> Profile {
    let mut device = raster::device();
    device.formats.retain(|support| support.format.feature() != Some(feature));
    device
}

#[test]
fn a_texture_has_the_levels_layers_shape_and_format_of_its_file() {
    let text = |fields: &str| {
        format!(
            r#"Pipeline(version: 1, textures: [(name: "texture", {fields})],
                images: [(name: "screen", format: Output, size: Output)],
                passes: [(name: "show", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#
        )
    };
    let texture = |fields: &str| right(&text(fields), &INPUTS).images[0].clone();
    let cube = texture(r#"file: "box.ktx2""#);
    assert_eq!((cube.format, cube.shape, cube.extent), (BC7_SRGB_BLOCK, Shape::Cube, [8, 8, 1]));
    assert_eq!((cube.mips, cube.layers), (4, 6));
    let Lifetime::File(file) = &cube.lifetime else { panic!("{cube:?}") };
    assert_eq!((file.stored, file.color_space), (true, ColorSpace::Srgb));
    // The colour space is the file's own, without a word.
    let normals = texture(r#"file: "normals.dds""#);
    assert_eq!((normals.format, normals.mips, normals.layers), (BC5_UNORM_BLOCK, 2, 3));
    let Lifetime::File(file) = &normals.lifetime else { panic!("{normals:?}") };
    assert_eq!(file.color_space, ColorSpace::Linear);
    // Its texels may be decoded.
    assert_eq!(texture(r#"file: "box.ktx2", format: R8G8B8A8_SRGB, shape: Cube"#).format, R8G8B8A8_SRGB);
    assert_eq!(texture(r#"file: "deep.ktx2", shape: D3"#).extent, [8, 8, 4]);
}

#[test]
fn a_plan_keeps_that_a_file_stores_all_parts_and_the_image_has_no_barrier() {
    let plan = compiled(&frame(BC7_UNORM_BLOCK));
    let wood = image(&plan, "wood");
    assert_eq!((wood.format, wood.mips), (BC7_UNORM_BLOCK, 3));
    let Role::Persistent { initial: FirstContents::File(file), .. } = &wood.role else { panic!("{:?}", wood.role) };
    assert!(file.stored);
    let json = plan.to_json().expect("it has one");
    assert!(json.contains("\"stored\": true"), "{json}");
    assert_eq!(Plan::from_json(&json).expect("it is read"), plan);
    assert!(plan.steps.iter().flat_map(|step| &step.image_barriers).all(|barrier| barrier.image != wood.id));
}

#[test]
fn a_device_without_the_format_gets_what_it_decodes_to_and_the_note_says_so() {
    for format in Format::ALL.iter().copied().filter(|format| format.is_compressed()) {
        let feature = format.feature().expect("one brings it");
        let here = on(&frame(format), &raster::device()).expect("a Plan");
        assert_eq!(image(&here, "wood").format, format);
        let plan = on(&frame(format), &without(feature)).expect("a Plan");
        let made = format.decoded().expect("it is compressed");
        assert_eq!(image(&plan, "wood").format, made);
        assert!(becomes(format, made), "the loader decodes {format}");
        let said = &plan.notes.iter().find(|note| &*note.subject == "wood").expect("a note").text;
        let wanted = format!("{format} was asked for, {made} is made: `a device for tests` has no SAMPLED for it");
        assert!(said.starts_with(&wanted) && said.ends_with("; the file's texels are decoded"), "{said}");
    }
}

#[test]
fn a_format_is_there_only_where_the_feature_that_brings_it_is_switched_on() {
    let mut device = raster::device();
    device.features = Some(vec!["textureCompressionETC2".to_owned()]);
    assert!(device.format(BC1_RGB_SRGB_BLOCK).is_none() && device.format(EAC_R11_UNORM_BLOCK).is_some());
    assert_eq!(image(&on(&frame(BC1_RGB_SRGB_BLOCK), &device).expect("a Plan"), "wood").format, R8G8B8A8_SRGB);
    for (name, bc, astc) in [("nvidia-rtx-2080", true, false), ("mali-g78", false, true), ("meta-quest-3", false, true)]
    {
        let device = shipped(name);
        let found = [BC7_SRGB_BLOCK, ASTC_8x6_SRGB_BLOCK].map(|format| device.format(format).is_some());
        assert_eq!(found, [bc, astc], "{name}");
    }
}

#[test]
fn deep_images_in_blocks_of_mobile_devices_are_decoded() {
    for (format, made) in [(ASTC_4x4_UNORM_BLOCK, R8G8B8A8_UNORM), (BC7_UNORM_BLOCK, BC7_UNORM_BLOCK)] {
        let mut frame = frame(format);
        (frame.images[0].shape, frame.images[0].extent) = (Shape::D3, [20, 12, 5]);
        let plan = on(&frame, &raster::device()).expect("a Plan");
        assert_eq!(image(&plan, "wood").format, made);
    }
}

#[test]
fn compressed_images_are_only_sampled_and_filled_from_outside() {
    let mut drawn = frame(BC7_UNORM_BLOCK);
    drawn.images[0].lifetime = Lifetime::Transient;
    assert_eq!(refused(&drawn), ["`wood` is BC7_UNORM_BLOCK, a compressed format, and no pass can fill it"]);
    let state = State {
        stages: Stages::FRAGMENT_SHADER,
        accesses: Accesses::SHADER_SAMPLED_READ,
        layout: Layout::ShaderReadOnlyOptimal,
    };
    let imported = |frame: &mut Frame| {
        frame.images[0].lifetime = Lifetime::Imported { before: state, after: Some(state), owner: None };
    };
    let mut given = frame(BC7_UNORM_BLOCK);
    imported(&mut given);
    let plan = compiled(&given);
    assert!(matches!(image(&plan, "wood").role, Role::External { .. }));
    // No device decodes what a program hands in.
    let missing = refused_on(&given, &without("textureCompressionBC"));
    assert_eq!(missing, ["`wood` can't be BC7_UNORM_BLOCK on `a device for tests`: no SAMPLED"]);
    let mut cleared = given.clone();
    let mut fill = Pass::new("wipe", Work::Fill { value: framewright_graph::vulkan::FillValue::Color([0.0; 4]) });
    fill.transfers = vec![TransferUse {
        resource: Resource::Image(ImageIndex(0)),
        range: Subresources::WHOLE,
        span: Span::NONE,
        frames_ago: 0,
        write: true,
        keeps: false,
    }];
    cleared.passes.insert(0, fill);
    let errors = refused(&cleared);
    assert_eq!(errors, ["`wipe` does more with `wood` than sample it: it is BC7_UNORM_BLOCK, a compressed format"]);
    given.outputs.push(Resource::Image(ImageIndex(0)).into());
    assert_eq!(refused(&given), ["`wood` is an output and is BC7_UNORM_BLOCK, a compressed format"]);
    let mut picture = frame(BC7_UNORM_BLOCK);
    picture.images[0].lifetime = Lifetime::File(Arc::new(TextureFile::picture("wood.png", ColorSpace::Linear)));
    let errors = refused(&picture);
    assert!(errors[0].ends_with("only a texture file (KTX2, DDS) holds compressed texels"), "{errors:?}");
}

#[test]
fn a_plan_in_which_a_compressed_image_is_more_than_sampled_is_wrong() {
    let right = compiled(&frame(BC7_UNORM_BLOCK));
    let found = |change: fn(&mut Plan)| {
        let mut plan = right.clone();
        change(&mut plan);
        verify(&plan).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let said = "is compressed, and more than sampled, or filled by the frame";
    for change in [
        (|plan| plan.images[0].usage |= Usage::COLOR_ATTACHMENT) as fn(&mut Plan),
        |plan| plan.images[0].samples = 4,
        |plan| {
            let Role::Persistent { initial, .. } = &mut plan.images[0].role else { panic!("it persists") };
            *initial = FirstContents::Value(framewright_graph::vulkan::FillValue::Color([0.0; 4]));
        },
    ] {
        assert!(found(change).contains(said), "{}", found(change));
    }
    let picture = found(|plan| {
        let Role::Persistent { initial, .. } = &mut plan.images[0].role else { panic!("it persists") };
        *initial = FirstContents::File(Arc::new(TextureFile::picture("wood.png", ColorSpace::Linear)));
    });
    assert!(picture.contains(said) && picture.contains("another kind than its format"), "{picture}");
}

#[test]
fn sizes_count_whole_blocks() {
    let wanted = |format, mips, layers| WantedTexels { format, extent: [20, 12, 1], mips, layers }.bytes();
    // 5 × 3, 3 × 2 and 2 × 1 blocks of 8 bytes.
    assert_eq!(wanted(BC1_RGB_UNORM_BLOCK, 3, 1), 8 * (15 + 6 + 2));
    assert_eq!(wanted(ASTC_12x12_SRGB_BLOCK, 2, 6), 16 * (2 + 1) * 6);
    assert_eq!(wanted(R8G8B8A8_UNORM, 2, 1), 4 * (240 + 60));
    let memory = raster::device().memory;
    let estimated = |format: Format| {
        let plan = compiled(&frame(format));
        let wood = image(&plan, "wood");
        let descriptor = framewright_graph::device::ImageDescriptor {
            format,
            shape: wood.shape,
            extent: [1024, 1024, 1],
            mips: 1,
            layers: 1,
            samples: 1,
            usage: wood.usage,
            sharing: wood.sharing,
        };
        memory.image(&descriptor).bytes
    };
    assert_eq!(estimated(BC7_UNORM_BLOCK) * 4, estimated(R8G8B8A8_UNORM));
}

#[test]
fn a_texture_file_makes_no_image_of_another_shape() {
    let info = TextureInfo { layers: 6, cube: true, stored: true, ..TextureInfo::picture([4, 4], BC7_UNORM_BLOCK) };
    let wrong = info.image_extent(Shape::D2).expect_err("it is a cube");
    assert_eq!(wrong, TextureProblem::Shape { found: Shape::Cube, expected: Shape::D2 });
    let file = TextureFile::picture("box.ktx2", ColorSpace::Linear);
    let made = Image::of_file("box", file.clone(), &info, Shape::Cube).expect("an image");
    assert_eq!((made.mips, made.layers, made.shape), (1, 6, Shape::Cube));
    assert!(matches!(&made.lifetime, Lifetime::File(file) if file.stored));
    assert_eq!(
        info.format_problem(&file, BC1_RGB_UNORM_BLOCK),
        Some("only a texture file (KTX2, DDS) holds compressed texels")
    );
}
