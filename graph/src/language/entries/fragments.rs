//! `fragments`: images, buffers and passes that each use of a fragment makes anew.

use super::body::{self, Body, Lists, Tables};
use super::list::entries;
use super::parameters::{self, ParameterFields};
use super::textures::{self, Pictures};
use crate::fields;
use crate::language::scope::Parameter;
use crate::ron::{Described, Form, Leaf, Name, Names, Plain, Reader};

fields! {
    /// A fragment: images, buffers and passes that belong together.
    /// ```ron
    /// (name: "halve", about: "half as large",
    ///     parameters: [(name: "source", value: Image), (name: "target", value: Image)],
    ///     passes: [(name: "shrink", draw: FullScreen("downsample"), sample: {"source": "source"}, color: ["target"])])
    /// ```
    struct FragmentFields<'src> as "Fragment" {
        /// Its name, by which it is used.
        name: Leaf<'src> => Form::Plain(Plain::Name),
        /// A description for people.
        about: Option<Leaf<'src>> => Form::Plain(Plain::Text),
        /// What whoever uses it gives it.
        parameters: Option<Leaf<'src>> => Form::List(&Form::Fields(ParameterFields::<'static>::table)),
        /// As those of a pipeline.
        textures: Option<Leaf<'src>> => textures::TEXTURES,
        /// As those of a pipeline.
        images: Option<Leaf<'src>> => body::IMAGES,
        /// As those of a pipeline.
        buffers: Option<Leaf<'src>> => body::BUFFERS,
        /// As those of a pipeline; other fragments may be used, not in a circle.
        passes: Leaf<'src> => body::ITEMS,
    }
}

/// A list of fragments.
pub(crate) const FRAGMENTS: Form = Form::List(&Form::Fields(FragmentFields::<'static>::table));

/// A fragment.
pub(crate) struct Fragment {
    pub(crate) name: Option<Name>,
    pub(crate) body: Body,
}

/// A fragment with the field tables of its entries.
pub(crate) struct FragmentTable<'t> {
    name: Option<Name>,
    pub(crate) tables: Tables<'t>,
}

/// Fragments by name, with the field tables of their entries; `None` where one couldn't be told apart.
pub(crate) struct FragmentTables<'t> {
    pub(crate) names: Names,
    pub(crate) list: Vec<Option<FragmentTable<'t>>>,
}

impl Fragment {
    /// Its name; empty if that couldn't be read.
    pub(crate) fn called(&self) -> &str {
        self.name.as_ref().map_or("", |name| &*name.text)
    }
}

impl FragmentTable<'_> {
    /// Its name; empty if that couldn't be read.
    pub(crate) fn called(&self) -> &str {
        self.name.as_ref().map_or("", |name| &*name.text)
    }
}

impl<'t> FragmentTables<'t> {
    /// Tells the fields of fragments apart: of lists of them, one after the other.
    pub(crate) fn read(reader: &mut Reader, lists: impl IntoIterator<Item = Leaf<'t>>) -> FragmentTables<'t> {
        let mut names = Names::new("fragment");
        let mut list = Vec::new();
        for leaf in lists {
            let fields: Vec<Option<FragmentFields<'t>>> =
                entries(reader, Some(leaf), "`fragments`", "fragment", &mut names);
            list.extend(fields.into_iter().map(|fields| fields.map(|fields| fragment(reader, &fields))));
        }
        FragmentTables { names, list }
    }

    /// Reads the entries of all fragments; they may use each other.
    pub(crate) fn fragments(&self, reader: &mut Reader, pictures: &Pictures) -> Vec<Option<Fragment>> {
        let mut read = |table: &FragmentTable<'_>| {
            let body = table.tables.body(reader, None, self, pictures);
            Fragment { name: table.name.clone(), body }
        };
        self.list.iter().map(|table| table.as_ref().map(&mut read)).collect()
    }
}

fn fragment<'t>(reader: &mut Reader, fields: &FragmentFields<'t>) -> FragmentTable<'t> {
    let name = reader.name(fields.name, "a fragment");
    if let Some(about) = fields.about {
        reader.words(about, "a description");
    }
    let mut names = Names::new("parameter");
    let given: Vec<Option<ParameterFields<'t>>> =
        entries(reader, fields.parameters, "`parameters`", "parameter", &mut names);
    let read = |fields: Option<ParameterFields<'t>>| fields.and_then(|fields| parameters::parameter(reader, &fields));
    let parameters: Vec<Option<Parameter>> = given.into_iter().map(read).collect();
    let FragmentFields { textures, images, buffers, passes, .. } = *fields;
    let lists = Lists { textures, images, buffers, passes: Some(passes) };
    FragmentTable { name, tables: Tables::read(reader, names, parameters, false, lists) }
}
