//! `fragments`: images, buffers and passes that each use of a fragment makes anew.

use super::body::{self, Body, Lists, Tables};
use super::list::entries;
use super::parameters::{self, ParameterFields};
use super::textures::{self, Pictures};
use crate::base::Code;
use crate::fields;
use crate::language::scope::Parameter;
use crate::ron::{FieldTable, Form, Leaf, Names, PlainForm, Reader};

fields! {
    /// A fragment: images, buffers and passes that belong together.
    /// ```ron
    /// (name: "halve", about: "half as large",
    ///     parameters: [(name: "source", value: Image), (name: "target", value: Image)],
    ///     passes: [(name: "shrink", draw: FullScreen("downsample"), sample: {"source": "source"}, color: ["target"])])
    /// ```
    struct FragmentFields<'src> as "Fragment" {
        /// Its name, by which it is used.
        name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// A description for people.
        about: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// The arguments that each use of the fragment gives.
        parameters: Option<Leaf<'src>> => Form::List(&Form::Fields(ParameterFields::<'static>::table)),
        /// The textures, as in a pipeline.
        textures: Option<Leaf<'src>> => textures::TEXTURES,
        /// The images, as in a pipeline.
        images: Option<Leaf<'src>> => body::IMAGES,
        /// The buffers, as in a pipeline.
        buffers: Option<Leaf<'src>> => body::BUFFERS,
        /// The passes, as in a pipeline; other fragments may be used, not in a circle.
        passes: Leaf<'src> => body::ITEMS,
    }
}

/// A list of fragments.
pub(crate) const FRAGMENTS: Form = Form::List(&Form::Fields(FragmentFields::<'static>::table));

/// Fragments by name: the field tables of their entries, or the entries. `None` where one couldn't be told apart.
pub(crate) struct Fragments<T> {
    pub(crate) names: Names,
    pub(crate) list: Vec<Option<T>>,
}

impl<T> Fragments<T> {
    /// The fragment of this number, if it could be told apart.
    pub(crate) fn get(&self, at: usize) -> Option<&T> {
        self.list.get(at)?.as_ref()
    }

    /// The name of the fragment of this number; empty if it couldn't be read.
    pub(crate) fn called(&self, at: usize) -> &str {
        self.names.get(at).map_or("", |name| &*name.text)
    }
}

impl<'t> Fragments<Tables<'t>> {
    /// Tells the fields of fragments apart, list by list.
    pub(crate) fn read(reader: &mut Reader, lists: impl IntoIterator<Item = Leaf<'t>>) -> Self {
        let mut names = Names::new("fragment", Code::UNKNOWN_FRAGMENT);
        let mut list = Vec::new();
        for leaf in lists {
            let fields: Vec<Option<FragmentFields<'t>>> =
                entries(reader, Some(leaf), "`fragments`", "fragment", &mut names);
            list.extend(fields.into_iter().map(|fields| fields.map(|fields| tables(reader, &fields))));
        }
        Fragments { names, list }
    }

    /// Reads the entries of all fragments; they may use each other.
    pub(crate) fn bodies(self, reader: &mut Reader, pictures: &Pictures) -> Fragments<Body> {
        let mut body = |tables: &Tables<'t>| tables.body(reader, None, &self, pictures);
        let list = self.list.iter().map(|tables| tables.as_ref().map(&mut body)).collect();
        Fragments { names: self.names, list }
    }
}

fn tables<'t>(reader: &mut Reader, fields: &FragmentFields<'t>) -> Tables<'t> {
    reader.name(fields.name, "a fragment");
    if let Some(about) = fields.about {
        reader.words(about, "a description");
    }
    let mut names = Names::new("parameter", Code::UNKNOWN_PARAMETER);
    let given: Vec<Option<ParameterFields<'t>>> =
        entries(reader, fields.parameters, "`parameters`", "parameter", &mut names);
    let read = |fields: Option<ParameterFields<'t>>| fields.and_then(|fields| parameters::parameter(reader, &fields));
    let parameters: Vec<Option<Parameter>> = given.into_iter().map(read).collect();
    let FragmentFields { textures, images, buffers, passes, .. } = *fields;
    let lists = Lists { textures, images, buffers, passes: Some(passes) };
    Tables::read(reader, names, parameters, false, lists)
}
