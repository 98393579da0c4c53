//! A state as a page of one file, which opens from disk: its pictures lie within it.

use super::published_state::PublishedState;
use crate::page;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};
use std::time::{SystemTime, UNIX_EPOCH};

/// The page of the frame that a state shows; without the texts of the pipeline's files, unless `with_sources`. `lost` says why it is the last one.
/// `None`: the state shows no frame.
///
/// # Errors
/// If the state is no JSON.
pub(crate) fn saved_page(
    state: &PublishedState,
    with_sources: bool,
    lost: Option<&str>,
) -> serde_json::Result<Option<String>> {
    if state.json.is_empty() {
        return Ok(None);
    }
    let mut told: Value = serde_json::from_str(&state.json)?;
    let (mut live, mut data) = (told["live"].take(), told["page"].take());
    let Some(plans) = data["plans"].as_array_mut() else { return Ok(None) };
    for plan in plans {
        if !with_sources {
            plan["sources"] = json!([]);
        }
        if let Some(times) = live.get("times") {
            plan["times"] = times.clone();
        }
    }
    let pictures = [(&mut live, "outputs", "picture"), (&mut data, "captures", "file")];
    for (part, list, field) in pictures {
        for address in part[list].as_array_mut().into_iter().flatten().filter_map(|one| one.get_mut(field)) {
            embed(state, address);
        }
    }
    // Nobody answers the page when it asks for others.
    if let Some(captures) = data["captures"].as_array_mut() {
        captures.retain(|capture| capture["data"].is_string());
    }
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    data["saved"] = json!({
        "seconds": seconds,
        "lost": lost,
        "program": live["program"],
        "outputs": live["outputs"],
        "took": live["took"],
        "message": if with_sources { live["message"].take() } else { json!("") },
    });
    page::saved_page(&data).map(Some)
}

/// Puts a picture in place of its address.
fn embed(state: &PublishedState, address: &mut Value) {
    let name = address.as_str().and_then(|address| address.strip_prefix("picture/"));
    if let Some(png) = name.and_then(|name| state.pictures.get(name)) {
        *address = format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png)).into();
    }
}
