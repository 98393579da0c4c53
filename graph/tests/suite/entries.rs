//! The entries of a Plan are held against its sums, and against the lines of its text.

use crate::testing::graphs;
use crate::testing::pipelines::{INPUTS, right, shipped};
use crate::testing::plans::compiled;
use framewright_graph::plan::{About, Detail, EntryKind, Item, Outline, Plan};
use std::collections::BTreeMap;

fn some_plans() -> Vec<Plan> {
    let graphs = [graphs::deferred(), graphs::chain(9), graphs::wide(5), graphs::local(7)];
    let pipelines = ["forward.ron", "soft_focus.ron", "auto_exposure.ron", "snow.ron"];
    let pipelines = pipelines.map(|name| compiled(&right(&shipped(name), &INPUTS)));
    graphs.iter().map(compiled).chain(pipelines).collect()
}

/// All entries, those within steps too.
fn items(plan: &Plan) -> Vec<Item<'_>> {
    plan.entries().flat_map(|entry| std::iter::once(entry).chain(entry.parts())).map(|entry| entry.item).collect()
}

#[test]
fn each_part_of_a_plan_is_an_entry_once() {
    for plan in some_plans() {
        let items = items(&plan);
        let count = |is_one: fn(&Item<'_>) -> bool| items.iter().filter(|item| is_one(item)).count() as u32;
        let totals = &plan.totals;
        // A transfer of the file is a pass whose entry is its step.
        let transfers =
            plan.steps.iter().filter(|step| step.work.sides().next().is_some() && step.work.name().is_some());
        let passes = count(|item| matches!(item, Item::Pass(_))) + transfers.count() as u32;
        assert_eq!(passes, totals.passes + totals.inserted_passes);
        assert_eq!(count(|item| matches!(item, Item::ImageBarrier(_))), totals.image_barriers);
        assert_eq!(count(|item| matches!(item, Item::MemoryBarrier(_))), totals.memory_barriers);
        assert_eq!(count(|item| matches!(item, Item::Resolve(..))), totals.folded_resolves);
        assert_eq!(count(|item| matches!(item, Item::Wait(_))), totals.waits);
        assert_eq!(count(|item| matches!(item, Item::Step(_))) as usize, plan.steps.len());
        assert_eq!(count(|item| matches!(item, Item::Image(_))) as usize, plan.images.len());
        assert_eq!(count(|item| matches!(item, Item::Buffer(_))) as usize, plan.buffers.len());
        assert_eq!(count(|item| matches!(item, Item::Output(_))) as usize, plan.outputs.len());
    }
}

#[test]
fn each_entry_is_a_line_of_its_kind() {
    fn walk(line: &Outline, lines: &mut BTreeMap<EntryKind, u32>) {
        // Lines beside entries aren't counted, and neither are headings, whose lines are about something.
        let heads = line.parts.first().is_some_and(|part| part.kind == line.kind);
        if line.kind != EntryKind::Detail && !heads {
            *lines.entry(line.kind).or_default() += 1;
        }
        line.parts.iter().for_each(|part| walk(part, lines));
    }
    for plan in some_plans() {
        let mut lines = BTreeMap::new();
        walk(&plan.outline(Detail { verbose: true, ..Detail::default() }), &mut lines);
        let mut entries: BTreeMap<EntryKind, u32> = BTreeMap::from([(EntryKind::Plan, 1), (EntryKind::Total, 1)]);
        for entry in plan.entries().flat_map(|entry| std::iter::once(entry).chain(entry.parts())) {
            *entries.entry(entry.kind()).or_default() += 1;
            if let Item::Step(_) = entry.item {
                assert_eq!(entry.about(), entry.step.map(About::Step));
            }
        }
        // All settings stand in one line.
        entries.entry(EntryKind::Setting).and_modify(|settings| *settings = 1);
        assert_eq!(lines, entries, "{}", plan.tree());
    }
}
