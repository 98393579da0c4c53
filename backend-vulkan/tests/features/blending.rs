//! Colour attachments that are blended, each in its own way.

use crate::frames::{Small, Uses, draw, everywhere, frame, texels};
use framewright_graph::base::Span;
use framewright_graph::frame::{Blend, DepthTarget, Draw};
use framewright_graph::vulkan::{CompareOp, Format, Subresources};

const WHOLE: Subresources = Subresources::WHOLE;

const SHADERS: &[(&str, &str)] = &[
    ("nothing.frag", "#version 460\nvoid main() {}"),
    (
        "both.frag",
        "#version 460
        layout(location = 0) out vec4 replaced;
        layout(location = 1) out vec4 added;
        void main() { replaced = added = vec4(0.4); }",
    ),
];

#[test]
fn after_a_scope_without_colour_attachments_each_attachment_is_blended_in_its_own_way() {
    let mut small = Small::default();
    let depth = small.image("depth", Format::D32_SFLOAT, [2, 2]);
    let [replaced, added] = ["replaced", "added"].map(|name| small.image(name, Format::R8G8B8A8_UNORM, [1, 1]));
    let target = DepthTarget {
        image: depth,
        range: WHOLE,
        span: Span::NONE,
        clear: Some(1.0),
        test: CompareOp::Less,
        write: true,
        stencil: None,
    };
    let mut pass = draw("nothing", Draw::FullScreen).tests(target);
    pass.side_effect = true;
    small.pass(pass);
    let clear = Some([0.2; 4]);
    let mut pass = draw("both", Draw::FullScreen).draws(replaced, WHOLE, clear).draws(added, WHOLE, clear);
    pass.color[1].blend = Blend::Additive;
    small.pass(pass);
    small.image_output(replaced);
    small.image_output(added);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "replaced", 0), [0x6666_6666]);
        assert_eq!(texels(executor, "added", 0), [0x9999_9999]);
    });
}
