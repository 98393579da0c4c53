//! What a file as a whole is: a pipeline, one that extends another, an extension, a file of fragments.

use super::changes::CHANGES;
use crate::fields;
use crate::language::entries::fragments::FRAGMENTS;
use crate::language::entries::{body, outputs, precision, presets, resolves, settings, textures, views};
use crate::ron::{Field, Form, Leaf, Plain, Reader, Row, Table, slots};

/// A field of a pipeline, of one that extends another or of an extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Section {
    Version,
    Extends,
    Extensions,
    About,
    Include,
    Settings,
    Presets,
    Views,
    Fragments,
    Textures,
    Images,
    Buffers,
    Passes,
    Outputs,
    Depth,
    Color,
    DepthFormat,
    Changes,
}

/// Files that are named.
const INCLUDE: Form = Form::List(&Form::Plain(Plain::Text));

/// All of them, with their names and what may stand there, in the order in which they are declared.
const SECTIONS: [(&str, Form); 18] = [
    ("version", VERSION),
    ("extends", Form::Plain(Plain::Text)),
    ("extensions", INCLUDE),
    ("about", Form::Plain(Plain::Text)),
    ("include", INCLUDE),
    ("settings", settings::SETTINGS),
    ("presets", presets::PRESETS),
    ("views", views::VIEWS),
    ("fragments", FRAGMENTS),
    ("textures", textures::TEXTURES),
    ("images", body::IMAGES),
    ("buffers", body::BUFFERS),
    ("passes", body::ITEMS),
    ("outputs", outputs::OUTPUTS),
    ("depth", resolves::DEPTH),
    ("color", precision::COLOR),
    ("depth_format", precision::DEPTH),
    ("changes", CHANGES),
];

/// The version of a file.
pub(crate) const VERSION: Form = Form::Plain(Plain::Whole);

impl Section {
    /// As it is written.
    pub(crate) const fn name(self) -> &'static str {
        SECTIONS[self as usize].0
    }

    const fn row(self, needed: bool, about: &'static [&'static str]) -> Row {
        let (name, form) = SECTIONS[self as usize];
        Row { name, needed, about, form }
    }

    /// A field that has to be there.
    const fn needed(self, about: &'static [&'static str]) -> Row {
        self.row(true, about)
    }

    /// A field that may be left out.
    const fn optional(self, about: &'static [&'static str]) -> Row {
        self.row(false, about)
    }
}

/// The names of all fields.
pub(crate) fn section_names() -> impl Iterator<Item = &'static str> {
    SECTIONS.iter().map(|(name, _)| *name)
}

const VERSION_ROW: Row = Section::Version.needed(&["The version of the language: 1."]);

/// A pipeline that stands by itself.
pub(crate) const PIPELINE: Table = Table {
    name: "PipelineFields",
    word: Some("Pipeline"),
    about: &[
        " A pipeline: what a frame is made of.",
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
        Section::Extensions.optional(&["Files of extensions, which are applied in their order."]),
        Section::Include.optional(&["Files with fragments, each read once however often it is named."]),
        Section::Settings.optional(&["What a user may choose."]),
        Section::Presets.optional(&["Values of several settings under one name."]),
        Section::Views.optional(&["What the frame shows, from where and how large, the main view first; one view of the frame's size if left out."]),
        Section::Fragments.optional(&["What is written once and used often."]),
        Section::Textures.optional(&["Images that come from files."]),
        Section::Images.needed(&["Images that passes make."]),
        Section::Buffers.optional(&["The buffers."]),
        Section::Passes.needed(&["The passes. Their order gives them their meaning: each reads what those above it wrote."]),
        Section::Outputs.needed(&["The images and buffers that leave the frame."]),
        Section::Depth.optional(&[
            "How several samples of depth become one value where a pass samples it, of images that don't say it; `Exact` if left",
            "out.",
        ]),
        Section::Color.optional(&["What images of the format `Color` become that passes of the frame alone draw and sample; `Balanced` if left out."]),
        Section::DepthFormat.optional(&[
            "What images of the formats `Depth` and `DepthStencil` become that passes of the frame alone draw and sample; `Exact`",
            "if left out.",
        ]),
        Section::Changes.optional(&["What is changed of all that, after the extensions."]),
    ],
};

/// A pipeline that extends another.
pub(crate) const EXTENDING: Table = Table {
    name: "ExtendingFields",
    word: Some("Pipeline"),
    about: &[
        " A pipeline that extends another: it begins with what that says.",
        " ",
        " ```ron",
        " Pipeline(version: 1, extends: \"forward.ron\", changes: [Remove(pass: \"transparent\")])",
        " ```",
    ],
    rows: &[
        VERSION_ROW,
        Section::Extends.needed(&["The file of the pipeline that it begins with."]),
        Section::Extensions.optional(&["Files of extensions, which are applied in their order."]),
        ADDED[0],
        ADDED[1],
        ADDED[2],
        ADDED[3],
        ADDED[4],
        ADDED[5],
        ADDED[6],
        ADDED[7],
        Section::Passes.optional(&["None: passes are inserted by `changes`."]),
        Section::Outputs.optional(&["Outputs in place of those that there are."]),
        REPLACED[0],
        REPLACED[1],
        REPLACED[2],
        Section::Changes.optional(&["What is changed of all that."]),
    ],
};

/// What may be added to pipelines.
pub(crate) const EXTENSION: Table = Table {
    name: "ExtensionFields",
    word: Some("Extension"),
    about: &[
        " An extension: what may be added to pipelines.",
        " ",
        " ```ron",
        " Extension(version: 1, about: \"without glass\", changes: [Remove(pass: \"transparent\")])",
        " ```",
    ],
    rows: &[
        VERSION_ROW,
        Section::About.optional(&["A description for people."]),
        ADDED[0],
        ADDED[1],
        ADDED[2],
        ADDED[3],
        ADDED[4],
        ADDED[5],
        ADDED[6],
        ADDED[7],
        REPLACED[0],
        REPLACED[1],
        REPLACED[2],
        Section::Changes.optional(&["What is changed."]),
    ],
};

/// What a file adds to another.
const ADDED: [Row; 8] = [
    Section::Include.optional(&["Files with fragments."]),
    Section::Settings.optional(&["Settings that are added."]),
    Section::Presets.optional(&["Presets that are added."]),
    Section::Views.optional(&["Views that are added."]),
    Section::Fragments.optional(&["Fragments that are added."]),
    Section::Textures.optional(&["Textures that are added."]),
    Section::Images.optional(&["Images that are added."]),
    Section::Buffers.optional(&["Buffers that are added."]),
];

/// What a file says in place of what another said.
const REPLACED: [Row; 3] = [
    Section::Depth.optional(&["How several samples of depth become one value, in place of what there is."]),
    Section::Color.optional(&["What `Color` becomes, in place of what there is."]),
    Section::DepthFormat.optional(&["What `Depth` and `DepthStencil` become, in place of what there is."]),
];

/// The fields of a file, once they are told apart.
#[derive(Clone, Copy)]
pub(crate) struct Sections<'t>([Option<Leaf<'t>>; SECTIONS.len()]);

impl<'t> Sections<'t> {
    /// Tells the fields of a file apart; `what` names it in messages: "the pipeline".
    pub(crate) fn read(reader: &mut Reader, root: Leaf<'t>, what: &str, table: &Table) -> Option<Sections<'t>> {
        let mut found = [None; SECTIONS.len()];
        slots(root, what, table, &mut found[..table.rows.len()], &mut reader.errors)?;
        let mut sections = [None; SECTIONS.len()];
        for (row, leaf) in table.rows.iter().zip(found) {
            let at = SECTIONS.iter().position(|(name, _)| *name == row.name)?;
            sections[at] = Field::of(leaf)?;
        }
        Some(Sections(sections))
    }

    /// Takes out what stands in a field.
    pub(crate) const fn take(&mut self, section: Section) -> Option<Leaf<'t>> {
        self.0[section as usize].take()
    }

    /// What stands in a field.
    pub(crate) const fn get(&self, section: Section) -> Option<Leaf<'t>> {
        self.0[section as usize]
    }
}

fields! {
    /// A file of fragments: what several pipelines have in common.
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
        pub(crate) include: Option<Leaf<'src>> => INCLUDE,
        /// The fragments.
        #[expect(dead_code, reason = "read for each choice of settings")]
        fragments: Leaf<'src> => FRAGMENTS,
    }
}
