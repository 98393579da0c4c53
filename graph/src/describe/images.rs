//! `images`: format, size, samples, mip levels, layers, shape and lifetime, most its own or another image's.

use super::leaf::{Leaf, Shape};
use super::pipeline::{ImageRef, Name, SettingKind};
use super::reader::Reader;
use super::resources::{Format, Image, Layers, Lifetime, Mips, Samples, Shape as ImageShape, Size};
use super::scope::{Quoted, Scope, joined};
use super::values::Decided;
use super::{Diagnostic, Spanned, lifetimes, values};
use crate::expression::{Value, Wanted};
use crate::fields;
use crate::format;
use crate::view::ViewIndex;
use std::sync::Arc;

/// Largest width and height that a file may ask for.
pub(crate) const LARGEST_SIZE: u32 = 16384;

/// Most array layers that a file may ask for: what desktop devices have.
pub(crate) const MOST_LAYERS: i64 = 2048;

/// Mip levels that an image of the largest size has.
const MOST_MIPS: i64 = 15;

/// Sample counts that a file may ask for.
pub(crate) const SAMPLE_COUNTS: [i64; 5] = [1, 2, 4, 8, 16];

fields! {
    pub(super) struct ImageFields<'src> as "Image" {
        name: Leaf<'src>,
        pub(super) view: Option<Leaf<'src>>,
        pub(super) repeat: Option<Leaf<'src>>,
        format: Leaf<'src>,
        size: Leaf<'src>,
        samples: Option<Leaf<'src>>,
        mips: Option<Leaf<'src>>,
        layers: Option<Leaf<'src>>,
        shape: Option<Leaf<'src>>,
        lifetime: Option<Leaf<'src>>,
    }
}

fields! {
    struct ColorFields<'src> {
        hdr: Option<Leaf<'src>>,
    }
}

const FORMATS: &str = "a format is `Color(hdr: …)`, `Depth`, `DepthStencil`, `Output`, `Like(\"image\")` or one of Vulkan's, such as `R16G16B16A16_SFLOAT`";
const SIZES: &str =
    "a size is `Output`, `Scaled(0.5)`, `Scaled(0.5, \"image\")`, `Fixed(640, 480)` or `Like(\"image\")`";
const COUNTS: &str = "sample counts are 1, 2, 4, 8, 16, an expression in quotes, or `Like(\"image\")`";

/// An image, once its fields are told apart.
pub(super) fn lower<'src>(reader: &mut Reader, scope: &Scope<'_>, fields: &ImageFields<'src>) -> Option<Image> {
    let name = reader.name(fields.name, "an image");
    let format = format(reader, scope, fields.format);
    let size = size(reader, scope, fields.size);
    let samples = match fields.samples {
        Some(leaf) => samples(reader, scope, leaf, &name).map(|(samples, because)| (leaf.spanned(samples), because)),
        None => name.as_ref().map(|name| (Spanned { value: Samples::Count(1), span: name.span }, None)),
    };
    let mips = or(reader, fields.mips, &name, Mips::Count(1), |reader, leaf| mips(reader, scope, leaf));
    let layers = or(reader, fields.layers, &name, Layers::Default, |reader, leaf| layers(reader, scope, leaf));
    let shape = or(reader, fields.shape, &name, ImageShape::D2, |reader, leaf| shape(reader, scope, leaf));
    let lifetime = match fields.lifetime {
        Some(leaf) => lifetimes::lower(reader, scope, leaf, lifetimes::Of::Image),
        None => name.as_ref().map(|name| Spanned { value: Lifetime::Transient, span: name.span }),
    };
    let ((size, size_because), (samples, samples_because)) = (size?, samples?);
    Some(Image {
        name: name?,
        format: fields.format.spanned(format?),
        size: fields.size.spanned(size),
        size_because,
        samples,
        samples_because,
        mips: mips?,
        layers: layers?,
        shape: shape?,
        lifetime: lifetime?,
        view: ViewIndex::default(),
        instance: None,
    })
}

/// The value of a field that may be absent; its place is then the image's name.
fn or<'src, T>(
    reader: &mut Reader,
    leaf: Option<Leaf<'src>>,
    name: &Option<Name>,
    absent: T,
    lower: impl FnOnce(&mut Reader, Leaf<'src>) -> Option<T>,
) -> Option<Spanned<T>> {
    match leaf {
        Some(leaf) => lower(reader, leaf).map(|value| leaf.spanned(value)),
        None => name.as_ref().map(|name| Spanned { value: absent, span: name.span }),
    }
}

/// `("image")`, what stands behind `Like`.
fn like<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>, rest: Option<Leaf<'src>>) -> Option<ImageRef> {
    let [image]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Like(\"image\")")?;
    scope.image(reader, image)
}

fn format<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Format> {
    let known: Vec<&str> = ["Color", "Depth", "DepthStencil", "Output", "Like"]
        .into_iter()
        .chain(format::Format::ALL.iter().map(|f| f.name()))
        .collect();
    if let Shape::Text = leaf.shape() {
        if let Some(word @ ("Depth" | "DepthStencil" | "Output")) = leaf.plain() {
            reader.wrong(leaf, format!("`{word}` is no format of Vulkan's"), "it stands without quotes");
            return None;
        }
        return values::format(reader, scope, leaf).map(Format::Named);
    }
    let (word, rest) = reader.word(leaf, "a format", &known, FORMATS)?;
    match word {
        "Color" => {
            let hdr = match rest {
                Some(_) => reader.inside::<ColorFields<'_>>(leaf, rest, "Color(hdr: …)")?.hdr,
                None => None,
            };
            match hdr {
                Some(hdr) => values::truth(reader, scope, hdr).map(|hdr| Format::Color { hdr }),
                None => Some(Format::Color { hdr: false }),
            }
        }
        "Depth" => reader.bare(word, rest).map(|()| Format::Depth),
        "DepthStencil" => reader.bare(word, rest).map(|()| Format::DepthStencil),
        "Output" => reader.bare(word, rest).map(|()| Format::Output),
        "Like" => like(reader, scope, leaf, rest).map(Format::Like),
        vulkan => {
            reader.bare(word, rest)?;
            format::Format::from_name(vulkan).map(Format::Named)
        }
    }
}

fn size<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Decided<Size>> {
    let (word, rest) = reader.word(leaf, "a size", &["Output", "Scaled", "Fixed", "Like"], SIZES)?;
    match word {
        "Output" => reader.bare(word, rest).map(|()| (Size::Output, None)),
        "Like" => like(reader, scope, leaf, rest).map(|of| (Size::Like(of), None)),
        "Fixed" => {
            let [width, height]: [Leaf<'_>; 2] = reader.inside(leaf, rest, "Fixed(width, height)")?;
            let (width, height) = (extent(reader, scope, width), extent(reader, scope, height));
            Some((Size::Fixed([width?, height?]), None))
        }
        _ => {
            let both = rest.and_then(Leaf::tuple);
            let (by, of) = match both {
                Some([by, of]) => (by, Some(scope.image(reader, of))),
                None => {
                    let [by]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Scaled(0.5)` or `Scaled(0.5, \"image\")")?;
                    (by, None)
                }
            };
            let (by, because) = scale(reader, scope, by)?;
            match of {
                Some(of) => Some((Size::Scaled { by, of: Some(of?) }, because)),
                None => Some((Size::Scaled { by, of: None }, because)),
            }
        }
    }
}

pub(super) fn extent<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<u32> {
    if let Shape::Text = leaf.shape() {
        return values::whole(reader, scope, leaf, "size", 1..=i64::from(LARGEST_SIZE));
    }
    let extent = reader.integer(leaf)?;
    match u32::try_from(extent) {
        Ok(extent @ 1..=LARGEST_SIZE) => Some(extent),
        _ => {
            reader.wrong(leaf, format!("{extent} is no size: 1 to {LARGEST_SIZE} texels are allowed"), "");
            None
        }
    }
}

pub(super) fn scale<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Decided<f64>> {
    if let Shape::Text = leaf.shape()
        && scope.known.settings
        && let Quoted::Given(parameter, _) = scope.quoted(reader, leaf, SettingKind::is_number, "a number")?
        && let Some(least) = parameter.least().filter(|least| *least <= 0.0)
    {
        let message = format!("a scale is greater than 0, but this setting allows {}", super::shown_number(least));
        reader.wrong(leaf, message, "let the setting begin above 0");
        return None;
    }
    let (by, because) = values::number_because(reader, scope, leaf)?;
    if by <= 0.0 {
        let wrong = format!("a scale is greater than 0, found {}", super::shown_number(by));
        let wrong = Diagnostic::new(leaf.span(), wrong).remark(because.as_deref().unwrap_or_default());
        scope.fault(reader, leaf, wrong);
        return None;
    }
    Some((by, because))
}

fn samples<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    image: &Option<Name>,
) -> Option<Decided<Samples>> {
    let (count, because): Decided<i64> = match leaf.shape() {
        Shape::Text => match scope.quoted(reader, leaf, SettingKind::is_whole, "a whole number")? {
            Quoted::Given(parameter, given) => {
                if scope.known.settings
                    && let Some(odd) = parameter.one_of().iter().find(|count| !SAMPLE_COUNTS.contains(count))
                {
                    reader.wrong(leaf, format!("this setting allows {odd}, which is no sample count"), COUNTS);
                    return None;
                }
                let Value::Integer(count) = given.value else { return None };
                (count, scope.because(parameter, given))
            }
            Quoted::Expression => {
                let outcome = scope.evaluate(reader, leaf, Wanted::INTEGER)?;
                let Value::Integer(count) = outcome.value else { return None };
                (count, joined(&outcome.decided))
            }
        },
        Shape::Number => {
            let count = reader.integer(leaf)?;
            if !SAMPLE_COUNTS.contains(&count) {
                reader.wrong(leaf, format!("{count} is no sample count"), COUNTS);
                return None;
            }
            (count, None)
        }
        _ => {
            let (_, rest) = reader.word(leaf, "a sample count", &["Like"], COUNTS)?;
            return like(reader, scope, leaf, rest).map(|of| (Samples::Like(of), None));
        }
    };
    if !SAMPLE_COUNTS.contains(&count) {
        let why = because.map(|because: Arc<str>| format!(" ({because})")).unwrap_or_default();
        let name = image.as_ref().map_or("", |name| &*name.text);
        let wrong = Diagnostic::new(leaf.span(), format!("image `{name}` can't have {count} samples{why}"));
        let allowed = SAMPLE_COUNTS.map(|count| count.to_string()).join(", ");
        scope.fault(reader, leaf, wrong.help(format!("sample counts are {allowed}")));
        return None;
    }
    u32::try_from(count).ok().map(|count| (Samples::Count(count), because))
}

fn mips<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Mips> {
    let forms = "mip levels are a number, an expression in quotes, `Full` or `Like(\"image\")`";
    if let Shape::Text | Shape::Number = leaf.shape() {
        return values::whole(reader, scope, leaf, "number of mip levels", 1..=MOST_MIPS).map(Mips::Count);
    }
    let (word, rest) = reader.word(leaf, "a number of mip levels", &["Full", "Like"], forms)?;
    match word {
        "Full" => reader.bare(word, rest).map(|()| Mips::Full),
        _ => like(reader, scope, leaf, rest).map(Mips::Like),
    }
}

fn layers<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Layers> {
    let forms = "layers are a number, an expression in quotes or `Like(\"image\")`";
    if let Shape::Text | Shape::Number = leaf.shape() {
        return values::whole(reader, scope, leaf, "number of layers", 1..=MOST_LAYERS).map(Layers::Count);
    }
    let (_, rest) = reader.word(leaf, "a number of layers", &["Like"], forms)?;
    like(reader, scope, leaf, rest).map(Layers::Like)
}

fn shape<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<ImageShape> {
    let forms = "a shape is `D2`, `D3(depth)` or `Cube`";
    let (word, rest) = reader.word(leaf, "a shape", &["D2", "D3", "Cube"], forms)?;
    match word {
        "D2" => reader.bare(word, rest).map(|()| ImageShape::D2),
        "Cube" => reader.bare(word, rest).map(|()| ImageShape::Cube),
        _ => {
            let [depth]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "D3(64)")?;
            values::whole(reader, scope, depth, "depth", 1..=i64::from(LARGEST_SIZE)).map(ImageShape::D3)
        }
    }
}
