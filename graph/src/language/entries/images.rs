//! `images`: format, size, samples, mip levels, layers, shape and lifetime, most its own or another image's.

use super::repeat::REPEAT;
use super::values::{optional, typed, whole_number};
use super::{lifetimes, parameters, parts, resolves, sizes, views};
use crate::base::{Code, Diagnostic, Span};
use crate::expression::WantedTypes;
use crate::frame::{SAMPLE_COUNTS, ViewIndex};
use crate::language::model::{
    Decided, Decisions, Format, Image, ImageShape, LARGEST_SIZE, Layers, Lifetime, Mips, Samples, SettingKind,
};
use crate::language::scope::{Context, FieldContents, FieldValue, Parameter, combined, within_view};
use crate::ron::{FieldTable, Form, Leaf, Name, PlainForm, Shape, Spanned, Word, WordContents, Words};
use crate::vulkan::access::StateSubject;
use crate::{fields, vulkan};
use std::sync::Arc;

/// Most array layers that a file may ask for: as many as desktop devices have.
pub(crate) const MOST_LAYERS: i64 = 2048;

/// Mip levels that an image of the largest size has.
const MOST_MIPS: i64 = 15;

fields! {
    /// An image: texels that passes draw into, write and read.
    /// ```ron
    /// (name: "sky_light", format: R16G16B16A16_SFLOAT, size: Fixed(128, 128), mips: Full, shape: Cube, lifetime: Persistent)
    /// ```
    pub(crate) struct ImageFields<'src> as "Image" {
        /// Its name, unique among images and buffers.
        name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// The view that it is for; the first if left out.
        pub(crate) view: Option<Leaf<'src>> => views::NAME,
        /// The name of an index, and how often the entry is repeated.
        pub(crate) repeat: Option<Leaf<'src>> => REPEAT,
        /// The format of a texel.
        format: Leaf<'src> => Form::Words(&FORMATS),
        /// Width and height.
        size: Leaf<'src> => sizes::SIZE,
        /// The number of samples of each texel; 1 if left out.
        samples: Option<Leaf<'src>> => Form::Words(&SAMPLES),
        /// The way in which several samples become one value where one is wanted. If left out, colour is averaged, and depth
        /// follows the pipeline's `depth`. The target of a forward keeps its own way.
        resolve: Option<Leaf<'src>> => resolves::RESOLVE,
        /// Mip levels; 1 if left out.
        mips: Option<Leaf<'src>> => Form::Words(&MIPS),
        /// Array layers; 1 if left out, of a cube 6.
        layers: Option<Leaf<'src>> => Form::Words(&LAYERS),
        /// Flat, deep or a cube; `D2` if left out.
        shape: Option<Leaf<'src>> => Form::Words(&SHAPES),
        /// How long its contents live; `Transient` if left out.
        lifetime: Option<Leaf<'src>> => lifetimes::LIFETIME,
        /// Whether each eye has an image of its own where a frame is drawn for two eyes. If left out, as for the image whose
        /// size it follows; false if it follows none.
        per_eye: Option<Leaf<'src>> => Form::Truth,
    }
}

fields! {
    /// A colour format.
    struct ColorFormatFields<'src> {
        /// Whether values above 1 are kept; not if left out.
        hdr: Option<Leaf<'src>> => Form::Truth,
        /// Whether alpha is kept; it is if left out. If not, `color: Smallest` with high dynamic range chooses a format without
        /// alpha, and shaders read 1 in its place.
        alpha: Option<Leaf<'src>> => Form::Truth,
    }
}

static FORMATS: Words = Words {
    name: "Format",
    what: "a format",
    or: &[parameters::FORMAT, Form::Expression("a format")],
    all: &[
        Word::new(
            "Color",
            &[WordContents::Nothing, WordContents::Fields(ColorFormatFields::<'static>::table)],
            &["Color(hdr: true)"],
            "Colour: `R16G16B16A16_SFLOAT` with high dynamic range, else `R8G8B8A8_SRGB`, unless the pipeline's `color` says otherwise.",
        ),
        Word::alone("Depth", "Depth: `D32_SFLOAT`, unless the pipeline's `depth_format` says otherwise."),
        Word::alone(
            "DepthStencil",
            "Depth and stencil: `D32_SFLOAT_S8_UINT`, unless the pipeline's `depth_format` says otherwise.",
        ),
        Word::alone("Output", "The format of a picture that leaves the frame: `R8G8B8A8_SRGB`."),
        Word::new(
            "Like",
            &[WordContents::Values(&[parts::WHOLE_IMAGE])],
            &["Like(\"image\")"],
            "The format of another image.",
        ),
    ],
};

static SAMPLES: Words = Words {
    name: "Samples",
    what: "a sample count",
    or: &[Form::Listed(&SAMPLE_COUNTS), Form::Expression("a whole number")],
    all: &[Word::new(
        "Like",
        &[WordContents::Values(&[parts::WHOLE_IMAGE])],
        &["Like(\"image\")"],
        "As many as another image has.",
    )],
};

static MIPS: Words = Words {
    name: "Mips",
    what: "a number of mip levels",
    or: &[Form::Whole(1, MOST_MIPS)],
    all: &[
        Word::alone("Full", "Down to a single texel."),
        Word::new(
            "Like",
            &[WordContents::Values(&[parts::WHOLE_IMAGE])],
            &["Like(\"image\")"],
            "As many as another image has.",
        ),
    ],
};

static LAYERS: Words = Words {
    name: "Layers",
    what: "a number of layers",
    or: &[Form::Whole(1, MOST_LAYERS)],
    all: &[Word::new(
        "Like",
        &[WordContents::Values(&[parts::WHOLE_IMAGE])],
        &["Like(\"image\")"],
        "As many as another image has.",
    )],
};

static SHAPES: Words = Words {
    name: "Shape",
    what: "a shape",
    or: &[],
    all: &[
        Word::alone("D2", "Two-dimensional, or an array of such layers."),
        Word::new(
            "D3",
            &[WordContents::Values(&[sizes::EXTENT])],
            &["D3(64)"],
            "Three-dimensional, this many texels deep.",
        ),
        Word::alone("Cube", "Six square layers that may be sampled as a cube, or several times six."),
    ],
};

impl Context<'_> {
    /// An image.
    pub(crate) fn image_entry(&mut self, fields: &ImageFields<'_>) -> Option<FieldValue<Arc<Image>>> {
        let name = self.reader.name(fields.name, "an image");
        let span = name.as_ref().map_or(Span::NONE, |name| name.span);
        let format = self.image_format(fields.format);
        let size = self.size(fields.size);
        let samples = or(fields.samples, span, Samples::Count(1), |leaf| self.samples(leaf, name.as_ref()));
        let resolve = optional(fields.resolve, |leaf| self.resolve(leaf));
        let mips = or(fields.mips, span, Mips::Count(1), |leaf| self.mips(leaf));
        let layers = or(fields.layers, span, Layers::Default, |leaf| self.layers(leaf));
        let shape = or(fields.shape, span, ImageShape::D2, |leaf| self.shape(leaf));
        let transient = FieldValue::Constant(Spanned { value: Lifetime::Transient, span });
        let lifetime = fields.lifetime.map_or(Some(transient), |leaf| self.lifetime(leaf, StateSubject::Image));
        let per_eye = optional(fields.per_eye, |leaf| self.truth(leaf).map(FieldValue::spanned));
        let (format, size) = (in_field(fields.format, format?), in_field(fields.size, size?));
        let (name, how_many) = (name?, (samples?, mips?, layers?));
        let parts = ((format, size, shape?), how_many, resolve?, lifetime?, per_eye?);
        Some(combined(parts, move |((format, size, shape), (samples, mips, layers), resolve, lifetime, per_eye)| {
            Arc::new(Image {
                name: name.clone(),
                format,
                size,
                samples,
                resolve,
                mips,
                layers,
                shape,
                lifetime,
                repeat: Decisions::default(),
                eyes: None,
                per_eye,
                view: ViewIndex::default(),
                instance: None,
            })
        }))
    }

    fn image_format(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<Format>>> {
        if let Shape::Text = leaf.shape() {
            if let Some(word @ ("Depth" | "DepthStencil" | "Output")) = leaf.plain() {
                self.reader.wrong(
                    Code::UNKNOWN_WORD,
                    leaf,
                    format!("`{word}` is no format of Vulkan's"),
                    "it stands without quotes",
                );
                return None;
            }
            return Some(self.format(leaf)?.of(Format::Named));
        }
        let (word, rest) = match leaf.shape() {
            Shape::Word(word, rest) if vulkan::Format::from_name(word).is_some() => (word, rest),
            _ => self.reader.one_of(leaf, &FORMATS)?,
        };
        match word {
            "Color" => {
                let fields = match rest {
                    Some(_) => Some(self.reader.inside::<ColorFormatFields<'_>>(leaf, rest, "Color(hdr: …)")?),
                    None => None,
                };
                let mut truth = |field: Option<Leaf<'_>>, absent: bool| match field {
                    Some(field) => self.truth(field),
                    None => Some(FieldValue::said(leaf, absent)),
                };
                let (hdr, alpha) = fields.map_or((None, None), |fields| (fields.hdr, fields.alpha));
                let (hdr, alpha) = (truth(hdr, false), truth(alpha, true));
                Some(combined((hdr?, alpha?), |(hdr, alpha)| hdr.and(alpha, |hdr, alpha| Format::Color { hdr, alpha })))
            }
            "Like" => self.like(leaf, rest, Format::Like),
            name => {
                self.reader.bare(word, rest)?;
                let format = match name {
                    "Depth" => Format::Depth,
                    "DepthStencil" => Format::DepthStencil,
                    "Output" => Format::Output,
                    name => Format::Named(vulkan::Format::from_name(name)?),
                };
                Some(FieldValue::said(leaf, format))
            }
        }
    }

    fn samples(&mut self, leaf: Leaf<'_>, image: Option<&Name>) -> Option<FieldValue<Decided<Samples>>> {
        let known = |count: i64| u32::try_from(count).ok().filter(|count| SAMPLE_COUNTS.contains(count));
        let count = match leaf.shape() {
            Shape::Text => {
                let words = ("a whole number", Some("a whole number"));
                let (count, setting) = self.value(leaf, SettingKind::is_whole, WantedTypes::INTEGER, words)?;
                let odd = |setting: &Parameter| setting.one_of().iter().copied().find(|count| known(*count).is_none());
                if let Some(odd) = setting.and_then(odd) {
                    let message = format!("this setting allows {odd}, which is no sample count");
                    self.reader.wrong(Code::SETTING_TOO_WIDE, leaf, message, &SAMPLES.forms());
                    return None;
                }
                typed(count, whole_number)?
            }
            Shape::Number => {
                let count = self.reader.integer(leaf)?;
                if known(count).is_none() {
                    self.reader.wrong(
                        Code::SAMPLE_COUNT,
                        leaf,
                        format!("{count} is no sample count"),
                        &SAMPLES.forms(),
                    );
                    return None;
                }
                FieldValue::said(leaf, count)
            }
            _ => {
                let (_, rest) = self.reader.one_of(leaf, &SAMPLES)?;
                return self.like(leaf, rest, Samples::Like);
            }
        };
        let name = image.map_or_else(|| "".into(), |name| name.text.clone());
        count.checked(self.reader, move |count, view| {
            if let Some(known) = known(count.value) {
                return Ok(count.map(|_| Samples::Count(known)));
            }
            let why = count.because.as_ref().map(|because| format!(" ({})", within_view(view, because)));
            let message = format!("image `{name}` can't have {} samples{}", count.value, why.unwrap_or_default());
            let allowed = SAMPLE_COUNTS.map(|count| count.to_string()).join(", ");
            Err(Diagnostic::new(Code::SAMPLE_COUNT, count.span, message).help(format!("sample counts are {allowed}")))
        })
    }

    fn mips(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<Mips>>> {
        if let Shape::Text | Shape::Number = leaf.shape() {
            return Some(self.whole_because(leaf, "number of mip levels", 1..=MOST_MIPS)?.of(Mips::Count));
        }
        let (word, rest) = self.reader.one_of(leaf, &MIPS)?;
        match word {
            "Full" => self.reader.bare(word, rest).map(|()| FieldValue::said(leaf, Mips::Full)),
            _ => self.like(leaf, rest, Mips::Like),
        }
    }

    fn layers(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<Layers>>> {
        if let Shape::Text | Shape::Number = leaf.shape() {
            return Some(self.whole_because(leaf, "number of layers", 1..=MOST_LAYERS)?.of(Layers::Count));
        }
        let (_, rest) = self.reader.one_of(leaf, &LAYERS)?;
        self.like(leaf, rest, Layers::Like)
    }

    fn shape(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<ImageShape>>> {
        let (word, rest) = self.reader.one_of(leaf, &SHAPES)?;
        match word {
            "D2" => self.reader.bare(word, rest).map(|()| FieldValue::said(leaf, ImageShape::D2)),
            "Cube" => self.reader.bare(word, rest).map(|()| FieldValue::said(leaf, ImageShape::Cube)),
            _ => {
                let [depth]: [Leaf<'_>; 1] = self.reader.inside(leaf, rest, "D3(64)")?;
                Some(self.whole_because(depth, "depth", 1..=i64::from(LARGEST_SIZE))?.of(ImageShape::D3))
            }
        }
    }
}

/// The value of a field of an image that may be absent; its place is then the image's name.
fn or<'src, T: FieldContents>(
    leaf: Option<Leaf<'src>>,
    name: Span,
    absent: T,
    read: impl FnOnce(Leaf<'src>) -> Option<FieldValue<Decided<T>>>,
) -> Option<FieldValue<Decided<T>>> {
    match leaf {
        Some(leaf) => Some(in_field(leaf, read(leaf)?)),
        None => Some(FieldValue::Constant(Decided::said(name, absent))),
    }
}

/// The value of a field of an image, as it is told outside of its entry.
fn in_field<T: FieldContents>(leaf: Leaf<'_>, value: FieldValue<Decided<T>>) -> FieldValue<Decided<T>> {
    value.at(leaf).within_view()
}
