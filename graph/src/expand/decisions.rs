//! The settings and facts that decided what images and passes are like, for the readers of a Plan.

use super::passes::State;
use super::resources::follow::follow_all;
use super::resources::images::index;
use crate::expression::{Decision, Origin};
use crate::frame::{Access, DecidedBy, DecidedProperty, ImageIndex, NamedValue, Output, Property, Resource, Subject};
use crate::language::{Decisions, Image, ImageRef, PassDecisions, Pipeline};
use std::sync::Arc;

/// The decisions about images, then about passes. An image that no pass uses has none.
pub(super) fn decided(pipeline: &Pipeline, states: &[State], outputs: &[Output]) -> Arc<[DecidedProperty]> {
    if !pipeline.images.iter().any(|image| is_decided(image))
        && pipeline.passes.iter().all(|pass| pass.decided.is_empty())
    {
        return Arc::default();
    }
    let mut all = DecisionList::default();
    let followed = PROPERTIES.map(|(what, of, follows)| (what, followed(&pipeline.images, of, follows)));
    for ((image, user), at) in pipeline.images.iter().zip(users(pipeline, states, outputs)).zip(0..) {
        let subject = || Subject::Image(image.name.text.clone());
        match &user {
            Use::None => continue,
            Use::If(runs) => all.add(subject, Property::Exists, runs),
            Use::Always => {}
        }
        for (what, by) in &followed {
            by.get(at).into_iter().flatten().for_each(|by| all.add(subject, *what, by));
        }
        all.add(subject, Property::Depth, &image.shape.by);
        all.add(subject, Property::Repeat, &image.repeat);
    }
    for pass in &pipeline.passes {
        let subject = || Subject::Pass(pass.name.text.clone());
        if pass.off.is_some() {
            all.add(subject, Property::LeftOut, &pass.decided.runs);
            continue;
        }
        all.add(subject, Property::Runs, &pass.decided.runs);
        all.add(subject, Property::Images, &pass.decided.images);
        all.add(subject, Property::Repeat, &pass.decided.repeat);
    }
    all.decided.into()
}

/// The decisions about a property of an image.
type DecisionsOf = fn(&Image) -> &Decisions;

/// The image that another one follows in a property.
type FollowedImage = fn(&Image) -> Option<ImageRef>;

/// The properties in which an image may follow another one.
const PROPERTIES: [(Property, DecisionsOf, FollowedImage); 5] = [
    (Property::Format, |image| &image.format.by, |image| image.format.value.follows()),
    (Property::Size, |image| &image.size.by, |image| image.size.value.follows()),
    (Property::Samples, |image| &image.samples.by, |image| image.samples.value.follows()),
    (Property::Mips, |image| &image.mips.by, |image| image.mips.value.follows()),
    (Property::Layers, |image| &image.layers.by, |image| image.layers.value.follows()),
];

/// Whether there are decisions about an image itself.
fn is_decided(image: &Image) -> bool {
    !(PROPERTIES.iter().all(|(_, of, _)| of(image).is_empty()) && image.shape.by.is_empty() && image.repeat.is_empty())
}

/// The decisions about a property of each image, with those about the images that it follows; empty if there are none.
fn followed(images: &[Arc<Image>], of: DecisionsOf, follows: FollowedImage) -> Vec<Option<Decisions>> {
    if images.iter().all(|image| of(image).is_empty()) {
        return Vec::new();
    }
    let with = |image: &Arc<Image>, followed: Option<Decisions>| {
        Some(followed.map_or_else(|| of(image).clone(), |followed| of(image).and(&followed)))
    };
    follow_all(images, |image| follows(image).map(index), with)
}

/// The decisions so far, and the last of them as they were and as they are shown: passes of a fragment share theirs.
#[derive(Default)]
struct DecisionList {
    decided: Vec<DecidedProperty>,
    last: Option<(Decisions, Arc<DecidedBy>)>,
}

impl DecisionList {
    fn add(&mut self, subject: impl FnOnce() -> Subject, what: Property, by: &Decisions) {
        if by.is_empty() {
            return;
        }
        let shown = match &self.last {
            Some((last, shown)) if last.are_same(by) => Arc::clone(shown),
            _ => shown(by.all()).into(),
        };
        self.last = Some((by.clone(), Arc::clone(&shown)));
        self.decided.push(DecidedProperty { subject: subject(), what, by: shown });
    }
}

fn shown(decisions: &[Decision]) -> DecidedBy {
    let mut by = DecidedBy::default();
    for decision in decisions {
        let list = if decision.origin == Origin::Setting { &mut by.settings } else { &mut by.facts };
        list.push(named(decision));
    }
    by
}

fn named(decision: &Decision) -> NamedValue {
    NamedValue { name: decision.name.clone(), value: decision.value.to_string() }
}

/// Whether an image is used in a frame.
#[derive(Clone)]
enum Use {
    None,
    /// All its uses have conditions; those of the first.
    If(Decisions),
    Always,
}

/// How each image is used, by passes that run and by outputs.
fn users(pipeline: &Pipeline, states: &[State], outputs: &[Output]) -> Vec<Use> {
    let mut users = vec![Use::None; pipeline.images.len()];
    let mut uses = |image: ImageIndex, condition: &Decisions| {
        let user = &mut users[image.0 as usize];
        match user {
            _ if condition.is_empty() => *user = Use::Always,
            Use::None => *user = Use::If(condition.clone()),
            Use::If(_) | Use::Always => {}
        }
    };
    let always = Decisions::default();
    for (state, pass) in states.iter().zip(&pipeline.passes) {
        let PassDecisions { runs, images, .. } = &pass.decided;
        // A pass with `otherwise` uses its images whether it runs or not.
        let runs = if pass.otherwise.is_empty() { runs } else { &always };
        for access in state.runs().iter().flat_map(|pass| pass.accesses()) {
            let chosen = matches!(access, Access::Sampled(_)) && runs.is_empty();
            access.image_index().into_iter().for_each(|image| uses(image, if chosen { images } else { runs }));
        }
    }
    for output in outputs {
        if let Resource::Image(image) = output.resource {
            uses(image, &always);
        }
    }
    users
}
