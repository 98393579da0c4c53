//! `extends`, `extensions` and `changes`: a pipeline that begins with the entries of another.
//!
//! ```text
//! files ─► Layers (their turns) ─► Draft: lists of entries (add, then apply changes) ─► one Tree (build) ─► Document
//! ```
//! Trees are merged before their entries are read. The result is the tree of one pipeline, except that each value keeps its
//! place in the file where it was written.
//!
//! The order: the pipeline that is extended, then extensions as they are listed, then the file's own lists and changes.

use super::change_log::ChangeLog;
use super::draft::Draft;
use super::files::FoundFile;
use super::includes::WantedFiles;
use super::layers::{self, Layer, Layers, Role, Turn};
use super::loader::{self, Loader};
use super::tables::{self, Sections};
use super::{apply, build, removed_settings};
use crate::ron::{Reader, Tree};

/// A pipeline that was put together.
pub(crate) struct ComposedPipeline {
    pub(crate) tree: Tree,
    pub(crate) wanted: Vec<WantedFiles>,
    pub(crate) change_log: ChangeLog,
}

/// Reads the files that the pipeline's own file is put together with, and then `further` extensions. `None` if a mistake
/// that was reported leaves nothing to go on with.
pub(crate) fn read(
    reader: &mut Reader,
    loader: &mut Loader<'_>,
    own: Layer,
    further: Vec<FoundFile>,
) -> Option<ComposedPipeline> {
    if !own.is_pipeline(reader) {
        return None;
    }
    if own.is_all() && further.is_empty() {
        return Some(ComposedPipeline { tree: own.into_tree(), wanted: Vec::new(), change_log: ChangeLog::default() });
    }
    let layers = layers::read(reader, loader, own, further)?;
    compose(reader, &layers)
}

/// Puts layers together, in the order of their turns.
fn compose(reader: &mut Reader, layers: &Layers) -> Option<ComposedPipeline> {
    let sections: Vec<Option<Sections<'_>>> = layers.list.iter().map(|layer| layer.sections(reader)).collect();
    let sections: Vec<Sections<'_>> = sections.into_iter().collect::<Option<_>>()?;
    let base = layers.list.iter().find(|layer| layer.role == Role::Whole)?.tree.root();
    let mut change_log = ChangeLog::default();
    let mut draft = Draft::default();
    let mut wanted = Vec::new();
    for Turn { layer: at, named, adds, changes } in &layers.turns {
        let (layer, sections) = (&layers.list[*at], &sections[*at]);
        if let Some(named) = named {
            change_log.did(*named, layer.action());
        }
        if *adds {
            let paths = loader::paths(reader, sections.get(&tables::INCLUDE), "`include`");
            wanted.push(WantedFiles { from: layer.relative.clone(), paths });
            draft.add(reader, sections, layer.role, &mut change_log);
        }
        if let Some(list) = sections.get(&tables::CHANGES).filter(|_| *changes) {
            apply::changes(reader, &mut draft, list, &mut change_log);
        }
    }
    let removed = std::mem::take(&mut draft.removed_settings);
    removed_settings::everywhere(&mut draft, &removed);
    Some(ComposedPipeline { tree: build::tree(&draft, base), wanted, change_log })
}
