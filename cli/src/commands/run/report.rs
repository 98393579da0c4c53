//! The report of a run: a table for people, JSON for programs.

use crate::system::text;
use comfy_table::presets::ASCII_MARKDOWN;
use comfy_table::{CellAlignment, Table};
use framewright_graph::dataflow::NodeKind;
use framewright_graph::plan::{Note, SettingUsed, Totals};
use framewright_lab::timings::Row;
use framewright_viewer::Times;
use framewright_vulkan::{Canary, DeviceSummary, Message, MessageKind, Severity};
use serde::Serialize;

/// Everything that a run found out. Its JSON form is `--report`'s.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    /// 2; rises when a field changes its meaning.
    pub(crate) format_version: u32,
    /// The pipeline, as it was named; `null` if it was a Plan.
    pub(crate) pipeline: Option<String>,
    /// The Plan, as it was named; `null` if it was made of a pipeline.
    pub(crate) plan: Option<String>,
    /// The scene, as it was named.
    pub(crate) scene: String,
    /// Settings in force, by name.
    pub(crate) settings: Vec<SettingUsed>,
    /// Width and height of the output in pixels.
    pub(crate) size: [u32; 2],
    /// How many times the frame was drawn.
    pub(crate) frames: u32,
    pub(crate) device: DeviceUsed,
    /// Memory of images and buffers.
    pub(crate) memory: Memory,
    pub(crate) barriers: Barriers,
    /// Median of the frame's GPU times over all frames.
    pub(crate) gpu_milliseconds: f64,
    /// Median of the processor times that recording a frame took.
    pub(crate) recording_milliseconds: f64,
    /// Passes in the order of execution, inserted resolves and copies between them.
    pub(crate) passes: Vec<Row>,
    /// The times of all frames, step by step; `null` if the device measures none.
    pub(crate) times: Option<Times>,
    /// The compiler's remarks.
    pub(crate) notes: Vec<Note>,
    /// Content of the scene's file that isn't drawn.
    pub(crate) scene_notes: Vec<String>,
    /// Messages of the validation layer; `null` without `--validate`.
    pub(crate) validation: Option<Validation>,
    /// Files that were written, as they were named.
    pub(crate) files: Vec<String>,
}

/// A device.
#[derive(Debug, Serialize)]
pub(crate) struct DeviceUsed {
    pub(crate) name: String,
    /// Its driver and the driver's version.
    pub(crate) driver: String,
    /// `cpu`, `integrated`, `discrete`, `virtual` or `other`.
    pub(crate) kind: &'static str,
    /// Its Vulkan version.
    pub(crate) vulkan: String,
}

/// Bytes of images and buffers.
#[derive(Debug, Serialize)]
pub(crate) struct Memory {
    /// The bytes of all transient ones, if each had memory of its own.
    pub(crate) sum_bytes: u64,
    /// The bytes of the heaps that they share.
    pub(crate) placed_bytes: u64,
    /// Alive at the worst moment: no placement can need less.
    pub(crate) live_peak_bytes: u64,
    /// The bytes of those that outlive the frame: outputs, imported and persistent ones.
    pub(crate) kept_bytes: u64,
}

/// Barriers and waits of one frame.
#[derive(Debug, Serialize)]
pub(crate) struct Barriers {
    /// Calls of `vkCmdPipelineBarrier2`.
    pub(crate) calls: u32,
    pub(crate) image: u32,
    pub(crate) memory: u32,
    /// Waits of one queue for another.
    pub(crate) waits: u32,
}

/// Messages of the validation layer.
#[derive(Debug, Serialize)]
pub(crate) struct Validation {
    /// The layer and its version.
    pub(crate) layer: String,
    /// Whether it reported a planted hazard of dynamic rendering attachments. Every layer that gets this far reported a
    /// simpler planted mistake.
    pub(crate) sees_attachments: bool,
    /// The rules' names in the messages about the planted mistakes.
    pub(crate) canary: Vec<String>,
    /// Number of messages that say that something is wrong, each counted once however often it was said.
    pub(crate) findings: usize,
    /// Every message that says something else.
    pub(crate) messages: Vec<ValidationMessage>,
}

/// A message of the validation layer.
#[derive(Debug, Serialize)]
pub(crate) struct ValidationMessage {
    /// `error` or `warning`.
    pub(crate) severity: &'static str,
    /// `validation`, `performance` or `general`.
    pub(crate) kind: &'static str,
    /// Whether it says that something is wrong.
    pub(crate) finding: bool,
    /// How often it was said: of each draw, for example.
    pub(crate) times: usize,
    /// The rule's name.
    pub(crate) id: String,
    /// The layer's words.
    pub(crate) text: String,
    /// The step and pass that were recorded, if the layer tells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) at: Option<String>,
    /// Both, for people.
    #[serde(skip)]
    located: String,
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
            kept_bytes: totals.kept_bytes,
        }
    }
}

impl From<&Totals> for Barriers {
    fn from(totals: &Totals) -> Barriers {
        Barriers {
            calls: totals.barrier_calls,
            image: totals.image_barriers,
            memory: totals.memory_barriers,
            waits: totals.waits,
        }
    }
}

impl Validation {
    /// The layer's messages besides those about the canary.
    #[must_use]
    pub(crate) fn new(canary: Canary, messages: &[(Message, usize)]) -> Validation {
        let messages: Vec<ValidationMessage> = messages.iter().map(ValidationMessage::from).collect();
        Validation {
            layer: canary.layer,
            sees_attachments: canary.sees_attachments,
            canary: canary.messages.into_iter().map(|message| message.id).collect(),
            findings: messages.iter().filter(|message| message.finding).count(),
            messages,
        }
    }
}

impl From<&(Message, usize)> for ValidationMessage {
    fn from((message, times): &(Message, usize)) -> ValidationMessage {
        ValidationMessage {
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
            times: *times,
            id: message.id.clone(),
            text: message.text.clone(),
            at: message.at.clone(),
            located: message.located(),
        }
    }
}

impl Report {
    /// The report for people.
    #[must_use]
    pub(crate) fn table(&self) -> String {
        let mut table = Table::new();
        table.load_preset(ASCII_MARKDOWN).set_header(["step", "pass", "draws", "culled", "GPU ms"]);
        for row in &self.passes {
            let name = match row.inserted {
                Some(word) => format!("({word} {})", text::cell(&row.name)),
                None => text::cell(&row.name),
            };
            let count = |count: u32| if row.kind == NodeKind::Draw { count.to_string() } else { String::new() };
            let (draws, culled) = (count(row.draws), count(row.culled));
            table.add_row([row.step.to_string(), name, draws, culled, format!("{:.2}", row.gpu_milliseconds)]);
        }
        let sum = |count: fn(&Row) -> u32| self.passes.iter().map(count).sum::<u32>().to_string();
        let (draws, culled) = (sum(|row| row.draws), sum(|row| row.culled));
        table.add_row(["", "frame", &draws, &culled, &format!("{:.2}", self.gpu_milliseconds)]);
        for column in [0, 2, 3, 4] {
            if let Some(column) = table.column_mut(column) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        let (memory, barriers) = (&self.memory, &self.barriers);
        let mut shown = format!(
            "{table}\n\
             device:   {} ({}, Vulkan {})\n\
             memory:   {} in {}, {} alive at the worst moment; {} outlive the frame\n\
             barriers: {} image and {} memory barriers in {}{}\n\
             recorded: in {:.2} ms of the processor's time\n",
            text::escape(&self.device.name),
            text::escape(&self.device.driver),
            text::escape(&self.device.vulkan),
            text::bytes(memory.sum_bytes),
            text::bytes(memory.placed_bytes),
            text::bytes(memory.live_peak_bytes),
            text::bytes(memory.kept_bytes),
            barriers.image,
            barriers.memory,
            text::count(barriers.calls as usize, "call", "calls"),
            match barriers.waits {
                0 => String::new(),
                waits => format!(", {} for another queue", text::count(waits as usize, "wait", "waits")),
            },
            self.recording_milliseconds,
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
            let (id, said) = (text::escape(&message.id), text::escape(&message.located));
            let times = if message.times > 1 { format!(", {} times", message.times) } else { String::new() };
            shown += &format!("{word} ({}{times}): {id}: {said}\n", message.kind);
        }
        shown
    }
}
