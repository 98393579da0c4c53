//! Encodings of outputs: declared or said by the format, held against the format, and told with the place where they are
//! encoded.

use crate::testing::plans::on;
use crate::testing::raster::{self, Raster};
use framewright_graph::base::{Diagnostic, Span};
use framewright_graph::device::Profile;
use framewright_graph::frame::{Blend, Frame, ImageIndex, Work};
use framewright_graph::plan::{Output, Plan};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Encoding::{self, *};
use framewright_graph::vulkan::Format::{self, *};

/// Draws into `color`, and shows it on `screen`, which leaves the frame so encoded.
fn frame(screen: Format, encoding: Option<Encoding>) -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", R16G16B16A16_SFLOAT, 1);
    let screen = raster.image("screen", screen, 1);
    raster.objects("opaque").clear(color);
    raster.full_screen("show").sample(color).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.outputs[0].encoding = encoding;
    frame
}

fn planned_for(frame: &Frame, device: &Profile) -> Result<Plan, Vec<Diagnostic>> {
    let plan = on(frame, device)?;
    let json = plan.to_json().expect("JSON");
    assert_eq!(Plan::from_json(&json).expect("a Plan"), plan);
    Ok(plan)
}

fn planned(frame: &Frame) -> Plan {
    planned_for(frame, &raster::device()).expect("it compiles")
}

fn said(plan: &Plan) -> (Option<Encoding>, Option<&str>) {
    let Output { encoding, encoded, .. } = &plan.outputs[0];
    (*encoding, encoded.as_deref())
}

#[test]
fn without_a_declaration_the_format_says_what_it_can() {
    for (format, encoding, encoded) in [
        (R8G8B8A8_SRGB, Some(Srgb), Some("by the format, when `show` stores")),
        (R16G16B16A16_SFLOAT, Some(Linear), None),
        (B10G11R11_UFLOAT_PACK32, Some(Linear), None),
        (R8G8B8A8_UNORM, None, None),
        (A2B10G10R10_UNORM_PACK32, None, None),
    ] {
        assert_eq!(said(&planned(&frame(format, None))), (encoding, encoded), "{format}");
    }
}

#[test]
fn a_shader_encodes_what_the_format_does_not() {
    for (format, encoding, encoded) in [
        (R8G8B8A8_SRGB, Srgb, Some("by the format, when `show` stores")),
        (R8G8B8A8_UNORM, Srgb, Some("by shader `show` of pass `show`")),
        (A2B10G10R10_UNORM_PACK32, Hdr10, Some("by shader `show` of pass `show`")),
        (R16G16B16A16_UNORM, Hdr10, Some("by shader `show` of pass `show`")),
        (R8G8B8A8_UNORM, Unorm, None),
        (R32_SFLOAT, Linear, None),
    ] {
        let plan = planned(&frame(format, Some(encoding)));
        assert_eq!(said(&plan), (Some(encoding), encoded), "{format}");
        let tree = plan.tree();
        let shown = match encoding {
            Srgb => format!("; sRGB, encoded {}", encoded.expect("it is")),
            Hdr10 => "; HDR10, encoded by shader `show` of pass `show`".to_owned(),
            Linear => "; linear light, not encoded".to_owned(),
            Unorm => "; shares from 0 to 1, not encoded".to_owned(),
        };
        // Long lines are broken, and go on further in.
        let words =
            |text: &str| text.split([' ', '\n', '│']).filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ");
        assert!(words(&tree).contains(&words(&shown)), "{tree}");
    }
}

#[test]
fn what_is_passed_on_bit_by_bit_was_encoded_where_it_was_stored() {
    let mut raster = Raster::default();
    let [first, screen] = ["first", "screen"].map(|name| raster.image(name, R8G8B8A8_UNORM, 1));
    raster.objects("encode").clear(first);
    raster.full_screen("off").color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.outputs[0].encoding = Some(Srgb);
    frame.passes[1].color.clear();
    frame.passes[1].work = Work::Forward { from: ImageIndex(0), to: ImageIndex(1), because: "it is off".to_owned() };
    assert_eq!(said(&planned(&frame)).1, Some("by shader `encode` of pass `encode`"));
    // Into another format the stand-in stores, and that encodes.
    frame.images[0].format = R16G16B16A16_SFLOAT;
    frame.images[1].format = R8G8B8A8_SRGB;
    assert_eq!(said(&planned(&frame)).1, Some("by the format, when `off` stores"));
}

#[test]
fn an_encoding_that_the_format_cannot_hold_is_refused_with_its_place() {
    let span = Span::new(0, 3, 9);
    for (format, encoding, help) in [
        (R8G8B8A8_SRGB, Linear, "`Linear` takes a floating-point format"),
        (R8G8B8A8_UNORM, Linear, "`Linear` takes a floating-point format"),
        (R16G16B16A16_SFLOAT, Srgb, "`Srgb` takes an _SRGB format, or a UNORM one that a shader encodes into"),
        (R8G8B8A8_SRGB, Unorm, "`Unorm` takes a UNORM format"),
        (R16G16B16A16_SFLOAT, Unorm, "`Unorm` takes a UNORM format"),
        (R8G8B8A8_UNORM, Hdr10, "`Hdr10` takes A2B10G10R10_UNORM_PACK32 or R16G16B16A16_UNORM"),
        (R16G16B16A16_SFLOAT, Hdr10, "`Hdr10` takes A2B10G10R10_UNORM_PACK32 or R16G16B16A16_UNORM"),
        (R8G8B8A8_SRGB, Hdr10, "`Hdr10` takes A2B10G10R10_UNORM_PACK32 or R16G16B16A16_UNORM"),
    ] {
        let mut frame = frame(format, Some(encoding));
        frame.outputs[0].span = span;
        let errors = planned_for(&frame, &raster::device()).expect_err("a contradiction");
        let name = encoding.name();
        assert_eq!(errors.len(), 1, "{errors:?}");
        assert_eq!(errors[0].message, format!("`screen` can't leave the frame as `{name}`: it is {format}"));
        let said = errors[0].help.as_deref().and_then(|said| said.strip_suffix("` of `screen`"));
        let (takes, named) = said.and_then(|said| said.split_once(": say `format: ")).expect("a format of the image");
        assert_eq!(takes, help);
        assert!(Format::ALL.iter().any(|format| format.name() == named && encoding.fits(*format)), "{named}");
        assert_eq!(errors[0].labels[0].span, span);
    }
}

#[test]
fn integers_and_depth_have_no_encoding() {
    for format in Format::ALL.iter().filter(|format| format.is_depth() || format.is_integer()) {
        assert_eq!(Encoding::of(*format), None, "{format}");
        assert!([Srgb, Unorm, Linear, Hdr10].iter().all(|encoding| !encoding.fits(*format)), "{format}");
    }
}

#[test]
fn hdr10_takes_16_bits_where_a_device_has_no_10_and_says_so() {
    let mut device = raster::device();
    device.formats.retain(|support| support.format != A2B10G10R10_UNORM_PACK32);
    let declared = frame(A2B10G10R10_UNORM_PACK32, Some(Hdr10));
    let plan = planned_for(&declared, &device).expect("16 bits hold it");
    let screen = plan.images.iter().find(|image| *image.name == *"screen").expect("it is there");
    assert_eq!((screen.format, plan.outputs[0].encoding), (R16G16B16A16_UNORM, Some(Hdr10)));
    let note = plan.notes.iter().find(|note| *note.subject == *"screen").expect("it is said");
    let wanted = "A2B10G10R10_UNORM_PACK32 was asked for, R16G16B16A16_UNORM is made: `a device for tests` has no ";
    assert!(note.text.starts_with(wanted), "{}", note.text);
    // Of what nothing is declared the program may rely on every bit.
    assert!(planned_for(&frame(A2B10G10R10_UNORM_PACK32, None), &device).is_err());
    // Without 16 bits either it is refused: half floats would keep what HDR10 cuts off.
    device.formats.retain(|support| support.format != R16G16B16A16_UNORM);
    let errors = planned_for(&declared, &device).expect_err("nothing holds it");
    assert!(errors[0].message.starts_with("`screen` can't be A2B10G10R10_UNORM_PACK32"), "{errors:?}");
}

#[test]
fn a_plan_whose_output_cannot_hold_its_encoding_is_wrong() {
    let mut plan = planned(&frame(R8G8B8A8_SRGB, None));
    plan.outputs[0].encoding = Some(Hdr10);
    let found = verify(&plan);
    assert!(found.len() == 1 && found[0].to_string().contains("Hdr10"), "{found:?}");
}
