//! Parts of images: mip levels, layers, slices and faces, each read and written for itself.

use crate::frames::{Small, Uses, dispatch, draw, everywhere, frame, layer, mip, texels};
use framewright_graph::frame::{Draw, Groups, Image};
use framewright_graph::vulkan::{Format, Shape, Subresources};

const WHOLE: Subresources = Subresources::WHOLE;
const ONE: Groups = Groups::Count([1, 1, 1]);

const SHADERS: &[(&str, &str)] = &[
    (
        "sum.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(location = 0) out uint color;
        void main() {
            ivec2 at = 2 * ivec2(gl_FragCoord.xy);
            color = 0;
            for (int i = 0; i < 4; ++i) color += texelFetch(source, at + ivec2(i & 1, i >> 1), 0).r;
        }",
    ),
    (
        "next.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(location = 0) out uint color;
        void main() { color = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r + 100; }",
    ),
    (
        "total.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2DArray source;
        layout(location = 0) out uint color;
        void main() {
            color = 0;
            for (int i = 0; i < textureSize(source, 0).z; ++i) {
                color = color * 3 + texelFetch(source, ivec3(gl_FragCoord.xy, i), 0).r;
            }
        }",
    ),
    (
        "levels.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(location = 0) out uint color;
        void main() {
            color = texelFetch(source, ivec2(gl_FragCoord.xy) / 2, 1).r + textureQueryLevels(source) * 1000;
        }",
    ),
    (
        "carve.comp",
        "#version 460
        layout(local_size_x = 4, local_size_y = 2, local_size_z = 3) in;
        layout(set = 0, binding = 0, r32ui) uniform writeonly uimage3D target;
        void main() {
            uvec3 at = gl_GlobalInvocationID;
            imageStore(target, ivec3(at), uvec4(at.x + 10 * at.y + 100 * at.z));
        }",
    ),
    (
        "slice.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler3D source;
        layout(location = 0) out uint color;
        void main() { color = texelFetch(source, ivec3(ivec2(gl_FragCoord.xy), 2), 0).r; }",
    ),
    (
        "look_around.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usamplerCube source;
        layout(location = 0) out uint color;
        void main() {
            int face = int(gl_FragCoord.x);
            vec3 direction = vec3(0.0);
            direction[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
            color = texture(source, direction).r;
        }",
    ),
    (
        "look_at_both.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usamplerCubeArray source;
        layout(location = 0) out uint color;
        void main() {
            int face = int(gl_FragCoord.x);
            vec3 direction = vec3(0.0);
            direction[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
            color = texture(source, vec4(direction, floor(gl_FragCoord.y))).r;
        }",
    ),
    (
        "faces.comp",
        "#version 460
        layout(local_size_x = 2, local_size_y = 2) in;
        layout(set = 0, binding = 0, r32ui) uniform writeonly uimage2DArray target;
        void main() { imageStore(target, ivec3(gl_GlobalInvocationID), uvec4(7 + gl_GlobalInvocationID.z)); }",
    ),
];

#[test]
fn each_mip_level_is_drawn_from_the_one_before() {
    let mut small = Small::default();
    let chain = small.image_like(Image { mips: 4, ..Image::new("chain", Format::R32_UINT, 8, 8) });
    small.pass(draw("number", Draw::FullScreen).draws(chain, mip(0), None));
    for level in 1..4 {
        let name = format!("level {level}");
        let mut pass = draw("sum", Draw::FullScreen).samples("source", chain, mip(level - 1));
        pass.name = name.into();
        small.pass(pass.draws(chain, mip(level), None));
    }
    small.image_output(chain);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        let level = |level: u32| {
            let (side, width) = (8 >> level, 1_u32 << level);
            // The sum over a square of `width` × `width` texels whose value is x + 10 y.
            let corner = |at: u32| at * width * 2 + width - 1;
            let sum = move |at: u32| width * width * (corner(at % side) + 10 * corner(at / side)) / 2;
            (0..side * side).map(sum).collect::<Vec<_>>()
        };
        for number in 0..4 {
            assert_eq!(texels(executor, "chain", number), level(number), "level {number}");
        }
    });
}

#[test]
fn a_pass_reads_one_layer_and_writes_another() {
    let mut small = Small::default();
    let layers = small.image_like(Image { layers: 3, ..Image::new("layers", Format::R32_UINT, 2, 2) });
    let total = small.image("total", Format::R32_UINT, [2, 2]);
    small.pass(draw("number", Draw::FullScreen).draws(layers, layer(0), None));
    for (name, number) in [("second", 1), ("third", 2)] {
        let mut pass = draw("next", Draw::FullScreen).samples("source", layers, layer(number - 1));
        pass.name = name.into();
        small.pass(pass.draws(layers, layer(number), None));
    }
    small.pass(draw("total", Draw::FullScreen).samples("source", layers, WHOLE).draws(total, WHOLE, None));
    small.image_output(total);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        let expected = [0, 1, 10, 11].map(|first| (first * 3 + first + 100) * 3 + first + 200);
        assert_eq!(texels(executor, "total", 0), expected);
    });
}

#[test]
fn mip_one_is_read_while_mip_two_is_written() {
    let mut small = Small::default();
    let image = small.image_like(Image { mips: 3, ..Image::new("i", Format::R32_UINT, 4, 4) });
    let shown = small.image("shown", Format::R32_UINT, [4, 4]);
    small.pass(draw("number", Draw::FullScreen).draws(image, mip(0), None));
    for (name, level) in [("first", 1), ("second", 2)] {
        let mut pass = draw("sum", Draw::FullScreen).samples("source", image, mip(level - 1));
        pass.name = name.into();
        small.pass(pass.draws(image, mip(level), None));
    }
    // Between the two that change mip 2, this one reads mips 0 and 1 alone.
    let upper = Subresources { base_mip: 0, mips: 2, ..WHOLE };
    small.pass(draw("levels", Draw::FullScreen).samples("source", image, upper).draws(shown, WHOLE, None));
    let mut again = draw("next", Draw::FullScreen).samples("source", image, mip(1));
    again.name = "again".into();
    small.pass(again.draws(image, mip(2), None));
    small.image_output(shown);
    small.image_output(image);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        let sums = [22, 30, 102, 110];
        assert_eq!(texels(executor, "i", 1), sums);
        let expected: Vec<u32> = (0..16).map(|at| 2000 + sums[at % 4 / 2 + at / 8 * 2]).collect();
        assert_eq!(texels(executor, "shown", 0), expected);
        assert_eq!(texels(executor, "i", 2), [122]);
    });
}

#[test]
fn a_volume_is_written_by_compute_and_sampled_in_slices() {
    let mut small = Small::default();
    let volume = Image { shape: Shape::D3, extent: [4, 2, 3], ..Image::new("volume", Format::R32_UINT, 4, 2) };
    let volume = small.image_like(volume);
    let slice = small.image("slice", Format::R32_UINT, [4, 2]);
    small.pass(dispatch("carve", ONE).stores("target", volume, WHOLE));
    small.pass(draw("slice", Draw::FullScreen).samples("source", volume, WHOLE).draws(slice, WHOLE, None));
    small.image_output(slice);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "slice", 0), [200, 201, 202, 203, 210, 211, 212, 213]);
    });
}

#[test]
fn the_faces_of_a_cube_are_found_by_direction() {
    let mut small = Small::default();
    let cube = Image { shape: Shape::Cube, layers: 6, ..Image::new("cube", Format::R32_UINT, 2, 2) };
    let cube = small.image_like(cube);
    let seen = small.image("seen", Format::R32_UINT, [6, 1]);
    let pass = dispatch("faces", Groups::Invocations([2, 2, 6])).stores("target", cube, WHOLE);
    small.pass(pass);
    // One face is drawn anew.
    small.pass(draw("number", Draw::FullScreen).draws(cube, layer(4), None));
    let name = "after one face was drawn";
    let mut next = draw("next", Draw::FullScreen).samples("source", cube, layer(3));
    next.name = name.into();
    small.pass(next.draws(cube, layer(5), None));
    small.pass(draw("look_around", Draw::FullScreen).samples("source", cube, WHOLE).draws(seen, WHOLE, None));
    small.image_output(seen);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        let seen = texels(executor, "seen", 0);
        assert_eq!([seen[0], seen[1], seen[2], seen[3], seen[5]], [7, 8, 9, 10, 110]);
        assert!([0, 1, 10, 11].contains(&seen[4]), "a texel of the face that was drawn: {}", seen[4]);
    });
}

#[test]
fn several_cubes_are_found_by_number_and_direction() {
    let mut small = Small::default();
    let cubes = Image { shape: Shape::Cube, layers: 12, ..Image::new("cubes", Format::R32_UINT, 2, 2) };
    let cubes = small.image_like(cubes);
    let seen = small.image("seen", Format::R32_UINT, [6, 2]);
    small.pass(dispatch("faces", Groups::Invocations([2, 2, 12])).stores("target", cubes, WHOLE));
    small.pass(draw("look_at_both", Draw::FullScreen).samples("source", cubes, WHOLE).draws(seen, WHOLE, None));
    small.image_output(seen);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "seen", 0), (7..19).collect::<Vec<_>>());
    });
}
