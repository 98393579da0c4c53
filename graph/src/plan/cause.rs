//! Why something is in a Plan.

use crate::base::Place;
use serde::{Deserialize, Serialize};

/// Why something is in a Plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The pipeline says so, there (`None`: the frame was built in memory).
    Written(Option<Place>),
    /// The compiler inserted it. Inserted things are few, so their reason is boxed to keep all other causes small.
    Inserted(Box<InsertionCause>),
}

/// Why the compiler inserted something.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct InsertionCause {
    /// In the reader's words: "pass `tonemap` samples `color` and it has 4 samples".
    pub because: String,
    /// The place that made it necessary.
    pub at: Option<Place>,
}

impl Cause {
    /// The place that says so or made it necessary.
    #[must_use]
    pub fn at(&self) -> Option<&Place> {
        match self {
            Cause::Written(at) => at.as_ref(),
            Cause::Inserted(why) => why.at.as_ref(),
        }
    }

    /// Why the compiler inserted it; `None`: the pipeline says so.
    #[must_use]
    pub fn because(&self) -> Option<&str> {
        match self {
            Cause::Written(_) => None,
            Cause::Inserted(why) => Some(&why.because),
        }
    }
}
