//! The files that a pipeline is put together of, in the order in which they apply.

use super::files::FoundFile;
use super::loader::{self, Loader};
use super::tables::{self, EXTENDING, EXTENSION, PIPELINE, Sections};
use crate::base::{Code, Diagnostic, FilePath, OutsideChoice, Span};
use crate::frame::change::Action;
use crate::ron::{Reader, Shape, Tree};

/// The role of a file among the files of a pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// A pipeline that stands by itself.
    Whole,
    /// A pipeline that extends another.
    Extending,
    /// An extension, which is added to pipelines.
    Extension,
}

/// A file that a pipeline is put together of.
pub(crate) struct Layer {
    pub(crate) tree: Tree,
    /// The file's path.
    pub(crate) relative: FilePath,
    pub(crate) role: Role,
}

/// A file's turn: first its additions, then its changes.
pub(crate) struct Turn {
    /// The file: an index into [`Layers::list`].
    pub(crate) layer: usize,
    /// The place that names it, if another file does.
    pub(crate) named: Option<Span>,
    pub(crate) adds: bool,
    pub(crate) changes: bool,
}

/// Layers, and their turns in the order in which they apply.
#[derive(Default)]
pub(crate) struct Layers {
    pub(crate) list: Vec<Layer>,
    pub(crate) turns: Vec<Turn>,
}

impl Layer {
    /// A pipeline's own file.
    pub(crate) fn pipeline(tree: Tree, relative: &FilePath) -> Layer {
        let role = if tree.root().field("extends").is_some() { Role::Extending } else { Role::Whole };
        Layer { tree, relative: relative.clone(), role }
    }

    /// Whether it is a pipeline. Reports an extension.
    pub(crate) fn is_pipeline(&self, reader: &mut Reader) -> bool {
        let Shape::Word(word @ "Extension", _) = self.tree.root().shape() else { return true };
        let wrong = Diagnostic::new(
            Code::NO_PIPELINE,
            self.tree.root().span_of(word),
            "this is an extension, and a pipeline is needed here",
        );
        let help = "a pipeline applies it by `extensions: [\"…\"]`";
        reader.report(wrong.help(help).choice(OutsideChoice::Extensions));
        false
    }

    /// Whether it makes a pipeline by itself, unchanged.
    pub(crate) fn is_all(&self) -> bool {
        let root = self.tree.root();
        ["extends", "extensions", "changes"].into_iter().all(|field| root.field(field).is_none())
    }

    /// Its tree alone.
    pub(crate) fn into_tree(self) -> Tree {
        self.tree
    }

    /// The action that naming the file stands for.
    pub(crate) fn action(&self) -> Action {
        let file = self.relative.to_string().into();
        match self.role {
            Role::Extension => Action::Extension { file },
            Role::Whole | Role::Extending => Action::Extends { file },
        }
    }

    /// Tells its fields apart.
    pub(crate) fn sections(&self, reader: &mut Reader) -> Option<Sections<'_>> {
        let (what, table) = match self.role {
            Role::Whole => ("the pipeline", &PIPELINE),
            Role::Extending => ("the pipeline", &EXTENDING),
            Role::Extension => ("the extension", &EXTENSION),
        };
        let sections = Sections::read(reader, self.tree.root(), what, table)?;
        if self.role == Role::Extending
            && let Some(passes) = sections.get(&tables::PASSES)
        {
            let wrong = Diagnostic::new(
                Code::PASSES_WHILE_EXTENDING,
                passes.start(),
                "a pipeline that extends another has no `passes` of its own",
            );
            reader.report(
                wrong.help("move them to where they belong, such as `changes: [Insert(at: End, passes: […])]`"),
            );
        }
        if let Some(about) = sections.get(&tables::ABOUT) {
            reader.words(about, "a description");
        }
        Some(sections)
    }
}

/// Follows `extends` and `extensions` from the pipeline's own file on. `further` extensions come last. `None` if that
/// leads nowhere, which was reported.
pub(crate) fn read(
    reader: &mut Reader,
    loader: &mut Loader<'_>,
    own: Layer,
    further: Vec<FoundFile>,
) -> Option<Layers> {
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
            reader.report(
                Diagnostic::new(Code::EXTENSION_TWICE, span, twice).remark("again here").label(first, "first here"),
            );
            return;
        }
        self.turns.push(Turn { layer: self.list.len(), named: Some(span), adds: true, changes: true });
        self.list.push(extension);
    }
}

/// The pipeline, the pipeline that it extends, and so on, each with the place that names it.
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
        let FoundFile { relative, .. } = &found;
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

fn layer(reader: &mut Reader, loader: &mut Loader<'_>, found: FoundFile, span: Span) -> Option<Layer> {
    let relative = found.relative.clone();
    let tree = loader.tree(reader, found, span, "applied here")?;
    let role = Role::Extension;
    loader::version(reader, tree.root()).then_some(Layer { tree, relative, role })
}
