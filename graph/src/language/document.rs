//! A document: the files of a pipeline, read. It is evaluated for each choice of settings, scene, view and device.

use super::mistakes::{in_order, never_none};
use super::settings_file;
use crate::base::{Diagnostic, FilePath, Sources};
use crate::expression::Value;
use crate::frame::Allowances;
use crate::frame::change::{Change, Kind};
use crate::language::compose::account::Account;
use crate::language::compose::extend::Composed;
use crate::language::compose::includes::{self, Wanted};
use crate::language::compose::loader::{self, Loader};
use crate::language::compose::origins::Origins;
use crate::language::compose::tables::{self, PIPELINE, Sections};
use crate::language::entries::body::{Body, Lists};
use crate::language::entries::fragments::Fragments;
use crate::language::entries::textures::Pictures;
use crate::language::entries::{presets, settings};
use crate::language::evaluate::{Declared, Purpose, evaluate};
use crate::language::inputs::{Facts, Surroundings};
use crate::language::model::{InForce, Pipeline, Preset, Setting, SettingsFile, in_force, unknown_preset};
use crate::language::scope::{DecidedValue, Parameter};
use crate::ron::{Names, Reader, Tree};

/// A pipeline file that was read. Made by [`super::read`], once; [`crate::expand::expand`] puts it together as
/// often as there are choices of settings, scenes, sizes and devices.
#[derive(Debug, Clone)]
pub struct Document {
    /// What a user may choose, in file order.
    pub settings: Vec<Setting>,
    /// What a user may choose at once, in file order.
    pub presets: Vec<Preset>,
    in_force: Vec<InForce>,
    files: Read,
    origins: Origins,
}

/// What was read of the files of a pipeline.
#[derive(Debug, Clone)]
struct Read {
    /// The pipeline.
    tree: Tree,
    /// Files of fragments.
    included: Vec<Tree>,
    /// The pictures that textures name.
    pictures: Pictures,
    /// What files did to the pipeline that they extend.
    account: Account,
}

impl Document {
    /// Finds all that is wrong with what was put together, whatever the values. `relative` is the path of the pipeline's
    /// own file. Mistakes come beside those that `reader` has already.
    pub(crate) fn read(
        mut reader: Reader,
        loader: &mut Loader<'_>,
        relative: &FilePath,
        Composed { tree, mut wanted, account }: Composed,
    ) -> Result<Document, Vec<Diagnostic>> {
        let mut choices = None;
        let mut included = Vec::new();
        if let Some(sections) = Sections::read(&mut reader, tree.root(), "the pipeline", &PIPELINE) {
            let (names, settings) = settings::list(&mut reader, sections.get(&tables::SETTINGS));
            let presets = presets::presets(&mut reader, sections.get(&tables::PRESETS), &settings);
            let paths = loader::paths(&mut reader, sections.get(&tables::INCLUDE), "`include`");
            wanted.push(Wanted { from: relative.clone(), paths });
            included = includes::read(&mut reader, loader, wanted);
            loader.look(&mut reader, sections.get(&tables::TEXTURES));
            loader.look_in_fragments(&mut reader, tree.root());
            choices = Some((names, settings, presets));
        }
        let origins = std::mem::take(&mut loader.origins);
        let files = Read { tree, included, pictures: std::mem::take(&mut loader.pictures), account };
        if let Some((names, settings, presets)) = choices {
            let values =
                settings.iter().map(|setting| setting.as_ref().map(|setting| setting.kind.default())).collect();
            let allows = Allowances::default();
            let surroundings =
                Surroundings { facts: Facts::UNKNOWN, extent: [1920, 1080], eyes: 1, allows, device: None };
            files.evaluate(&mut reader, (names, &settings), values, &surroundings, Purpose::Check);
            let settings: Option<Vec<Setting>> = settings.into_iter().collect();
            if let (Some(settings), Some(presets)) = (settings, presets.into_iter().collect())
                && reader.errors.is_empty()
            {
                let in_force = in_force(&settings, None, &[]);
                return Ok(Document { settings, presets, in_force, files, origins });
            }
        }
        files.account.tell(&files.tree, &mut reader.errors);
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
    pub fn in_force(&self) -> &[InForce] {
        &self.in_force
    }

    /// Whether an expression may ask for a property of the device.
    #[must_use]
    pub fn asks_device(&self) -> bool {
        [&self.files.tree].into_iter().chain(&self.files.included).any(|tree| tree.mentions("device."))
    }

    /// Puts in the values of settings, in their order, and what the pipeline is made for.
    ///
    /// # Errors
    /// Everything that is wrong with the file, and expressions that have no value or none that is allowed.
    pub fn lower(&self, values: &[Value], surroundings: &Surroundings<'_>) -> Result<Pipeline, Vec<Diagnostic>> {
        let mut reader = Reader::default();
        let mut names = Names::new("setting");
        for setting in &self.settings {
            names.give(&mut reader, Some(setting.name.clone()));
        }
        let settings: Vec<Option<Setting>> = self.settings.iter().cloned().map(Some).collect();
        let values = values.iter().cloned().map(Some).collect();
        match self.files.evaluate(&mut reader, (names, &settings), values, surroundings, Purpose::Pipeline) {
            Some(pipeline) if reader.errors.is_empty() => {
                let removed = self.files.account.removed_passes().collect();
                Ok(Pipeline { removed, ..pipeline })
            }
            _ => {
                self.tell_origins(&mut reader.errors);
                Err(in_order(never_none(reader.errors)))
            }
        }
    }

    /// What files did to the pipeline that they extend, in the order in which they did it.
    #[must_use]
    pub fn changes(&self) -> &[Change] {
        &self.files.account.changes
    }

    /// Adds the other place to mistakes in what was changed, and to those in files that others brought in.
    pub(crate) fn tell_origins(&self, errors: &mut [Diagnostic]) {
        self.files.account.tell(&self.files.tree, errors);
        self.origins.tell(errors);
    }
}

impl Read {
    /// Evaluates the pipeline for values of its settings. `None` if errors were reported.
    fn evaluate(
        &self,
        reader: &mut Reader,
        (names, settings): (Names, &[Option<Setting>]),
        values: Vec<Option<Value>>,
        surroundings: &Surroundings<'_>,
        purpose: Purpose,
    ) -> Option<Pipeline> {
        let sections = Sections::read(reader, self.tree.root(), "the pipeline", &PIPELINE)?;
        let parameters = settings.iter().map(|setting| setting.as_ref().map(Parameter::from)).collect();
        let included = self.included.iter().filter_map(|tree| tree.root().field("fragments"));
        let fragments = Fragments::read(reader, sections.get(&tables::FRAGMENTS).into_iter().chain(included));
        let lists = Lists {
            textures: sections.get(&tables::TEXTURES),
            images: sections.get(&tables::IMAGES),
            buffers: sections.get(&tables::BUFFERS),
            passes: sections.get(&tables::PASSES),
        };
        let declared = Declared {
            body: &Body::read(reader, names, parameters, true, lists),
            fragments: &fragments,
            pictures: &self.pictures,
            settings,
            views: sections.get(&tables::VIEWS),
            removed_view: self.account.changes.iter().find(|change| change.removes(Kind::View)),
            depth: sections.get(&tables::DEPTH),
            color: sections.get(&tables::COLOR),
            depth_format: sections.get(&tables::DEPTH_FORMAT),
            outputs: sections.get(&tables::OUTPUTS)?,
        };
        let values = values.into_iter().map(|value| value.map(DecidedValue::from)).collect();
        evaluate(reader, &declared, values, surroundings, purpose)
    }
}
