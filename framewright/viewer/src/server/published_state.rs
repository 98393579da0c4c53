//! What browsers are told: the state of the page, numbered, and its pictures.

use super::controls::Controls;
use crate::history::History;
use crate::times::Times;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A state of the page. The server counts them; before the first one the number is 0.
#[derive(Debug, Clone, Default)]
pub struct PublishedState {
    /// Its number.
    pub version: u64,
    /// The server that numbers them.
    pub server: Arc<str>,
    /// The state as JSON: `live` is a [`LiveState`], `page` the data of the page of the last good frame, or null;
    /// of a server that keeps earlier states, `history` lists them.
    pub json: Arc<str>,
    /// PNG files of the last good frame, by their addresses.
    pub pictures: Arc<BTreeMap<String, Arc<[u8]>>>,
    /// Earlier states, of which browsers ask for two to be compared.
    pub history: Arc<History>,
}

/// The part of a state that changes even where the last good frame stays.
#[derive(Debug, Serialize)]
pub struct LiveState<'a> {
    /// The version of this form: [`About::FORMAT_VERSION`](super::About::FORMAT_VERSION).
    pub format_version: u32,
    /// What tells this server from earlier ones of the same address.
    pub server: &'a str,
    /// The state's number.
    pub version: u64,
    /// The number of the last good frame: as long as it stays, `page` does.
    pub frame: u64,
    /// Whether a frame is being drawn.
    pub busy: bool,
    /// The mistakes that keep a newer frame from being drawn, as `check --format json` has them.
    pub mistakes: &'a Value,
    /// The same as `check` prints them; empty if there is none.
    pub message: &'a str,
    /// The texts that the mistakes point into.
    pub sources: &'a [SourceText],
    /// The pipeline's settings and presets.
    #[serde(flatten)]
    pub controls: &'a Controls,
    /// The settings that were chosen in the page.
    pub chosen: &'a BTreeMap<String, String>,
    /// The preset that was chosen in the page.
    pub preset: Option<&'a str>,
    /// The outputs of the last good frame.
    pub outputs: &'a [Output],
    /// What the last good frame took, in words.
    pub took: &'a str,
    /// What it is of, where a program serves the page; `None`: `serve` does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program: Option<LiveProgram<'a>>,
    /// How long the last frames took, where it changes from state to state; `None`: the page's own data has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub times: Option<&'a Times>,
}

/// What the page of a program looks at.
#[derive(Debug, Serialize)]
pub struct LiveProgram<'a> {
    /// The renderers that the program draws with, in the order in which they were first seen.
    pub renderers: &'a [LiveRenderer],
    /// The id of the one that is shown.
    pub renderer: u64,
    /// Whether the frame that is shown stays.
    pub held: bool,
    /// The number of the frame that is shown, from 0; `None`: it has drawn none.
    pub frame: Option<u64>,
    /// The name of the device.
    pub device: &'a str,
    /// The name and version of its driver.
    pub driver: &'a str,
    /// What the validation layer found, if the device has one.
    pub findings: &'a [ShownFinding],
}

/// A renderer of a program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LiveRenderer {
    /// [`Renderer::id`](framewright::Renderer::id).
    pub id: u64,
    /// Its name, which no other one has: of several renderers of one pipeline, the second is called `… (2)`.
    pub name: String,
}

/// A message of the validation layer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ShownFinding {
    /// The rule's name.
    pub rule: String,
    /// The layer's words.
    pub text: String,
    /// The step and pass that was recorded; `None`: the layer doesn't tell.
    pub at: Option<String>,
    /// How often it was said.
    pub times: usize,
}

/// A picture of an output.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Output {
    /// The output's name.
    pub name: String,
    /// The address of its picture.
    pub picture: String,
}

/// A file of the pipeline.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SourceText {
    /// Its path, counted from the pipeline's folder.
    pub name: String,
    /// Its name in mistakes.
    pub shown: String,
    /// What it holds.
    pub text: String,
}
