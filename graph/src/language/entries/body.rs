//! The body of a pipeline or of a fragment: its textures, images, buffers and passes, field by field.

use super::buffers::BufferFields;
use super::fragments::FragmentTables;
use super::images::ImageFields;
use super::list::{entries, entry};
use super::pass_fields::PassFields;
use super::passes::PassEntry;
use super::repeat::{MOST_THINGS, Repeat};
use super::textures::{Pictures, TextureFields};
use super::uses::{UseEntry, UseFields};
use super::views::ViewEntries;
use crate::base::Diagnostic;
use crate::fields;
use crate::frame::ViewIndex;
use crate::language::model::{Buffer, Image};
use crate::language::scope::{Context, Given, Parameter, Scope, Symbols};
use crate::ron::{Described, Form, Leaf, Name, Names, Plain, Reader};
use std::collections::HashMap;
use std::sync::Arc;

/// The entries of `textures`, `images`, `buffers` and `passes`; `None` where fields couldn't be told apart.
pub(crate) struct Body {
    pub(crate) symbols: Arc<Symbols>,
    /// Textures first.
    pub(crate) images: Vec<Option<Entry<Given<Image>>>>,
    pub(crate) buffers: Vec<Option<Entry<Given<Buffer>>>>,
    pub(crate) items: Vec<Option<Entry<Item>>>,
}

/// An entry, and how often it stands there.
pub(crate) struct Entry<T> {
    pub(crate) repeat: Repeat<Told<Given<u32>>>,
    /// The view that it names, if it names one.
    view: Told<Option<ViewIndex>>,
    pub(crate) value: Told<T>,
}

/// What was read of an entry, and what is wrong with it. Mistakes are told where the entry is evaluated, and so with the
/// uses of its fragment.
pub(crate) struct Told<T> {
    value: Option<T>,
    mistakes: Vec<Diagnostic>,
}

/// An entry of `passes`.
pub(crate) enum Item {
    /// A pass.
    Pass(Box<PassEntry>),
    /// A fragment is used.
    Use(Box<UseEntry>),
    /// A place that extensions may name.
    Anchor,
}

/// The field tables of a level's entries, told apart; `None` where that couldn't be done.
pub(crate) struct Tables<'t> {
    pub(crate) symbols: Arc<Symbols>,
    textures: Vec<Option<TextureFields<'t>>>,
    images: Vec<Option<Repeated<'t, ImageFields<'t>>>>,
    buffers: Vec<Option<Repeated<'t, BufferFields<'t>>>>,
    items: Vec<Option<Repeated<'t, ItemFields<'t>>>>,
}

/// Fields, and how often they stand there.
type Repeated<'t, T> = (Repeat<Leaf<'t>>, T);

/// Fields of an entry of `passes`.
enum ItemFields<'t> {
    Pass(Box<PassFields<'t>>),
    Use(Box<UseFields<'t>>),
    Anchor,
}

impl<T> Entry<T> {
    /// The view that it names, else the one that its whole level is for. `None` if it names none that there is.
    pub(crate) fn view(&self, reader: &mut Reader, level: ViewIndex) -> Option<ViewIndex> {
        self.view.get(reader).map(|view| view.unwrap_or(level))
    }
}

impl<T> Told<T> {
    /// What was read, if anything was. Mistakes are reported to `reader`.
    pub(crate) fn get(&self, reader: &mut Reader) -> Option<&T> {
        self.mistakes.iter().for_each(|mistake| reader.report(mistake.clone()));
        self.value.as_ref()
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

impl<'t> Tables<'t> {
    /// Tells the entries apart. `names` are those of settings or parameters.
    pub(crate) fn read(
        reader: &mut Reader,
        names: Names,
        parameters: Vec<Option<Parameter>>,
        settings: bool,
        lists: Lists<'t>,
    ) -> Tables<'t> {
        let mut image_names = Names::new("image");
        let textures: Vec<Option<TextureFields<'t>>> =
            entries(reader, lists.textures, "`textures`", "texture", &mut image_names);
        let images: Vec<Option<ImageFields<'t>>> = entries(reader, lists.images, "`images`", "image", &mut image_names);
        let mut buffer_names = Names::new("buffer");
        let buffers: Vec<Option<BufferFields<'t>>> =
            entries(reader, lists.buffers, "`buffers`", "buffer", &mut buffer_names);
        let images = repeated(reader, images, |fields| fields.repeat);
        let buffers = repeated(reader, buffers, |fields| fields.repeat);
        let symbols = Symbols {
            names,
            parameters,
            settings,
            images: image_names,
            image_lists: textures.iter().map(|_| false).chain(images.iter().map(is_list)).collect(),
            buffers: buffer_names,
            buffer_lists: buffers.iter().map(is_list).collect(),
        };
        symbols.differ(reader);
        let items = items(reader, lists.passes);
        let repeats = images.iter().flatten().map(|(repeat, _)| repeat);
        let repeats = repeats.chain(buffers.iter().flatten().map(|(repeat, _)| repeat));
        for index in repeats.chain(items.iter().flatten().map(|(repeat, _)| repeat)).filter_map(Repeat::index) {
            symbols.differs(reader, index);
        }
        Tables { symbols: Arc::new(symbols), textures, images, buffers, items }
    }

    /// Reads the entries. `views` are those that they may name, of a fragment none.
    pub(crate) fn body(
        &self,
        reader: &mut Reader,
        views: Option<&ViewEntries>,
        fragments: &FragmentTables<'_>,
        pictures: &Pictures,
    ) -> Body {
        let mut level = LevelReader { reader, symbols: &self.symbols, views };
        // Textures come first: images may ask for their sizes.
        let textures = self.textures.iter().map(|fields| {
            let fields = fields.as_ref()?;
            Some(level.entry(&Repeat::Once, None, |context| context.texture(pictures, fields)))
        });
        let mut images: Vec<_> = textures.collect();
        images.extend(self.images.iter().map(|image| {
            let (repeat, fields) = image.as_ref()?;
            Some(level.entry(repeat, fields.view, |context| context.image_entry(fields)))
        }));
        let buffers = self.buffers.iter().map(|buffer| {
            let (repeat, fields) = buffer.as_ref()?;
            Some(level.entry(repeat, fields.view, |context| context.buffer_entry(fields)))
        });
        let buffers = buffers.collect();
        let items = self.items.iter().map(|item| {
            let (repeat, fields) = item.as_ref()?;
            Some(match fields {
                ItemFields::Pass(fields) => {
                    level.entry(repeat, fields.view, |context| Some(Item::Pass(Box::new(context.pass(fields)))))
                }
                ItemFields::Use(fields) => level.entry(repeat, fields.view, |context| {
                    Some(Item::Use(Box::new(context.use_entry(fields, fragments)?)))
                }),
                ItemFields::Anchor => level.entry(repeat, None, |_| Some(Item::Anchor)),
            })
        });
        let items = items.collect();
        Body { symbols: Arc::clone(&self.symbols), images, buffers, items }
    }
}

/// What reads the entries of a level.
struct LevelReader<'c> {
    reader: &'c mut Reader,
    symbols: &'c Symbols,
    /// Views that entries may name; `None` in a fragment.
    views: Option<&'c ViewEntries>,
}

impl LevelReader<'_> {
    fn entry<T>(
        &mut self,
        repeat: &Repeat<Leaf<'_>>,
        view: Option<Leaf<'_>>,
        read: impl FnOnce(&mut Context<'_>) -> Option<T>,
    ) -> Entry<T> {
        let (symbols, views) = (self.symbols, self.views);
        let view = self.told(|reader| match (view, views) {
            (None, _) => Some(None),
            (Some(leaf), Some(views)) => views.find(reader, leaf).map(Some),
            (Some(leaf), None) => {
                let help = "leave it out; the use of the fragment may have a `view`";
                reader.wrong(leaf, "all that a fragment makes is for the view of its use", help);
                None
            }
        });
        let repeat = match repeat {
            Repeat::Once => Repeat::Once,
            Repeat::Broken => Repeat::Broken,
            Repeat::Times { index, span, count } => {
                let range = 0..=i64::from(MOST_THINGS);
                let count = self.told(|reader| {
                    Context { reader, scope: Scope { symbols, index: None } }.whole(
                        *count,
                        "number of repetitions",
                        range,
                    )
                });
                Repeat::Times { index: index.clone(), span: *span, count }
            }
        };
        let scope = Scope { symbols, index: repeat.index() };
        let value = self.told(|reader| read(&mut Context { reader, scope }));
        Entry { repeat, view, value }
    }

    fn told<T>(&mut self, read: impl FnOnce(&mut Reader) -> Option<T>) -> Told<T> {
        let before = self.reader.errors.len();
        let value = read(self.reader);
        Told { value, mistakes: self.reader.errors.split_off(before) }
    }
}

fn repeated<'t, T>(
    reader: &mut Reader,
    entries: Vec<Option<T>>,
    repeat: impl Fn(&T) -> Option<Leaf<'t>>,
) -> Vec<Option<Repeated<'t, T>>> {
    let mut entry = |fields: T| (Repeat::read(reader, repeat(&fields)), fields);
    entries.into_iter().map(|fields| fields.map(&mut entry)).collect()
}

fn is_list<T>(entry: &Option<Repeated<'_, T>>) -> bool {
    entry.as_ref().is_some_and(|(repeat, _)| repeat.is_list())
}

/// Passes, uses of fragments, and anchors. Passes and uses have their names in common.
fn items<'t>(reader: &mut Reader, list: Option<Leaf<'t>>) -> Vec<Option<Repeated<'t, ItemFields<'t>>>> {
    let Some(leaves) = list.and_then(|list| reader.list(list, "`passes`")) else { return Vec::new() };
    let mut names = Names::new("pass");
    let mut anchors = HashMap::new();
    let mut items = Vec::with_capacity(leaves.len());
    for leaf in leaves {
        let item = if leaf.field("anchor").is_some() {
            anchor(reader, leaf, &mut anchors).map(|()| (None, ItemFields::Anchor))
        } else if leaf.field("use").is_some() {
            let fields: Option<UseFields<'t>> = entry(reader, leaf, "use", "use", &mut names);
            fields.map(|fields| (fields.repeat, ItemFields::Use(Box::new(fields))))
        } else {
            let fields: Option<PassFields<'t>> = entry(reader, leaf, "pass", "pass", &mut names);
            fields.map(|fields| (fields.repeat, ItemFields::Pass(Box::new(fields))))
        };
        items.push(item.map(|(repeat, fields)| (Repeat::read(reader, repeat), fields)));
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
