//! Checks one variant: expands, compiles and verifies it.

use super::axes::{self, Axes};
use super::identity::{Identities, Identity};
use super::shaders::SharedShaders;
use super::space::Choice;
use crate::command_line::values::Modes;
use crate::planning::{self, View};
use framewright_graph::base::{Diagnostic, Sources};
use framewright_graph::compile::{Compiler, Options, heap_size};
use framewright_graph::device::{Estimated, Profile};
use framewright_graph::expand;
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::language::Document;
use framewright_graph::plan::Totals;
use framewright_graph::verify;
use std::sync::Arc;

/// The pipeline whose variants are checked: everything that they share.
pub(crate) struct CheckedPipeline<'a> {
    pub(crate) pipeline: &'a Document,
    /// The texts that it was read from.
    pub(crate) sources: &'a Arc<Sources>,
    /// The inputs of every frame.
    pub(crate) view: View<'static>,
    /// The axes that vary.
    pub(crate) axes: Axes,
    /// The devices, in the order of their axis.
    pub(crate) devices: Vec<Arc<Profile>>,
    /// How Plans are made.
    pub(crate) options: Options,
    /// How frames are drawn for two eyes.
    pub(crate) stereo: Modes,
}

/// Checks variants, on one thread.
pub(crate) struct VariantChecker<'a> {
    subject: &'a CheckedPipeline<'a>,
    shaders: SharedShaders<'a>,
    /// By device.
    compilers: Vec<Compiler>,
    identities: Identities,
    /// The last frame, and its choice without the device unless frames depend on it.
    last: Option<(Choice, ExpandedFrame)>,
}

/// A frame, or its mistakes.
type ExpandedFrame = Result<Arc<Frame>, Vec<Diagnostic>>;

/// The Plan of a variant of which nothing is wrong.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VerifiedPlan {
    pub(crate) identity: Identity,
    pub(crate) totals: Totals,
}

impl<'a> VariantChecker<'a> {
    /// A checker with empty caches.
    #[must_use]
    pub(crate) fn new(subject: &'a CheckedPipeline<'a>, shaders: SharedShaders<'a>) -> VariantChecker<'a> {
        let compilers = subject.devices.iter().map(|_| Compiler::new()).collect();
        VariantChecker { subject, shaders, compilers, identities: Identities::default(), last: None }
    }

    /// Expands, compiles and verifies a variant.
    ///
    /// # Errors
    /// Its mistakes.
    pub(crate) fn check(&mut self, choice: &Choice) -> Result<VerifiedPlan, Vec<Diagnostic>> {
        let frame = self.frame(choice)?;
        let device = axes::device(choice);
        let profile = &self.subject.devices[device];
        let plan = self.compilers[device].compile(&frame, profile, &mut Estimated(profile), &self.subject.options)?;
        let violations = verify::verify(plan);
        if let Some(large) = heap_size::too_large(plan, &frame, profile) {
            return Err(vec![large]);
        }
        if violations.is_empty() {
            Ok(VerifiedPlan { identity: self.identities.of(plan), totals: plan.totals })
        } else {
            Err(violations.iter().map(|violation| own_mistake(&violation.to_string())).collect())
        }
    }

    fn frame(&mut self, choice: &Choice) -> ExpandedFrame {
        // The device decides whether the images of both eyes are layers or halves.
        let by_device =
            self.subject.pipeline.asks_device() || self.subject.stereo.0.iter().any(|it| *it > Stereo::MultiPass);
        let same_for_all = usize::from(!by_device);
        let without_device = &choice[..choice.len().saturating_sub(same_for_all)];
        match &self.last {
            Some((last, frame)) if last == without_device => frame.clone(),
            _ => {
                let frame = self.expand(choice).map(Arc::new);
                self.last = Some((without_device.to_vec(), frame.clone()));
                frame
            }
        }
    }

    fn expand(&mut self, choice: &Choice) -> Result<Frame, Vec<Diagnostic>> {
        let CheckedPipeline { pipeline, sources, view, axes, .. } = self.subject;
        let device = self.subject.devices.get(axes::device(choice)).map(|device| &**device);
        let stereo = device.map_or(Ok(Stereo::Off), |device| Stereo::first_fit(&self.subject.stereo.0, device));
        let stereo = stereo.map_err(|why| vec![Diagnostic::nowhere(why)])?;
        let (set, view) = (axes.settings(choice), View { facts: Some(axes.facts(choice)), ..*view });
        let inputs = planning::inputs(&set, stereo, view, device);
        expand::expand(pipeline, Arc::clone(sources), &inputs, &mut self.shaders)
    }
}

fn own_mistake(violation: &str) -> Diagnostic {
    Diagnostic::nowhere(format!("the Plan breaks its own rules, which is a mistake of framewright itself: {violation}"))
}
