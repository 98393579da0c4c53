//! What the views of a page show of a Plan.

use framewright_graph::base::Sources;
use framewright_graph::dataflow::{Dataflow, Edge, Node};
use framewright_graph::hints::{Hint, hints};
use framewright_graph::plan::{About, Detail, ImageId, MovedBytes, Outline, Plan, Resource, Step};
use serde::Serialize;

/// A graph of more nodes than this isn't laid out: nobody could read the picture, and a browser could hardly hold it.
pub const MOST_NODES: usize = 3000;

/// At most this many lines of one kind are left of an outline that is shortened.
const MOST_LINES: usize = 200;

/// The data of the views of a Plan.
#[derive(Serialize)]
pub struct PlanView<'a> {
    name: String,
    sources: Vec<SourceText<'a>>,
    outline: Outline,
    hints: Vec<Hint>,
    #[serde(flatten)]
    body: Body<'a>,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Body<'a> {
    /// All of it.
    Whole {
        plan: &'a Plan,
        nodes: Vec<Node>,
        edges: Vec<Edge>,
        moved: Vec<Vec<(Resource, MovedBytes)>>,
        on_chip: Vec<Vec<(ImageId, u64)>>,
    },
    /// Nothing but the outline, which is shortened: the Plan is too large to be looked at node by node.
    Summary { steps: usize, most: usize },
}

#[derive(Serialize)]
struct SourceText<'a> {
    name: &'a str,
    text: &'a str,
}

impl<'a> PlanView<'a> {
    /// Those of a Plan with a name for people. `sources`: the files that it was made from.
    #[must_use]
    pub fn of(name: &str, plan: &'a Plan, detail: Detail<'_>, sources: Option<&'a Sources>) -> PlanView<'a> {
        let flow = Dataflow::of(plan);
        let outline = plan.outline(detail);
        let files = sources.into_iter().flat_map(|sources| (0..).map_while(|file| sources.file(file)));
        let mut view = PlanView {
            name: name.to_owned(),
            sources: files.map(|file| SourceText { name: &file.relative, text: &file.text }).collect(),
            outline,
            hints: hints(plan),
            body: Body::Summary { steps: plan.steps.len(), most: MOST_NODES },
        };
        if flow.nodes.len() > MOST_NODES {
            view.outline = shortened(plan, view.outline);
            view.sources.clear();
            return view;
        }
        let moved = plan.steps.iter().map(|step| moved(plan, step)).collect();
        let on_chip = plan.steps.iter().map(|step| plan.on_chip_of_each(step)).collect();
        view.body = Body::Whole { plan, nodes: flow.nodes, edges: flow.edges, moved, on_chip };
        view
    }
}

/// The bytes that a step moves, image by image, without those of which there are none.
fn moved(plan: &Plan, step: &Step) -> Vec<(Resource, MovedBytes)> {
    plan.moved_of_each(step).into_iter().filter(|(_, moved)| moved.sum() > 0).collect()
}

/// The outline with the steps that move most, and of each list the first lines.
fn shortened(plan: &Plan, outline: Outline) -> Outline {
    let mut costs: Vec<(u64, usize)> =
        plan.steps.iter().enumerate().map(|(at, step)| (plan.moved_by(step).sum(), at)).collect();
    costs.sort_unstable_by(|one, other| other.cmp(one));
    costs.truncate(MOST_LINES);
    let kept: std::collections::BTreeSet<usize> = costs.into_iter().map(|(_, at)| at).collect();
    let is_left = |line: &Outline| match &line.about {
        Some(About::Step(step)) => kept.contains(&(step.0 as usize)),
        _ => true,
    };
    let parts = outline.parts.into_iter().filter(is_left).map(|mut line| {
        line.parts.truncate(MOST_LINES);
        line
    });
    Outline { parts: parts.collect(), ..outline }
}
