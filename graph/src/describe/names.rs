//! The names that a file gives, each once, and the search for those that it refers to.

use super::Diagnostic;
use super::leaf::Leaf;
use super::pipeline::{BufferRef, ImageRef, Name, ResourceRef, Setting, SettingKind, SettingRef};
use super::reader::Reader;
use crate::frame::{BufferIndex, ImageIndex, Resource};
use std::collections::HashMap;
use std::sync::Arc;

impl Name {
    /// A name as it stands in the file, without a judgement.
    #[must_use]
    pub fn written(leaf: Leaf<'_>) -> Option<Name> {
        leaf.plain().map(|text| Name { text: text.into(), span: leaf.span() })
    }
}

/// Names of one kind of thing, in file order.
pub struct Names {
    what: &'static str,
    given: Vec<Option<Name>>,
    index: HashMap<Arc<str>, usize>,
    /// Whether every name could be read.
    complete: bool,
}

impl Names {
    /// No names yet, of things called `what`.
    #[must_use]
    pub fn new(what: &'static str) -> Names {
        Names { what, given: Vec::new(), index: HashMap::new(), complete: true }
    }

    /// Gives the next thing its name; `None` if it couldn't be read. Reports a name that is given twice.
    pub fn give(&mut self, reader: &mut Reader, name: Option<Name>) {
        if let Some(name) = &name {
            match self.index.get(&name.text).and_then(|first| self.given[*first].as_ref()) {
                Some(first) => reader.report(
                    Diagnostic::new(name.span, format!("`{}` is the name of more than one {}", name.text, self.what))
                        .remark("again here")
                        .label(first.span, "first here"),
                ),
                None => {
                    self.index.insert(name.text.clone(), self.given.len());
                }
            }
        }
        self.complete &= name.is_some();
        self.given.push(name);
    }

    /// The index of the thing named `name`. Reports a name that doesn't exist, unless some name couldn't be read: it
    /// may be that one.
    pub fn find(&self, reader: &mut Reader, name: &Name) -> Option<usize> {
        if let Some(index) = self.index.get(&name.text) {
            return Some(*index);
        }
        if self.complete {
            let unknown = Diagnostic::new(name.span, format!("there is no {} named `{}`", self.what, name.text));
            let help = reader.known(&name.text, self.in_order());
            reader.report(Diagnostic { help, ..unknown });
        }
        None
    }

    /// Known names in file order.
    fn in_order(&self) -> impl Iterator<Item = &str> + Clone {
        self.given.iter().flatten().map(|name| &*name.text)
    }
}

/// What the rest of the file may refer to.
pub(super) struct Scope<'a> {
    pub(super) settings: &'a Names,
    /// Settings by index; `None` where one couldn't be read.
    pub(super) kinds: &'a [Option<Setting>],
    pub(super) images: &'a Names,
    pub(super) buffers: &'a Names,
}

impl Scope<'_> {
    /// An image that is referred to.
    pub(super) fn image<'src>(&self, reader: &mut Reader, leaf: Leaf<'src>) -> Option<ImageRef> {
        let name = reader.reference(leaf, "an image")?;
        if self.other_kind(reader, &name, self.images, self.buffers) {
            return None;
        }
        let index = self.images.find(reader, &name)?;
        Some(ImageRef { index: ImageIndex(u32::try_from(index).ok()?), span: name.span })
    }

    /// A buffer that is referred to.
    pub(super) fn buffer<'src>(&self, reader: &mut Reader, leaf: Leaf<'src>) -> Option<BufferRef> {
        let name = reader.reference(leaf, "a buffer")?;
        if self.other_kind(reader, &name, self.buffers, self.images) {
            return None;
        }
        let index = self.buffers.find(reader, &name)?;
        Some(BufferRef { index: BufferIndex(u32::try_from(index).ok()?), span: name.span })
    }

    /// An image or buffer that is referred to.
    pub(super) fn resource<'src>(&self, reader: &mut Reader, leaf: Leaf<'src>) -> Option<ResourceRef> {
        let name = reader.reference(leaf, "an image or buffer")?;
        let span = name.span;
        let index = |names: &Names| names.index.get(&name.text).and_then(|index| u32::try_from(*index).ok());
        if let Some(index) = index(self.images) {
            return Some(ResourceRef { resource: Resource::Image(ImageIndex(index)), span });
        }
        if let Some(index) = index(self.buffers) {
            return Some(ResourceRef { resource: Resource::Buffer(BufferIndex(index)), span });
        }
        if self.images.complete && self.buffers.complete {
            let what = if self.buffers.given.is_empty() { "image" } else { "image or buffer" };
            let unknown = Diagnostic::new(span, format!("there is no {what} named `{}`", name.text));
            let help = reader.known(&name.text, self.images.in_order().chain(self.buffers.in_order()));
            reader.report(Diagnostic { help, ..unknown });
        }
        None
    }

    /// Reports a name that is not among `wanted` but among `others`.
    fn other_kind(&self, reader: &mut Reader, name: &Name, wanted: &Names, others: &Names) -> bool {
        let Some(other) = others.index.get(&name.text).and_then(|at| others.given[*at].as_ref()) else { return false };
        if wanted.index.contains_key(&name.text) {
            return false;
        }
        let kinds = |names: &Names| if names.what == "image" { "an image" } else { "a buffer" };
        let message = format!("`{}` is {}; {} is needed here", name.text, kinds(others), kinds(wanted));
        reader.report(Diagnostic::new(name.span, message).label(other.span, "declared here"));
        true
    }

    /// Reports names that are given to an image and a buffer.
    pub(super) fn images_and_buffers_differ(&self, reader: &mut Reader) {
        for name in self.buffers.given.iter().flatten() {
            let Some(first) = self.images.index.get(&name.text).and_then(|at| self.images.given[*at].as_ref()) else {
                continue;
            };
            let twice = format!("`{}` is the name of an image and of a buffer", name.text);
            reader.report(Diagnostic::new(name.span, twice).remark("this buffer").label(first.span, "this image"));
        }
    }

    /// A setting that is referred to, of whatever type.
    pub(super) fn any_setting<'src>(&self, reader: &mut Reader, leaf: Leaf<'src>) -> Option<SettingRef> {
        let name = reader.reference(leaf, "a setting")?;
        let index = self.settings.find(reader, &name)?;
        Some(SettingRef { index, span: name.span })
    }

    /// A setting that is referred to, which must be of a kind that `fits`; `wanted` says which.
    pub(super) fn setting<'src>(
        &self,
        reader: &mut Reader,
        leaf: Leaf<'src>,
        fits: impl Fn(&SettingKind) -> bool,
        wanted: &str,
    ) -> Option<SettingRef> {
        let reference = self.any_setting(reader, leaf)?;
        self.fitting(reader, reference, fits, wanted)
    }

    /// Checks the kind of a setting.
    pub(super) fn fitting(
        &self,
        reader: &mut Reader,
        reference: SettingRef,
        fits: impl Fn(&SettingKind) -> bool,
        wanted: &str,
    ) -> Option<SettingRef> {
        let setting = self.kinds.get(reference.index)?.as_ref()?;
        if fits(&setting.kind) {
            return Some(reference);
        }
        let (name, kind) = (&setting.name.text, setting.kind.words());
        reader.report(
            Diagnostic::new(reference.span, format!("setting `{name}` is {kind}; {wanted} is needed here"))
                .label(setting.name.span, "declared here"),
        );
        None
    }
}
