//! Tells whether two Plans are the same, or the same but for values, by hashes of their serialised form.

use framewright_graph::plan::{DeviceUsed, Plan};
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// The hashes of a Plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Identity {
    /// Equal for equal Plans.
    pub(crate) plan: u64,
    /// Equal for Plans that differ in values alone, see [`Plan::without_values`], and have the same notes.
    pub(crate) shape: u64,
}

/// Identifies Plans. Most variants share their Plan with others, so each shape is hashed once.
#[derive(Default)]
pub(super) struct Identities {
    shapes: HashMap<u64, u64>,
}

impl Identities {
    /// The identity of a Plan. Its settings and the device's name don't count.
    pub(super) fn of(&mut self, plan: &Plan) -> Identity {
        let identity = hash(plan);
        // A note tells of another decision: a sample count that the device lacks, a pass that was left out.
        let shape = || Plan { notes: plan.notes.clone(), totals: plan.totals, ..plan.without_values() };
        let shape = *self.shapes.entry(identity).or_insert_with(|| hash(&shape()));
        Identity { plan: identity, shape }
    }
}

fn hash(plan: &Plan) -> u64 {
    let Plan {
        format_version: _,
        device,
        settings: _,
        changes: _,
        decided: _,
        extent,
        stereo,
        views,
        images,
        buffers,
        heaps,
        steps,
        outputs,
        notes,
        totals,
    } = plan;
    let DeviceUsed { name: _, exact_memory } = device;
    let counted = (exact_memory, extent, stereo, views, images, buffers, heaps, steps, outputs, notes, totals);
    let mut hasher = DefaultHasher::new();
    // Lists of unknown length alone can't be serialised, and a Plan has none.
    postcard::to_stdvec(&counted).unwrap_or_default().hash(&mut hasher);
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::frame::ParamValue;
    use framewright_graph::plan::Work;

    /// The identity of the documentation's example after a change.
    fn changed(change: impl FnOnce(&mut Plan)) -> Identity {
        let mut plan = Plan::from_json(include_str!("../../../docs/plan-example.json")).expect("a Plan");
        change(&mut plan);
        Identities::default().of(&plan)
    }

    fn scope(plan: &mut Plan) -> &mut framewright_graph::plan::RenderScope {
        let scopes = plan.steps.iter_mut().filter_map(|step| match &mut step.work {
            Work::Render(scope) => Some(scope),
            _ => None,
        });
        scopes.last().expect("a rendering scope")
    }

    #[test]
    fn values_change_the_plan_and_not_its_shape() {
        let clear = |value| changed(|plan| scope(plan).attachments[0].clear = Some([0.0, value, 0.0, 1.0]));
        let groups = |count| {
            let groups = framewright_graph::frame::Groups::Count([count, 1, 1]);
            changed(|plan| scope(plan).passes[0].groups = Some(groups))
        };
        let param = |value| {
            let param = framewright_graph::plan::Param { name: "scale".into(), value: ParamValue::Number(value) };
            changed(|plan| scope(plan).passes[0].params = vec![param])
        };
        for (one, other) in [(clear(0.0), clear(-0.0)), (groups(1), groups(2)), (param(1.0), param(2.0))] {
            assert_eq!(one.shape, other.shape);
            assert_ne!(one.plan, other.plan);
        }
    }

    #[test]
    fn all_else_but_names_changes_both() {
        let same = changed(|_| {});
        let name = changed(|plan| "another".clone_into(&mut plan.device.name));
        assert_eq!(name, same);
        let samples = changed(|plan| scope(plan).samples += 1);
        let notes = changed(|plan| drop(plan.notes.pop()));
        let images = changed(|plan| plan.images[0].name = "another".into());
        for other in [samples, notes, images] {
            assert!(other.plan != same.plan && other.shape != same.shape);
        }
    }
}
