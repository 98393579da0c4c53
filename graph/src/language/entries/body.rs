//! The body of a pipeline or of a fragment: its textures, images, buffers and passes, field by field.

use super::buffers::BufferFields;
use super::diagnosed::Diagnosed;
use super::fragments::Fragments;
use super::images::ImageFields;
use super::list::{entries, entry};
use super::pass_fields::PassFields;
use super::repeat::{MOST_THINGS, Repeat};
use super::textures::{Pictures, TextureFields};
use super::uses::{UseEntry, UseFields};
use super::views::ViewEntries;
use crate::base::{Code, Diagnostic};
use crate::fields;
use crate::frame::ViewIndex;
use crate::language::model::{Buffer, Image, Pass};
use crate::language::scope::{Context, FieldValue, Parameter, Scope, Symbols, fixed};
use crate::ron::{FieldTable, Form, Leaf, Name, Names, PlainForm, Reader};
use std::collections::HashMap;
use std::sync::Arc;

/// The entries of `textures`, `images`, `buffers` and `passes`; `None` where fields couldn't be told apart.
pub(crate) struct Body {
    pub(crate) symbols: Arc<Symbols>,
    /// Textures first.
    pub(crate) images: Vec<Option<Entry<FieldValue<Arc<Image>>>>>,
    pub(crate) buffers: Vec<Option<Entry<FieldValue<Buffer>>>>,
    pub(crate) items: Vec<Option<Entry<Item>>>,
}

/// An entry, and how often it is repeated.
pub(crate) struct Entry<T> {
    pub(crate) repeat: Repeat,
    /// The view that it names, if it names one.
    view: Diagnosed<Option<ViewIndex>>,
    pub(crate) value: Diagnosed<T>,
}

/// An entry of `passes`.
pub(crate) enum Item {
    /// A pass.
    Pass(FieldValue<Arc<Pass>>),
    /// A fragment is used.
    Use(Box<UseEntry>),
    /// A place that extensions may name.
    Anchor,
}

/// The field tables of a level's entries, told apart; `None` where that couldn't be done.
pub(crate) struct Tables<'t> {
    pub(crate) symbols: Arc<Symbols>,
    textures: Vec<Option<TextureFields<'t>>>,
    images: Vec<Option<ImageFields<'t>>>,
    buffers: Vec<Option<BufferFields<'t>>>,
    /// The entries of `passes`. Their fields are told apart when they are read: nothing refers to a pass.
    items: Vec<Leaf<'t>>,
}

impl<T> Entry<T> {
    /// The view that it names, else the view of its whole level. `None` if it names a view that there is not.
    pub(crate) fn view(&self, reader: &mut Reader, level: ViewIndex) -> Option<ViewIndex> {
        self.view.get(reader).map(|view| view.unwrap_or(level))
    }
}

fields! {
    /// An anchor: a place among passes with a name. It does nothing.
    /// ```ron
    /// (anchor: "after_lighting")
    /// ```
    struct AnchorFields<'src> {
        /// Its name.
        anchor: Leaf<'src> => Form::Plain(PlainForm::Name),
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

impl<'t> Tables<'t> {
    /// Tells the fields of all entries apart. `names` are the names of settings or parameters.
    pub(crate) fn read(
        reader: &mut Reader,
        names: Names,
        parameters: Vec<Option<Parameter>>,
        settings: bool,
        lists: Lists<'t>,
    ) -> Tables<'t> {
        let mut image_names = Names::new("image", Code::UNKNOWN_IMAGE);
        let textures: Vec<Option<TextureFields<'t>>> =
            entries(reader, lists.textures, "`textures`", "texture", &mut image_names);
        let images: Vec<Option<ImageFields<'t>>> = entries(reader, lists.images, "`images`", "image", &mut image_names);
        let mut buffer_names = Names::new("buffer", Code::UNKNOWN_BUFFER);
        let buffers: Vec<Option<BufferFields<'t>>> =
            entries(reader, lists.buffers, "`buffers`", "buffer", &mut buffer_names);
        let is_list = |repeat: Option<Option<Leaf<'_>>>| repeat.flatten().is_some();
        let image_lists = images.iter().map(|fields| is_list(fields.as_ref().map(|fields| fields.repeat)));
        let buffer_lists = buffers.iter().map(|fields| is_list(fields.as_ref().map(|fields| fields.repeat)));
        let image_lists: Vec<bool> = textures.iter().map(|_| false).chain(image_lists).collect();
        let buffer_lists: Vec<bool> = buffer_lists.collect();
        let [fixed_images, fixed_buffers] = fixed(settings, &image_lists, &buffer_lists, MOST_THINGS as usize);
        let symbols = Symbols {
            names,
            parameters,
            settings,
            images: image_names,
            image_lists,
            buffers: buffer_names,
            buffer_lists,
            fixed_images,
            fixed_buffers,
        };
        symbols.differ(reader);
        let items = lists.passes.and_then(|list| reader.list(list, "`passes`")).unwrap_or_default();
        Tables { symbols: Arc::new(symbols), textures, images, buffers, items }
    }

    /// Reads the entries. `views` are the views that they may name; `None` in a fragment.
    pub(crate) fn body(
        &self,
        reader: &mut Reader,
        views: Option<&ViewEntries>,
        fragments: &Fragments<Tables<'_>>,
        pictures: &Pictures,
    ) -> Body {
        let mut level = LevelReader { reader, symbols: &self.symbols, views };
        // Textures come first: images may ask for their sizes.
        let textures = self.textures.iter().map(|fields| {
            let fields = fields.as_ref()?;
            Some(level.entry(None, None, |context| context.texture(pictures, fields)))
        });
        let mut images: Vec<_> = textures.collect();
        images.extend(self.images.iter().map(|fields| {
            let fields = fields.as_ref()?;
            Some(level.entry(fields.repeat, fields.view, |context| context.image_entry(fields)))
        }));
        let buffers = self.buffers.iter().map(|fields| {
            let fields = fields.as_ref()?;
            Some(level.entry(fields.repeat, fields.view, |context| context.buffer_entry(fields)))
        });
        let buffers = buffers.collect();
        // Passes and uses have their names in common.
        let mut names = Names::new("pass", Code::UNKNOWN_PASS);
        names.reserve(self.items.len());
        let mut anchors = HashMap::new();
        let items = self.items.iter().map(|leaf| {
            if leaf.field("anchor").is_some() {
                anchor(level.reader, *leaf, &mut anchors)?;
                return Some(level.entry(None, None, |_| Some(Item::Anchor)));
            }
            if leaf.field("use").is_some() {
                let fields: UseFields<'_> = entry(level.reader, *leaf, "use", "use", &mut names)?;
                return Some(level.entry(fields.repeat, fields.view, |context| {
                    Some(Item::Use(Box::new(context.use_entry(&fields, fragments)?)))
                }));
            }
            let fields: PassFields<'_> = entry(level.reader, *leaf, "pass", "pass", &mut names)?;
            Some(level.entry(fields.repeat, fields.view, |context| Some(Item::Pass(context.pass(&fields)))))
        });
        let items = items.collect();
        Body { symbols: Arc::clone(&self.symbols), images, buffers, items }
    }
}

/// The reader of the entries of a level.
struct LevelReader<'c> {
    reader: &'c mut Reader,
    symbols: &'c Symbols,
    /// Views that entries may name; `None` in a fragment.
    views: Option<&'c ViewEntries>,
}

impl LevelReader<'_> {
    fn entry<T>(
        &mut self,
        repeat: Option<Leaf<'_>>,
        view: Option<Leaf<'_>>,
        read: impl FnOnce(&mut Context<'_>) -> Option<T>,
    ) -> Entry<T> {
        let LevelReader { reader, symbols, views } = self;
        let view = Diagnosed::read(reader, |reader| match (view, views) {
            (None, _) => Some(None),
            (Some(leaf), Some(views)) => views.find(reader, leaf).map(Some),
            (Some(leaf), None) => {
                let help = "leave it out; the use of the fragment may have a `view`";
                reader.wrong(
                    Code::VIEW_IN_FRAGMENT,
                    leaf,
                    "all that a fragment makes is for the view of its use",
                    help,
                );
                None
            }
        });
        let repeat = Repeat::read(&mut Context { reader, scope: Scope { symbols, index: None } }, repeat);
        let scope = Scope { symbols, index: repeat.index() };
        let value = Diagnosed::read(reader, |reader| read(&mut Context { reader, scope }));
        Entry { repeat, view, value }
    }
}

fn anchor<'t>(reader: &mut Reader, leaf: Leaf<'t>, anchors: &mut HashMap<Arc<str>, Name>) -> Option<()> {
    let fields: AnchorFields<'t> = reader.read(leaf, "an anchor")?;
    let name = reader.name(fields.anchor, "an anchor")?;
    if let Some(first) = anchors.get(&name.text) {
        let twice = Diagnostic::new(
            Code::NAME_TAKEN,
            name.span,
            format!("`{}` is the name of more than one anchor", name.text),
        );
        reader.report(twice.remark("again here").label(first.span, "first here"));
        return None;
    }
    anchors.insert(name.text.clone(), name);
    Some(())
}
