//! Helpers that the tests share: one validated device for each test binary.

#![allow(dead_code, reason = "each test binary uses its part of this")]

pub(crate) mod plans;

use framewright_graph::frame::Draw;
use framewright_vulkan::{
    Blame, Device, DeviceChoice, DeviceOptions, DrawSource, Error, Message, Messages, Recorder, layer,
};
use std::sync::OnceLock;

/// The device that the tests of this binary share, under the best validation layer that is installed. `None`, with a
/// message, where the machine has no driver or layer; in CI that is a failure.
pub(crate) fn device() -> Option<&'static Device> {
    static DEVICE: OnceLock<Option<Device>> = OnceLock::new();
    DEVICE.get_or_init(open).as_ref()
}

/// A validated device of its own, for tests that close it or look at all its messages.
pub(crate) fn open() -> Option<Device> {
    find_layer();
    let name = std::env::var("FRAMEWRIGHT_TEST_DEVICE").ok();
    let choice = name.map_or(DeviceChoice::Default, DeviceChoice::Name);
    match Device::open(&DeviceOptions { choice, validation: true, ..DeviceOptions::default() }) {
        Ok(device) => Some(device),
        Err(error) if error.blame() == Blame::Environment => {
            skip(&error);
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Leads the loader to the current validation layer, before anything in this process uses the loader.
pub(crate) fn find_layer() {
    static FOUND: OnceLock<()> = OnceLock::new();
    FOUND.get_or_init(|| {
        if let Some(folder) = layer::manifest_folder().expect("the layer's manifest can be written") {
            // SAFETY: every test comes through here before it touches the loader, which is the only code in these test
            // binaries that reads the environment without the standard library's lock.
            unsafe { std::env::set_var("VK_LAYER_PATH", folder) };
        }
    });
}

/// Says what the machine lacks.
pub(crate) fn skip(error: &Error) {
    assert!(std::env::var_os("CI").is_none(), "in CI this is a failure: {error}");
    eprintln!("SKIPPED: {error}");
}

/// The messages that say that something is wrong.
pub(crate) fn findings(messages: &Messages) -> Vec<Message> {
    messages.list().into_iter().filter(Message::is_finding).collect()
}

/// The vertex shader of a triangle over the whole target.
pub(crate) const OVER_ALL: &str = "#version 460
    void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }";

/// The fragment shader of white.
pub(crate) const WHITE: &str = "#version 460
    layout(location = 0) out vec4 color;
    void main() { color = vec4(1.0); }";

/// Draws nothing, and knows no custom passes.
pub(crate) struct Nothing;

impl DrawSource for Nothing {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Ok(0)
    }
}
