//! `fragments`: images, buffers and passes that each use of a fragment makes anew.

use super::body::{self, Body, Lists};
use super::list::entries;
use super::parameters::{self, ParameterFields};
use super::textures;
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

/// A fragment with the fields of its entries.
pub(crate) struct Fragment<'t> {
    pub(crate) name: Option<Name>,
    pub(crate) body: Body<'t>,
}

/// Fragments by name; `None` where one couldn't be told apart.
pub(crate) struct Fragments<'t> {
    pub(crate) names: Names,
    pub(crate) list: Vec<Option<Fragment<'t>>>,
}

impl Fragment<'_> {
    /// Its name; empty if that couldn't be read.
    pub(crate) fn called(&self) -> &str {
        self.name.as_ref().map_or("", |name| &*name.text)
    }
}

impl<'t> Fragments<'t> {
    /// Reads lists of fragments, one after the other.
    pub(crate) fn read(reader: &mut Reader, lists: impl IntoIterator<Item = Leaf<'t>>) -> Fragments<'t> {
        let mut names = Names::new("fragment");
        let mut list = Vec::new();
        for leaf in lists {
            let fields: Vec<Option<FragmentFields<'t>>> =
                entries(reader, Some(leaf), "`fragments`", "fragment", &mut names);
            list.extend(fields.into_iter().map(|fields| fields.map(|fields| fragment(reader, &fields))));
        }
        Fragments { names, list }
    }
}

fn fragment<'t>(reader: &mut Reader, fields: &FragmentFields<'t>) -> Fragment<'t> {
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
    Fragment { name, body: Body::read(reader, names, parameters, false, lists) }
}
