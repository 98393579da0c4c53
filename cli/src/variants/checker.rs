//! Checks one variant: expands, compiles and verifies it.

use super::axes::{self, Axes};
use super::decisions::{SharedDecisions, axes_of};
use super::identity::{Identities, Identity};
use super::shaders::SharedShaders;
use super::space::Choice;
use crate::budget::Budget;
use crate::system::interrupt;
use framewright::Choices;
use framewright_graph::base::{Code, Diagnostic, Sources};
use framewright_graph::compile::{Compiler, Options, heap_size, shaders};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::expand;
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::language::{Document, Read, Reads};
use framewright_graph::plan::Totals;
use framewright_graph::verify;
use std::collections::HashMap;
use std::sync::Arc;

/// The pipeline whose variants are checked: everything that they share.
pub(crate) struct CheckedPipeline<'a> {
    pub(crate) pipeline: &'a Document,
    /// The texts that it was read from.
    pub(crate) sources: &'a Arc<Sources>,
    /// What is chosen for every frame, but for settings and facts that vary.
    pub(crate) choices: Choices,
    /// The axes that vary.
    pub(crate) axes: Axes,
    /// The devices, in the order of their axis.
    pub(crate) devices: Vec<Arc<Profile>>,
    /// How Plans are made.
    pub(crate) options: Options,
    /// The bounds that Plans are held to.
    pub(crate) budget: &'a Budget,
}

/// Checks variants, on one thread.
pub(crate) struct VariantChecker<'a> {
    subject: &'a CheckedPipeline<'a>,
    shaders: SharedShaders<'a>,
    /// By device.
    compilers: Vec<Compiler>,
    identities: Identities,
    /// Mistakes of shaders as they are drawn, by the hash of a Plan without its values.
    compiled: HashMap<u64, Vec<Diagnostic>>,
    decisions: &'a SharedDecisions,
    /// The last frame, and its choice without the device unless frames depend on it.
    last: Option<(Choice, ExpandedFrame)>,
}

/// A frame or its mistakes, and the axes that were read for it.
#[derive(Clone)]
struct ExpandedFrame {
    frame: Result<Arc<Frame>, Vec<Diagnostic>>,
    reads: Arc<[usize]>,
}

/// The verdict on a variant: its Plan, or its mistakes.
pub(crate) type Verdict = Result<VerifiedPlan, Vec<Diagnostic>>;

/// The Plan of a variant of which nothing is wrong.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VerifiedPlan {
    pub(crate) identity: Identity,
    pub(crate) totals: Totals,
}

impl<'a> VariantChecker<'a> {
    /// A checker with empty caches.
    #[must_use]
    pub(crate) fn new(
        subject: &'a CheckedPipeline<'a>,
        shaders: SharedShaders<'a>,
        decisions: &'a SharedDecisions,
    ) -> VariantChecker<'a> {
        let compilers = subject.devices.iter().map(|_| Compiler::new()).collect();
        let (identities, compiled) = (Identities::default(), HashMap::new());
        VariantChecker { subject, shaders, compilers, identities, compiled, decisions, last: None }
    }

    /// Expands, compiles and verifies a variant, unless the verdict follows from another one.
    ///
    /// # Errors
    /// Its mistakes.
    pub(crate) fn check(&mut self, choice: &Choice) -> Verdict {
        let device = axes::device(choice);
        if let Some(known) = self.decisions.find(device, choice) {
            return known;
        }
        let ExpandedFrame { frame, reads } = self.frame(choice);
        let verdict = frame.and_then(|frame| self.judge(&frame, device));
        // A shader whose compilation was given up is no mistake.
        if !interrupt::asked() {
            self.decisions.add(device, choice, &reads, verdict.clone());
        }
        verdict
    }

    /// Compiles and verifies a frame, and compiles its shaders as they are drawn.
    fn judge(&mut self, frame: &Arc<Frame>, device: usize) -> Verdict {
        let profile = &self.subject.devices[device];
        let plan =
            self.compilers[device].compile(frame, profile, &mut MemoryEstimate(profile), &self.subject.options)?;
        let violations = verify::verify(plan);
        if let Some(large) = heap_size::too_large(plan, frame, profile) {
            return Err(vec![large]);
        }
        if !violations.is_empty() {
            return Err(violations.iter().map(|violation| own_mistake(&violation.to_string())).collect());
        }
        let breaches = self.subject.budget.breaches(plan, self.subject.sources);
        if !breaches.is_empty() {
            return Err(breaches);
        }
        let identity = self.identities.of(plan);
        let mistakes =
            self.compiled.entry(identity.shape).or_insert_with(|| shaders::wrong(plan, frame, &mut self.shaders));
        if !mistakes.is_empty() {
            return Err(mistakes.clone());
        }
        Ok(VerifiedPlan { identity, totals: plan.totals })
    }

    fn frame(&mut self, choice: &Choice) -> ExpandedFrame {
        // The device decides whether the images of both eyes are layers or halves.
        let CheckedPipeline { pipeline, choices, .. } = self.subject;
        let by_device = pipeline.asks_device() || choices.stereo.iter().any(|it| *it > Stereo::MultiPass);
        let same_for_all = usize::from(!by_device);
        let without_device = &choice[..choice.len().saturating_sub(same_for_all)];
        match &self.last {
            Some((last, frame)) if last == without_device => frame.clone(),
            _ => {
                let frame = self.expand(choice);
                self.last = Some((without_device.to_vec(), frame.clone()));
                frame
            }
        }
    }

    fn expand(&mut self, choice: &Choice) -> ExpandedFrame {
        let reads = Reads::default();
        let frame = self.expand_reading(choice, &reads).map(Arc::new);
        let CheckedPipeline { pipeline, axes, budget, .. } = self.subject;
        let settings: Vec<&str> = pipeline.settings.iter().map(|setting| &*setting.name.text).collect();
        // The budget reads settings too, always the same ones.
        let of_budget = budget.settings().filter_map(|name| settings.iter().position(|known| *known == name));
        let reads: Vec<Read> = of_budget.map(Read::Setting).chain(reads.in_order()).collect();
        ExpandedFrame { frame, reads: axes_of(&reads, &settings, &axes.list).into() }
    }

    fn expand_reading(&mut self, choice: &Choice, reads: &Reads) -> Result<Frame, Vec<Diagnostic>> {
        let CheckedPipeline { pipeline, sources, choices, axes, .. } = self.subject;
        let device = self.subject.devices.get(axes::device(choice)).map(|device| &**device);
        let stereo = device.map_or(Ok(Stereo::Off), |device| choices.stereo_on(device));
        let stereo = stereo.map_err(|why| vec![Diagnostic::nowhere(Code::STEREO_UNSUPPORTED, why.to_string())])?;
        let mut choices = choices.clone();
        (choices.set, choices.facts) = (axes.settings(choice), Some(axes.facts(choice)));
        let inputs = choices.inputs(stereo, device);
        expand::expand_reading(pipeline, Arc::clone(sources), &inputs, &mut self.shaders, Some(reads))
    }
}

fn own_mistake(violation: &str) -> Diagnostic {
    Diagnostic::nowhere(
        Code::OWN_MISTAKE,
        format!("the Plan breaks its own rules, which is a mistake of framewright itself: {violation}"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command_line::args::{self, Command};
    use crate::planning;
    use crate::variants::space::Space;
    use framewright_graph::base::ReadFiles;
    use framewright_passes::draw::interfaces;
    use framewright_passes::shipped::SHADERS;
    use framewright_vulkan::ShaderLibrary;
    use std::sync::Mutex;

    /// Verdicts in the order of the variants: by one checker, and by a new one for each variant.
    fn verdicts(pipeline: &str, devices: &[Arc<Profile>], stereo: &str) -> [Vec<String>; 2] {
        let words = ["framewright", "check", pipeline, "--stereo", stereo];
        let line = args::parse(words.into_iter().map(Into::into)).expect("a command line");
        let Command::Check(arguments) = line.command else { panic!("another command") };
        let loaded = planning::load(&arguments.pipeline, &ReadFiles::default()).expect("a pipeline");
        let names: Vec<String> = devices.iter().map(|device| device.name.clone()).collect();
        let subject = CheckedPipeline {
            pipeline: &loaded.document,
            sources: &loaded.sources,
            choices: planning::choices(&arguments.pipeline, arguments.size, arguments.planning.rotate),
            axes: Axes::of(&loaded.document, &loaded.sources, &[], &names),
            devices: devices.to_vec(),
            options: arguments.planning.options(),
            budget: &Budget::default(),
        };
        let space = Space::all(subject.axes.sizes(), subject.axes.variants_of_presets());
        let library = Mutex::new(ShaderLibrary::new(Vec::new(), SHADERS, interfaces()));
        let decisions = || SharedDecisions::of(subject.devices.len());
        let shared = decisions();
        let mut one = VariantChecker::new(&subject, SharedShaders::new(&library), &shared);
        let mut judged = [Vec::new(), Vec::new()];
        for choice in (0..space.len()).map(|number| space.choice(number)) {
            judged[0].push(format!("{:?}", one.check(&choice)));
            let own = decisions();
            let mut new = VariantChecker::new(&subject, SharedShaders::new(&library), &own);
            judged[1].push(format!("{:?}", new.check(&choice)));
        }
        judged
    }

    #[test]
    fn a_verdict_that_follows_from_another_one_is_the_variants_own() {
        let all = crate::planning::device::all().expect("profiles");
        let devices = ["lavapipe", "mali-g78"]
            .map(|name| Arc::new(all.iter().find(|it| it.0 == name).expect("it is shipped").1.clone()));
        for (pipeline, stereo) in
            [("forward", "off"), ("soft_focus", "off"), ("snow", "auto"), ("forward_overlay", "multiview,double-wide")]
        {
            let [shared, alone] = verdicts(pipeline, &devices, stereo);
            assert!(shared == alone, "{pipeline}, {stereo}");
            assert!(shared.len() > 7, "{pipeline} has {} variants", shared.len());
        }
    }
}
