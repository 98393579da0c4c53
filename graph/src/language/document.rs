//! A document: the entries of a pipeline's files. It is lowered for each choice of settings, scene, view and device.

use super::mistakes::{in_order, never_none};
use super::settings_file;
use crate::base::{Diagnostic, FilePath, Sources};
use crate::expression::Value;
use crate::frame::Allowances;
use crate::frame::change::{Change, Kind};
use crate::language::compose::change_log::ChangeLog;
use crate::language::compose::extend::ComposedPipeline;
use crate::language::compose::includes::{self, WantedFiles};
use crate::language::compose::loader::{self, Loader};
use crate::language::compose::origins::Origins;
use crate::language::compose::tables::{self, PIPELINE, Sections};
use crate::language::entries::body::{Lists, Tables};
use crate::language::entries::fragments::Fragments;
use crate::language::entries::pipeline::Entries;
use crate::language::entries::textures::Pictures;
use crate::language::entries::values::optional;
use crate::language::entries::views::ViewEntries;
use crate::language::entries::{presets, settings};
use crate::language::evaluate::{Memory, Purpose, evaluate};
use crate::language::inputs::{Facts, Surroundings};
use crate::language::model::{ChosenValue, Pipeline, Preset, Setting, SettingsFile, in_force, unknown_preset};
use crate::language::scope::{Context, Parameter, Scope};
use crate::ron::{Names, Reader, Tree};
use std::sync::Arc;

/// A pipeline file that was read. Made by [`super::read`], once; [`crate::expand::expand`] puts it together as
/// often as there are choices of settings, scenes, sizes and devices.
#[derive(Debug, Clone)]
pub struct Document {
    /// Settings that a user may choose, in file order.
    pub settings: Vec<Setting>,
    /// Presets that a user may choose, in file order.
    pub presets: Vec<Preset>,
    in_force: Vec<ChosenValue>,
    entries: Arc<Entries>,
    /// Whether an expression may ask for a property of the device.
    asks_device: bool,
    /// The pipeline, as it was put together of its files.
    tree: Tree,
    /// Changes that files made to the pipeline that they extend.
    change_log: ChangeLog,
    origins: Origins,
}

impl Document {
    /// Reads a pipeline that was put together, and finds all mistakes that don't depend on values. `relative` is the path
    /// of the pipeline's own file. Mistakes come beside those that `reader` has already.
    pub(crate) fn read(
        mut reader: Reader,
        loader: &mut Loader<'_>,
        relative: &FilePath,
        ComposedPipeline { tree, mut wanted, change_log }: ComposedPipeline,
    ) -> Result<Document, Vec<Diagnostic>> {
        let mut entries = None;
        if let Some(sections) = Sections::read(&mut reader, tree.root(), "the pipeline", &PIPELINE) {
            let (names, settings) = settings::list(&mut reader, sections.get(&tables::SETTINGS));
            let presets = presets::presets(&mut reader, sections.get(&tables::PRESETS), &settings);
            let paths = loader::paths(&mut reader, sections.get(&tables::INCLUDE), "`include`");
            wanted.push(WantedFiles { from: relative.clone(), paths });
            let included = includes::read(&mut reader, loader, wanted);
            loader.look(&mut reader, sections.get(&tables::TEXTURES));
            loader.look_in_fragments(&mut reader, tree.root());
            let removed_view = change_log.changes.iter().find(|change| change.removes(Kind::View));
            let read =
                read_entries(&mut reader, (names, &settings), &sections, &included, removed_view, &loader.pictures);
            let asks_device = [&tree].into_iter().chain(&included).any(|tree| tree.mentions("device."));
            entries = Some((read, settings, presets, asks_device));
        }
        let origins = std::mem::take(&mut loader.origins);
        if let Some((entries, settings, presets, asks_device)) = entries {
            let values = settings.iter().map(|setting| Some(setting.as_ref()?.kind.default().into())).collect();
            let allows = Allowances::default();
            let surroundings = Surroundings {
                facts: Facts::UNKNOWN,
                extent: [1920, 1080],
                eyes: 1,
                allows,
                device: None,
                reads: None,
            };
            evaluate(&mut reader, &entries, values, &surroundings, Purpose::Check, None);
            let settings: Option<Vec<Setting>> = settings.into_iter().collect();
            if let (Some(settings), Some(presets)) = (settings, presets.into_iter().collect())
                && reader.errors.is_empty()
            {
                let (in_force, entries) = (in_force(&settings, None, &[]), Arc::new(entries));
                return Ok(Document { settings, presets, in_force, entries, asks_device, tree, change_log, origins });
            }
        }
        change_log.tell(&tree, &mut reader.errors);
        origins.tell(&mut reader.errors);
        Err(never_none(reader.errors))
    }

    /// Reads a settings file's text, which is added to `sources`: those that this document was read into. `shown` and
    /// `relative` are as in [`read`](super::read).
    ///
    /// # Errors
    /// Everything that is wrong with the file by itself, and with it for this pipeline.
    pub fn read_settings(
        &self,
        sources: &mut Sources,
        shown: &str,
        relative: &str,
        text: String,
    ) -> Result<SettingsFile, Vec<Diagnostic>> {
        settings_file::read(sources, (shown, relative), text, &self.settings, &self.presets)
    }

    /// Applies a preset and settings files, in place of those that were applied before. One preset at most is in force:
    /// `preset`, else that of the last file that names one. It is stronger than defaults; then come the values of the
    /// files, of which later ones are stronger; strongest is [`Inputs::set`](crate::expand::Inputs::set).
    ///
    /// # Errors
    /// If there is no preset of that name.
    pub fn choose(&mut self, preset: Option<&str>, files: &[SettingsFile]) -> Result<(), Diagnostic> {
        let preset = match preset {
            Some(name) => {
                let found = self.presets.iter().find(|preset| *preset.name.text == *name);
                Some(found.ok_or_else(|| unknown_preset(name, &self.presets))?)
            }
            None => files.iter().rev().find_map(|file| file.preset).and_then(|preset| self.presets.get(preset)),
        };
        self.in_force = in_force(&self.settings, preset, files);
        Ok(())
    }

    /// The value of every setting, in their order, as [`Document::choose`] left it; at first defaults.
    #[must_use]
    pub fn in_force(&self) -> &[ChosenValue] {
        &self.in_force
    }

    /// Whether an expression may ask for a property of the device.
    #[must_use]
    pub fn asks_device(&self) -> bool {
        self.asks_device
    }

    /// Evaluates the pipeline for values of its settings, in their order, and for surroundings.
    ///
    /// # Errors
    /// Everything that is wrong with the file, and expressions that have no value or none that is allowed.
    pub fn lower(&self, values: &[Value], surroundings: &Surroundings<'_>) -> Result<Pipeline, Vec<Diagnostic>> {
        self.lower_again(values, surroundings, None)
    }

    /// As [`Document::lower`], with what `memory` has kept of earlier evaluations of this document.
    pub(crate) fn lower_again(
        &self,
        values: &[Value],
        surroundings: &Surroundings<'_>,
        mut memory: Option<&mut Memory>,
    ) -> Result<Pipeline, Vec<Diagnostic>> {
        memory.iter_mut().for_each(|memory| memory.begin(&self.entries));
        let mut reader = Reader::default();
        let values = values.iter().map(|value| Some(value.clone().into())).collect();
        match evaluate(&mut reader, &self.entries, values, surroundings, Purpose::Pipeline, memory) {
            Some(pipeline) if reader.errors.is_empty() => {
                let removed = self.change_log.removed_passes().collect();
                Ok(Pipeline { removed, ..pipeline })
            }
            _ => {
                self.tell_origins(&mut reader.errors);
                Err(in_order(never_none(reader.errors)))
            }
        }
    }

    /// Changes that files made to the pipeline that they extend, in the order in which they were made.
    #[must_use]
    pub fn changes(&self) -> &[Change] {
        &self.change_log.changes
    }

    /// Adds the other place to mistakes in changed entries, and to mistakes in files that others brought in.
    pub(crate) fn tell_origins(&self, errors: &mut [Diagnostic]) {
        self.change_log.tell(&self.tree, errors);
        self.origins.tell(errors);
    }
}

/// Reads all entries of a pipeline and of the fragments that it may use.
fn read_entries(
    reader: &mut Reader,
    (names, settings): (Names, &[Option<Setting>]),
    sections: &Sections<'_>,
    included: &[Tree],
    removed_view: Option<&Change>,
    pictures: &Pictures,
) -> Entries {
    let parameters = settings.iter().map(|setting| setting.as_ref().map(Parameter::from)).collect();
    let included = included.iter().filter_map(|tree| tree.root().field("fragments"));
    let fragments = Fragments::read(reader, sections.get(&tables::FRAGMENTS).into_iter().chain(included));
    let lists = Lists {
        textures: sections.get(&tables::TEXTURES),
        images: sections.get(&tables::IMAGES),
        buffers: sections.get(&tables::BUFFERS),
        passes: sections.get(&tables::PASSES),
    };
    let tables = Tables::read(reader, names, parameters, true, lists);
    let scope = Scope { symbols: &tables.symbols, index: None };
    let mut context = Context { reader, scope };
    let views = ViewEntries::read(&mut context, settings, sections.get(&tables::VIEWS), removed_view);
    let depth = optional(sections.get(&tables::DEPTH), |leaf| context.depth_policy(leaf));
    let color = optional(sections.get(&tables::COLOR), |leaf| context.color_policy(leaf));
    let depth_format = optional(sections.get(&tables::DEPTH_FORMAT), |leaf| context.depth_format_policy(leaf));
    let outputs = sections.get(&tables::OUTPUTS).and_then(|leaf| context.outputs(leaf));
    let body = tables.body(reader, Some(&views), &fragments, pictures);
    let fragments = fragments.bodies(reader, pictures);
    Entries { body, fragments, views, depth, color, depth_format, outputs }
}
