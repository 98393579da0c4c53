//! Memory and contents: images and buffers on top of each other, lifetimes cut short, contents thrown away.

use super::{Mutant, UNCHANGED, catch_all, mutants};
use crate::testing::hand_written_plans::placed;
use framewright_graph::plan::{Attachment, Placement, Plan, Role, Work};
use framewright_graph::vulkan::{LoadOp, StoreOp};
use std::sync::Arc;

/// The roles of all images, then those of all buffers.
fn roles(plan: &mut Plan) -> Vec<(Arc<str>, &mut Role)> {
    let images = plan.images.iter_mut().map(|image| (image.name.clone(), &mut image.role));
    images.chain(plan.buffers.iter_mut().map(|buffer| (buffer.name.clone(), &mut buffer.role))).collect()
}

/// Whether both live at one step, in one heap.
fn live_together(one: &Placement, other: &Placement) -> bool {
    let [first, last] = [one.lifetime[0].max(other.lifetime[0]), one.lifetime[1].min(other.lifetime[1])];
    first <= last && one.heap == other.heap
}

fn on_a_live_neighbour(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let mut roles = roles(plan);
        let (one, other) = (place / roles.len(), place % roles.len());
        let neighbour = (roles[other].0.clone(), placed(roles[other].1).cloned());
        let (name, role) = roles.get_mut(one)?;
        let ((with, Some(neighbour)), Role::Transient(moved)) = (neighbour, &mut **role) else {
            return Some(UNCHANGED.to_owned());
        };
        if one == other || !live_together(moved, &neighbour) {
            return Some(UNCHANGED.to_owned());
        }
        moved.offset = neighbour.offset;
        let what = format!("`{name}` moved onto `{with}`");
        plan.heaps[neighbour.heap as usize].bytes *= 2;
        Some(what)
    })
}

fn outliving_its_lifetime(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let mut roles = roles(plan);
        let (name, role) = roles.get_mut(place / 2)?;
        match &mut **role {
            Role::Transient(placement) if placement.lifetime[0] < placement.lifetime[1] => {
                let [first, last] = &mut placement.lifetime;
                if place.is_multiple_of(2) {
                    first.0 += 1
                } else {
                    last.0 -= 1
                }
                Some(format!("lifetime of `{name}` shortened"))
            }
            _ => Some(UNCHANGED.to_owned()),
        }
    })
}

fn attachments(plan: &mut Plan) -> impl Iterator<Item = (usize, &mut Attachment)> {
    plan.steps.iter_mut().enumerate().flat_map(|(step, described)| {
        let scope = match &mut described.work {
            Work::Render(scope) => Some(scope),
            _ => None,
        };
        scope.into_iter().flat_map(|scope| &mut scope.attachments).map(move |of| (step, of))
    })
}

fn with_lost_contents(plan: &Plan) -> Vec<Mutant> {
    let mut all = mutants(plan, |plan, place| {
        let (step, attachment) = attachments(plan).nth(place)?;
        let begins = attachment.load != LoadOp::DontCare;
        let change = format!("{:?} of step {step} → DONT_CARE{}", attachment.load, if begins { "" } else { UNCHANGED });
        (attachment.load, attachment.clear) = (LoadOp::DontCare, None);
        Some(change)
    });
    all.extend(mutants(plan, |plan, place| {
        let (step, attachment) = attachments(plan).nth(place)?;
        let stores = attachment.store == StoreOp::Store;
        attachment.store = if stores { StoreOp::DontCare } else { attachment.store };
        Some(format!("STORE of step {step} → DONT_CARE{}", if stores { "" } else { UNCHANGED }))
    }));
    all.extend(mutants(plan, |plan, place| {
        let (step, attachment) = attachments(plan).nth(place)?;
        let resolves = attachment.resolve.take().is_some();
        Some(format!("resolve of step {step} dropped{}", if resolves { "" } else { UNCHANGED }))
    }));
    all
}

#[test]
fn every_allocation_on_a_live_neighbour_is_caught() {
    catch_all(on_a_live_neighbour, &[]);
}

#[test]
fn every_shortened_lifetime_is_caught() {
    catch_all(outliving_its_lifetime, &[]);
}

#[test]
fn all_lost_contents_are_caught() {
    catch_all(with_lost_contents, &[]);
}
