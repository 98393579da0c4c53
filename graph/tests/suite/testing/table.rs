//! Shader interfaces out of a table.

use framewright_graph::base::Quote;
use framewright_graph::frame::Draw;
use framewright_graph::shader::{
    Attribute, Binding, BindingKind, Block, DrawInterface, FragmentOutput, Member, ShaderInterface, ShaderInterfaces,
    ShaderMessage, ShaderProblem, SuppliedKind, SuppliedResource, UnbindableResource, UnsetOutput, UnturnedPart,
    Variant, VertexBuffer, VertexInput,
};
use framewright_graph::vulkan::{Component, Dimension, Format, ImageShape, Stages};

/// The table.
pub(crate) struct Table;

fn texture(name: &str, binding: u32, multisampled: bool, component: Component) -> Binding {
    let shape = ImageShape { dimension: Dimension::D2, arrayed: false, multisampled, component };
    let kind = BindingKind::SampledImage(shape);
    Binding {
        set: 0,
        binding,
        name: name.to_owned(),
        kind,
        length: None,
        adapts: false,
        separate: false,
        stages: Stages::FRAGMENT_SHADER,
    }
}

/// A sampled image that is declared as the pass has it.
fn adapting(name: &str, variant: &Variant) -> Binding {
    let flat = texture(name, 0, false, Component::Float);
    let given = variant.textures.iter().find(|(given, _)| **given == *name);
    let kind = given.map_or(flat.kind, |(_, shape)| BindingKind::SampledImage(*shape));
    Binding { kind, adapts: true, ..flat }
}

fn params(members: &[(&str, &str)]) -> Binding {
    let members = members.iter().zip(0..).map(|((name, ty), at)| Member {
        name: (*name).to_owned(),
        offset: 4 * at,
        ty: (*ty).to_owned(),
        ..Member::default()
    });
    let block = Block { bytes: 16, members: members.collect() };
    let kind = BindingKind::UniformBlock(block);
    Binding {
        set: 0,
        binding: 9,
        name: "params".to_owned(),
        kind,
        length: None,
        adapts: false,
        separate: false,
        stages: Stages::FRAGMENT_SHADER,
    }
}

fn outputs(count: u32, component: Component, components: u32) -> Vec<FragmentOutput> {
    (0..count)
        .map(|location| FragmentOutput { location, name: format!("color_{location}"), component, components })
        .collect()
}

/// A full-screen shader with one colour output.
fn full_screen(bindings: Vec<Binding>) -> ShaderInterface {
    let asks_part = sampled(&bindings);
    ShaderInterface { bindings, outputs: outputs(1, Component::Float, 4), asks_part, ..ShaderInterface::default() }
}

/// The first output, perhaps not set on some path, or surely.
fn unset(refused: bool) -> UnsetOutput {
    let what = if refused { "never sets `color_0`" } else { "doesn't set `color_0` on every path" };
    let place = Some("unset.frag:3".to_owned());
    UnsetOutput { location: Some(0), name: "color_0".to_owned(), what: what.to_owned(), refused, place }
}

/// The names of the sampled images among `bindings`.
fn sampled(bindings: &[Binding]) -> Vec<String> {
    let sampled = bindings.iter().filter(|it| matches!(it.kind, BindingKind::SampledImage(_)));
    sampled.map(|it| it.name.clone()).collect()
}

fn lit(discards: bool) -> ShaderInterface {
    let frame = |binding, name: &str, kind| Binding {
        set: 1,
        binding,
        name: name.to_owned(),
        kind,
        length: None,
        adapts: false,
        separate: false,
        stages: Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER,
    };
    let view = frame(0, "view", BindingKind::UniformBlock(Block::default()));
    let objects = frame(2, "objects", BindingKind::StorageBlock { readable: true, writable: false, bytes: 0 });
    let texture = Binding { set: 2, ..texture("base_color_texture", 0, false, Component::Float) };
    let input = |location, name: &str, ty: &str| VertexInput {
        location,
        component: 0,
        name: name.to_owned(),
        ty: ty.to_owned(),
        used: true,
    };
    ShaderInterface {
        bindings: vec![view, objects, texture],
        vertex_inputs: vec![input(0, "position", "vec3"), input(1, "normal", "vec3")],
        outputs: outputs(1, Component::Float, 4),
        discards,
        ..ShaderInterface::default()
    }
}

fn block(name: &str, binding: u32, readable: bool, writable: bool, stages: Stages) -> Binding {
    let kind = BindingKind::StorageBlock { readable, writable, bytes: 0 };
    Binding { set: 0, binding, name: name.to_owned(), kind, length: None, adapts: false, separate: false, stages }
}

fn storage_image(name: &str, dimension: Dimension, format: Option<Format>, readable: bool) -> Binding {
    let component = format.map_or(Component::Float, Component::of);
    let shape = ImageShape { dimension, arrayed: false, multisampled: false, component };
    let kind = BindingKind::StorageImage { shape, format, readable, writable: true };
    Binding {
        set: 0,
        binding: 5,
        name: name.to_owned(),
        kind,
        length: None,
        adapts: false,
        separate: false,
        stages: Stages::COMPUTE_SHADER,
    }
}

/// The binding as another stage sees it.
fn of_stage(binding: Binding, stages: Stages) -> Binding {
    Binding { stages, ..binding }
}

fn shaped(name: &str, dimension: Dimension, arrayed: bool) -> Binding {
    let shape = ImageShape { dimension, arrayed, multisampled: false, component: Component::Float };
    Binding { kind: BindingKind::SampledImage(shape), ..texture(name, 0, false, Component::Float) }
}

/// A compute shader with workgroups of this size.
fn compute(size: [u32; 3], bindings: Vec<Binding>) -> ShaderInterface {
    let bindings: Vec<Binding> =
        bindings.into_iter().map(|binding| of_stage(binding, Stages::COMPUTE_SHADER)).collect();
    let asks_part = sampled(&bindings);
    ShaderInterface { bindings, workgroup_size: Some(size), asks_part, ..ShaderInterface::default() }
}

fn uniform_block(name: &str, bytes: u32) -> Binding {
    let kind = BindingKind::UniformBlock(Block { bytes, members: Vec::new() });
    Binding {
        set: 0,
        binding: 7,
        name: name.to_owned(),
        kind,
        length: None,
        adapts: false,
        separate: false,
        stages: Stages::COMPUTE_SHADER,
    }
}

/// Compute shaders out of the table.
fn compute_shader(name: &str) -> Option<ShaderInterface> {
    let source = || texture("source", 0, false, Component::Float);
    let here = Stages::COMPUTE_SHADER;
    Some(match name {
        "store_two" => {
            let mut targets = storage_image("targets", Dimension::D2, Some(Format::R32_UINT), false);
            targets.length = Some(2);
            compute([8, 8, 1], vec![targets])
        }
        "simulate" => compute(
            [64, 1, 1],
            vec![
                block("particles", 0, true, true, here),
                block("before", 1, true, false, here),
                uniform_block("forces", 64),
                params(&[("seconds", "float")]),
            ],
        ),
        "histogram" => compute([16, 16, 1], vec![source(), block("bins", 1, true, true, here)]),
        "luminance_histogram" => compute([16, 16, 1], vec![source(), block("bins", 1, true, true, here)]),
        "adapt_exposure" => compute(
            [256, 1, 1],
            vec![
                block("bins", 0, true, false, here),
                block("exposure", 1, true, true, here),
                params(&["key", "darkest", "brightest", "seconds", "adaptation"].map(|name| (name, "float"))),
            ],
        ),
        "snow_fall" => compute(
            [64, 1, 1],
            vec![
                block("before", 0, true, false, here),
                block("flakes", 1, false, true, here),
                params(&[("seconds", "float"), ("wind", "float")]),
            ],
        ),
        "snow_gather" => compute(
            [256, 1, 1],
            vec![
                block("flakes", 0, true, false, here),
                block("seen", 1, false, true, here),
                block("counts", 2, false, true, here),
            ],
        ),
        "count_up" => ShaderInterface {
            only_written_at: vec![("counts".to_owned(), "count_up.comp:3".to_owned())],
            ..compute([64, 1, 1], vec![block("counts", 0, false, true, here)])
        },
        "halve" => compute(
            [8, 8, 1],
            vec![source(), storage_image("target", Dimension::D2, Some(Format::R16G16B16A16_SFLOAT), false)],
        ),
        "paint" => compute([8, 8, 1], vec![storage_image("target", Dimension::D2, None, true)]),
        "fog" => compute([4, 4, 4], vec![storage_image("target", Dimension::D3, None, false)]),
        _ => return None,
    })
}

const NAMES: &[&str] = &["blur", "downsample", "lit", "lit_masked", "reinhard", "sky", "soft_focus", "tone_map"];

/// Adds shadow maps to a shader that lights surfaces, if the variant gives them.
fn shadowed(mut shader: ShaderInterface, variant: &Variant) -> ShaderInterface {
    if variant.sampled.iter().any(|name| **name == *"sun_shadow") {
        shader.bindings.extend([adapting("sun_shadow", variant), params(&[("shadow_taps", "int")])]);
    }
    shader
}

/// A binding that the draw source brings along for a whole frame.
fn of_frame(binding: u32, name: &str, kind: BindingKind) -> Binding {
    Binding {
        set: 1,
        binding,
        name: name.to_owned(),
        kind,
        length: None,
        adapts: false,
        separate: false,
        stages: Stages::FRAGMENT_SHADER,
    }
}

/// Declares images that are read from the pass's own rendering scope as input attachments.
fn read_locally(mut shader: ShaderInterface, variant: &Variant) -> ShaderInterface {
    for binding in shader.bindings.iter_mut().filter(|it| variant.local.iter().any(|local| **local == *it.name)) {
        binding.kind = BindingKind::InputAttachment { multisampled: false, component: Component::Float };
    }
    shader
}

impl ShaderInterfaces for Table {
    fn draw_shader(&mut self, name: &str, draw: Draw, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        let float = Component::Float;
        let source = || texture("source", 0, false, float);
        let shader = match name {
            "lit" => shadowed(lit(false), variant),
            "lit_masked" => shadowed(lit(true), variant),
            "casters" | "casters_masked" => ShaderInterface { outputs: Vec::new(), ..lit(name == "casters_masked") },
            "forgetful" => lit(!variant.depth_only),
            "marked" | "moved" => {
                let mut marked = lit(true);
                if name == "marked" || !variant.depth_only {
                    marked.bindings.insert(0, block("marks", 0, true, false, Stages::VERTEX_SHADER));
                }
                marked
            }
            "sky" | "plain" => full_screen(vec![]),
            "whole" => ShaderInterface { outputs: outputs(1, Component::Uint, 1), ..ShaderInterface::default() },
            "uints" => ShaderInterface { outputs: outputs(1, Component::Uint, 4), ..ShaderInterface::default() },
            "ints" => ShaderInterface { outputs: outputs(1, Component::Int, 4), ..ShaderInterface::default() },
            "tone_map" => full_screen(vec![source(), params(&[("exposure", "float"), ("white_point", "float")])]),
            "over_bright" | "blur_tent" | "copy" => full_screen(vec![source()]),
            "scale_area" | "scale_catmull_rom" => {
                full_screen(vec![source(), params(&[("target_width", "int"), ("target_height", "int")])])
            }
            "depth_stripes" => full_screen(vec![adapting("depth", variant), params(&[("period", "float")])]),
            "depth_stripes_copy" => {
                full_screen(vec![source(), adapting("depth", variant), params(&[("period", "float")])])
            }
            "tone_map_operator" => full_screen(vec![
                adapting("source", variant),
                params(&[("exposure", "float"), ("operator", "int"), ("white_point", "float")]),
            ]),
            "resolve_weighted" => full_screen(vec![adapting("source", variant), params(&[("invert", "uint")])]),
            "g_buffer" | "g_buffer_masked" => {
                let mut outputs = outputs(3, float, 4);
                outputs[1].components = 2;
                ShaderInterface { outputs, ..lit(name == "g_buffer_masked") }
            }
            "deferred_lighting" => {
                let lights = BindingKind::StorageBlock { readable: true, writable: false, bytes: 0 };
                let mut bindings = vec![
                    texture("base_color", 0, false, float),
                    texture("normal", 1, false, float),
                    texture("emissive", 2, false, float),
                    texture("depth", 3, false, float),
                    of_frame(0, "view", BindingKind::UniformBlock(Block::default())),
                    of_frame(1, "lights", lights),
                ];
                if variant.sampled.iter().any(|name| **name == *"ambient_occlusion") {
                    bindings.push(texture("ambient_occlusion", 5, false, float));
                }
                shadowed(full_screen(bindings), variant)
            }
            "ambient_occlusion" => full_screen(vec![
                texture("depth", 0, false, float),
                texture("normal", 1, false, float),
                params(&[("radius", "float"), ("strength", "float")]),
                of_frame(0, "view", BindingKind::UniformBlock(Block::default())),
            ]),
            "color_grade" => {
                full_screen(vec![source(), texture("table", 1, false, float), params(&[("strength", "float")])])
            }
            "depth_of_field" => full_screen(vec![
                source(),
                texture("depth", 1, false, float),
                params(&[("focus", "float"), ("spread", "float"), ("largest", "int")]),
                of_frame(0, "view", BindingKind::UniformBlock(Block::default())),
            ]),
            "taps" => full_screen(vec![Binding { length: Some(3), ..texture("taps", 0, false, float) }]),
            "fxaa" => full_screen(vec![source(), params(&[("subpixel", "float")])]),
            "ambient_occlusion_blur" => full_screen(vec![source(), texture("depth", 1, false, float)]),
            "bloom_shrink" => full_screen(vec![source(), params(&[("partial", "uint")])]),
            "bloom_grow" => full_screen(vec![
                texture("own", 0, false, float),
                texture("below", 1, false, float),
                params(&[("radius", "float"), ("share", "float")]),
            ]),
            "bloom_mix" => full_screen(vec![
                texture("sharp", 0, false, float),
                texture("bloom", 1, false, float),
                params(&[("radius", "float"), ("strength", "float")]),
            ]),
            "expose" => full_screen(vec![
                source(),
                of_stage(uniform_block("exposure", 4), Stages::FRAGMENT_SHADER),
                params(&[("white_point", "float")]),
            ]),
            "accumulate" => full_screen(vec![
                texture("now", 0, false, float),
                texture("before", 1, false, float),
                params(&[("share", "float")]),
            ]),
            "average_frames" => full_screen(vec![
                texture("now", 0, false, float),
                texture("before", 1, false, float),
                params(&[("frames", "int")]),
            ]),
            "motion" | "motion_masked" => {
                ShaderInterface { outputs: outputs(1, float, 2), ..lit(name == "motion_masked") }
            }
            "motion_sky" => ShaderInterface { outputs: outputs(1, float, 2), ..full_screen(vec![]) },
            "taa" => ShaderInterface {
                outputs: [outputs(1, float, 4), vec![FragmentOutput { location: 1, ..outputs(1, float, 2).remove(0) }]]
                    .concat(),
                ..full_screen(vec![
                    texture("now", 0, false, float),
                    texture("before", 1, false, float),
                    texture("depth", 2, false, float),
                    texture("motion", 3, false, float),
                    texture("record_before", 4, false, float),
                    params(&[("share", "float"), ("deviations", "float")]),
                ])
            },
            "snow" => full_screen(vec![
                block("flakes", 0, true, false, Stages::VERTEX_SHADER),
                block("seen", 1, true, false, Stages::VERTEX_SHADER),
                params(&[("brightness", "float")]),
            ]),
            "downsample" | "reinhard" => full_screen(vec![source()]),
            "two_blocks.hlsl" => {
                let block = |name: &str, binding, members: &[(&str, &str)]| Binding {
                    name: name.to_owned(),
                    binding,
                    ..params(members)
                };
                let tint = block("Tint", 1, &[("tint", "vec3"), ("strength", "float")]);
                full_screen(vec![source(), tint, block("Shape", 2, &[("corners", "float")])])
            }
            "look_up" => {
                let mut texels = storage_image("texels", Dimension::D2, Some(Format::R16G16B16A16_SFLOAT), true);
                if let BindingKind::StorageImage { writable, .. } = &mut texels.kind {
                    *writable = false;
                }
                full_screen(vec![of_stage(texels, Stages::FRAGMENT_SHADER)])
            }
            "blur" => full_screen(vec![source(), params(&[("direction_x", "float"), ("direction_y", "float")])]),
            "gauss" => full_screen(vec![
                source(),
                params(&[("direction_x", "float"), ("direction_y", "float"), ("radius", "float")]),
            ]),
            "overlay" => {
                let floats = ["scale", "offset_x", "offset_y", "gain", "farthest"].map(|name| (name, "float"));
                full_screen(vec![
                    adapting("shown", variant),
                    params(&[&floats[..], &[("is_signed", "uint"), ("layer", "int")]].concat()),
                ])
            }
            "soft_focus" => full_screen(vec![
                texture("sharp", 0, false, float),
                texture("soft", 1, false, float),
                params(&[("strength", "float")]),
            ]),
            "raw" | "raw.hlsl:main" | "raw.slang:main" | "raw.spv" | "raw.wgsl:main" => {
                ShaderInterface { unturned: vec![UnturnedPart::FragCoord], ..full_screen(vec![source()]) }
            }
            "deaf" | "deaf.hlsl:main" | "deaf.slang:main" | "deaf.wgsl:main" => {
                ShaderInterface { asks_part: Vec::new(), ..full_screen(vec![source()]) }
            }
            "any_texture" => full_screen(vec![adapting("source", variant)]),
            "custom_resolve" => full_screen(vec![texture("source", 0, true, float)]),
            "count" => full_screen(vec![texture("source", 0, false, Component::Uint)]),
            "typed" => full_screen(vec![params(&[("a", "float"), ("b", "uint"), ("c", "int"), ("d", "vec4")])]),
            "shadowed" => {
                let mut interface = full_screen(vec![texture("shadow", 0, false, float)]);
                if let BindingKind::SampledImage(shape) = interface.bindings[0].kind {
                    interface.bindings[0].kind = BindingKind::ComparedDepth(shape);
                    interface.asks_part.push("shadow".to_owned());
                }
                interface
            }
            "vectors" => full_screen(vec![params(&[
                ("tint", "vec3"),
                ("cell", "ivec2"),
                ("flags", "uvec2"),
                ("turn", "mat2x3"),
            ])]),
            "listed" => full_screen(vec![params(&[("weights", "vec4[2]")])]),
            "scalars" => full_screen(vec![params(&[("a", "float"), ("b", "uint"), ("c", "int")])]),
            "cube" => {
                let mut interface = full_screen(vec![source()]);
                if let BindingKind::SampledImage(shape) = &mut interface.bindings[0].kind {
                    shape.dimension = Dimension::Cube;
                }
                interface
            }
            "holes" => ShaderInterface { discards: true, ..full_screen(vec![]) },
            "masks" => ShaderInterface {
                masks_samples: true,
                per_sample: true,
                leaves_out_at: Some("masks.frag:4".to_owned()),
                ..full_screen(vec![])
            },
            "second" => ShaderInterface { second_source: true, ..full_screen(vec![]) },
            "points" => ShaderInterface { point_size: true, ..full_screen(vec![]) },
            "part" => ShaderInterface { own_vertices: Some("part.vert".to_owned()), ..full_screen(vec![]) },
            "forgets" => ShaderInterface { unset: vec![unset(false)], ..full_screen(vec![]) },
            "never_sets" => ShaderInterface { unset: vec![unset(true)], ..full_screen(vec![]) },
            "unmasked" => ShaderInterface { masks_samples: !variant.depth_only, ..lit(false) },
            "around" => full_screen(vec![shaped("source", Dimension::Cube, false)]),
            "layered" => full_screen(vec![shaped("source", Dimension::D2, true)]),
            "deep" => full_screen(vec![shaped("source", Dimension::D3, false)]),
            "own" => {
                let kind = BindingKind::InputAttachment { multisampled: false, component: float };
                full_screen(vec![Binding { kind, ..source() }])
            }
            "particles" => ShaderInterface {
                vertex_inputs: vec![VertexInput {
                    location: 0,
                    component: 0,
                    name: "position".to_owned(),
                    ty: "vec4".to_owned(),
                    used: true,
                }],
                ..full_screen(vec![])
            },
            "sized" => full_screen(vec![Binding {
                kind: BindingKind::StorageBlock { readable: true, writable: false, bytes: 24 },
                ..block("tiles", 0, true, false, Stages::FRAGMENT_SHADER)
            }]),
            "instanced" => {
                let input = |location, component, name: &str, ty: &str, used| VertexInput {
                    location,
                    component,
                    name: name.to_owned(),
                    ty: ty.to_owned(),
                    used,
                };
                let (turn, unused) = (input(1, 0, "turn", "mat4", true), input(5, 0, "uv", "vec2", false));
                let vertex_inputs = vec![input(0, 0, "position", "vec2", true), turn, unused];
                ShaderInterface { vertex_inputs, ..full_screen(vec![]) }
            }
            "leftover" => {
                let mut interface = lit(false);
                interface.vertex_inputs[1] =
                    VertexInput { used: false, name: "tint".to_owned(), ..interface.vertex_inputs[1].clone() };
                interface
            }
            "pulled" => full_screen(vec![block("particles", 0, true, false, Stages::VERTEX_SHADER)]),
            "no_color" => ShaderInterface::default(),
            "vec3" => ShaderInterface { outputs: outputs(1, float, 3), ..ShaderInterface::default() },
            "odd_set" => full_screen(vec![Binding {
                set: 0,
                binding: 0,
                name: "tiles".to_owned(),
                kind: BindingKind::StorageBlock { readable: true, writable: true, bytes: 0 },
                length: None,
                adapts: false,
                separate: false,
                stages: Stages::FRAGMENT_SHADER,
            }]),
            "misplaced" => {
                let mut interface = lit(false);
                interface.bindings[0].binding = 7;
                interface.bindings[1].kind = BindingKind::StorageBlock { readable: true, writable: true, bytes: 0 };
                interface.bindings[2].name = "base_colour_texture".to_owned();
                interface.vertex_inputs[0].name = "positions".to_owned();
                interface.vertex_inputs[1].ty = "ivec3".to_owned();
                interface
            }
            "broken" => {
                let text = "shaders/broken.frag:3: error: 'colr' : undeclared identifier".to_owned();
                let quote = Quote {
                    file: "shaders/broken.frag".to_owned(),
                    line: 3,
                    text: "void main() { color = colr; }".to_owned(),
                    underlined: 22..26,
                    remark: "'colr' : undeclared identifier".to_owned(),
                };
                let message = ShaderMessage { text, quote: Some(quote), limit: None };
                return Err(ShaderProblem::DoesNotCompile { messages: vec![message] });
            }
            "comparing" => full_screen(vec![
                Binding {
                    kind: BindingKind::Other(UnbindableResource {
                        what: "a sampler that compares depth".to_owned(),
                        instead: "sample the depth by a `sampler2D`, and compare it in the shader".to_owned(),
                        place: Some("shaders/comparing.frag:2".to_owned()),
                    }),
                    ..texture("map", 0, false, Component::Float)
                },
                of_stage(storage_image("picture", Dimension::D2, None, true), Stages::FRAGMENT_SHADER),
            ]),
            "exotic" => return Err(ShaderProblem::Unsupported { what: "input attachment `previous`".to_owned() }),
            _ => {
                let known = NAMES.iter().map(|name| (*name).to_owned()).collect();
                let looked_in = vec!["shaders".to_owned(), "the shipped shaders".to_owned()];
                let _ = draw;
                return Err(ShaderProblem::Missing { looked_in, known });
            }
        };
        Ok(read_locally(shader, variant))
    }

    fn compute_shader(&mut self, name: &str, _: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        compute_shader(name).ok_or_else(|| ShaderProblem::Missing {
            looked_in: vec!["shaders".to_owned()],
            known: ["histogram", "simulate"].map(str::to_owned).to_vec(),
        })
    }

    fn brought_along(&self, draw: Option<Draw>, _: &str) -> DrawInterface {
        let supplied = |set, binding, name, kind| SuppliedResource::new(set, binding, name, kind);
        let view = supplied(1, 0, "view", SuppliedKind::UniformBlock);
        let lights = supplied(1, 1, "lights", SuppliedKind::StorageBlock);
        match draw {
            None => DrawInterface { supplied: vec![view], ..DrawInterface::default() },
            Some(Draw::Objects(_) | Draw::Casters(_)) => DrawInterface {
                vertex_buffers: vec![VertexBuffer::of_vertices(32)],
                attributes: vec![
                    Attribute::new("position", 3, 0),
                    Attribute::new("normal", 3, 12),
                    Attribute::new("uv", 2, 24),
                ],
                supplied: vec![
                    view,
                    lights,
                    supplied(1, 2, "objects", SuppliedKind::StorageBlock),
                    supplied(2, 0, "base_color_texture", SuppliedKind::SampledImage),
                ],
                ..DrawInterface::default()
            },
            Some(Draw::Sky) => DrawInterface { supplied: vec![view], ..DrawInterface::default() },
            Some(Draw::FullScreen) => DrawInterface { supplied: vec![view, lights], ..DrawInterface::default() },
            Some(Draw::Vertices { .. } | Draw::Indirect | Draw::Indirects(_) | Draw::Custom) => {
                DrawInterface::default()
            }
        }
    }
}
