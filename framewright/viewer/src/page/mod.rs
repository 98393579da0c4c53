//! A Plan, or two, as one HTML page that needs nothing else, not even a network.

mod summary;
mod thumbnail;

pub use thumbnail::Thumbnail;

use crate::html::{self, Template};
use crate::times::Times;
use framewright_graph::base::Sources;
use framewright_graph::dataflow::{Dataflow, Edge, Node};
use framewright_graph::difference::Differences;
use framewright_graph::hints::{Hint, hints};
use framewright_graph::plan::{Detail, ImageId, MovedBytes, Outline, Plan, Resource, Step};
use serde::Serialize;

/// A graph of more nodes than this isn't laid out: nobody could read the picture, and a browser could hardly hold it.
pub const MOST_NODES: usize = 3000;

const TEMPLATE: Template<'_> = Template {
    page: include_str!("page.html"),
    style: include_str!("page.css"),
    script: concat!(
        include_str!("elements.js"),
        include_str!("times.js"),
        include_str!("model.js"),
        include_str!("selection.js"),
        include_str!("overview.js"),
        include_str!("canvas.js"),
        include_str!("layered.js"),
        include_str!("graph.js"),
        include_str!("timeline.js"),
        include_str!("grid.js"),
        include_str!("memory.js"),
        include_str!("steps.js"),
        include_str!("lists.js"),
        include_str!("differences.js"),
        include_str!("source.js"),
        include_str!("pictures.js"),
        include_str!("details.js"),
        include_str!("history.js"),
        include_str!("live.js"),
        include_str!("main.js"),
    ),
    // Captured pictures lie beside the page, wherever that is.
    images: "'self' file:",
    asked: "'none'",
};

/// What a page shows.
pub struct Page<'a> {
    /// One Plan, or two that are compared.
    pub plans: Vec<ShownPlan<'a>>,
    /// The differences between the two.
    pub differences: Option<&'a Differences>,
    /// What other devices change.
    pub devices: &'a [DeviceDifferences],
    /// Images after the passes that wrote them, in the order of the passes.
    pub captures: &'a [Thumbnail],
}

/// A Plan on a page.
pub struct ShownPlan<'a> {
    /// Its name for people.
    pub name: String,
    /// The Plan.
    pub plan: &'a Plan,
    /// The detail of its outline.
    pub detail: Detail<'a>,
    /// The files that it was made from; `None`: it was read from a file itself.
    pub sources: Option<&'a Sources>,
    /// How long its last frames took; `None`: nobody measured it.
    pub times: Option<&'a Times>,
}

/// The differences that another device makes.
#[derive(Serialize)]
pub struct DeviceDifferences {
    /// The name of the device's profile.
    pub profile: String,
    /// The differences; else why there is no Plan for it.
    pub differences: Result<Differences, String>,
}

/// The data of a page.
#[derive(Default, Serialize)]
struct Data<'a> {
    /// Whether the page asks its server for its data.
    live: bool,
    plans: Vec<PlanData<'a>>,
    differences: Option<&'a Differences>,
    devices: &'a [DeviceDifferences],
    captures: &'a [Thumbnail],
}

#[derive(Serialize)]
struct PlanData<'a> {
    name: &'a str,
    sources: Vec<SourceText<'a>>,
    outline: Outline,
    hints: Vec<Hint>,
    times: Option<&'a Times>,
    #[serde(flatten)]
    body: Body<'a>,
}

/// The views' data.
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

/// The page.
///
/// # Errors
/// If a Plan has no JSON form.
pub fn page(page: &Page<'_>) -> serde_json::Result<String> {
    html::page(&TEMPLATE, &data(page))
}

/// The page that asks its server for its data, again and again.
///
/// # Errors
/// None that happens.
pub fn live_page() -> serde_json::Result<String> {
    let template = Template { images: "'self'", asked: "'self'", ..TEMPLATE };
    html::page(&template, &Data { live: true, ..Data::default() })
}

/// The data of a page, as JSON.
///
/// # Errors
/// If a Plan has no JSON form.
pub fn page_data(page: &Page<'_>) -> serde_json::Result<String> {
    serde_json::to_string(&data(page))
}

/// The data of a page, for a member to be added.
///
/// # Errors
/// If a Plan has no JSON form.
pub(crate) fn page_value(page: &Page<'_>) -> serde_json::Result<serde_json::Value> {
    serde_json::to_value(data(page))
}

fn data<'a>(page: &'a Page<'a>) -> Data<'a> {
    let plans = page.plans.iter().map(plan_data).collect();
    let Page { differences, devices, captures, .. } = *page;
    Data { live: false, plans, differences, devices, captures }
}

fn plan_data<'a>(shown: &'a ShownPlan<'a>) -> PlanData<'a> {
    let ShownPlan { name, plan, detail, sources, times } = shown;
    let flow = Dataflow::of(plan);
    let outline = plan.outline(*detail);
    let files = sources.iter().flat_map(|sources| (0..).map_while(|file| sources.file(file)));
    let mut data = PlanData {
        name,
        sources: files.map(|file| SourceText { name: &file.relative, text: &file.text }).collect(),
        outline,
        hints: hints(plan),
        times: *times,
        body: Body::Summary { steps: plan.steps.len(), most: MOST_NODES },
    };
    if flow.nodes.len() > MOST_NODES {
        data.outline = summary::shortened(plan, data.outline);
        data.sources.clear();
        return data;
    }
    let moved = plan.steps.iter().map(|step| moved(plan, step)).collect();
    let on_chip = plan.steps.iter().map(|step| plan.on_chip_of_each(step)).collect();
    data.body = Body::Whole { plan, nodes: flow.nodes, edges: flow.edges, moved, on_chip };
    data
}

/// The bytes that a step moves, image by image, without those of which there are none.
fn moved(plan: &Plan, step: &Step) -> Vec<(Resource, MovedBytes)> {
    plan.moved_of_each(step).into_iter().filter(|(_, moved)| moved.sum() > 0).collect()
}
