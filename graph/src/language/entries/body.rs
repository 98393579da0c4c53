//! The body of a pipeline or of a fragment: its textures, images, buffers and passes, field by field.

use super::buffers::BufferFields;
use super::images::ImageFields;
use super::list::{entries, entry};
use super::pass_fields::PassFields;
use super::repeat::Repeat;
use super::textures::TextureFields;
use super::uses::UseFields;
use crate::base::Diagnostic;
use crate::fields;
use crate::language::scope::{Parameter, Symbols};
use crate::ron::{Described, Form, Leaf, Name, Names, Plain, Reader};
use std::collections::HashMap;
use std::sync::Arc;

/// The entries of `textures`, `images`, `buffers` and `passes`; `None` where one couldn't be read.
pub(crate) struct Body<'t> {
    pub(crate) symbols: Symbols,
    pub(crate) images: Vec<Option<Entry<'t, AnyImage<'t>>>>,
    pub(crate) buffers: Vec<Option<Entry<'t, BufferFields<'t>>>>,
    pub(crate) items: Vec<Option<Entry<'t, Item<'t>>>>,
}

/// An entry, and how often it stands there.
pub(crate) struct Entry<'t, T> {
    pub(crate) repeat: Repeat<'t>,
    pub(crate) fields: T,
}

/// An entry of `textures` or `images`.
pub(crate) enum AnyImage<'t> {
    /// An image that passes make.
    Made(ImageFields<'t>),
    /// An image whose texels come from a file.
    Texture(TextureFields<'t>),
}

/// An entry of `passes`.
pub(crate) enum Item<'t> {
    /// A pass.
    Pass(Box<PassFields<'t>>),
    /// A fragment is used.
    Use(Box<UseFields<'t>>),
    /// A place that extensions may name.
    Anchor,
}

impl<'t> AnyImage<'t> {
    /// The view that it names.
    pub(crate) const fn view(&self) -> Option<Leaf<'t>> {
        match self {
            AnyImage::Made(fields) => fields.view,
            AnyImage::Texture(_) => None,
        }
    }
}

fields! {
    /// An anchor: a place among passes with a name. It does nothing.
    /// ```ron
    /// (anchor: "after_lighting")
    /// ```
    struct AnchorFields<'src> {
        /// Its name.
        anchor: Leaf<'src> => Form::Plain(Plain::Name),
    }
}

/// The images of one level.
pub(crate) const IMAGES: Form = Form::List(&Form::Fields(ImageFields::<'static>::table));

/// The buffers of one level.
pub(crate) const BUFFERS: Form = Form::List(&Form::Fields(BufferFields::<'static>::table));

/// The passes of one level.
pub(crate) const ITEMS: Form = Form::List(&Form::Either(&[
    Form::Fields(PassFields::<'static>::table),
    Form::Fields(UseFields::<'static>::table),
    Form::Fields(AnchorFields::<'static>::table),
]));

/// The lists of one level.
pub(crate) struct Lists<'t> {
    pub(crate) textures: Option<Leaf<'t>>,
    pub(crate) images: Option<Leaf<'t>>,
    pub(crate) buffers: Option<Leaf<'t>>,
    pub(crate) passes: Option<Leaf<'t>>,
}

impl<'t> Body<'t> {
    /// Tells the entries apart. `names` are those of settings or parameters.
    pub(crate) fn read(
        reader: &mut Reader,
        names: Names,
        parameters: Vec<Option<Parameter>>,
        settings: bool,
        lists: Lists<'t>,
    ) -> Body<'t> {
        let mut images = Names::new("image");
        let textures: Vec<Option<TextureFields<'t>>> =
            entries(reader, lists.textures, "`textures`", "texture", &mut images);
        let image_entries: Vec<Option<ImageFields<'t>>> =
            entries(reader, lists.images, "`images`", "image", &mut images);
        let mut buffers = Names::new("buffer");
        let buffer_entries: Vec<Option<BufferFields<'t>>> =
            entries(reader, lists.buffers, "`buffers`", "buffer", &mut buffers);
        // Textures come first: images may ask for their sizes.
        let texture = |fields| Entry { repeat: Repeat::Once, fields: AnyImage::Texture(fields) };
        let textures = textures.into_iter().map(|fields| fields.map(texture));
        let made = repeated(reader, image_entries, |fields| fields.repeat);
        let made = made
            .into_iter()
            .map(|entry| entry.map(|Entry { repeat, fields }| Entry { repeat, fields: AnyImage::Made(fields) }));
        let image_entries: Vec<_> = textures.chain(made).collect();
        let buffer_entries = repeated(reader, buffer_entries, |fields| fields.repeat);
        let symbols = Symbols {
            names,
            parameters,
            settings,
            images,
            image_lists: lists_of(&image_entries),
            buffers,
            buffer_lists: lists_of(&buffer_entries),
        };
        symbols.differ(reader);
        let items = items(reader, lists.passes);
        let repeats = image_entries.iter().flatten().map(|entry| &entry.repeat);
        let repeats = repeats.chain(buffer_entries.iter().flatten().map(|entry| &entry.repeat));
        for repeat in repeats.chain(items.iter().flatten().map(|entry| &entry.repeat)) {
            if let Repeat::Times { index, .. } = repeat {
                symbols.differs(reader, index);
            }
        }
        Body { symbols, images: image_entries, buffers: buffer_entries, items }
    }
}

fn repeated<'t, T>(
    reader: &mut Reader,
    entries: Vec<Option<T>>,
    repeat: impl Fn(&T) -> Option<Leaf<'t>>,
) -> Vec<Option<Entry<'t, T>>> {
    let entry = |fields: T| Entry { repeat: Repeat::read(reader, repeat(&fields)), fields };
    let mut entry = entry;
    entries.into_iter().map(|fields| fields.map(&mut entry)).collect()
}

fn lists_of<T>(entries: &[Option<Entry<'_, T>>]) -> Vec<bool> {
    entries.iter().map(|entry| entry.as_ref().is_some_and(|entry| entry.repeat.is_list())).collect()
}

/// Passes, uses of fragments, and anchors. Passes and uses have their names in common.
fn items<'t>(reader: &mut Reader, list: Option<Leaf<'t>>) -> Vec<Option<Entry<'t, Item<'t>>>> {
    let Some(leaves) = list.and_then(|list| reader.list(list, "`passes`")) else { return Vec::new() };
    let mut names = Names::new("pass");
    let mut anchors = HashMap::new();
    let mut items = Vec::with_capacity(leaves.len());
    for leaf in leaves {
        let item = if leaf.field("anchor").is_some() {
            anchor(reader, leaf, &mut anchors).map(|()| (None, Item::Anchor))
        } else if leaf.field("use").is_some() {
            let fields: Option<UseFields<'t>> = entry(reader, leaf, "use", "use", &mut names);
            fields.map(|fields| (fields.repeat, Item::Use(Box::new(fields))))
        } else {
            let fields: Option<PassFields<'t>> = entry(reader, leaf, "pass", "pass", &mut names);
            fields.map(|fields| (fields.repeat, Item::Pass(Box::new(fields))))
        };
        items.push(item.map(|(repeat, fields)| Entry { repeat: Repeat::read(reader, repeat), fields }));
    }
    items
}

fn anchor<'t>(reader: &mut Reader, leaf: Leaf<'t>, anchors: &mut HashMap<Arc<str>, Name>) -> Option<()> {
    let fields: AnchorFields<'t> = reader.read(leaf, "an anchor")?;
    let name = reader.name(fields.anchor, "an anchor")?;
    if let Some(first) = anchors.get(&name.text) {
        let twice = Diagnostic::new(name.span, format!("`{}` is the name of more than one anchor", name.text));
        reader.report(twice.remark("again here").label(first.span, "first here"));
        return None;
    }
    anchors.insert(name.text.clone(), name);
    Some(())
}
