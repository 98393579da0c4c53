//! The files that a pipeline is put together of, in the order in which they apply.

use super::apply::CHANGES;
use crate::base::{Diagnostic, FilePath, OutsideChoice, Span};
use crate::fields;
use crate::frame::change::Action;
use crate::language::document::{INCLUDE, PRESETS, PipelineFields, SETTINGS, VERSION};
use crate::language::fragments::FRAGMENTS;
use crate::language::loader::{self, Loader};
use crate::language::{Found, body, outputs, precision, resolves, textures, views};
use crate::ron::{Leaf, Plain, Reader, Shape, Tree};

fields! {
    /// A pipeline that extends another: it begins with what that says.
    ///
    /// ```ron
    /// Pipeline(version: 1, extends: "forward.ron", changes: [Remove(pass: "transparent")])
    /// ```
    pub(in crate::language) struct ExtendingFields<'src> as "Pipeline" {
        /// The version of the language: 1.
        #[expect(dead_code, reason = "read before the others, so that a later version is said first")]
        version: Leaf<'src> => VERSION,
        /// The file of the pipeline that it begins with.
        #[expect(dead_code, reason = "followed before the others are read")]
        extends: Leaf<'src> => Form::Plain(Plain::Text),
        /// Files of extensions, which are applied in their order.
        #[expect(dead_code, reason = "followed before the others are read")]
        extensions: Option<Leaf<'src>> => INCLUDE,
        /// Files with fragments.
        include: Option<Leaf<'src>> => INCLUDE,
        /// Settings that are added.
        settings: Option<Leaf<'src>> => SETTINGS,
        /// Presets that are added.
        presets: Option<Leaf<'src>> => PRESETS,
        /// Views that are added.
        views: Option<Leaf<'src>> => views::VIEWS,
        /// Fragments that are added.
        fragments: Option<Leaf<'src>> => FRAGMENTS,
        /// Textures that are added.
        textures: Option<Leaf<'src>> => textures::TEXTURES,
        /// Images that are added.
        images: Option<Leaf<'src>> => body::IMAGES,
        /// Buffers that are added.
        buffers: Option<Leaf<'src>> => body::BUFFERS,
        /// None: passes are inserted by `changes`.
        passes: Option<Leaf<'src>> => body::ITEMS,
        /// Outputs in place of those that there are.
        outputs: Option<Leaf<'src>> => outputs::OUTPUTS,
        /// How several samples of depth become one value, in place of what there is.
        depth: Option<Leaf<'src>> => resolves::DEPTH,
        /// What `Color` becomes, in place of what there is.
        color: Option<Leaf<'src>> => precision::COLOR,
        /// What `Depth` and `DepthStencil` become, in place of what there is.
        depth_format: Option<Leaf<'src>> => precision::DEPTH,
        /// What is changed of all that.
        changes: Option<Leaf<'src>> => CHANGES,
    }
}

fields! {
    /// An extension: what may be added to pipelines.
    ///
    /// ```ron
    /// Extension(version: 1, about: "without glass", changes: [Remove(pass: "transparent")])
    /// ```
    pub(in crate::language) struct ExtensionFields<'src> as "Extension" {
        /// The version of the language: 1.
        #[expect(dead_code, reason = "read before the others, so that a later version is said first")]
        version: Leaf<'src> => VERSION,
        /// A description for people.
        about: Option<Leaf<'src>> => Form::Plain(Plain::Text),
        /// Files with fragments.
        include: Option<Leaf<'src>> => INCLUDE,
        /// Settings that are added.
        settings: Option<Leaf<'src>> => SETTINGS,
        /// Presets that are added.
        presets: Option<Leaf<'src>> => PRESETS,
        /// Views that are added.
        views: Option<Leaf<'src>> => views::VIEWS,
        /// Fragments that are added.
        fragments: Option<Leaf<'src>> => FRAGMENTS,
        /// Textures that are added.
        textures: Option<Leaf<'src>> => textures::TEXTURES,
        /// Images that are added.
        images: Option<Leaf<'src>> => body::IMAGES,
        /// Buffers that are added.
        buffers: Option<Leaf<'src>> => body::BUFFERS,
        /// How several samples of depth become one value, in place of what there is.
        depth: Option<Leaf<'src>> => resolves::DEPTH,
        /// What `Color` becomes, in place of what there is.
        color: Option<Leaf<'src>> => precision::COLOR,
        /// What `Depth` and `DepthStencil` become, in place of what there is.
        depth_format: Option<Leaf<'src>> => precision::DEPTH,
        /// What is changed.
        changes: Option<Leaf<'src>> => CHANGES,
    }
}

/// What a file is to the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// A pipeline that stands by itself.
    Whole,
    /// A pipeline that begins with what another says.
    Extending,
    /// What is added to pipelines.
    Extension,
}

/// A file that a pipeline is put together of.
pub(in crate::language) struct Layer {
    pub(super) tree: Tree,
    /// Which file it is.
    pub(super) relative: FilePath,
    pub(super) role: Role,
}

/// A file's turn: first what it adds, then what it changes.
pub(super) struct Turn {
    /// Which file.
    pub(super) layer: usize,
    /// Where it is named, if another names it.
    pub(super) named: Option<Span>,
    pub(super) adds: bool,
    pub(super) changes: bool,
}

/// What a file says; every list may be absent.
#[derive(Clone, Copy, Default)]
pub(super) struct Said<'t> {
    pub(super) include: Option<Leaf<'t>>,
    pub(super) settings: Option<Leaf<'t>>,
    pub(super) presets: Option<Leaf<'t>>,
    pub(super) views: Option<Leaf<'t>>,
    pub(super) fragments: Option<Leaf<'t>>,
    pub(super) textures: Option<Leaf<'t>>,
    pub(super) images: Option<Leaf<'t>>,
    pub(super) buffers: Option<Leaf<'t>>,
    pub(super) passes: Option<Leaf<'t>>,
    pub(super) outputs: Option<Leaf<'t>>,
    pub(super) depth: Option<Leaf<'t>>,
    pub(super) color: Option<Leaf<'t>>,
    pub(super) depth_format: Option<Leaf<'t>>,
    pub(super) changes: Option<Leaf<'t>>,
}

/// Layers, and their turns in the order in which they apply.
#[derive(Default)]
pub(super) struct Layers {
    pub(super) list: Vec<Layer>,
    pub(super) turns: Vec<Turn>,
}

impl Layer {
    /// A pipeline's own file.
    pub(in crate::language) fn pipeline(tree: Tree, relative: &FilePath) -> Layer {
        let role = if tree.root().field("extends").is_some() { Role::Extending } else { Role::Whole };
        Layer { tree, relative: relative.clone(), role }
    }

    /// Whether it isn't an extension, which would be no pipeline. Reports that.
    pub(super) fn is_pipeline(&self, reader: &mut Reader) -> bool {
        let Shape::Word(word @ "Extension", _) = self.tree.root().shape() else { return true };
        let wrong =
            Diagnostic::new(self.tree.root().span_of(word), "this is an extension, and a pipeline is needed here");
        let help = "a pipeline applies it by `extensions: [\"…\"]`";
        reader.report(wrong.help(help).choice(OutsideChoice::Extensions));
        false
    }

    /// Whether it makes a pipeline by itself, unchanged.
    pub(super) fn is_all(&self) -> bool {
        let root = self.tree.root();
        ["extends", "extensions", "changes"].into_iter().all(|field| root.field(field).is_none())
    }

    /// Its tree alone.
    pub(super) fn into_tree(self) -> Tree {
        self.tree
    }

    /// What naming it comes to.
    pub(super) fn action(&self) -> Action {
        let file = self.relative.to_string().into();
        match self.role {
            Role::Extension => Action::Extension { file },
            Role::Whole | Role::Extending => Action::Extends { file },
        }
    }

    /// Tells its lists apart.
    pub(super) fn said(&self, reader: &mut Reader) -> Option<Said<'_>> {
        // The lists of those names, and no others.
        macro_rules! common {
            ($all:ident: $($list:ident)*) => { Said { $($list: $all.$list,)* ..Said::default() } };
        }
        let root = self.tree.root();
        Some(match self.role {
            Role::Whole => {
                let all: PipelineFields<'_> = reader.read(root, "the pipeline")?;
                let [images, passes, outputs] = [all.images, all.passes, all.outputs].map(Some);
                let common = common!(all: include settings presets views fragments textures buffers depth color depth_format changes);
                Said { images, passes, outputs, ..common }
            }
            Role::Extending => {
                let all: ExtendingFields<'_> = reader.read(root, "the pipeline")?;
                if let Some(passes) = all.passes {
                    let wrong =
                        Diagnostic::new(passes.start(), "a pipeline that extends another has no `passes` of its own");
                    reader.report(
                        wrong.help("move them to where they belong, such as `changes: [Insert(at: End, passes: […])]`"),
                    );
                }
                common!(all: include settings presets views fragments textures images buffers outputs depth color depth_format changes)
            }
            Role::Extension => {
                let all: ExtensionFields<'_> = reader.read(root, "the extension")?;
                if let Some(about) = all.about {
                    reader.words(about, "a description");
                }
                common!(all: include settings presets views fragments textures images buffers depth color depth_format changes)
            }
        })
    }
}

/// Follows `extends` and `extensions` from the pipeline's own file on. `further` extensions come last. `None` if that
/// leads nowhere, which was reported.
pub(super) fn read(reader: &mut Reader, loader: &mut Loader<'_>, own: Layer, further: Vec<Found>) -> Option<Layers> {
    let pipelines = pipelines(reader, loader, own)?;
    let mut layers = Layers::default();
    let mut whole = true;
    for (pipeline, named) in pipelines.into_iter().rev() {
        let is_base = pipeline.role == Role::Whole;
        let root = pipeline.tree.root();
        let extensions = loader::paths(reader, root.field("extensions"), "`extensions`");
        let (from, at) = (pipeline.relative.clone(), layers.list.len());
        layers.list.push(pipeline);
        if is_base {
            layers.turns.push(Turn { layer: at, named, adds: true, changes: false });
        }
        for (path, span) in extensions {
            match extension(reader, loader, (&from, &path, span)) {
                Some(extension) => layers.apply(reader, extension, span),
                None => whole = false,
            }
        }
        let named = named.filter(|_| !is_base);
        layers.turns.push(Turn { layer: at, named, adds: !is_base, changes: true });
    }
    for found in further {
        match layer(reader, loader, found, Span::NONE) {
            Some(extension) => {
                let span = extension.tree.root().start();
                layers.apply(reader, extension, span);
            }
            None => whole = false,
        }
    }
    whole.then_some(layers)
}

impl Layers {
    fn apply(&mut self, reader: &mut Reader, extension: Layer, span: Span) {
        let same = |turn: &&Turn| self.list[turn.layer].relative == extension.relative;
        if let Some(first) = self.turns.iter().find(same).and_then(|turn| turn.named) {
            let twice = format!("`{}` is applied twice", extension.relative);
            reader.report(Diagnostic::new(span, twice).remark("again here").label(first, "first here"));
            return;
        }
        self.turns.push(Turn { layer: self.list.len(), named: Some(span), adds: true, changes: true });
        self.list.push(extension);
    }
}

/// The pipeline, what it extends, what that extends, and so on, each with the place that names it.
fn pipelines(reader: &mut Reader, loader: &mut Loader<'_>, own: Layer) -> Option<Vec<(Layer, Option<Span>)>> {
    let mut path = vec![(own.relative.clone(), Span::NONE)];
    let mut pipelines = vec![(own, None)];
    loop {
        let (last, _) = pipelines.last()?;
        let Some(extends) = last.tree.root().field("extends") else { return Some(pipelines) };
        let (named, span) = loader::path(reader, extends)?;
        let found = loader.find(reader, &last.relative, &named, span)?;
        if let Some(first) = path.iter().position(|(outer, _)| *outer == found.relative) {
            loader::circle(reader, &path, first, span, ("extend", "extended"));
            return None;
        }
        let Found { relative, .. } = &found;
        let relative = relative.clone();
        let tree = loader.tree(reader, found, span, "extended here")?;
        if !loader::version(reader, tree.root()) {
            return None;
        }
        let pipeline = Layer::pipeline(tree, &relative);
        if !pipeline.is_pipeline(reader) {
            return None;
        }
        path.push((relative, span));
        pipelines.push((pipeline, Some(span)));
    }
}

fn extension(
    reader: &mut Reader,
    loader: &mut Loader<'_>,
    (from, path, span): (&FilePath, &str, Span),
) -> Option<Layer> {
    let found = loader.find(reader, from, path, span)?;
    layer(reader, loader, found, span)
}

fn layer(reader: &mut Reader, loader: &mut Loader<'_>, found: Found, span: Span) -> Option<Layer> {
    let relative = found.relative.clone();
    let tree = loader.tree(reader, found, span, "applied here")?;
    let role = Role::Extension;
    loader::version(reader, tree.root()).then_some(Layer { tree, relative, role })
}
