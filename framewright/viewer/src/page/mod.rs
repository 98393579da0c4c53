//! A Plan, or two, as one HTML page that needs nothing else, not even a network.

mod thumbnail;

pub use framewright_what_if::MOST_NODES;
pub use thumbnail::{PictureSize, PictureTexels, Thumbnail};

use crate::html::{self, Template};
use crate::times::Times;
use framewright_graph::base::Sources;
use framewright_graph::difference::Differences;
use framewright_graph::plan::{Detail, Plan};
use framewright_what_if::PlanView;
use serde::Serialize;

const TEMPLATE: Template<'_> = Template {
    page: include_str!("page.html"),
    style: concat!(include_str!("page.css"), include_str!("pictures.css")),
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
        include_str!("asked.js"),
        include_str!("pictures.js"),
        include_str!("tiny.js"),
        include_str!("histogram.js"),
        include_str!("stage.js"),
        include_str!("large.js"),
        include_str!("details.js"),
        include_str!("history.js"),
        include_str!("live.js"),
        include_str!("what_if.js"),
        include_str!("saved.js"),
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
    /// The form of states that the page shows, where it asks its server for them.
    live: Option<u32>,
    plans: Vec<PlanData<'a>>,
    differences: Option<&'a Differences>,
    devices: &'a [DeviceDifferences],
    captures: &'a [Thumbnail],
}

#[derive(Serialize)]
struct PlanData<'a> {
    #[serde(flatten)]
    view: PlanView<'a>,
    times: Option<&'a Times>,
}

/// The data of a page whose Plan is compiled anew in the page.
#[derive(Serialize)]
struct WhatIfData<'a, W> {
    #[serde(flatten)]
    data: Data<'a>,
    what_if: &'a W,
}

/// The page.
///
/// # Errors
/// If a Plan has no JSON form.
pub fn page(page: &Page<'_>) -> serde_json::Result<String> {
    html::page(&TEMPLATE, &data(page))
}

/// The page, with what it compiles the pipeline anew by.
///
/// # Errors
/// If a Plan has no JSON form.
pub(crate) fn page_of_compiler(page: &Page<'_>, what_if: &impl Serialize) -> serde_json::Result<String> {
    html::page_of_modules(&TEMPLATE, &WhatIfData { data: data(page), what_if })
}

/// The page that asks its server for its data, again and again: states of the form `format_version`.
///
/// # Errors
/// None that happens.
pub fn live_page(format_version: u32) -> serde_json::Result<String> {
    let template = Template { images: "'self'", asked: "'self'", ..TEMPLATE };
    html::page(&template, &Data { live: Some(format_version), ..Data::default() })
}

/// A page that opens from disk, of data whose pictures lie within it.
///
/// # Errors
/// None that happens.
pub(crate) fn saved_page(data: &serde_json::Value) -> serde_json::Result<String> {
    html::page(&Template { images: "data:", ..TEMPLATE }, data)
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
    Data { live: None, plans, differences, devices, captures }
}

fn plan_data<'a>(shown: &'a ShownPlan<'a>) -> PlanData<'a> {
    let ShownPlan { name, plan, detail, sources, times } = shown;
    PlanData { view: PlanView::of(name, plan, *detail, *sources), times: *times }
}
