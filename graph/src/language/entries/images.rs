//! `images`: format, size, samples, mip levels, layers, shape and lifetime, most its own or another image's.

use super::repeat::REPEAT;
use super::values::{Decided, optional};
use super::{lifetimes, parameters, parts, resolves, sizes, views};
use crate::base::Diagnostic;
use crate::expression::{Value, Wanted};
use crate::frame::ViewIndex;
use crate::language::model::{Format, Image, ImageShape, LARGEST_SIZE, Layers, Lifetime, Mips, Samples, SettingKind};
use crate::language::scope::{Context, Evaluated, Parameter};
use crate::ron::{Described, Form, Leaf, Name, Plain, Shape, Spanned, Takes, Word, Words};
use crate::{fields, vulkan};
use std::sync::Arc;

/// Most array layers that a file may ask for: what desktop devices have.
pub(crate) const MOST_LAYERS: i64 = 2048;

/// Mip levels that an image of the largest size has.
const MOST_MIPS: i64 = 15;

/// Sample counts that a file may ask for.
pub(crate) const SAMPLE_COUNTS: [i64; 5] = [1, 2, 4, 8, 16];

fields! {
    /// An image: texels that passes draw into, write and read.
    /// ```ron
    /// (name: "sky_light", format: R16G16B16A16_SFLOAT, size: Fixed(128, 128), mips: Full, shape: Cube, lifetime: Persistent)
    /// ```
    pub(crate) struct ImageFields<'src> as "Image" {
        /// Its name, unique among images and buffers.
        name: Leaf<'src> => Form::Plain(Plain::Name),
        /// The view that it is for; the first if left out.
        pub(crate) view: Option<Leaf<'src>> => views::NAME,
        /// How often it stands there.
        pub(crate) repeat: Option<Leaf<'src>> => REPEAT,
        /// What a texel holds.
        format: Leaf<'src> => Form::Words(&FORMATS),
        /// Width and height.
        size: Leaf<'src> => sizes::SIZE,
        /// Samples a texel; 1 if left out.
        samples: Option<Leaf<'src>> => Form::Words(&SAMPLES),
        /// How several samples become one value where one is wanted; if left out colour is averaged, and depth is as the
        /// pipeline's `depth` says. An image that another is forwarded to has its own.
        resolve: Option<Leaf<'src>> => resolves::RESOLVE,
        /// Mip levels; 1 if left out.
        mips: Option<Leaf<'src>> => Form::Words(&MIPS),
        /// Array layers; 1 if left out, of a cube 6.
        layers: Option<Leaf<'src>> => Form::Words(&LAYERS),
        /// Flat, deep or a cube; `D2` if left out.
        shape: Option<Leaf<'src>> => Form::Words(&SHAPES),
        /// How long its contents live; `Transient` if left out.
        lifetime: Option<Leaf<'src>> => lifetimes::LIFETIME,
        /// Whether each eye has one of its own where a frame is drawn for two; if left out as the image whose size it follows,
        /// and not if it follows none.
        per_eye: Option<Leaf<'src>> => Form::Truth,
    }
}

fields! {
    /// A colour format.
    struct ColorFormatFields<'src> {
        /// Whether values above 1 are kept; not if left out.
        hdr: Option<Leaf<'src>> => Form::Truth,
    }
}

static FORMATS: Words = Words {
    name: "Format",
    what: "a format",
    or: &[parameters::FORMAT, Form::Expression("a format")],
    all: &[
        Word::new(
            "Color",
            &[Takes::Nothing, Takes::Fields(ColorFormatFields::<'static>::table)],
            &["Color(hdr: true)"],
            "Colour: `R16G16B16A16_SFLOAT` with high dynamic range, else `R8G8B8A8_SRGB`, unless the pipeline's `color` says otherwise.",
        ),
        Word::alone("Depth", "Depth: `D32_SFLOAT`, unless the pipeline's `depth_format` says otherwise."),
        Word::alone(
            "DepthStencil",
            "Depth and stencil: `D32_SFLOAT_S8_UINT`, unless the pipeline's `depth_format` says otherwise.",
        ),
        Word::alone("Output", "What leaves the frame: `R8G8B8A8_SRGB`."),
        Word::new("Like", &[Takes::Values(&[parts::WHOLE_IMAGE])], &["Like(\"image\")"], "That of another image."),
    ],
};

static SAMPLES: Words = Words {
    name: "Samples",
    what: "a sample count",
    or: &[Form::Listed(&SAMPLE_COUNTS), Form::Expression("a whole number")],
    all: &[Word::new(
        "Like",
        &[Takes::Values(&[parts::WHOLE_IMAGE])],
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
            &[Takes::Values(&[parts::WHOLE_IMAGE])],
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
        &[Takes::Values(&[parts::WHOLE_IMAGE])],
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
        Word::new("D3", &[Takes::Values(&[sizes::EXTENT])], &["D3(64)"], "Three-dimensional, so many texels deep."),
        Word::alone("Cube", "Six square layers that may be sampled as a cube, or several times six."),
    ],
};

impl Context<'_, '_> {
    /// An image.
    pub(crate) fn image_entry(&mut self, fields: &ImageFields<'_>) -> Option<Image> {
        let name = self.reader.name(fields.name, "an image");
        let format = self.image_format(fields.format);
        let size = self.size(fields.size);
        let samples = match fields.samples {
            Some(leaf) => self.samples(leaf, &name).map(|(samples, because)| (leaf.spanned(samples), because)),
            None => name.as_ref().map(|name| (Spanned { value: Samples::Count(1), span: name.span }, None)),
        };
        let resolve = optional(fields.resolve, |leaf| self.resolve(leaf));
        let mips = self.or(fields.mips, &name, Mips::Count(1), Self::mips);
        let layers = self.or(fields.layers, &name, Layers::Default, Self::layers);
        let shape = self.or(fields.shape, &name, ImageShape::D2, Self::shape);
        let lifetime = match fields.lifetime {
            Some(leaf) => self.lifetime(leaf, lifetimes::Of::Image),
            None => name.as_ref().map(|name| Spanned { value: Lifetime::Transient, span: name.span }),
        };
        let per_eye = optional(fields.per_eye, |leaf| self.truth(leaf).map(|own| leaf.spanned(own)));
        let ((size, size_because), (samples, samples_because)) = (size?, samples?);
        let within = |because: Option<Arc<str>>| because.map(|because| self.scope.within_view(&because).into());
        Some(Image {
            name: name?,
            format: fields.format.spanned(format?),
            size: fields.size.spanned(size),
            size_because: within(size_because),
            samples,
            samples_because: within(samples_because),
            resolve: resolve?,
            mips: mips?,
            layers: layers?,
            shape: shape?,
            lifetime: lifetime?,
            eyes: None,
            per_eye: per_eye?,
            view: ViewIndex::default(),
            instance: None,
        })
    }

    /// The value of a field that may be absent; its place is then the image's name.
    fn or<'src, T>(
        &mut self,
        leaf: Option<Leaf<'src>>,
        name: &Option<Name>,
        absent: T,
        read: impl FnOnce(&mut Self, Leaf<'src>) -> Option<T>,
    ) -> Option<Spanned<T>> {
        match leaf {
            Some(leaf) => read(self, leaf).map(|value| leaf.spanned(value)),
            None => name.as_ref().map(|name| Spanned { value: absent, span: name.span }),
        }
    }

    fn image_format(&mut self, leaf: Leaf<'_>) -> Option<Format> {
        if let Shape::Text = leaf.shape() {
            if let Some(word @ ("Depth" | "DepthStencil" | "Output")) = leaf.plain() {
                self.reader.wrong(leaf, format!("`{word}` is no format of Vulkan's"), "it stands without quotes");
                return None;
            }
            return self.format(leaf).map(Format::Named);
        }
        let (word, rest) = match leaf.shape() {
            Shape::Word(word, rest) if vulkan::Format::from_name(word).is_some() => (word, rest),
            _ => self.reader.one_of(leaf, &FORMATS)?,
        };
        match word {
            "Color" => {
                let hdr = match rest {
                    Some(_) => self.reader.inside::<ColorFormatFields<'_>>(leaf, rest, "Color(hdr: …)")?.hdr,
                    None => None,
                };
                match hdr {
                    Some(hdr) => self.truth(hdr).map(|hdr| Format::Color { hdr }),
                    None => Some(Format::Color { hdr: false }),
                }
            }
            "Depth" => self.reader.bare(word, rest).map(|()| Format::Depth),
            "DepthStencil" => self.reader.bare(word, rest).map(|()| Format::DepthStencil),
            "Output" => self.reader.bare(word, rest).map(|()| Format::Output),
            "Like" => self.like(leaf, rest).map(Format::Like),
            name => {
                self.reader.bare(word, rest)?;
                vulkan::Format::from_name(name).map(Format::Named)
            }
        }
    }

    fn samples(&mut self, leaf: Leaf<'_>, image: &Option<Name>) -> Option<Decided<Samples>> {
        let (count, because): Decided<i64> = match leaf.shape() {
            Shape::Text => {
                let words = ("a whole number", Some("a whole number"));
                let Evaluated { value, because, setting } =
                    self.value(leaf, SettingKind::is_whole, Wanted::INTEGER, words)?;
                let odd =
                    |setting: &Parameter| setting.one_of().iter().copied().find(|count| !SAMPLE_COUNTS.contains(count));
                if let Some(odd) = setting.and_then(odd) {
                    let message = format!("this setting allows {odd}, which is no sample count");
                    self.reader.wrong(leaf, message, &SAMPLES.forms());
                    return None;
                }
                let Value::Integer(count) = value else { return None };
                (count, because)
            }
            Shape::Number => {
                let count = self.reader.integer(leaf)?;
                if !SAMPLE_COUNTS.contains(&count) {
                    self.reader.wrong(leaf, format!("{count} is no sample count"), &SAMPLES.forms());
                    return None;
                }
                (count, None)
            }
            _ => {
                let (_, rest) = self.reader.one_of(leaf, &SAMPLES)?;
                return self.like(leaf, rest).map(|of| (Samples::Like(of), None));
            }
        };
        if !SAMPLE_COUNTS.contains(&count) {
            let why =
                because.map(|because: Arc<str>| format!(" ({})", self.scope.within_view(&because))).unwrap_or_default();
            let name = image.as_ref().map_or("", |name| &*name.text);
            let wrong = Diagnostic::new(leaf.span(), format!("image `{name}` can't have {count} samples{why}"));
            let allowed = SAMPLE_COUNTS.map(|count| count.to_string()).join(", ");
            self.fault(leaf, wrong.help(format!("sample counts are {allowed}")));
            return None;
        }
        u32::try_from(count).ok().map(|count| (Samples::Count(count), because))
    }

    fn mips(&mut self, leaf: Leaf<'_>) -> Option<Mips> {
        if let Shape::Text | Shape::Number = leaf.shape() {
            return self.whole(leaf, "number of mip levels", 1..=MOST_MIPS).map(Mips::Count);
        }
        let (word, rest) = self.reader.one_of(leaf, &MIPS)?;
        match word {
            "Full" => self.reader.bare(word, rest).map(|()| Mips::Full),
            _ => self.like(leaf, rest).map(Mips::Like),
        }
    }

    fn layers(&mut self, leaf: Leaf<'_>) -> Option<Layers> {
        if let Shape::Text | Shape::Number = leaf.shape() {
            return self.whole(leaf, "number of layers", 1..=MOST_LAYERS).map(Layers::Count);
        }
        let (_, rest) = self.reader.one_of(leaf, &LAYERS)?;
        self.like(leaf, rest).map(Layers::Like)
    }

    fn shape(&mut self, leaf: Leaf<'_>) -> Option<ImageShape> {
        let (word, rest) = self.reader.one_of(leaf, &SHAPES)?;
        match word {
            "D2" => self.reader.bare(word, rest).map(|()| ImageShape::D2),
            "Cube" => self.reader.bare(word, rest).map(|()| ImageShape::Cube),
            _ => {
                let [depth]: [Leaf<'_>; 1] = self.reader.inside(leaf, rest, "D3(64)")?;
                self.whole(depth, "depth", 1..=i64::from(LARGEST_SIZE)).map(ImageShape::D3)
            }
        }
    }
}
