//! The choices of a sweep, put into words that the pipeline, the scene and the output understand.

use super::digest::Digest;
use super::sweep::{self, Combined};
use crate::command_line::measuring::MeasureArguments;
use crate::command_line::values::{self, Size, Sweep};
use crate::error::Error;
use crate::files::inputs;
use crate::system::text;
use crate::variants::axes;
use framewright::{Choices, Pipeline, Stereo};
use framewright_graph::base::ReadFiles;
use framewright_graph::expand;
use framewright_passes::scene::Scene;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The preset whose settings decide how right a picture is. All other settings decide how it looks.
pub(crate) const REFERENCE: &str = "reference";
/// Sweeps of things that are no settings.
pub(crate) const SIZE: &str = "@size";
pub(crate) const SCENE: &str = "@scene";
pub(crate) const STEREO: &str = "@stereo";

/// A scene that choices are drawn with.
#[derive(Debug)]
pub(crate) struct Subject {
    pub(crate) file: String,
    pub(crate) digest: String,
    /// As it stands at its first frame.
    pub(crate) scene: Scene,
    /// As it moves.
    pub(crate) moving: Scene,
}

impl Subject {
    /// The scene as it stands at a frame.
    pub(crate) fn still_at(&self, frame: u32) -> Scene {
        self.moving.still_at(frame.into())
    }
}

/// A choice of a sweep.
#[derive(Debug, Clone)]
pub(crate) struct Choice {
    /// The values that the sweep chose, by name.
    pub(crate) values: BTreeMap<String, String>,
    pub(crate) scene: Rc<Subject>,
    /// Width and height of the output.
    pub(crate) size: [u32; 2],
    /// Ways of drawing for two eyes, the first one first.
    pub(crate) stereo: Vec<Stereo>,
}

impl Choice {
    /// The settings among its values.
    pub(crate) fn settings(&self) -> impl Iterator<Item = (String, String)> + '_ {
        let settings = self.values.iter().filter(|(name, _)| !name.starts_with('@'));
        settings.map(|(name, value)| (name.clone(), value.clone()))
    }

    /// What is chosen for its frame with a scene, on top of what is chosen for all choices.
    pub(crate) fn of(&self, of_all: &Choices, scene: &Scene) -> Choices {
        let mut choices = of_all.clone();
        choices.set.extend(self.settings());
        (choices.facts, choices.extent) = (Some(scene.facts()), self.size);
        choices.stereo.clone_from(&self.stereo);
        choices
    }

    /// A name for its files, other than that of every other choice.
    pub(crate) fn key(&self) -> String {
        let values = self.values.iter().flat_map(|(name, value)| [&**name, &**value]);
        let rest = [self.scene.digest.clone(), size_name(self.size), format!("{:?}", self.stereo)];
        Digest::of(values.chain(rest.iter().map(|it| &**it)))
    }
}

/// The name of a size, as results and the command line have it.
pub(crate) fn size_name([width, height]: [u32; 2]) -> String {
    format!("{width}x{height}")
}

/// All choices that the command line asks for, and the one without any sweep.
///
/// # Errors
/// Names of no settings, values of no size or way, scenes that can't be read; too many choices.
pub(crate) fn choices(
    arguments: &MeasureArguments,
    pipeline: &Pipeline,
    read: &ReadFiles,
) -> Result<(Choice, Vec<Choice>), Error> {
    let wrong = |what: String| Error::Sweep { what };
    let (sweeps, combined) = match (arguments.sweep.is_empty(), arguments.pairwise) {
        (true, _) => (of_reference(pipeline), Combined::OneByOne),
        (false, true) => (arguments.sweep.clone(), Combined::Pairwise),
        (false, false) => (arguments.sweep.clone(), Combined::All),
    };
    if sweeps.is_empty() {
        return Err(wrong(format!(
            "the pipeline has no preset `{REFERENCE}`, whose settings are swept: name some by --sweep"
        )));
    }
    let settings = &pipeline.document.settings;
    let sweeps = sweeps.into_iter().map(|sweep| canonical(pipeline, sweep)).collect::<Result<Vec<_>, Error>>()?;
    for (at, Sweep { name, .. }) in sweeps.iter().enumerate() {
        if sweeps[..at].iter().any(|other| other.name == *name) {
            return Err(wrong(format!("`{}` is swept twice", text::escape(name))));
        }
        if ![SIZE, SCENE, STEREO].contains(&&**name) && settings.iter().all(|it| *it.name.text != **name) {
            let known = settings.iter().map(|it| &*it.name.text).chain([SIZE, SCENE, STEREO]);
            let known = text::escape(&known.collect::<Vec<_>>().join(", "));
            return Err(wrong(format!("the pipeline has no setting `{}`; there are {known}", text::escape(name))));
        }
    }
    let count = sweep::count(&sweeps, combined);
    if count > sweep::MOST_CHOICES as u128 {
        let fits =
            combined == Combined::All && sweep::count(&sweeps, Combined::Pairwise) <= sweep::MOST_CHOICES as u128;
        let or_pairs = if fits { ", or add --pairwise" } else { "" };
        let most = sweep::MOST_CHOICES;
        return Err(wrong(format!(
            "the sweep has {count} choices, and at most {most} are measured: sweep fewer values{or_pairs}"
        )));
    }
    let mut scenes: BTreeMap<PathBuf, Rc<Subject>> = BTreeMap::new();
    let mut scene = |path: &Path| -> Result<Rc<Subject>, Error> {
        if let Some(known) = scenes.get(path) {
            return Ok(Rc::clone(known));
        }
        let moving = inputs::scene(path, arguments.reading.strict, read)?;
        let (file, digest) = (path.to_string_lossy().into_owned(), Digest::of_value(&moving));
        let subject = Rc::new(Subject { file, digest, scene: moving.still_at(0), moving });
        scenes.insert(path.to_owned(), Rc::clone(&subject));
        Ok(subject)
    };
    let baseline = Choice {
        values: BTreeMap::new(),
        scene: scene(&arguments.scene)?,
        size: arguments.size.into(),
        stereo: arguments.pipeline.stereo.0.clone(),
    };
    let mut choices = Vec::new();
    for values in sweep::choices(&sweeps, combined) {
        let mut choice = Choice { values, ..baseline.clone() };
        if let Some(size) = choice.values.get(SIZE) {
            let size: Size = size.parse().map_err(|problem| wrong(format!("{SIZE}: {problem}")))?;
            choice.size = size.into();
        }
        if let Some(stereo) = choice.values.get(STEREO) {
            choice.stereo = values::stereo(stereo).map_err(|problem| wrong(format!("{STEREO}: {problem}")))?.0;
        }
        if let Some(file) = choice.values.get(SCENE) {
            choice.scene = scene(Path::new(file))?;
        }
        choices.push(choice);
    }
    Ok((baseline, choices))
}

/// A sweep with its values in the form that Plans have them in: so `2.0` and `2` are one choice, and a choice that can't be drawn has the
/// settings of one that can. What is no value stays as it is: it is told of later.
fn canonical(pipeline: &Pipeline, sweep: Sweep) -> Result<Sweep, Error> {
    let setting = pipeline.document.settings.iter().find(|it| *it.name.text == *sweep.name);
    let value = |text: &String| match setting {
        Some(setting) => expand::canonical_value(&setting.kind, text),
        None if sweep.name == SIZE => text.parse::<Size>().ok().map(|size| size.to_string()),
        None => None,
    };
    let values: Vec<String> = sweep.values.iter().map(|text| value(text).unwrap_or_else(|| text.clone())).collect();
    if let Some(at) = (1..values.len()).find(|at| values[..*at].contains(&values[*at])) {
        let [name, value] = [&sweep.name, &values[at]].map(|text| text::escape(text));
        return Err(Error::Sweep { what: format!("`{name}` is swept over `{value}` twice") });
    }
    Ok(Sweep { name: sweep.name, values })
}

/// A sweep over each setting that the preset `reference` names.
fn of_reference(pipeline: &Pipeline) -> Vec<Sweep> {
    let settings = &pipeline.document.settings;
    let preset = pipeline.document.presets.iter().find(|preset| *preset.name.text == *REFERENCE);
    let named = preset.into_iter().flat_map(|preset| &preset.set).filter_map(|chosen| settings.get(chosen.setting));
    named.map(|it| Sweep { name: it.name.text.to_string(), values: axes::values(&it.kind) }).collect()
}

/// The settings of the preset `reference`; `None` if there is no such preset.
pub(crate) fn reference_settings(pipeline: &Pipeline) -> Option<Vec<(String, String)>> {
    let settings = &pipeline.document.settings;
    let preset = pipeline.document.presets.iter().find(|preset| *preset.name.text == *REFERENCE)?;
    let named = preset.set.iter().filter_map(|chosen| Some((settings.get(chosen.setting)?, &chosen.value)));
    Some(named.map(|(setting, value)| (setting.name.text.to_string(), axes::text(value))).collect())
}
