//! Shaders that no device could take are refused in words.

use super::*;

#[test]
fn arrays_beyond_all_devices_are_refused_before_memory_is_spent_on_them() {
    let own = |declared: &str, body: &str| {
        let text = format!("#version 460\n{declared}\n{WHITE} {body} }}");
        unsupported(&[("test.frag", &text)])
    };
    let index = "[int(gl_FragCoord.x)]";
    for (declared, body) in [
        ("float own[200000000];".to_owned(), format!("own{index} = 1; color.x = own[5];")),
        (String::new(), format!("float own[200000000]; own{index} = 1; color.x = own[5];")),
        ("float own[4];".to_owned(), format!("float far[20000]; far{index} = 1; color.x = far[5] + own{index};")),
        (
            "struct Row { float cells[70000]; }; Row rows[70000];".to_owned(),
            format!("rows{index}.cells{index} = 1; color.x = rows[3].cells[7];"),
        ),
    ] {
        let problem = own(&declared, &body);
        assert!(problem.ends_with("bytes: at most 65536 are allowed"), "{problem}");
    }
    for many in ["many[100000000]", "many[65536][65536]"] {
        let text = format!("#version 460\nlayout(location = 0) out vec4 {many}; void main() {{}}");
        let problem = unsupported(&[("test.frag", &text)]);
        assert!(problem.contains("output `many`: ") && problem.ends_with("locations go up to 255"), "{problem}");
    }
}

#[test]
fn push_constants_and_double_bindings_are_refused() {
    // Nor by the name of the block that tells of images in part, where there are none.
    for block in ["P", "FramewrightParts"] {
        let push =
            format!("#version 460\nlayout(push_constant) uniform {block} {{ float x; }} p; {WHITE} color.x = p.x; }}");
        let said = unsupported(&[("test.frag", &push)]);
        assert!(said.ends_with("push constants: parameters come in the uniform block `params`"), "{said}");
    }
    let double = format!(
        "#version 460
        layout(set = 0, binding = 1) uniform sampler2D a;
        layout(set = 0, binding = 1) uniform sampler2D b;
        {WHITE} }}"
    );
    assert!(unsupported(&[("test.frag", &double)]).ends_with("`a` and `b` at the same place: set 0, binding 1"));
}

#[test]
fn numbers_and_features_beyond_every_devices_are_refused() {
    let what = |fragment: &str| {
        let what = unsupported(&[("test.frag", &format!("#version 460\n{fragment}"))]);
        what.split_once(".frag:").map(|(_, what)| what.to_owned()).unwrap_or(what)
    };
    let far_binding = format!("layout(set = 0, binding = 60000) uniform sampler2D far; {WHITE} }}");
    assert_eq!(what(&far_binding), "2: `far` at binding 60000: bindings go up to 255");
    let far_input = format!("layout(location = 20) in vec4 far; {WHITE} color = far; }}");
    assert_eq!(what(&far_input), "2: `far` at location 20: locations go up to 13");
    // Vertex attributes, by the last location of a matrix or an array.
    let attributes = |declared: &str| {
        let vertex = format!("#version 460\n{declared}\nvoid main() {{ gl_Position = vec4(1.0); }}\n");
        drawn(Draw::Vertices { count: 3, instances: 1 }, &[("test.frag", SHIPPED[1].1), ("test.vert", &vertex)])
    };
    for (far, locations) in [("in float far", 1), ("in vec4 far[2]", 2), ("in mat3 far", 3)] {
        let at = |first: u32| attributes(&format!("layout(location = {first}) {far};"));
        assert!(at(16 - locations).is_ok(), "{far}");
        let Err(ShaderProblem::Unsupported { what }) = at(17 - locations) else { panic!("{far}") };
        assert!(what.ends_with("test.vert:2: `far` at location 16: locations go up to 15"), "{what}");
    }
    // The compiler allows 8 of each.
    let distances = |clip: u32, cull: u32| {
        let (last_clip, last_cull) = (clip - 1, cull - 1);
        format!("{WHITE} color.xy = vec2(gl_ClipDistance[{last_clip}], gl_CullDistance[{last_cull}]); }}")
    };
    assert_eq!(what(&distances(5, 4)), "2: 9 clip and cull distances: at most 8 are allowed");
}

#[test]
fn a_vertex_shader_that_writes_an_image_is_refused() {
    let vertex = |access: &str| {
        format!(
            "#version 460\nlayout(set = 0, binding = 1, rgba8) uniform {access} image2D picture;
            void main() {{ gl_Position = vec4(imageSize(picture), 0.0, 1.0); }}"
        )
    };
    let (written, read) = (vertex(""), vertex("readonly"));
    let plain = ("test.frag", SHIPPED[1].1);
    let said = unsupported(&[plain, ("test.vert", &written)]);
    assert!(said.contains("`picture` is written by a vertex shader"), "{said}");
    assert!(drawn(Draw::FullScreen, &[plain, ("test.vert", &read)]).is_ok());
}
