//! The choices of a sweep, put into words that the pipeline, the scene and the output understand.

use crate::command_line::measuring::MeasureArguments;
use crate::command_line::values::{self, Size};
use crate::error::Error;
use crate::files::inputs;
use crate::system::text;
use framewright::Pipeline;
use framewright_graph::base::ReadFiles;
use framewright_graph::expand;
use framewright_lab::bench::{Choice, MeasuredScene, REFERENCE, of_reference};
use framewright_lab::sweep::{self, Combination, SCENE, SIZE, STEREO, Sweep};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// All choices that the command line asks for, and the one without any sweep.
///
/// # Errors
/// Names of no settings, values of no size or way, scenes that can't be read; too many choices.
pub(crate) fn choices(
    arguments: &MeasureArguments,
    pipeline: &Pipeline,
    read: &ReadFiles,
) -> Result<(Choice, Vec<Choice>), Error> {
    let wrong = |what: String| Error::from(framewright_lab::Error::Sweep { what });
    let (sweeps, combined) = match (arguments.sweep.is_empty(), arguments.pairwise) {
        (true, _) => (of_reference(pipeline), Combination::OneByOne),
        (false, true) => (arguments.sweep.clone(), Combination::Pairwise),
        (false, false) => (arguments.sweep.clone(), Combination::All),
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
    let chosen = sweep::choices(&sweeps, combined)?;
    let mut scenes: BTreeMap<PathBuf, Rc<MeasuredScene>> = BTreeMap::new();
    let mut scene = |path: &Path| -> Result<Rc<MeasuredScene>, Error> {
        if let Some(known) = scenes.get(path) {
            return Ok(Rc::clone(known));
        }
        let moving = inputs::scene(path, arguments.reading.strict, read)?;
        let scene = Rc::new(MeasuredScene::new(path.to_string_lossy().into_owned(), moving));
        scenes.insert(path.to_owned(), Rc::clone(&scene));
        Ok(scene)
    };
    let baseline = Choice {
        values: BTreeMap::new(),
        scene: scene(&arguments.scene)?,
        size: arguments.size.into(),
        stereo: arguments.pipeline.stereo.0.clone(),
    };
    let mut choices = Vec::new();
    for values in chosen {
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
        return Err(framewright_lab::Error::Sweep { what: format!("`{name}` is swept over `{value}` twice") }.into());
    }
    Ok(Sweep { name: sweep.name, values })
}
