//! From a subject and choices to a verified Plan.

use crate::files::CarriedFiles;
use crate::shaders::CarriedShaders;
use crate::subject::{Choices, FORMAT, Subject};
use framewright_graph::base::{self, Diagnostic, FilePath, Sources, escape};
use framewright_graph::compile;
use framewright_graph::device::{MemoryEstimate, Profile, SHIPPED_PROFILES};
use framewright_graph::expand::{self, Inputs};
use framewright_graph::frame::Stereo;
use framewright_graph::language::{self, Facts, FoundFile};
use framewright_graph::plan::Plan;
use framewright_graph::shader::{DrawInterfaces, ShaderInterfaces};
use framewright_graph::verify;
use serde_json::{Value, json};
use std::sync::Arc;

/// A Plan of a subject.
#[derive(Debug)]
pub struct SubjectPlan {
    /// The Plan, verified.
    pub plan: Plan,
    /// The texts that it was made of.
    pub sources: Arc<Sources>,
}

/// Why there is no Plan.
#[derive(Debug)]
pub enum Refusal {
    /// Mistakes of the files or the choices.
    Mistakes {
        /// The texts that they point into.
        sources: Arc<Sources>,
        /// The mistakes.
        diagnostics: Vec<Diagnostic>,
    },
    /// Anything else, in words. Not yet escaped.
    Words(String),
}

impl Refusal {
    fn mistakes(sources: impl Into<Arc<Sources>>, diagnostics: Vec<Diagnostic>) -> Refusal {
        Refusal::Mistakes { sources: sources.into(), diagnostics }
    }

    /// The text that people read, with lines of files.
    #[must_use]
    pub fn message(&self) -> String {
        match self {
            Refusal::Mistakes { sources, diagnostics } => base::render(sources, diagnostics),
            Refusal::Words(words) => format!("error: {}\n", escape(words)),
        }
    }

    /// The mistakes as data.
    #[must_use]
    pub fn data(&self) -> Value {
        match self {
            Refusal::Mistakes { sources, diagnostics } => base::to_json(sources, diagnostics),
            Refusal::Words(words) => json!([{ "message": escape(words), "help": null, "labels": [] }]),
        }
    }
}

impl Subject {
    /// The Plan of these choices, with the shaders that the subject carries.
    ///
    /// # Errors
    /// [`Refusal`] says why there is none.
    pub fn planned(&self, choices: &Choices) -> Result<SubjectPlan, Refusal> {
        let mut sources = Sources::default();
        let draws = DrawInterfaces::read(&mut sources, "the interface", "interface.ron", self.draws.clone());
        let draws = draws.map_err(|wrong| Refusal::mistakes(sources, wrong))?;
        self.planned_with(choices, &mut CarriedShaders::new(&self.shaders, draws))
    }

    /// The Plan of these choices, with shaders from elsewhere.
    ///
    /// # Errors
    /// [`Refusal`] says why there is none.
    pub fn planned_with(&self, choices: &Choices, shaders: &mut dyn ShaderInterfaces) -> Result<SubjectPlan, Refusal> {
        if self.format != FORMAT {
            let words =
                format!("the page carries a subject in form {}, and its compiler reads form {FORMAT}", self.format);
            return Err(Refusal::Words(words));
        }
        let device = self.profile(&choices.device)?;
        let mut files = CarriedFiles::new(self, choices);
        let Some(own) = self.files.first() else {
            return Err(Refusal::Words("the page carries no pipeline".to_owned()));
        };
        let extensions = self.extensions.iter().filter_map(|number| self.files.get(*number));
        let extensions = extensions.map(|file| files.found(file)).chain(left_out(&choices.left_out)).collect();
        let (mut sources, own) = (Sources::default(), files.found(own));
        let document = language::read_extended(&mut sources, &mut files, own, extensions);
        let mut document = match document {
            Ok(document) => document,
            Err(wrong) => return Err(Refusal::mistakes(sources, wrong)),
        };
        let (mut settings, mut wrong) = (Vec::new(), Vec::new());
        for file in &self.settings {
            match document.read_settings(&mut sources, &file.shown, &file.path, file.text.clone()) {
                Ok(file) => settings.push(file),
                Err(mistakes) => wrong.extend(mistakes),
            }
        }
        wrong.extend(document.choose(choices.preset.as_deref(), &settings).err());
        let inputs = Inputs {
            set: &choices.set,
            facts: self.facts.unwrap_or(Facts::UNKNOWN),
            facts_known: self.facts.is_some(),
            output_extent: choices.extent,
            device: Some(&device),
            rotation: choices.rotation,
            window: None,
            dump: &[],
            stereo: stereo(choices, &device)?,
        };
        wrong.extend(expand::check_inputs(&document, &inputs));
        let sources = Arc::new(sources);
        let refused = |wrong| Refusal::mistakes(Arc::clone(&sources), wrong);
        if !wrong.is_empty() {
            return Err(refused(wrong));
        }
        let frame = expand::expand(&document, Arc::clone(&sources), &inputs, shaders).map_err(refused)?;
        let plan = compile::compile(&frame, &device, &mut MemoryEstimate(&device), &self.options).map_err(refused)?;
        if let Some(violation) = verify::verify(&plan).first() {
            let words = format!("the Plan breaks its own rules, which is a mistake of framewright itself: {violation}");
            return Err(Refusal::Words(words));
        }
        let wrong = compile::shaders::wrong(&plan, &frame, shaders);
        if wrong.is_empty() { Ok(SubjectPlan { plan, sources }) } else { Err(refused(wrong)) }
    }

    /// The names of all devices that can be chosen, those of the subject first.
    #[must_use]
    pub fn devices(&self) -> Vec<&str> {
        let own = self.profiles.iter().map(|profile| &*profile.name);
        own.chain(SHIPPED_PROFILES.iter().map(|(name, _)| *name)).collect()
    }

    fn profile(&self, device: &str) -> Result<Profile, Refusal> {
        let own = self.profiles.iter().find(|profile| profile.name == device).map(|profile| &*profile.text);
        let shipped = || SHIPPED_PROFILES.iter().find(|(name, _)| *name == device).map(|(_, text)| *text);
        let Some(text) = own.or_else(shipped) else {
            return Err(Refusal::Words(format!("there is no device profile `{device}`")));
        };
        Profile::from_ron(text).map_err(|problem| Refusal::Words(format!("{device}:{problem}")))
    }
}

fn stereo(choices: &Choices, device: &Profile) -> Result<Stereo, Refusal> {
    match &*choices.stereo {
        [] => Ok(Stereo::Off),
        wanted => Stereo::first_fit(wanted, device).map_err(Refusal::Words),
    }
}

/// An extension that leaves passes out.
fn left_out(passes: &[String]) -> Option<FoundFile> {
    const NAME: &str = "(left out)";
    if passes.is_empty() {
        return None;
    }
    // Text in RON and in JSON is written alike, but for control characters, which no name has.
    let removed: Vec<String> = passes.iter().map(|pass| format!("Remove(pass: {})", json!(pass))).collect();
    let text = format!("Extension(version: 1, changes: [{}])", removed.join(", "));
    Some(FoundFile { shown: NAME.to_owned(), relative: FilePath::from(NAME), bytes: text.into_bytes() })
}
