//! The list that is laid over what a window shows: the pipeline, its settings, the times of its passes, and the keys.

mod contents;
mod lines;
mod paint;

pub(super) use contents::Contents;

use crate::error::Error;
use framewright::{
    Change, Device, Draw, DrawSource, FrameReport, Plan, Recorder, Renderer, RendererOptions, Swapchain,
};
use framewright_graph::vulkan::Aspects;
use framewright_lab::timings::{self, Row};
use lines::Line;
use paint::{Grid, Painting};
use std::time::{Duration, Instant};

/// Draws the list over what the window shows.
const PIPELINE: &str = include_str!("list.ron");

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
    /// Its picture; `None`: there is nothing to show.
    painted: Option<Painting>,
    /// Draws the picture, where there is one.
    renderer: Option<Renderer>,
    /// What that is made with.
    options: RendererOptions,
}

/// What the list's pipeline draws beside the full screen: nothing.
pub(super) struct NoObjects;

impl DrawSource for NoObjects {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, framewright_vulkan::Error> {
        Ok(0)
    }
}

impl List {
    /// A list that is shown from the beginning, or not. It is drawn with these options.
    pub(super) fn new(on: bool, options: RendererOptions) -> List {
        List {
            on,
            made: None,
            reports: Vec::new(),
            times: Vec::new(),
            shown: None,
            painted: None,
            renderer: None,
            options,
        }
    }

    /// Shows it, or takes it away.
    pub(super) fn turn(&mut self) {
        *self = List::new(!self.on, self.options.clone());
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

    /// Has it drawn over the window from the next frame on. A pixel of the list is that of a screen of this scale factor.
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`] and of writing its picture.
    pub(super) fn show(
        &mut self,
        contents: &Contents,
        scale: f64,
        device: &Device,
        swapchain: &Swapchain,
    ) -> Result<(), Error> {
        self.made = Some(Instant::now());
        let Some(extent) = swapchain.extent() else { return Ok(()) };
        let is_new = self.paint(contents, extent, scale);
        let Some(Painting { extent: [width, height], texels }) = &self.painted else {
            self.renderer = None;
            return Ok(());
        };
        let renderer = match &mut self.renderer {
            Some(renderer) => renderer,
            none => none.insert(Renderer::carried(device, "list.ron", PIPELINE, self.options.clone())?),
        };
        renderer.fit(swapchain)?;
        renderer.set("list_width", width)?;
        renderer.set("list_height", height)?;
        let change = renderer.prepare()?.change;
        if is_new || matches!(change, Change::Executor { .. }) {
            renderer.executor_mut()?.write_image("list", Aspects::COLOR, 0, texels)?;
        }
        Ok(())
    }

    /// Paints it for a window of this size, and says whether the picture is another one than before.
    fn paint(&mut self, contents: &Contents, extent: [u32; 2], scale: f64) -> bool {
        let grid = Grid::new(extent, scale);
        let lines = lines::of(contents, grid.columns, grid.rows);
        let is_new = self.shown.as_ref().is_none_or(|shown| shown.0 != grid || shown.1 != lines);
        if is_new {
            self.painted = paint::painted(&lines, &grid);
            self.shown = Some((grid, lines));
        }
        is_new
    }

    /// What draws it, if it is shown.
    pub(super) fn renderer(&mut self) -> Option<&mut Renderer> {
        self.renderer.as_mut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_that_had_no_room_is_painted_again_when_it_has() {
        let contents = Contents { title: "forward".to_owned(), ..Contents::default() };
        let mut list = List::new(true, RendererOptions::default());
        for (extent, is_there) in [([600, 400], true), ([4, 4], false), ([600, 400], true)] {
            assert!(list.paint(&contents, extent, 1.0), "{extent:?}");
            assert_eq!(list.painted.is_some(), is_there, "{extent:?}");
        }
        assert!(!list.paint(&contents, [600, 400], 1.0));
    }
}
