//! Around the panel stands Framewright's picture, texel by texel; where the panel is, it is drawn; the validation layer is silent (EM-12).

use framewright::{Device, DeviceOptions, Renderer, RendererOptions, SceneDrawSource, load_scene};
use image::RgbaImage;
use std::process::Command;

const EXTENT: [u32; 2] = [640, 360];

/// What turns the validation layer on, has it look closely, and print what it finds, although wgpu listens to it.
const VALIDATION: [(&str, &str); 8] = [
    ("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation"),
    ("VK_LAYER_VALIDATE_SYNC", "1"),
    ("VK_LAYER_SYNCVAL_SHADER_ACCESSES_HEURISTIC", "1"),
    ("VK_LAYER_SYNCVAL_LOAD_OP_AFTER_STORE_OP_VALIDATION", "1"),
    ("VK_LAYER_ENABLE_MESSAGE_LIMIT", "0"),
    ("VK_LAYER_DEBUG_ACTION", "VK_DBG_LAYER_ACTION_LOG_MSG"),
    ("VK_LAYER_LOG_FILENAME", "stdout"),
    ("VK_LOADER_DEBUG", "layer"),
];

/// naga gives members of a local variable offsets, in egui's shader too.
const OF_NAGA: &str = "VUID-StandaloneSpirv-None-10684";

/// Framewright's picture on a device of its own.
fn expected(tone_mapping: bool) -> RgbaImage {
    let device = Device::open(&DeviceOptions::default()).expect("a device");
    let scene = load_scene("spheres_and_cubes").expect("it is shipped");
    let mut renderer = Renderer::open(&device, "forward", RendererOptions::default()).expect("it is shipped");
    renderer.set("tone_mapping", tone_mapping).expect("allowed");
    renderer.set_scene(&scene);
    renderer.set_extent(EXTENT).expect("allowed");
    let plan = renderer.prepare().expect("planned").plan;
    let mut objects = SceneDrawSource::for_plan(&device, &scene, EXTENT, plan).expect("uploaded");
    renderer.frame(&mut objects).expect("drawn");
    let texels = renderer.read("screen").expect("read");
    RgbaImage::from_raw(EXTENT[0], EXTENT[1], texels.bytes).expect("as many bytes")
}

#[test]
fn the_panel_stands_over_framewrights_picture_in_silence() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut program = Command::new(env!("CARGO_BIN_EXE_wgpu-program"));
    let out = program.envs(VALIDATION).current_dir(folder.path()).output().expect("it runs");
    let (said, loader) = (String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
    assert!(out.status.success(), "{said}{loader}");
    assert!(loader.contains("VK_LAYER_KHRONOS_validation"), "the layer isn't there: {loader}");
    let findings: Vec<&str> = said.lines().filter(|line| line.contains("VUID-") || line.contains("SYNC-")).collect();
    assert!(findings.iter().all(|line| line.contains(OF_NAGA)), "the layer isn't silent: {said}");
    let panel = said.lines().find_map(|line| line.strip_prefix("the panel: ")).unwrap_or_else(|| panic!("{said}"));
    let panel: Vec<f32> = panel.split_whitespace().map(|side| side.parse().expect("a number")).collect();
    let [left, top, right, bottom] = panel[..] else { panic!("{said}") };
    assert!(right - left > 100.0 && right < 400.0 && bottom - top > 60.0 && bottom < 200.0, "{said}");

    let pictures = [("wgpu.png", true), ("wgpu_clicked.png", false)].map(|(file, tone_mapping)| {
        let shown = image::open(folder.path().join("out").join(file)).expect("a picture").into_rgba8();
        let expected = expected(tone_mapping);
        let (mut within, mut differ) = (0, 0);
        for (x, y, texel) in shown.enumerate_pixels() {
            let [column, row] = [x, y].map(|at| at as f32);
            // Its frame has soft edges.
            let is_outside = column < left - 1.0 || column > right + 1.0 || row < top - 1.0 || row > bottom + 1.0;
            let same = texel == expected.get_pixel(x, y);
            assert!(!is_outside || same, "{file}: {x}, {y}");
            within += u32::from(!is_outside);
            differ += u32::from(!same);
        }
        assert!(differ * 10 > within * 9, "{file}: {differ} of {within} texels of the panel were drawn");
        shown
    });
    assert!(pictures[0] != pictures[1], "the click chose nothing");
}
