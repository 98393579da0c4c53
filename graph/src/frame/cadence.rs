//! In which frames a pass runs.

use serde::{Deserialize, Serialize};
use std::fmt::{Display, Formatter};
use std::sync::Arc;

/// In which frames a pass runs. All passes run in the first frame of an executor.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Cadence {
    /// In every frame.
    #[default]
    Always,
    /// In the first frame alone.
    Once,
    /// In the first frame, and in each whose number divided by `count` leaves `at`.
    Every {
        /// How many frames it is from one run to the next, from 2 to [`Cadence::LONGEST`].
        count: u32,
        /// Below `count`.
        at: u32,
    },
    /// In the first frame, and in the next one after the program said that this name is dirty.
    WhenDirty(Arc<str>),
}

impl Cadence {
    /// The most frames from one run to the next.
    pub const LONGEST: u32 = 1_000_000;

    /// Every `count` frames, where the number of the frame leaves `at`; always if that is every frame.
    #[must_use]
    pub const fn every(count: u32, at: u32) -> Cadence {
        if count == 1 && at == 0 { Cadence::Always } else { Cadence::Every { count, at } }
    }

    /// Whether a pass runs in every frame.
    #[must_use]
    pub const fn is_always(&self) -> bool {
        matches!(self, Cadence::Always)
    }

    /// What is wrong with it, if anything is.
    pub(crate) fn problem(&self) -> Option<String> {
        match self {
            Cadence::Every { count, at } if *count > 0 && at >= count => Some(match count {
                1 => format!("in frame {at} of 1, which has the number 0"),
                _ => format!("in frame {at} of {count}, which are numbered from 0 to {}", count - 1),
            }),
            Cadence::Every { count, .. } if !(2..=Cadence::LONGEST).contains(count) => {
                Some(format!("every {count} frames; 2 to {} are possible", Cadence::LONGEST))
            }
            Cadence::WhenDirty(name) if name.is_empty() => Some("when something without a name is dirty".to_owned()),
            Cadence::Always | Cadence::Once | Cadence::Every { .. } | Cadence::WhenDirty(_) => None,
        }
    }
}

/// The words behind "runs": "once", "every 6 frames, in frame 2 of them", "when `sky` is dirty".
impl Display for Cadence {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Cadence::Always => f.write_str("always"),
            Cadence::Once => f.write_str("once"),
            Cadence::Every { count, at: 0 } => write!(f, "every {count} frames"),
            Cadence::Every { count, at } => write!(f, "every {count} frames, in number {at} of them"),
            Cadence::WhenDirty(name) => write!(f, "when `{name}` is dirty"),
        }
    }
}
