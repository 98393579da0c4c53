//! The kinds of file: a pipeline, a pipeline that extends another, an extension, a file of fragments.

use super::changes;
use crate::fields;
use crate::language::entries::{body, fragments, outputs, precision, presets, resolves, settings, textures, views};
use crate::ron::{Field, Form, Leaf, PlainForm, Reader, Row, Table, slots};

/// A field of a pipeline, of a pipeline that extends another, or of an extension.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Section {
    /// The name in files.
    pub(crate) name: &'static str,
    form: Form,
}

/// Paths of files.
const INCLUDES: Form = Form::List(&Form::Plain(PlainForm::Text));

/// The version of a file.
pub(crate) const VERSION: Form = Form::Plain(PlainForm::Whole);

pub(crate) const ABOUT: Section = Section { name: "about", form: Form::Plain(PlainForm::Text) };
const EXTENDS: Section = Section { name: "extends", form: Form::Plain(PlainForm::Text) };
const EXTENSIONS: Section = Section { name: "extensions", form: INCLUDES };
pub(crate) const INCLUDE: Section = Section { name: "include", form: INCLUDES };
pub(crate) const SETTINGS: Section = Section { name: "settings", form: settings::SETTINGS };
pub(crate) const PRESETS: Section = Section { name: "presets", form: presets::PRESETS };
pub(crate) const VIEWS: Section = Section { name: "views", form: views::VIEWS };
pub(crate) const FRAGMENTS: Section = Section { name: "fragments", form: fragments::FRAGMENTS };
pub(crate) const TEXTURES: Section = Section { name: "textures", form: textures::TEXTURES };
pub(crate) const IMAGES: Section = Section { name: "images", form: body::IMAGES };
pub(crate) const BUFFERS: Section = Section { name: "buffers", form: body::BUFFERS };
pub(crate) const PASSES: Section = Section { name: "passes", form: body::ITEMS };
pub(crate) const OUTPUTS: Section = Section { name: "outputs", form: outputs::OUTPUTS };
pub(crate) const DEPTH: Section = Section { name: "depth", form: resolves::DEPTH };
pub(crate) const COLOR: Section = Section { name: "color", form: precision::COLOR };
pub(crate) const DEPTH_FORMAT: Section = Section { name: "depth_format", form: precision::DEPTH };
pub(crate) const CHANGES: Section = Section { name: "changes", form: changes::CHANGES };

impl Section {
    /// A field that has to be there.
    const fn needed(self, about: &'static [&'static str]) -> Row {
        Row { name: self.name, needed: true, about, form: self.form }
    }

    /// A field that may be left out.
    const fn optional(self, about: &'static [&'static str]) -> Row {
        Row { name: self.name, needed: false, about, form: self.form }
    }
}

/// Several lists of rows as one.
const fn rows<const N: usize>(lists: &[&[Row]]) -> [Row; N] {
    let mut all = [VERSION_ROW; N];
    let (mut list, mut at, mut next) = (0, 0, 0);
    while list < lists.len() {
        if at < lists[list].len() {
            all[next] = lists[list][at];
            (at, next) = (at + 1, next + 1);
        } else {
            (list, at) = (list + 1, 0);
        }
    }
    all
}

const VERSION_ROW: Row =
    Row { name: "version", needed: true, about: &["The version of the language: 1."], form: VERSION };

/// A pipeline that stands by itself.
pub(crate) const PIPELINE: Table = Table {
    name: "PipelineFields",
    word: Some("Pipeline"),
    about: &[
        " A pipeline: the images, buffers and passes of a frame.",
        " ```ron",
        " Pipeline(",
        "     version: 1,",
        "     images: [(name: \"screen\", format: Output, size: Output)],",
        "     passes: [(name: \"sky\", draw: Sky, color: [(image: \"screen\", clear: (0.0, 0.0, 0.0, 1.0))])],",
        "     outputs: [\"screen\"],",
        " )",
        " ```",
    ],
    rows: &[
        VERSION_ROW,
        EXTENSIONS.optional(&["Files of extensions, which are applied in their order."]),
        INCLUDE.optional(&["Files with fragments. A file that is named twice is read once."]),
        SETTINGS.optional(&["Values that a user may choose."]),
        PRESETS.optional(&["Values of several settings under one name."]),
        VIEWS.optional(&["The pictures that the frame shows: from where, and how large. The main view comes first. One view of the frame's size if left out."]),
        FRAGMENTS.optional(&["Groups of images, buffers and passes that are written once and used often."]),
        TEXTURES.optional(&["Images that come from files."]),
        IMAGES.needed(&["Images that passes make."]),
        BUFFERS.optional(&["The buffers."]),
        PASSES.needed(&["The passes. Their order gives them their meaning: each reads what those above it wrote."]),
        OUTPUTS.needed(&["The images and buffers that leave the frame."]),
        DEPTH.optional(&[
            "The way in which several samples of depth become one value where a pass samples them, for images without `resolve`; `Exact` if left",
            "out.",
        ]),
        COLOR.optional(&["The precision of images of the format `Color`, if nothing but passes of the frame draws and samples them; `Balanced` if left out."]),
        DEPTH_FORMAT.optional(&[
            "The precision of images of the formats `Depth` and `DepthStencil`, if nothing but passes of the frame draws and samples them; `Exact`",
            "if left out.",
        ]),
        CHANGES.optional(&["Changes to the fields above. They are made after the extensions."]),
    ],
};

/// A pipeline that extends another.
pub(crate) const EXTENDING: Table = Table {
    name: "ExtendingFields",
    word: Some("Pipeline"),
    about: &[
        " A pipeline that extends another: it begins with that one's entries.",
        " ",
        " ```ron",
        " Pipeline(version: 1, extends: \"forward.ron\", changes: [Remove(pass: \"transparent\")])",
        " ```",
    ],
    rows: &rows::<17>(&[
        &[
            VERSION_ROW,
            EXTENDS.needed(&["The file of the pipeline that it begins with."]),
            EXTENSIONS.optional(&["Files of extensions, which are applied in their order."]),
        ],
        &ADDED,
        &[
            PASSES.optional(&["Not allowed here: `changes` inserts passes."]),
            OUTPUTS.optional(&["Outputs in place of those that there are."]),
        ],
        &REPLACED,
        &[CHANGES.optional(&["Changes to the pipeline that is extended, and to the fields above."])],
    ]),
};

/// An extension: a file that is added to pipelines.
pub(crate) const EXTENSION: Table = Table {
    name: "ExtensionFields",
    word: Some("Extension"),
    about: &[
        " An extension: entries and changes that a pipeline may take.",
        " ",
        " ```ron",
        " Extension(version: 1, about: \"without glass\", changes: [Remove(pass: \"transparent\")])",
        " ```",
    ],
    rows: &rows::<14>(&[
        &[VERSION_ROW, ABOUT.optional(&["A description for people."])],
        &ADDED,
        &REPLACED,
        &[CHANGES.optional(&["Changes to the pipeline."])],
    ]),
};

/// Lists that a file adds to another.
const ADDED: [Row; 8] = [
    INCLUDE.optional(&["Files with fragments."]),
    SETTINGS.optional(&["Settings that are added."]),
    PRESETS.optional(&["Presets that are added."]),
    VIEWS.optional(&["Views that are added."]),
    FRAGMENTS.optional(&["Fragments that are added."]),
    TEXTURES.optional(&["Textures that are added."]),
    IMAGES.optional(&["Images that are added."]),
    BUFFERS.optional(&["Buffers that are added."]),
];

/// Values that replace those of another file.
const REPLACED: [Row; 3] = [
    DEPTH.optional(&["The way in which several samples of depth become one value, in place of the earlier one."]),
    COLOR.optional(&["The precision of `Color`, in place of the earlier one."]),
    DEPTH_FORMAT.optional(&["The precision of `Depth` and `DepthStencil`, in place of the earlier one."]),
];

/// The values of the fields of a file.
#[derive(Clone, Copy)]
pub(crate) struct Sections<'t> {
    rows: &'static [Row],
    found: [Option<Leaf<'t>>; MOST_ROWS],
}

/// No table has more.
const MOST_ROWS: usize = EXTENDING.rows.len();

impl<'t> Sections<'t> {
    /// Reads the fields of a file; `what` names it in messages: "the pipeline".
    pub(crate) fn read(reader: &mut Reader, root: Leaf<'t>, what: &str, table: &Table) -> Option<Sections<'t>> {
        let mut found = [None; MOST_ROWS];
        slots(root, &what, table, &mut found[..table.rows.len()], &mut reader.errors)?;
        Some(Sections { rows: table.rows, found })
    }

    /// The value of a field.
    pub(crate) fn get(&self, section: &Section) -> Option<Leaf<'t>> {
        let at = self.rows.iter().position(|row| row.name == section.name)?;
        Field::of(self.found[at])?
    }
}

fields! {
    /// A file of fragments: images, buffers and passes that several pipelines have in common.
    /// ```ron
    /// Fragments(version: 1, fragments: [
    ///     (name: "wipe", parameters: [(name: "target", value: Image)],
    ///         passes: [(name: "wipe", fill: (to: "target", value: 0))]),
    /// ])
    /// ```
    pub(crate) struct LibraryFields<'src> as "Fragments" {
        /// The version of the language: 1.
        #[expect(dead_code, reason = "read before the others, so that a later version is said first")]
        version: Leaf<'src> => VERSION,
        /// Files with further fragments.
        pub(crate) include: Option<Leaf<'src>> => INCLUDES,
        /// The fragments.
        #[expect(dead_code, reason = "read with those of the pipeline")]
        fragments: Leaf<'src> => fragments::FRAGMENTS,
    }
}
