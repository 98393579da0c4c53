//! Several views of one scene in a frame: each is drawn from its own camera, in its own shape.

use framewright_graph::base::Span;
use framewright_graph::compile::{Options, compile};
use framewright_graph::frame::{
    Allowances, Blend, ColorTarget, DepthTarget, Draw, DrawList, Frame, Image, ImageIndex, Pass, Resource, View,
    ViewIndex, Work,
};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{CompareOp, Format, Subresources};
use framewright_passes::draw::{SceneDrawSource, interfaces};
use framewright_passes::scene::{Camera, NamedCamera, Scene};
use framewright_passes::shipped::SHADERS;
use framewright_tests::render::{device, silent};
use framewright_tests::shapes::{material, scene, sphere};
use framewright_vulkan::{Device, Executor, ExecutorOptions, ShaderLibrary};
use glam::{DVec3, Mat4, Vec3};

const SIZES: [[u32; 2]; 2] = [[64, 64], [96, 32]];

/// Three balls of their own colours, seen from the front by default and from the `side`; two of them let light through.
fn balls() -> Scene {
    let see_through = |color| framewright_passes::scene::Material {
        alpha: framewright_passes::scene::AlphaMode::Blend,
        ..material(color)
    };
    let materials =
        vec![material([0.9, 0.1, 0.1, 1.0]), see_through([0.1, 0.9, 0.1, 0.5]), see_through([0.1, 0.1, 0.9, 0.5])];
    let at = |x: f32, z: f32| Mat4::from_translation(Vec3::new(x, 0.0, z)) * Mat4::from_scale(Vec3::splat(0.7));
    let mut scene =
        scene(vec![sphere(16)], materials, vec![(0, 0, at(-1.0, -1.0)), (0, 1, at(0.0, 0.5)), (0, 2, at(0.5, -0.5))]);
    scene.ambient = [1.0; 3];
    let side = Camera::look_at(DVec3::new(5.0, 2.0, 0.0), DVec3::ZERO, DVec3::Y, 0.9, 0.1).expect("it looks somewhere");
    scene.cameras.push(NamedCamera { name: "side".to_owned(), camera: side });
    scene
}

/// One picture for each of the views, of objects in both lists.
fn frame(views: &[Option<&str>]) -> Frame {
    let mut frame = Frame::default();
    let (range, span) = (Subresources::WHOLE, Span::NONE);
    for (number, camera) in views.iter().enumerate() {
        let (extent, name) = (SIZES[number], format!("view {number}"));
        let (index, first) = (ViewIndex(number as u32), ImageIndex(frame.images.len() as u32));
        let (camera, allows) = (camera.map(Into::into), Allowances::default());
        frame.views.push(View { name: name.as_str().into(), span, extent, camera, allows, jitter: None, eye: None });
        frame.images.push(Image::new(&format!("picture {number}"), Format::R8G8B8A8_SRGB, extent[0], extent[1]));
        frame.images.push(Image::new(&format!("depth {number}"), Format::D32_SFLOAT, extent[0], extent[1]));
        for (list, clears, blend) in
            [(DrawList::Opaque, true, Blend::Replace), (DrawList::Transparent, false, Blend::Alpha)]
        {
            let draw = Draw::Objects(list);
            let work = Work::Draw { draw, shader: "lit".into(), discards: false, per_sample: false };
            let mut pass = Pass { view: index, ..Pass::new(&format!("{list:?} of {name}"), work) };
            let clear = clears.then_some([0.0, 0.0, 0.0, 1.0]);
            pass.color.push(ColorTarget { image: first, range, span, clear, blend, write_mask: Default::default() });
            let (clear, test, image) = (clears.then_some(0.0), CompareOp::GreaterOrEqual, ImageIndex(first.0 + 1));
            pass.depth = Some(DepthTarget { image, range, span, clear, test, write: clears, stencil: None });
            frame.passes.push(pass);
        }
        frame.outputs.push(Resource::Image(first).into());
    }
    frame
}

fn pictures(device: &Device, frame: &Frame, scene: &Scene, extent: [u32; 2]) -> Vec<Vec<u8>> {
    let plan = compile(frame, &device.profile(), &mut device.memory(), &Options::default()).expect("a Plan");
    assert_eq!(verify(&plan), []);
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
    let mut source = SceneDrawSource::for_plan(device, scene, extent, &plan).expect("a source");
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
    executor.frame(&mut source).expect("a frame");
    (0..plan.outputs.len()).map(|output| executor.read(output).expect("its texels").bytes).collect()
}

#[test]
fn each_view_of_a_frame_shows_what_its_camera_sees_in_its_own_shape() {
    let Some(device) = device() else { return };
    let balls = balls();
    let seen = pictures(device, &frame(&[None, Some("side")]), &balls, SIZES[0]);
    // The same one at a time, without views: the second from a scene whose only camera is that of the side.
    let mut from_the_side = balls.clone();
    from_the_side.camera = balls.cameras[0].camera;
    for (number, scene) in [&balls, &from_the_side].into_iter().enumerate() {
        let mut alone = frame(&[None, None]);
        alone.views.clear();
        alone.passes.iter_mut().for_each(|pass| pass.view = ViewIndex(0));
        let expected = pictures(device, &alone, scene, SIZES[number]).swap_remove(number);
        assert!(seen[number] == expected, "view {number} differs");
        let colors: std::collections::BTreeSet<&[u8]> = expected.chunks(4).collect();
        assert!(colors.len() > 3, "view {number} shows {} colours", colors.len());
    }
    silent(device).expect("the layer found nothing");
}

#[test]
fn a_camera_that_the_scene_does_not_have_is_named_with_those_it_has() {
    let Some(device) = device() else { return };
    let frame = frame(&[None, Some("top")]);
    let plan = compile(&frame, &device.profile(), &mut device.memory(), &Options::default()).expect("a Plan");
    let said = SceneDrawSource::for_plan(device, &balls(), SIZES[0], &plan).err().expect("no such camera");
    assert!(said.to_string().contains("view `view 1` asks for the camera `top`; the scene has `side`"), "{said}");
}
