//! Values are put in: what a file declares becomes flat lists of images, buffers and passes.

use super::{circles, previous, properties};
use crate::base::{Diagnostic, Span};
use crate::frame::ViewIndex;
use crate::frame::change::Change;
use crate::language::entries::body::{AnyImage, Body, Entry, Item};
use crate::language::entries::fragments::Fragments;
use crate::language::entries::repeat::{MOST_THINGS, Repeat};
use crate::language::entries::textures::{self, Pictures};
use crate::language::entries::views::Views;
use crate::language::entries::{buffers, images, outputs, passes, precision, resolves, values};
use crate::language::inputs::Surroundings;
use crate::language::model::{Buffer, Image, Instance, Pass, Pipeline, Setting};
use crate::language::scope::{Block, Checked, Level, Properties, Scope};
use crate::ron::{Leaf, Name, Reader};
use std::cell::Cell;
use std::collections::HashSet;
use std::sync::Arc;

/// What belongs to a whole pipeline alone.
pub(crate) struct Whole<'s, 't> {
    pub(crate) settings: &'s [Option<Setting>],
    pub(crate) views: Option<Leaf<'t>>,
    pub(crate) depth: Option<Leaf<'t>>,
    pub(crate) color: Option<Leaf<'t>>,
    pub(crate) depth_format: Option<Leaf<'t>>,
    /// The first view that is no longer there.
    pub(crate) removed_view: Option<&'s Change>,
    pub(crate) outputs: Leaf<'t>,
}

/// What was lowered so far.
pub(crate) struct Lowering<'a, 't> {
    pub(crate) surroundings: &'a Surroundings<'a>,
    pub(crate) fragments: &'a Fragments<'t>,
    pub(crate) pictures: &'a Pictures,
    pub(crate) views: Views<'a>,
    pub(crate) checked: Checked,
    pub(crate) forgave: Cell<bool>,
    /// Whether what is lowered is off, so that what has no value is no mistake.
    pub(crate) lenient: bool,
    pub(crate) images: Vec<Option<Image>>,
    pub(crate) properties: Vec<Option<Properties>>,
    pub(crate) buffers: Vec<Option<Buffer>>,
    pub(crate) passes: Vec<Option<Pass>>,
    pub(crate) instances: Vec<Instance>,
    /// Fragments that are being put in, by number, and where.
    pub(crate) path: Vec<(usize, Name)>,
    /// Mistakes in fragments that were reported: place and message.
    pub(crate) seen: HashSet<(Span, String)>,
    /// Fragments that were put in, by number.
    pub(crate) used: HashSet<usize>,
    /// Whether the file is only read, for no values in particular: what is repeated never, or nobody knows how often, is
    /// looked at once.
    reading: bool,
    /// Whether what is lowered is thrown away.
    pub(crate) trying: bool,
    made: u32,
    full: bool,
    /// Whether something that was reported has no place in the lists.
    broken: bool,
}

/// Where something is put in: what stands before its name, the view that it is for, and the instance that it belongs to.
#[derive(Clone)]
pub(crate) struct Place {
    pub(crate) prefix: Arc<str>,
    pub(crate) view: ViewIndex,
    pub(crate) instance: Option<u32>,
}

/// How often something stands there.
enum Count {
    Known(u32),
    /// It depends on images whose properties aren't known yet.
    Later,
    /// That was reported.
    Failed,
}

impl<'a, 't> Lowering<'a, 't> {
    pub(crate) fn new(
        surroundings: &'a Surroundings<'a>,
        fragments: &'a Fragments<'t>,
        pictures: &'a Pictures,
        lenient: bool,
    ) -> Self {
        Lowering {
            surroundings,
            fragments,
            pictures,
            views: Views::none(),
            checked: Checked::default(),
            forgave: Cell::new(false),
            lenient,
            images: Vec::new(),
            properties: Vec::new(),
            buffers: Vec::new(),
            passes: Vec::new(),
            instances: Vec::new(),
            path: Vec::new(),
            seen: HashSet::new(),
            used: HashSet::new(),
            reading: false,
            trying: false,
            made: 0,
            full: false,
            broken: false,
        }
    }

    /// One that finds what is wrong with a file whatever the values; what it makes is worth nothing.
    pub(crate) fn reading(
        surroundings: &'a Surroundings<'a>,
        fragments: &'a Fragments<'t>,
        pictures: &'a Pictures,
    ) -> Self {
        Lowering { reading: true, ..Lowering::new(surroundings, fragments, pictures, true) }
    }

    /// The whole pipeline. `None` if errors were reported.
    pub(crate) fn whole(
        mut self,
        reader: &mut Reader,
        body: &Body<'t>,
        mut level: Level,
        Whole { settings, views, depth, color, depth_format, removed_view, outputs }: Whole<'_, 't>,
    ) -> Option<Pipeline> {
        let place = Place { prefix: "".into(), view: ViewIndex::default(), instance: None };
        if let Some(views) = views {
            level.images = vec![Block::Below; body.images.len()];
            level.buffers = vec![Block::Below; body.buffers.len()];
            let scope = self.scope(body, &level, ViewIndex::default(), None);
            self.views = Views::read(reader, &scope, self.surroundings, settings, views, removed_view);
        }
        self.body(reader, body, &mut level, &place);
        circles::find(&self.images, &self.buffers, &mut reader.errors);
        previous::check(&self.images, &self.buffers, &self.passes, &mut reader.errors);
        let scope = self.scope(body, &level, ViewIndex::default(), None);
        let depth = depth.map(|leaf| resolves::policy(reader, &scope, leaf));
        let color = color.map(|leaf| precision::color(reader, &scope, leaf));
        let depth_format = depth_format.map(|leaf| precision::depth(reader, &scope, leaf));
        let outputs = outputs::lower(reader, &scope, outputs);
        if self.reading {
            self.unused(reader);
        }
        let mut seen = HashSet::new();
        reader
            .errors
            .retain(|error| error.labels.first().is_none_or(|at| seen.insert((at.span, error.message.clone()))));
        if self.broken {
            return None;
        }
        Some(Pipeline {
            views: self.views.into_list()?,
            images: self.images.into_iter().collect::<Option<_>>()?,
            buffers: self.buffers.into_iter().collect::<Option<_>>()?,
            passes: self.passes.into_iter().collect::<Option<_>>()?,
            depth: depth.map_or(Some(None), |depth| depth)?,
            color: color.map_or(Some(None), |color| color.map(Some))?,
            depth_format: depth_format.map_or(Some(None), |depth_format| depth_format.map(Some))?,
            outputs: outputs?,
            instances: self.instances,
            removed: Vec::new(),
        })
    }

    /// Everything at one level: images and buffers, then passes.
    pub(crate) fn body(&mut self, reader: &mut Reader, body: &Body<'t>, level: &mut Level, place: &Place) {
        level.images = vec![Block::Below; body.images.len()];
        level.buffers = vec![Block::Below; body.buffers.len()];
        self.things(reader, body, level, place);
        for entry in &body.items {
            self.item(reader, body, level, place, entry.as_ref());
        }
    }

    pub(crate) fn scope<'s>(
        &'s self,
        body: &'s Body<'t>,
        level: &'s Level,
        view: ViewIndex,
        index: Option<(&'s Name, u32)>,
    ) -> Scope<'s> {
        let seen = self.views.seen(view);
        Scope {
            known: &body.known,
            level,
            given: seen.filter(|_| body.known.settings).map_or(&level.given, |seen| &seen.given),
            surroundings: seen.map_or(self.surroundings, |seen| &seen.surroundings),
            properties: &self.properties,
            index,
            checked: &self.checked,
            lenient: self.lenient,
            forgave: &self.forgave,
            early: false,
            view: self.views.name(view),
        }
    }

    /// Numbers images and buffers, and lowers them. A number of repetitions that depends on images waits until those
    /// above are lowered; what stands below isn't known to them then.
    fn things(&mut self, reader: &mut Reader, body: &Body<'t>, level: &mut Level, place: &Place) {
        let images = body.images.len();
        let mut lowered = 0;
        let [mut next_image, mut next_buffer] = [self.images.len(), self.buffers.len()];
        for at in 0..images + body.buffers.len() {
            let (repeat, view) = match at.checked_sub(images) {
                None => body.images[at].as_ref().map(|entry| (&entry.repeat, entry.fields.view())),
                Some(at) => body.buffers[at].as_ref().map(|entry| (&entry.repeat, entry.fields.view)),
            }
            .unzip();
            let view = self.view(reader, body, place, view.flatten()).unwrap_or_default();
            let mut count = self.count(reader, body, level, view, repeat, true);
            if let Count::Later = count {
                self.lower_things(reader, body, level, place, lowered..at);
                lowered = at;
                count = self.count(reader, body, level, view, repeat, false);
            }
            let next = if at < images { &mut next_image } else { &mut next_buffer };
            let block = match (count, u32::try_from(*next)) {
                (Count::Known(count), Ok(first)) => {
                    *next += count as usize;
                    Block::At { first, count }
                }
                _ => Block::Failed,
            };
            match at.checked_sub(images) {
                None => level.images[at] = block,
                Some(at) => level.buffers[at] = block,
            }
        }
        self.lower_things(reader, body, level, place, lowered..images + body.buffers.len());
    }

    fn lower_things(
        &mut self,
        reader: &mut Reader,
        body: &Body<'t>,
        level: &Level,
        place: &Place,
        range: std::ops::Range<usize>,
    ) {
        for at in range {
            match at.checked_sub(body.images.len()) {
                None => self.image(reader, body, level, place, at),
                Some(at) => self.buffer(reader, body, level, place, at),
            }
        }
    }

    fn image(&mut self, reader: &mut Reader, body: &Body<'t>, level: &Level, place: &Place, at: usize) {
        let Block::At { count, .. } = level.images[at] else {
            self.broken = true;
            return;
        };
        let view = body.images[at].as_ref().and_then(|entry| entry.fields.view());
        let view = self.view(reader, body, place, view);
        let mut right = view.is_some();
        let view = view.unwrap_or_default();
        for number in 0..count {
            let before = reader.errors.len();
            let image = body.images[at].as_ref().filter(|_| right).and_then(|entry| {
                let scope = self.scope(body, level, view, indexed(&entry.repeat, number));
                match &entry.fields {
                    AnyImage::Made(fields) => images::lower(reader, &scope, fields),
                    AnyImage::Texture(fields) => textures::lower(reader, &scope, self.pictures, fields),
                }
            });
            let image = image.map(|image| {
                let because = |because: Option<Arc<str>>| because.map(|because| self.views.within(view, because));
                let (size_because, samples_because) = (because(image.size_because), because(image.samples_because));
                Image { size_because, samples_because, ..image }
            });
            let known = image.as_ref().map(|image| properties::of(image, &self.properties, self.extent(view)));
            let known = match known {
                Some(Err(wrong)) => {
                    if !self.lenient {
                        reader.report(wrong);
                    }
                    None
                }
                Some(Ok(known)) => Some(known),
                None => None,
            };
            self.properties.push(known);
            let list = body.known.image_lists[at];
            self.images.push(image.map(|image| {
                let name = full(place, &image.name, list.then_some(number));
                Image { name, view, instance: place.instance, ..image }
            }));
            // What is wrong with one is wrong with all.
            right = reader.errors.len() == before;
        }
    }

    fn buffer(&mut self, reader: &mut Reader, body: &Body<'t>, level: &Level, place: &Place, at: usize) {
        let Block::At { count, .. } = level.buffers[at] else {
            self.broken = true;
            return;
        };
        let view = body.buffers[at].as_ref().and_then(|entry| entry.fields.view);
        let view = self.view(reader, body, place, view);
        let mut right = view.is_some();
        let view = view.unwrap_or_default();
        for number in 0..count {
            let before = reader.errors.len();
            let buffer = body.buffers[at].as_ref().filter(|_| right).and_then(|entry| {
                let scope = self.scope(body, level, view, indexed(&entry.repeat, number));
                buffers::lower(reader, &scope, &entry.fields)
            });
            let list = body.known.buffer_lists[at];
            self.buffers.push(buffer.map(|buffer| {
                let name = full(place, &buffer.name, list.then_some(number));
                Buffer { name, instance: place.instance, ..buffer }
            }));
            right = reader.errors.len() == before;
        }
    }

    /// Passes, or a fragment that is put in.
    fn item(
        &mut self,
        reader: &mut Reader,
        body: &Body<'t>,
        level: &Level,
        place: &Place,
        entry: Option<&Entry<'t, Item<'t>>>,
    ) {
        let Some(entry) = entry else {
            self.passes.push(None);
            return;
        };
        let view = match &entry.fields {
            Item::Pass(fields) => fields.view,
            Item::Use(fields) => fields.view,
            Item::Anchor => return,
        };
        let Some(view) = self.view(reader, body, place, view) else {
            self.passes.push(None);
            return;
        };
        let place = &Place { view, ..place.clone() };
        let Count::Known(count) = self.count(reader, body, level, view, Some(&entry.repeat), false) else {
            self.passes.push(None);
            return;
        };
        for number in 0..count {
            let before = reader.errors.len();
            let index = indexed(&entry.repeat, number);
            let number = entry.repeat.is_list().then_some(number);
            match &entry.fields {
                Item::Pass(fields) => {
                    let pass = passes::lower(reader, &self.scope(body, level, view, index), fields);
                    self.passes.push(pass.map(|pass| {
                        let name = full(place, &pass.name, number);
                        let off = self.off_within(view, pass.off);
                        Pass { name, off, view, instance: place.instance, ..pass }
                    }));
                }
                Item::Use(fields) => self.put_in(reader, body, level, place, (index, number), fields),
                Item::Anchor => {}
            }
            if reader.errors.len() > before || self.full {
                self.passes.push(None);
                break;
            }
        }
    }

    /// How often something stands there; `early` puts off what depends on images.
    fn count(
        &mut self,
        reader: &mut Reader,
        body: &Body<'t>,
        level: &Level,
        view: ViewIndex,
        repeat: Option<&Repeat<'t>>,
        early: bool,
    ) -> Count {
        let (count, span) = match repeat {
            None | Some(Repeat::Once) => (1, None),
            Some(Repeat::Broken) => return Count::Failed,
            Some(Repeat::Times { count, .. }) => {
                let before = reader.errors.len();
                let scope = Scope { early, ..self.scope(body, level, view, None) };
                match values::whole::<u32>(reader, &scope, *count, "number of repetitions", 0..=i64::from(MOST_THINGS))
                {
                    Some(number) => (number.max(u32::from(self.reading)), Some(count.span())),
                    None if reader.errors.len() > before => return Count::Failed,
                    None if early => return Count::Later,
                    None if self.reading => (1, Some(count.span())),
                    None => return Count::Failed,
                }
            }
        };
        if self.makes(reader, count, span.unwrap_or(Span::NONE)) { Count::Known(count) } else { Count::Failed }
    }

    /// Whether there is room for so many more.
    fn makes(&mut self, reader: &mut Reader, count: u32, span: Span) -> bool {
        let made = self.made.saturating_add(count);
        if made <= MOST_THINGS {
            self.made = made;
            return true;
        }
        let known = std::mem::replace(&mut self.full, true);
        if !known && !self.trying {
            let message = "this makes more than 1000000 images, buffers, passes and uses of fragments";
            let used = self.path.last().map(|(_, name)| name.span);
            let at = if span == Span::NONE { used.unwrap_or(span) } else { span };
            reader.report(Diagnostic::new(at, message).help("repeat less, or let fragments use each other less often"));
        }
        false
    }

    pub(crate) const fn is_full(&self) -> bool {
        self.full
    }
}

/// The index and its value, if something is repeated.
fn indexed<'r>(repeat: &'r Repeat<'_>, number: u32) -> Option<(&'r Name, u32)> {
    match repeat {
        Repeat::Times { index, .. } => Some((index, number)),
        Repeat::Once | Repeat::Broken => None,
    }
}

/// The whole name: `glow.down[0]`.
pub(crate) fn full(place: &Place, name: &Name, number: Option<u32>) -> Name {
    let prefix = &place.prefix;
    let text = match number {
        None if prefix.is_empty() => return name.clone(),
        None => format!("{prefix}{}", name.text),
        Some(number) => format!("{prefix}{}[{number}]", name.text),
    };
    Name { text: text.into(), span: name.span }
}
