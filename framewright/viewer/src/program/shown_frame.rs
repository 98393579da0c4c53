//! What is shown of a renderer: its Plan, the times of its last frames, and pictures of its outputs.

use crate::open_questions::{no_json, to_ask_for};
use crate::page::{Page, ShownPlan, page_data};
use crate::server::{Controls, Output, ShownFinding};
use crate::times::LastFrames;
use framewright::{Error, Renderer};
use framewright_graph::plan::{Detail, Resource};
use framewright_lab::outputs;
use framewright_lab::picture::FileFormat;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A frame of a renderer.
#[derive(Debug, Default)]
pub(super) struct ShownFrame {
    /// The renderer's id, and its number of the Plan.
    of: Option<(u64, u64)>,
    /// The state that had the Plan first.
    pub(super) version: u64,
    pub(super) page: String,
    pub(super) controls: Controls,
    pub(super) outputs: Vec<Output>,
    pub(super) pictures: Arc<BTreeMap<String, Arc<[u8]>>>,
    pub(super) last: LastFrames,
    /// The last frame whose times were taken.
    timed: Option<u64>,
    /// The frame that the pictures are of.
    pub(super) frame: Option<u64>,
    pub(super) device: String,
    pub(super) driver: String,
    pub(super) findings: Vec<ShownFinding>,
}

impl ShownFrame {
    /// The id of the renderer that it is of.
    pub(super) fn renderer(&self) -> Option<u64> {
        self.of.map(|(id, _)| id)
    }

    /// Whether it shows the Plan that the renderer draws now.
    pub(super) fn is_of(&self, renderer: &Renderer) -> bool {
        self.of == Some((renderer.id(), renderer.plans()))
    }

    /// What the Plan of a renderer shows; `version` is the number of the state that has it first.
    pub(super) fn begin(renderer: &mut Renderer, name: String, version: u64) -> Result<Option<ShownFrame>, Error> {
        let captures = to_ask_for(renderer)?;
        let Some(plan) = renderer.plan() else { return Ok(None) };
        let shown = ShownPlan {
            name,
            plan,
            detail: Detail { objects: None, verbose: true },
            sources: Some(renderer.sources()),
            times: None,
        };
        let page = Page { plans: vec![shown], differences: None, devices: &[], captures: &captures };
        let summary = renderer.device().summary();
        Ok(Some(ShownFrame {
            of: Some((renderer.id(), renderer.plans())),
            version,
            page: page_data(&page).map_err(no_json)?,
            controls: Controls::of(renderer.document(), plan),
            device: summary.name.clone(),
            driver: summary.driver.clone(),
            last: LastFrames::on(renderer.device()),
            ..ShownFrame::default()
        }))
    }

    /// Takes the times of the newest frame that the device is done with, or of the one that the next frame waits for anyway.
    pub(super) fn take_times(&mut self, renderer: &mut Renderer) -> Result<(), Error> {
        let Some(executor) = renderer.current_executor_mut() else { return Ok(()) };
        let Some(oldest) = executor.oldest_frame().filter(|frame| self.timed.is_none_or(|last| *frame > last)) else {
            return Ok(());
        };
        self.timed = Some(oldest);
        self.last.add(executor.report(oldest)?);
        Ok(())
    }

    /// Reads the outputs of the last frame; `version` is the number of the state that has their pictures.
    pub(super) fn take_pictures(&mut self, renderer: &mut Renderer, version: u64) -> Result<(), Error> {
        let Some(executor) = renderer.current_executor_mut() else { return Ok(()) };
        let images = |(at, output): (usize, &framewright_graph::plan::Output)| match output.resource {
            Resource::Image(_) => Some((at, output.name.to_string())),
            Resource::Buffer(_) => None,
        };
        let named: Vec<(usize, String)> = executor.plan().outputs.iter().enumerate().filter_map(images).collect();
        self.frame = executor.frames().checked_sub(1);
        let mut pictures = BTreeMap::new();
        self.outputs.clear();
        for (at, name) in named {
            let texels = executor.read(at)?;
            let plan = executor.plan();
            // What has no picture is left out.
            let Ok(png) = outputs::encoded(FileFormat::Png, (plan, &plan.outputs[at]), vec![texels], &|_| ()) else {
                continue;
            };
            let address = format!("{version}/{at}.png");
            self.outputs.push(Output { name, picture: format!("picture/{address}") });
            pictures.insert(address, png.into());
        }
        self.pictures = Arc::new(pictures);
        Ok(())
    }

    /// Takes what the validation layer has said.
    pub(super) fn take_findings(&mut self, renderer: &Renderer) {
        let said = renderer.device().messages().distinct();
        let found = said.into_iter().filter(|(message, _)| message.is_finding());
        let shown =
            found.map(|(message, times)| ShownFinding { rule: message.id, text: message.text, at: message.at, times });
        self.findings = shown.take(MOST_FINDINGS).collect();
    }
}

/// At most this many findings are shown.
const MOST_FINDINGS: usize = 100;
