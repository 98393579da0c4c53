//! What a run has to tell: the table for people, the report for programs.

use crate::text;
use comfy_table::presets::ASCII_MARKDOWN;
use comfy_table::{CellAlignment, Table};
use framewright_graph::plan::{Note, Plan, Totals, Work};
use framewright_vulkan::{Canary, DeviceSummary, FrameReport, Message, MessageKind, Severity};
use serde::Serialize;

/// Everything that a run found out. Its JSON form is `--report`'s.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    /// 1; rises when a field changes its meaning.
    pub(crate) format_version: u32,
    /// The pipeline, as it was named.
    pub(crate) pipeline: String,
    /// The scene, as it was named.
    pub(crate) scene: String,
    /// Settings in force, by name.
    pub(crate) settings: Vec<Setting>,
    /// Width and height of the output in pixels.
    pub(crate) size: [u32; 2],
    /// How many times the frame was drawn.
    pub(crate) frames: u32,
    /// The device.
    pub(crate) device: DeviceUsed,
    /// Memory of images.
    pub(crate) memory: Memory,
    /// Barriers.
    pub(crate) barriers: Barriers,
    /// Median of the frame's GPU times over all frames.
    pub(crate) gpu_milliseconds: f64,
    /// Passes in the order of execution, resolves and copies between them.
    pub(crate) passes: Vec<Row>,
    /// The compiler's remarks.
    pub(crate) notes: Vec<Note>,
    /// What the validation layer said; `null` if it wasn't asked.
    pub(crate) validation: Option<Validation>,
    /// Files that were written, as they were named.
    pub(crate) files: Vec<String>,
}

/// A setting in force.
#[derive(Debug, Serialize)]
pub(crate) struct Setting {
    /// Its name.
    pub(crate) name: String,
    /// Its value.
    pub(crate) value: String,
}

/// A device.
#[derive(Debug, Serialize)]
pub(crate) struct DeviceUsed {
    /// Its name.
    pub(crate) name: String,
    /// Its driver and the driver's version.
    pub(crate) driver: String,
    /// `cpu`, `integrated`, `discrete`, `virtual` or `other`.
    pub(crate) kind: &'static str,
    /// Its Vulkan version.
    pub(crate) vulkan: String,
}

/// Bytes of images.
#[derive(Debug, Serialize)]
pub(crate) struct Memory {
    /// Of all transient images, if each had memory of its own.
    pub(crate) sum_bytes: u64,
    /// Of the heaps that they share.
    pub(crate) placed_bytes: u64,
    /// Alive at the worst moment: no placement can need less.
    pub(crate) live_peak_bytes: u64,
    /// Of output images.
    pub(crate) output_bytes: u64,
}

/// Barriers of one frame.
#[derive(Debug, Serialize)]
pub(crate) struct Barriers {
    /// Calls of `vkCmdPipelineBarrier2`.
    pub(crate) calls: u32,
    /// Image barriers.
    pub(crate) image: u32,
    /// Memory barriers.
    pub(crate) memory: u32,
}

/// A pass, resolve or copy.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Row {
    /// The Plan's step that it belongs to.
    pub(crate) step: usize,
    /// What it is.
    pub(crate) kind: Kind,
    /// The pass's name; of resolves and copies source and target.
    pub(crate) name: String,
    /// Draw calls.
    pub(crate) draws: u32,
    /// Median of its GPU times over all frames. A resolve at the end of a rendering scope takes what its passes leave of
    /// the scope's time, stores included.
    pub(crate) gpu_milliseconds: f64,
}

/// What a row is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Kind {
    /// A pass that draws.
    Draw,
    /// A compute pass.
    Dispatch,
    /// A resolve, at the end of a rendering scope or by itself.
    Resolve,
    /// A copy.
    Copy,
}

/// What the validation layer said.
#[derive(Debug, Serialize)]
pub(crate) struct Validation {
    /// The layer and its version.
    pub(crate) layer: String,
    /// Whether it sees hazards of dynamic rendering attachments, told by a mistake that was planted. Every layer that gets
    /// this far reported a simpler planted mistake.
    pub(crate) sees_attachments: bool,
    /// The rules' names in the messages about the planted mistakes.
    pub(crate) canary: Vec<String>,
    /// Number of messages that say that something is wrong.
    pub(crate) findings: usize,
    /// Every message.
    pub(crate) messages: Vec<Said>,
}

/// A message of the validation layer.
#[derive(Debug, Serialize)]
pub(crate) struct Said {
    /// `error` or `warning`.
    pub(crate) severity: &'static str,
    /// `validation`, `performance` or `general`.
    pub(crate) kind: &'static str,
    /// Whether it says that something is wrong.
    pub(crate) finding: bool,
    /// The rule's name.
    pub(crate) id: String,
    /// The layer's words.
    pub(crate) text: String,
}

impl From<&DeviceSummary> for DeviceUsed {
    fn from(device: &DeviceSummary) -> DeviceUsed {
        DeviceUsed {
            name: device.name.clone(),
            driver: device.driver.clone(),
            kind: device.kind,
            vulkan: device.vulkan.clone(),
        }
    }
}

impl From<&Totals> for Memory {
    fn from(totals: &Totals) -> Memory {
        Memory {
            sum_bytes: totals.transient_bytes,
            placed_bytes: totals.placed_bytes,
            live_peak_bytes: totals.live_peak_bytes,
            output_bytes: totals.output_bytes,
        }
    }
}

impl From<&Totals> for Barriers {
    fn from(totals: &Totals) -> Barriers {
        Barriers { calls: totals.barrier_calls, image: totals.image_barriers, memory: totals.memory_barriers }
    }
}

impl Validation {
    /// What the layer said besides its canary.
    #[must_use]
    pub(crate) fn new(canary: Canary, messages: &[Message]) -> Validation {
        let messages: Vec<Said> = messages.iter().map(Said::from).collect();
        Validation {
            layer: canary.layer,
            sees_attachments: canary.sees_attachments,
            canary: canary.messages.into_iter().map(|message| message.id).collect(),
            findings: messages.iter().filter(|message| message.finding).count(),
            messages,
        }
    }
}

impl From<&Message> for Said {
    fn from(message: &Message) -> Said {
        Said {
            severity: match message.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
            },
            kind: match message.kind {
                MessageKind::Validation => "validation",
                MessageKind::Performance => "performance",
                MessageKind::General => "general",
            },
            finding: message.is_finding(),
            id: message.id.clone(),
            text: message.text.clone(),
        }
    }
}

impl Report {
    /// The report for people.
    #[must_use]
    pub(crate) fn table(&self) -> String {
        let mut table = Table::new();
        table.load_preset(ASCII_MARKDOWN).set_header(["step", "pass", "draws", "GPU ms"]);
        for row in &self.passes {
            let (name, draws) = match row.kind {
                Kind::Draw => (text::escape(&row.name), row.draws.to_string()),
                Kind::Dispatch => (text::escape(&row.name), String::new()),
                Kind::Resolve => (format!("(resolve {})", text::escape(&row.name)), String::new()),
                Kind::Copy => (format!("(copy {})", text::escape(&row.name)), String::new()),
            };
            table.add_row([row.step.to_string(), name, draws, format!("{:.2}", row.gpu_milliseconds)]);
        }
        let draws: u32 = self.passes.iter().map(|row| row.draws).sum();
        table.add_row(["", "frame", &draws.to_string(), &format!("{:.2}", self.gpu_milliseconds)]);
        for column in [0, 2, 3] {
            if let Some(column) = table.column_mut(column) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        let (memory, barriers) = (&self.memory, &self.barriers);
        let mut shown = format!(
            "{table}\n\
             device:   {} ({}, Vulkan {})\n\
             memory:   {} of transient images in {}, {} alive at the worst moment; outputs {}\n\
             barriers: {} image and {} memory barriers in {}\n",
            text::escape(&self.device.name),
            text::escape(&self.device.driver),
            text::escape(&self.device.vulkan),
            text::bytes(memory.sum_bytes),
            text::bytes(memory.placed_bytes),
            text::bytes(memory.live_peak_bytes),
            text::bytes(memory.output_bytes),
            barriers.image,
            barriers.memory,
            text::count(barriers.calls as usize, "call", "calls"),
        );
        if let Some(validation) = &self.validation {
            shown += &validation.shown();
        }
        shown
    }
}

impl Validation {
    fn shown(&self) -> String {
        let layer = text::escape(&self.layer);
        let notes = self.messages.len() - self.findings;
        let mut shown = match self.findings {
            0 => format!("validation: silent; {layer} reported the mistakes that were planted to test it\n"),
            _ => format!("validation: {} by {layer}\n", text::count(self.findings, "finding", "findings")),
        };
        if !self.sees_attachments {
            shown += "validation: this layer does not see hazards of attachments; the one of Debian's chromium-common does\n";
        }
        if notes > 0 {
            shown += &format!("validation: {} without a finding\n", text::count(notes, "message", "messages"));
        }
        for message in &self.messages {
            let word = if message.finding { message.severity } else { "note" };
            shown +=
                &format!("{word} ({}): {}: {}\n", message.kind, text::escape(&message.id), text::escape(&message.text));
        }
        shown
    }
}

/// Draw counts of the last frame, and medians of the times of all.
#[must_use]
pub(crate) fn rows(plan: &Plan, frames: &[FrameReport]) -> Vec<Row> {
    let Some(last) = frames.last() else { return Vec::new() };
    let over = |time: &dyn Fn(&FrameReport) -> f64| median(frames.iter().map(time).collect());
    let mut rows = Vec::new();
    for (step, planned) in plan.steps.iter().enumerate() {
        let whole = || over(&|frame| frame.steps[step].milliseconds);
        let between = |source, target| format!("{} → {}", plan.image(source).name, plan.image(target).name);
        let mut row =
            |kind, name, draws, gpu_milliseconds| rows.push(Row { step, kind, name, draws, gpu_milliseconds });
        match &planned.work {
            Work::Render(scope) => {
                for (number, pass) in last.steps[step].passes.iter().enumerate() {
                    let time = over(&|frame| frame.steps[step].passes[number].milliseconds);
                    row(Kind::Draw, pass.name.clone(), pass.draws, time);
                }
                let resolves: Vec<String> = scope
                    .color
                    .iter()
                    .chain(&scope.depth)
                    .filter_map(|attachment| Some(between(attachment.image, attachment.resolve.as_ref()?.image)))
                    .collect();
                if !resolves.is_empty() {
                    let rest = over(&|frame| {
                        let step = &frame.steps[step];
                        step.milliseconds - step.passes.iter().map(|pass| pass.milliseconds).sum::<f64>()
                    });
                    row(Kind::Resolve, resolves.join(", "), 0, rest.max(0.0));
                }
            }
            Work::Dispatch(pass) => row(Kind::Dispatch, pass.name.to_string(), 0, whole()),
            Work::Resolve(transfer) => row(Kind::Resolve, between(transfer.source, transfer.target), 0, whole()),
            Work::Copy(transfer) => row(Kind::Copy, between(transfer.source, transfer.target), 0, whole()),
            Work::Export => {}
        }
    }
    rows
}

/// The middle of some times, or the mean of the two in the middle; 0 of none.
#[must_use]
pub(crate) fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    let middle = times.len() / 2;
    match times.len() {
        0 => 0.0,
        even if even % 2 == 0 => (times[middle - 1] + times[middle]) / 2.0,
        _ => times[middle],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_median_is_the_middle() {
        assert_eq!(median(vec![]), 0.0);
        assert_eq!(median(vec![3.0]), 3.0);
        assert_eq!(median(vec![3.0, 1.0, 100.0]), 3.0);
        assert_eq!(median(vec![4.0, 1.0]), 2.5);
    }
}
