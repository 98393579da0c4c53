//! The names at one level of a file: of the pipeline itself, or of one fragment. They don't depend on values, so
//! expressions are checked once.

use super::parameter::Parameter;
use crate::base::{Code, Diagnostic};
use crate::expression::Type;
use crate::ron::{Name, Names, Reader};

/// Settings or parameters, images and buffers of one level.
pub(crate) struct Symbols {
    /// Settings, or parameters of a fragment.
    pub(crate) names: Names,
    /// The settings or parameters of these names; `None` where one couldn't be read.
    pub(crate) parameters: Vec<Option<Parameter>>,
    /// Whether they are settings.
    pub(crate) settings: bool,
    /// Images, or lists of them.
    pub(crate) images: Names,
    /// Whether each is a list.
    pub(crate) image_lists: Vec<bool>,
    /// Buffers, or lists of them.
    pub(crate) buffers: Names,
    /// Whether each is a list.
    pub(crate) buffer_lists: Vec<bool>,
    /// How many images, from the first on, have their declaration's number as index in every pipeline that is evaluated.
    pub(crate) fixed_images: usize,
    /// How many buffers have.
    pub(crate) fixed_buffers: usize,
}

/// How many images and buffers, from the first on, have their declaration's number as index at every evaluation: those of the
/// pipeline itself that no list stands before, whose length may change. Images come before buffers. Where there is room for
/// less than all of them, none is sure to have an index.
pub(crate) fn fixed(settings: bool, image_lists: &[bool], buffer_lists: &[bool], room: usize) -> [usize; 2] {
    let plain = |lists: &[bool]| lists.iter().position(|is_list| *is_list).unwrap_or(lists.len());
    let images = plain(image_lists);
    let buffers = if images == image_lists.len() { plain(buffer_lists) } else { 0 };
    if settings && images + buffers <= room { [images, buffers] } else { [0, 0] }
}

impl Symbols {
    /// The word for a setting or parameter in messages.
    pub(crate) const fn parameter_word(&self) -> &'static str {
        if self.settings { "setting" } else { "parameter" }
    }

    /// Whether every name could be read.
    pub(crate) const fn complete(&self) -> bool {
        self.names.complete() && self.images.complete() && self.buffers.complete()
    }

    /// Names of images or of buffers, parameters included.
    pub(crate) fn all_of(&self, ty: Type) -> impl Iterator<Item = &str> + Clone {
        let names = if ty == Type::Image { &self.images } else { &self.buffers };
        let given = self.parameters.iter().flatten().filter(move |parameter| parameter.kind.ty() == ty);
        names.in_order().chain(given.map(|parameter| &*parameter.name.text))
    }

    /// Whether a parameter stands for an image or buffer.
    pub(crate) fn stands_for(&self, at: usize, ty: Type) -> bool {
        self.parameters.get(at).and_then(Option::as_ref).is_some_and(|parameter| parameter.kind.ty() == ty)
    }

    /// Reports names that two kinds of things have, at the second thing. A setting may have the name of an image or buffer:
    /// values mean the setting, references the image or buffer.
    pub(crate) fn differ(&self, reader: &mut Reader) {
        let lists = [(&self.names, "a parameter"), (&self.images, "an image"), (&self.buffers, "a buffer")];
        let lists = if self.settings { &lists[1..] } else { &lists };
        for (at, (names, what)) in lists.iter().enumerate() {
            for name in names.all() {
                let before =
                    lists[..at].iter().find_map(|(others, other)| Some((others.find_name(&name.text)?, other)));
                let Some((first, other)) = before else { continue };
                let twice = format!("`{}` is the name of {other} and of {what}", name.text);
                let this = |what: &str| format!("this {}", what.split_once(' ').map_or(what, |(_, noun)| noun));
                reader.report(
                    Diagnostic::new(Code::NAME_TAKEN, name.span, twice)
                        .remark(this(what))
                        .label(first.span, this(other)),
                );
            }
        }
    }

    /// Reports an index that has the name of something else.
    pub(crate) fn differs(&self, reader: &mut Reader, index: &Name) {
        let what = [(&self.names, self.parameter_word()), (&self.images, "image"), (&self.buffers, "buffer")];
        for (names, what) in what {
            if let Some(first) = names.find_name(&index.text) {
                let article = if what == "image" { "an" } else { "a" };
                let message = format!("`{}` is the name of an index and of {article} {what}", index.text);
                let wrong = Diagnostic::new(Code::NAME_TAKEN, index.span, message).remark("this index");
                reader.report(wrong.label(first.span, format!("this {what}")));
            }
        }
    }
}
