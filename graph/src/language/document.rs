//! A pipeline file that was read: what a user may choose, and all that is needed to put the rest together for a choice.

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
use crate::language::compose::tables::{PIPELINE, Section, Sections};
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
    tree: Tree,
    /// Files of fragments.
    included: Vec<Tree>,
    origins: Origins,
    /// The pictures that textures name.
    pictures: Pictures,
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
        let mut document = None;
        if let Some(sections) = Sections::read(&mut reader, tree.root(), "the pipeline", &PIPELINE) {
            let (names, settings) = settings::list(&mut reader, sections.get(Section::Settings));
            let presets = presets::presets(&mut reader, sections.get(Section::Presets), &settings);
            let paths = loader::paths(&mut reader, sections.get(Section::Include), "`include`");
            wanted.push(Wanted { from: relative.clone(), paths });
            let included = includes::read(&mut reader, loader, wanted);
            loader.look(&mut reader, sections.get(Section::Textures));
            loader.look_in_fragments(&mut reader, tree.root());
            let values =
                settings.iter().map(|setting| setting.as_ref().map(|setting| setting.kind.default())).collect();
            let allows = Allowances::default();
            let surroundings =
                Surroundings { facts: Facts::UNKNOWN, extent: [1920, 1080], eyes: 1, allows, device: None };
            let files = Files {
                sections,
                included: &included,
                pictures: &loader.pictures,
                removed_view: account.changes.iter().find(|change| change.removes(Kind::View)),
            };
            pipeline(&mut reader, files, (names, &settings), values, &surroundings, Purpose::Check);
            let settings: Option<Vec<Setting>> = settings.into_iter().collect();
            document = settings.zip(presets.into_iter().collect()).map(|both| (both, included));
        }
        let origins = std::mem::take(&mut loader.origins);
        let pictures = std::mem::take(&mut loader.pictures);
        match document {
            Some(((settings, presets), included)) if reader.errors.is_empty() => {
                let in_force = in_force(&settings, None, &[]);
                Ok(Document { settings, presets, in_force, tree, included, origins, pictures, account })
            }
            _ => {
                account.tell(&tree, &mut reader.errors);
                origins.tell(&mut reader.errors);
                Err(never_none(reader.errors))
            }
        }
    }

    /// Reads a settings file's text, which is added to `sources`: those that this document was read into. `shown` and
    /// `relative` are as in [`describe::read`](super::read).
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

    /// Whether what it comes to may depend on the device.
    #[must_use]
    pub fn asks_device(&self) -> bool {
        [&self.tree].into_iter().chain(&self.included).any(|tree| tree.mentions("device."))
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
        let sections = Sections::read(&mut reader, self.tree.root(), "the pipeline", &PIPELINE);
        let pipeline = sections.and_then(|sections| {
            let files = Files {
                sections,
                included: &self.included,
                pictures: &self.pictures,
                removed_view: self.changes().iter().find(|change| change.removes(Kind::View)),
            };
            pipeline(&mut reader, files, (names, &settings), values, surroundings, Purpose::Pipeline)
        });
        match pipeline {
            Some(pipeline) if reader.errors.is_empty() => {
                let removed = self.account.removed_passes().collect();
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
        &self.account.changes
    }

    /// Adds the other place to mistakes in what was changed, and to those in files that others brought in.
    pub(crate) fn tell_origins(&self, errors: &mut [Diagnostic]) {
        self.account.tell(&self.tree, errors);
        self.origins.tell(errors);
    }
}

/// What is read of the files of a pipeline.
#[derive(Clone, Copy)]
struct Files<'t> {
    /// The fields of the pipeline.
    sections: Sections<'t>,
    /// Files of fragments.
    included: &'t [Tree],
    /// The pictures that textures name.
    pictures: &'t Pictures,
    removed_view: Option<&'t Change>,
}

/// Evaluates a pipeline for values of its settings. `None` if errors were reported.
fn pipeline(
    reader: &mut Reader,
    Files { sections, included, pictures, removed_view }: Files<'_>,
    (names, settings): (Names, &[Option<Setting>]),
    values: Vec<Option<Value>>,
    surroundings: &Surroundings<'_>,
    purpose: Purpose,
) -> Option<Pipeline> {
    let parameters = settings.iter().map(|setting| setting.as_ref().map(Parameter::from)).collect();
    let included = included.iter().filter_map(|tree| tree.root().field("fragments"));
    let fragments = Fragments::read(reader, sections.get(Section::Fragments).into_iter().chain(included));
    let lists = Lists {
        textures: sections.get(Section::Textures),
        images: sections.get(Section::Images),
        buffers: sections.get(Section::Buffers),
        passes: sections.get(Section::Passes),
    };
    let declared = Declared {
        body: &Body::read(reader, names, parameters, true, lists),
        fragments: &fragments,
        pictures,
        settings,
        views: sections.get(Section::Views),
        removed_view,
        depth: sections.get(Section::Depth),
        color: sections.get(Section::Color),
        depth_format: sections.get(Section::DepthFormat),
        outputs: sections.get(Section::Outputs)?,
    };
    let values = values.into_iter().map(|value| value.map(DecidedValue::from)).collect();
    evaluate(reader, &declared, values, surroundings, purpose)
}
