//! `changes`: the forms in which a file sets, removes and inserts entries.

use crate::fields;
use crate::language::entries::{body, outputs};
use crate::ron::{FieldTable, Form, Leaf, PlainForm, Word, WordContents, Words};

fields! {
    /// A change of one thing: its fields get other values.
    pub(crate) struct SetFields<'src> {
        /// A pass or use.
        pub(crate) pass: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or an image.
        pub(crate) image: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a buffer.
        pub(crate) buffer: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a texture.
        pub(crate) texture: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a setting.
        pub(crate) setting: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a preset.
        pub(crate) preset: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a view.
        pub(crate) view: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Fields with their new values, as the thing has them; entries of a map come beside those that are there.
        pub(crate) to: Option<Leaf<'src>> => Form::Open("fields of the thing"),
        /// Names of fields that are left out.
        pub(crate) without: Option<Leaf<'src>> => Form::List(&Form::Plain(PlainForm::Text)),
    }
}

fields! {
    /// A removal of one thing.
    pub(crate) struct RemoveFields<'src> {
        /// A pass or use.
        pub(crate) pass: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or an image.
        pub(crate) image: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a buffer.
        pub(crate) buffer: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a texture.
        pub(crate) texture: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a setting.
        pub(crate) setting: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a preset.
        pub(crate) preset: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or a view.
        pub(crate) view: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or an output.
        pub(crate) output: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
    }
}

fields! {
    /// An insertion of passes at one place, or of outputs at the end.
    pub(crate) struct InsertFields<'src> {
        /// Before this pass.
        pub(crate) before: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or after this pass.
        pub(crate) after: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Or at this anchor, `Start` or `End`.
        pub(crate) at: Option<Leaf<'src>> => Form::Either(&[
            Form::Plain(PlainForm::Text),
            Form::Choice("a place", || vec!["Start", "End"]),
        ]),
        /// The passes.
        pub(crate) passes: Option<Leaf<'src>> => body::ITEMS,
        /// Or the outputs.
        pub(crate) outputs: Option<Leaf<'src>> => outputs::OUTPUTS,
    }
}

/// The form of `changes`: a list of changes.
pub(crate) const CHANGES: Form = Form::List(&Form::Words(&KINDS));

pub(crate) static KINDS: Words = Words {
    name: "Change",
    what: "a change",
    or: &[],
    all: &[
        Word::new(
            "Set",
            &[WordContents::Fields(SetFields::<'static>::table)],
            &["Set(pass: \"second\", to: (side_effect: true))"],
            "Fields of one thing get other values.",
        ),
        Word::new(
            "Remove",
            &[WordContents::Fields(RemoveFields::<'static>::table)],
            &["Remove(pass: \"second\")"],
            "One thing is removed. What others still use can't be; but presets and views choose nothing any more for a setting \
             that is removed.",
        ),
        Word::new(
            "Insert",
            &[WordContents::Fields(InsertFields::<'static>::table)],
            &["Insert(before: \"second\", passes: [])"],
            "Passes are inserted; those at one place stand in the order in which they are inserted.",
        ),
    ],
};
