//! Claims about every shipped shader, as the shader library sees it. No device is needed.

use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::{BindingKind, PASS_SET, ShaderInterface, ShaderInterfaces, SuppliedKind, Variant};
use framewright_graph::vulkan::Dimension;
use framewright_passes::draw::{interface, interfaces};
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::ShaderLibrary;
use std::error::Error;

const OPAQUE: Draw = Draw::Objects(DrawList::Opaque);
const MASKED: Draw = Draw::Objects(DrawList::Masked);
const TRANSPARENT: Draw = Draw::Objects(DrawList::Transparent);

/// Every shipped fragment shader with a draw that it is made for.
const DRAWN: &[(&str, Draw)] = &[
    ("accumulate", Draw::FullScreen),
    ("ambient_occlusion", Draw::FullScreen),
    ("ambient_occlusion_blur", Draw::FullScreen),
    ("average_frames", Draw::FullScreen),
    ("bloom_grow", Draw::FullScreen),
    ("bloom_mix", Draw::FullScreen),
    ("bloom_shrink", Draw::FullScreen),
    ("blur", Draw::FullScreen),
    ("blur_tent", Draw::FullScreen),
    ("casters", OPAQUE),
    ("casters_masked", MASKED),
    ("color_grade", Draw::FullScreen),
    ("copy", Draw::FullScreen),
    ("corner", Draw::FullScreen),
    ("deferred_lighting", Draw::FullScreen),
    ("depth_of_field", Draw::FullScreen),
    ("depth_resolve_average", Draw::FullScreen),
    ("depth_resolve_max", Draw::FullScreen),
    ("depth_resolve_min", Draw::FullScreen),
    ("depth_resolve_zero", Draw::FullScreen),
    ("depth_stripes", Draw::FullScreen),
    ("depth_stripes_copy", Draw::FullScreen),
    ("downsample", Draw::FullScreen),
    ("encode_hdr10", Draw::FullScreen),
    ("expose", Draw::FullScreen),
    ("film_grain", Draw::FullScreen),
    ("fxaa", Draw::FullScreen),
    ("g_buffer", OPAQUE),
    ("g_buffer_masked", MASKED),
    ("gauss", Draw::FullScreen),
    ("lit", OPAQUE),
    ("lit", TRANSPARENT),
    ("lit_masked", MASKED),
    ("motion", OPAQUE),
    ("motion_masked", MASKED),
    ("motion_sky", Draw::Sky),
    ("over_bright", Draw::FullScreen),
    ("overlay", Draw::FullScreen),
    ("reinhard", Draw::FullScreen),
    ("resolve_weighted", Draw::FullScreen),
    ("resolve_zero_sint", Draw::FullScreen),
    ("resolve_zero_uint", Draw::FullScreen),
    ("scale_area", Draw::FullScreen),
    ("scale_catmull_rom", Draw::FullScreen),
    ("sky", Draw::Sky),
    ("snow", Draw::Indirect),
    ("soft_focus", Draw::FullScreen),
    ("taa", Draw::FullScreen),
    ("tone_map", Draw::FullScreen),
    ("tone_map_operator", Draw::FullScreen),
    ("vignette", Draw::FullScreen),
];

/// Every shipped compute shader with the size of its workgroups.
const DISPATCHED: &[(&str, [u32; 3])] = &[
    ("adapt_exposure", [256, 1, 1]),
    ("count_frames", [1, 1, 1]),
    ("luminance_histogram", [16, 16, 1]),
    ("snow_fall", [64, 1, 1]),
    ("snow_gather", [256, 1, 1]),
];

fn library() -> ShaderLibrary {
    ShaderLibrary::new(Vec::new(), SHADERS, interfaces())
}

fn reflected(name: &str, draw: Draw) -> Result<ShaderInterface, Box<dyn Error>> {
    library().draw_shader(name, draw, &Variant::default()).map_err(|problem| format!("{name}: {problem:?}").into())
}

/// Names of the images that a shader samples for its pass, and of its parameters.
fn wanted(name: &str, draw: Draw) -> Result<(Vec<String>, Vec<String>), Box<dyn Error>> {
    let (mut images, mut params) = (Vec::new(), Vec::new());
    for binding in reflected(name, draw)?.bindings.into_iter().filter(|binding| binding.set == PASS_SET) {
        match binding.kind {
            BindingKind::UniformBlock(block) if binding.name == "params" => {
                params.extend(block.members.into_iter().map(|member| member.name));
            }
            BindingKind::SampledImage(_) => images.push(binding.name),
            _ => {}
        }
    }
    Ok((images, params))
}

#[test]
fn the_tables_here_name_every_shipped_fragment_and_compute_shader() {
    for (file, _) in SHADERS {
        if let Some(name) = file.strip_suffix(".frag") {
            assert!(DRAWN.iter().any(|(drawn, _)| *drawn == name), "{name}");
        }
        if let Some(name) = file.strip_suffix(".comp") {
            assert!(DISPATCHED.iter().any(|(dispatched, _)| *dispatched == name), "{name}");
        }
    }
}

#[test]
fn every_shipped_shader_compiles_and_finds_what_its_draw_brings_along() -> Result<(), Box<dyn Error>> {
    let mut library = library();
    for &(name, draw) in DRAWN {
        let shader =
            library.draw_shader(name, draw, &Variant::default()).map_err(|problem| format!("{name}: {problem:?}"))?;
        let brought = interface(draw);
        for binding in shader.bindings.iter().filter(|binding| binding.set != PASS_SET) {
            let kind = match &binding.kind {
                BindingKind::UniformBlock(_) => SuppliedKind::UniformBlock,
                BindingKind::StorageBlock { writable: false, .. } => SuppliedKind::StorageBlock,
                BindingKind::SampledImage(shape) if shape.dimension == Dimension::D2 => SuppliedKind::SampledImage,
                other => return Err(format!("{name}: {} is a {other:?}", binding.name).into()),
            };
            let fits = brought.supplied.iter().any(|supplied| {
                let place = (supplied.set, supplied.binding, &*supplied.name, supplied.kind);
                place == (binding.set, binding.binding, binding.name.as_str(), kind)
            });
            assert!(fits, "{name}: {binding:?}");
        }
        for input in &shader.vertex_inputs {
            let attribute = brought.attributes.iter().find(|attribute| attribute.name == *input.name);
            let ty = attribute.map(|attribute| format!("vec{}", attribute.format.components()));
            assert_eq!(ty.as_deref(), Some(input.ty.as_str()), "{name}: {}", input.name);
        }
    }
    Ok(())
}

#[test]
fn every_shipped_compute_shader_compiles_and_takes_nothing_but_what_is_its_passs_own() -> Result<(), Box<dyn Error>> {
    let mut library = library();
    for &(name, size) in DISPATCHED {
        let shader =
            library.compute_shader(name, &Variant::default()).map_err(|problem| format!("{name}: {problem:?}"))?;
        assert_eq!(shader.workgroup_size, Some(size), "{name}");
        assert!(shader.bindings.iter().all(|binding| binding.set == PASS_SET), "{name}");
    }
    Ok(())
}

#[test]
fn only_masked_shaders_discard() -> Result<(), Box<dyn Error>> {
    for &(name, draw) in DRAWN {
        assert_eq!(reflected(name, draw)?.discards, draw == MASKED, "{name}");
    }
    Ok(())
}

#[test]
fn full_screen_shaders_take_their_images_and_parameters_by_these_names() -> Result<(), Box<dyn Error>> {
    let cases: [(&str, &[&str], &[&str]); 39] = [
        ("accumulate", &["now", "before"], &["share"]),
        ("ambient_occlusion", &["depth", "normal"], &["radius", "strength"]),
        ("ambient_occlusion_blur", &["source", "depth"], &[]),
        ("average_frames", &["now", "before"], &["frames"]),
        ("bloom_grow", &["own", "below"], &["radius", "share"]),
        ("bloom_mix", &["sharp", "bloom"], &["radius", "strength"]),
        ("bloom_shrink", &["source"], &["partial"]),
        ("blur", &["source"], &["direction_x", "direction_y"]),
        ("blur_tent", &["source"], &[]),
        ("color_grade", &["source", "table"], &["strength"]),
        ("copy", &["source"], &[]),
        ("corner", &["shown"], &["width", "height"]),
        ("deferred_lighting", &["base_color", "normal", "emissive", "depth"], &[]),
        ("depth_of_field", &["source", "depth"], &["focus", "spread", "largest"]),
        ("depth_resolve_average", &["source"], &[]),
        ("depth_resolve_max", &["source"], &[]),
        ("depth_resolve_min", &["source"], &[]),
        ("depth_resolve_zero", &["source"], &[]),
        ("depth_stripes", &["depth"], &["period"]),
        ("depth_stripes_copy", &["source", "depth"], &["period"]),
        ("downsample", &["source"], &[]),
        ("encode_hdr10", &["source"], &["reference_white"]),
        ("expose", &["source"], &["white_point"]),
        ("film_grain", &["source"], &["strength"]),
        ("fxaa", &["source"], &["subpixel"]),
        ("gauss", &["source"], &["direction_x", "direction_y", "radius"]),
        ("over_bright", &["source"], &[]),
        ("overlay", &["shown"], &["scale", "offset_x", "offset_y", "gain", "is_signed", "farthest", "layer"]),
        ("reinhard", &["source"], &[]),
        ("resolve_weighted", &["source"], &["invert"]),
        ("resolve_zero_sint", &["source"], &[]),
        ("resolve_zero_uint", &["source"], &[]),
        ("scale_area", &["source"], &["target_width", "target_height"]),
        ("scale_catmull_rom", &["source"], &["target_width", "target_height"]),
        ("soft_focus", &["sharp", "soft"], &["strength"]),
        ("taa", &["now", "before", "depth", "motion", "record_before"], &["share", "deviations"]),
        ("tone_map", &["source"], &["exposure", "white_point"]),
        ("tone_map_operator", &["source"], &["exposure", "operator", "white_point"]),
        ("vignette", &[], &["strength", "aspect"]),
    ];
    for (name, images, params) in cases {
        let (found_images, found_params) = wanted(name, Draw::FullScreen)?;
        assert_eq!(found_images, images, "{name}");
        assert_eq!(found_params, params, "{name}");
    }
    Ok(())
}

#[test]
fn full_screen_shaders_are_safe_to_rotate() -> Result<(), Box<dyn Error>> {
    for &(name, draw) in DRAWN.iter().filter(|(_, draw)| *draw == Draw::FullScreen) {
        let shader = reflected(name, draw)?;
        assert!(!shader.uses_frag_coord && !shader.uses_derivatives && !shader.per_sample, "{name}");
    }
    Ok(())
}

/// IQ-13: masked objects keep what removes fragments, opaque ones need no fragment shader; neither colour nor light is left.
#[test]
fn object_shaders_that_draw_nothing_but_depth_keep_only_what_removes_fragments() -> Result<(), Box<dyn Error>> {
    let depth_only = Variant { depth_only: true, ..Variant::default() };
    for (name, draw) in DRAWN.iter().filter(|(_, draw)| matches!(draw, Draw::Objects(_))) {
        let whole = library().compiled(name, *draw, &Variant::default()).map_err(|problem| format!("{problem:?}"))?;
        let alone = library().compiled(name, *draw, &depth_only).map_err(|problem| format!("{problem:?}"))?;
        assert_eq!(alone.vertex, whole.vertex, "{name}: the same vertices");
        assert_eq!(alone.fragment.is_some(), whole.interface.discards, "{name}");
        assert_eq!(alone.interface.discards, whole.interface.discards, "{name}");
        let read: Vec<&str> = alone.interface.bindings.iter().map(|binding| &*binding.name).collect();
        assert!(alone.interface.outputs.is_empty() && !read.contains(&"lights"), "{name}: {read:?}");
    }
    Ok(())
}
