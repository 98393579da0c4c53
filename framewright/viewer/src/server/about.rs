//! What tells a viewer from other servers.

use serde::{Deserialize, Serialize};

/// What answers at an address.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct About {
    /// [`About::VIEWER`].
    pub server: String,
    /// The version of Framewright that serves the page.
    pub version: String,
    /// The form of its states: [`LiveState::format_version`](super::LiveState::format_version).
    pub format_version: u32,
}

impl About {
    /// The name of a viewer's server.
    pub const VIEWER: &'static str = "framewright-viewer";
    /// The form of states that this version writes and reads.
    pub const FORMAT_VERSION: u32 = 1;

    /// That of this version.
    #[must_use]
    pub fn own() -> About {
        About {
            server: About::VIEWER.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            format_version: About::FORMAT_VERSION,
        }
    }
}
