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
    Inserted(Box<Inserted>),
}

/// Why the compiler inserted something.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Inserted {
    /// In the reader's words: "pass `tonemap` samples `color` and it has 4 samples".
    pub because: String,
    /// The place that made it necessary.
    pub at: Option<Place>,
}
