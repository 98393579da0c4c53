//! The list that is laid over what a window shows: the pipeline, its settings, the times of its passes, and the keys.

mod contents;
mod lines;
mod paint;

pub(super) use contents::Contents;

use crate::drawing::timings::{self, Row};
use crate::error::Error;
use framewright::Swapchain;
use framewright_graph::plan::Plan;
use framewright_vulkan::{FrameReport, Overlay};
use lines::Line;
use paint::Grid;
use std::time::{Duration, Instant};

/// The list is made anew this often, and when a key was pressed.
const ANEW: Duration = Duration::from_millis(250);
/// Frames that a time is the median of, at most.
const FRAMES: usize = 64;

/// The list of a window.
pub(super) struct List {
    on: bool,
    /// When it was made; `None`: it is to be made anew.
    made: Option<Instant>,
    /// What frames took since then.
    reports: Vec<FrameReport>,
    /// The times of passes, as they were known last.
    times: Vec<Row>,
    /// What is shown.
    shown: Option<(Grid, Vec<Line>)>,
}

impl List {
    /// A list that is shown from the beginning, or not.
    pub(super) fn new(on: bool) -> List {
        List { on, made: None, reports: Vec::new(), times: Vec::new(), shown: None }
    }

    /// Shows it, or takes it away.
    ///
    /// # Errors
    /// Those of [`Swapchain::set_overlay`].
    pub(super) fn turn(&mut self, swapchain: &mut Swapchain) -> Result<(), Error> {
        *self = List::new(!self.on);
        Ok(swapchain.set_overlay(None)?)
    }

    /// Something that it tells has changed: it is made anew for the next frame.
    pub(super) fn changed(&mut self) {
        self.made = None;
    }

    /// The Plan is another one: the times of its passes aren't known yet.
    pub(super) fn replanned(&mut self) {
        self.reports.clear();
        self.times.clear();
    }

    /// A frame of the Plan took so long.
    pub(super) fn took(&mut self, report: FrameReport) {
        if self.on && self.reports.len() < FRAMES {
            self.reports.push(report);
        }
    }

    /// Whether it is time to make it anew.
    pub(super) fn is_due(&self) -> bool {
        self.on && self.made.is_none_or(|made| made.elapsed() >= ANEW)
    }

    /// The times of the passes of the Plan, the longest first.
    pub(super) fn times(&mut self, plan: &Plan) -> &[Row] {
        if !self.reports.is_empty() {
            self.times = timings::rows(plan, &self.reports);
            self.times.sort_by(|one, other| other.gpu_milliseconds.total_cmp(&one.gpu_milliseconds));
            self.reports.clear();
        }
        &self.times
    }

    /// Lays it over the window, unless it is there. A pixel of the list is that of a screen of this scale factor.
    ///
    /// # Errors
    /// Those of [`Swapchain::set_overlay`].
    pub(super) fn show(&mut self, contents: &Contents, scale: f64, swapchain: &mut Swapchain) -> Result<(), Error> {
        self.made = Some(Instant::now());
        let Some(extent) = swapchain.extent() else { return Ok(()) };
        let grid = Grid::new(extent, scale);
        let lines = lines::of(contents, grid.columns, grid.rows);
        if self.shown.as_ref().is_some_and(|shown| shown.0 == grid && shown.1 == lines) {
            return Ok(());
        }
        let painted = paint::painted(&lines, &grid);
        let overlay = painted.as_ref().map(|it| Overlay { extent: it.extent, offset: [0, 0], texels: &it.texels });
        swapchain.set_overlay(overlay.as_ref())?;
        self.shown = Some((grid, lines));
        Ok(())
    }
}
