//! `fragments`: images, buffers and passes that belong together, made for whoever uses them.

use super::body::{Body, Lists, entries};
use super::leaf::Leaf;
use super::names::Names;
use super::parameters::{self, Parameter, ParameterFields};
use super::pipeline::Name;
use super::reader::Reader;
use crate::fields;

fields! {
    struct FragmentFields<'src> as "Fragment" {
        name: Leaf<'src>,
        about: Option<Leaf<'src>>,
        parameters: Option<Leaf<'src>>,
        textures: Option<Leaf<'src>>,
        images: Option<Leaf<'src>>,
        buffers: Option<Leaf<'src>>,
        passes: Leaf<'src>,
    }
}

fields! {
    pub(super) struct LibraryFields<'src> as "Fragments" {
        #[expect(dead_code, reason = "read before the others, so that a later version is said first")]
        version: Leaf<'src>,
        pub(super) include: Option<Leaf<'src>>,
        #[expect(dead_code, reason = "read for each choice of settings")]
        fragments: Leaf<'src>,
    }
}

/// A fragment with its entries told apart.
pub(super) struct Fragment<'t> {
    pub(super) name: Option<Name>,
    pub(super) body: Body<'t>,
}

/// Fragments by name; `None` where one couldn't be told apart.
pub(super) struct Fragments<'t> {
    pub(super) names: Names,
    pub(super) list: Vec<Option<Fragment<'t>>>,
}

impl<'t> Fragments<'t> {
    /// Reads lists of fragments, one after the other.
    pub(super) fn read(reader: &mut Reader, lists: impl IntoIterator<Item = Leaf<'t>>) -> Fragments<'t> {
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
    let lower = |fields: Option<ParameterFields<'t>>| fields.and_then(|fields| parameters::lower(reader, &fields));
    let parameters: Vec<Option<Parameter>> = given.into_iter().map(lower).collect();
    let FragmentFields { textures, images, buffers, passes, .. } = *fields;
    let lists = Lists { textures, images, buffers, passes: Some(passes) };
    Fragment { name, body: Body::read(reader, names, parameters, false, lists) }
}
