//! A pipeline file that was read: what a user may choose, and all that is needed to put the rest together for a choice.

use super::body::{self, Body, Lists, entries};
use super::choices::{self, InForce, Preset, PresetFields, SettingsFile};
use super::extend::{Account, CHANGES, Composed};
use super::fragments::{FRAGMENTS, Fragments};
use super::includes::{self, Wanted};
use super::loader::{self, Loader};
use super::lower::Lowering;
use super::mistakes::{in_order, never_none};
use super::origins::Origins;
use super::parameters::Parameter;
use super::pipeline::{Pipeline, Setting};
use super::scope::{Given, Level};
use super::settings::{self, SettingFields};
use super::surroundings::Surroundings;
use super::textures::{self, Pictures};
use super::{Facts, outputs, precision, resolves, views};
use crate::base::{Diagnostic, FilePath, Sources};
use crate::expression::Value;
use crate::fields;
use crate::frame::Allowances;
use crate::frame::change::{Change, Kind};
use crate::ron::{Described, Form, Leaf, Names, Plain, Reader, Tree};

fields! {
    /// A pipeline: what a frame is made of.
    /// ```ron
    /// Pipeline(
    ///     version: 1,
    ///     images: [(name: "screen", format: Output, size: Output)],
    ///     passes: [(name: "sky", draw: Sky, color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))])],
    ///     outputs: ["screen"],
    /// )
    /// ```
    pub(super) struct PipelineFields<'src> as "Pipeline" {
        /// The version of the language: 1.
        #[expect(dead_code, reason = "read before the others, so that a later version is said first")]
        version: Leaf<'src> => VERSION,
        /// Files of extensions, which are applied in their order.
        #[expect(dead_code, reason = "followed before the others are read")]
        extensions: Option<Leaf<'src>> => INCLUDE,
        /// Files with fragments, each read once however often it is named.
        pub(super) include: Option<Leaf<'src>> => INCLUDE,
        /// What a user may choose.
        pub(super) settings: Option<Leaf<'src>> => SETTINGS,
        /// Values of several settings under one name.
        pub(super) presets: Option<Leaf<'src>> => PRESETS,
        /// What the frame shows, from where and how large, the main view first; one view of the frame's size if left out.
        pub(super) views: Option<Leaf<'src>> => views::VIEWS,
        /// What is written once and used often.
        pub(super) fragments: Option<Leaf<'src>> => FRAGMENTS,
        /// Images that come from files.
        pub(super) textures: Option<Leaf<'src>> => textures::TEXTURES,
        /// Images that passes make.
        pub(super) images: Leaf<'src> => body::IMAGES,
        /// The buffers.
        pub(super) buffers: Option<Leaf<'src>> => body::BUFFERS,
        /// The passes. Their order gives them their meaning: each reads what those above it wrote.
        pub(super) passes: Leaf<'src> => body::ITEMS,
        /// The images and buffers that leave the frame.
        pub(super) outputs: Leaf<'src> => outputs::OUTPUTS,
        /// How several samples of depth become one value where a pass samples it, of images that don't say it; `Exact` if left
        /// out.
        pub(super) depth: Option<Leaf<'src>> => resolves::DEPTH,
        /// What images of the format `Color` become that passes of the frame alone draw and sample; `Balanced` if left out.
        pub(super) color: Option<Leaf<'src>> => precision::COLOR,
        /// What images of the formats `Depth` and `DepthStencil` become that passes of the frame alone draw and sample; `Exact`
        /// if left out.
        pub(super) depth_format: Option<Leaf<'src>> => precision::DEPTH,
        /// What is changed of all that, after the extensions.
        pub(super) changes: Option<Leaf<'src>> => CHANGES,
    }
}

/// The settings of a pipeline.
pub(super) const SETTINGS: Form = Form::List(&Form::Fields(SettingFields::<'static>::table));

/// The presets of a pipeline.
pub(super) const PRESETS: Form = Form::List(&Form::Fields(PresetFields::<'static>::table));

/// The version of a file.
pub(super) const VERSION: Form = Form::Plain(Plain::Whole);

/// Files that are named.
pub(super) const INCLUDE: Form = Form::List(&Form::Plain(Plain::Text));

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
    pub(super) fn read(
        mut reader: Reader,
        loader: &mut Loader<'_>,
        relative: &FilePath,
        Composed { tree, mut wanted, account }: Composed,
    ) -> Result<Document, Vec<Diagnostic>> {
        let mut document = None;
        if let Some(Said { settings, presets, include, textures }) = said(&mut reader, tree.root()) {
            let paths = loader::paths(&mut reader, include, "`include`");
            wanted.push(Wanted { from: relative.clone(), paths });
            let included = includes::read(&mut reader, loader, wanted);
            loader.look(&mut reader, textures);
            loader.look_in_fragments(&mut reader, tree.root());
            let values: Vec<Option<Value>> =
                settings.iter().map(|setting| setting.as_ref().map(|setting| setting.kind.default())).collect();
            let allows = Allowances::default();
            let surroundings =
                Surroundings { facts: Facts::UNKNOWN, extent: [1920, 1080], eyes: 1, allows, device: None };
            let files = Read {
                all: tree.root(),
                included: &included,
                pictures: &loader.pictures,
                removed_view: account.changes.iter().find(|change| change.removes(Kind::View)),
            };
            lower(&mut reader, files, &settings, values, &surroundings, true);
            let settings: Option<Vec<Setting>> = settings.into_iter().collect();
            document = settings.zip(presets.into_iter().collect()).map(|both| (both, included));
        }
        let origins = std::mem::take(&mut loader.origins);
        let pictures = std::mem::take(&mut loader.pictures);
        match document {
            Some(((settings, presets), included)) if reader.errors.is_empty() => {
                let in_force = choices::in_force(&settings, None, &[]);
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
        choices::read(sources, (shown, relative), text, &self.settings, &self.presets)
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
                Some(found.ok_or_else(|| choices::unknown_preset(name, &self.presets))?)
            }
            None => files.iter().rev().find_map(|file| file.preset).and_then(|preset| self.presets.get(preset)),
        };
        self.in_force = choices::in_force(&self.settings, preset, files);
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
        let settings: Vec<Option<Setting>> = self.settings.iter().cloned().map(Some).collect();
        let values = values.iter().cloned().map(Some).collect();
        let files = Read {
            all: self.tree.root(),
            included: &self.included,
            pictures: &self.pictures,
            removed_view: self.changes().iter().find(|change| change.removes(Kind::View)),
        };
        match lower(&mut reader, files, &settings, values, surroundings, false) {
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

/// What is read of a file before all else; `None` where something couldn't be read.
struct Said<'t> {
    settings: Vec<Option<Setting>>,
    presets: Vec<Option<Preset>>,
    include: Option<Leaf<'t>>,
    textures: Option<Leaf<'t>>,
}

/// All that was read of files.
#[derive(Clone, Copy)]
struct Read<'t> {
    /// The pipeline's own.
    all: Leaf<'t>,
    /// Files of fragments.
    included: &'t [Tree],
    /// What textures name.
    pictures: &'t Pictures,
    removed_view: Option<&'t Change>,
}

/// Settings, presets and what is included. `None` if the file is no pipeline.
fn said<'t>(reader: &mut Reader, all: Leaf<'t>) -> Option<Said<'t>> {
    let fields: PipelineFields<'_> = reader.read(all, "the pipeline")?;
    let listed: Vec<Option<SettingFields<'_>>> =
        entries(reader, fields.settings, "`settings`", "setting", &mut Names::new("setting"));
    let lower = |fields: &Option<SettingFields<'_>>| fields.as_ref().and_then(|fields| settings::lower(reader, fields));
    let settings: Vec<Option<Setting>> = listed.iter().map(lower).collect();
    let presets = choices::presets(reader, fields.presets, &settings);
    Some(Said { settings, presets, include: fields.include, textures: fields.textures })
}

/// What belongs to a whole pipeline alone.
pub(super) struct Whole<'s, 't> {
    pub(super) settings: &'s [Option<Setting>],
    pub(super) views: Option<Leaf<'t>>,
    pub(super) depth: Option<Leaf<'t>>,
    pub(super) color: Option<Leaf<'t>>,
    pub(super) depth_format: Option<Leaf<'t>>,
    /// The first view that is no longer there.
    pub(super) removed_view: Option<&'s Change>,
    pub(super) outputs: Leaf<'t>,
}

/// Puts in values; `None` if errors were reported. `reading` if nothing is to be said about values.
fn lower(
    reader: &mut Reader,
    Read { all, included, pictures, removed_view }: Read<'_>,
    settings: &[Option<Setting>],
    values: Vec<Option<Value>>,
    surroundings: &Surroundings<'_>,
    reading: bool,
) -> Option<Pipeline> {
    let fields: PipelineFields<'_> = reader.read(all, "the pipeline")?;
    let mut names = Names::new("setting");
    let mut silent = Reader::default();
    let listed: Vec<Option<SettingFields<'_>>> =
        entries(&mut silent, fields.settings, "`settings`", "setting", &mut names);
    debug_assert_eq!(listed.len(), settings.len());
    let parameters: Vec<Option<Parameter>> =
        settings.iter().map(|setting| setting.as_ref().map(Parameter::from)).collect();
    let fragments = Fragments::read(
        reader,
        fields.fragments.into_iter().chain(included.iter().filter_map(|tree| tree.root().field("fragments"))),
    );
    let PipelineFields { textures, images, buffers, passes, views, depth, color, depth_format, outputs, .. } = fields;
    let lists = Lists { textures, images: Some(images), buffers, passes: Some(passes) };
    let body = Body::read(reader, names, parameters, true, lists);
    let given = values.into_iter().map(|value| value.map(|value| Given { value, decided: Vec::new() })).collect();
    let level = Level { given, ..Level::default() };
    let lowering = if reading {
        Lowering::reading(surroundings, &fragments, pictures)
    } else {
        Lowering::new(surroundings, &fragments, pictures, false)
    };
    lowering.whole(reader, &body, level, Whole { settings, views, depth, color, depth_format, removed_view, outputs })
}
