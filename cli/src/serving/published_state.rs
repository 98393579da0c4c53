//! What browsers are told: the state of the page, numbered, and its pictures.

use super::controls::Controls;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A state of the page. The server counts them; before the first one the number is 0.
#[derive(Debug, Clone, Default)]
pub(crate) struct PublishedState {
    pub(super) version: u64,
    /// The server that numbers them.
    pub(super) server: Arc<str>,
    /// The state as JSON: `live` is a [`LiveState`], `page` the data of the page of the last good frame, or null.
    pub(super) json: Arc<str>,
    /// PNG files of the last good frame, by their addresses.
    pub(super) pictures: Arc<BTreeMap<String, Arc<[u8]>>>,
}

/// The part of a state that changes even where the last good frame stays.
#[derive(Debug, Serialize)]
pub(super) struct LiveState<'a> {
    pub(super) format_version: u32,
    /// What tells this server from earlier ones of the same address.
    pub(super) server: &'a str,
    pub(super) version: u64,
    /// The number of the last good frame: as long as it stays, `page` does.
    pub(super) frame: u64,
    /// Whether a frame is being drawn.
    pub(super) busy: bool,
    /// The mistakes that keep a newer frame from being drawn, as `check --format json` has them.
    pub(super) mistakes: &'a Value,
    /// The same as `check` prints them; empty if there is none.
    pub(super) message: &'a str,
    /// The texts that the mistakes point into.
    pub(super) sources: &'a [SourceText],
    #[serde(flatten)]
    pub(super) controls: &'a Controls,
    /// The settings and the preset that were chosen in the page.
    pub(super) chosen: &'a BTreeMap<String, String>,
    pub(super) preset: Option<&'a str>,
    /// The outputs of the last good frame.
    pub(super) outputs: &'a [Output],
    /// What the last good frame took, in words.
    pub(super) took: &'a str,
}

/// A picture of an output.
#[derive(Debug, Serialize)]
pub(super) struct Output {
    pub(super) name: String,
    /// The address of its picture.
    pub(super) picture: String,
}

/// A file of the pipeline.
#[derive(Debug, Serialize)]
pub(super) struct SourceText {
    /// Its path, counted from the pipeline's folder.
    pub(super) name: String,
    /// Its name in mistakes.
    pub(super) shown: String,
    pub(super) text: String,
}
