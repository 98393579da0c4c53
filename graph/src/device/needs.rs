//! What shaders ask of a device beyond what every device has.

use super::{Limit, Limits};
use crate::vulkan::VertexFormat;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

/// Something that not every device has or allows.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Need {
    /// What it is.
    pub kind: NeedKind,
    /// The file and line of the shader that show it, `FILE:LINE`; its file alone where no line does; empty if nothing is known.
    pub place: Arc<str>,
}

/// A thing that not every device has or allows.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum NeedKind {
    /// A feature, by Vulkan's name, and what it is needed for.
    Feature {
        /// Vulkan's name.
        #[serde(deserialize_with = "lasting")]
        name: Word,
        /// What of the shader needs it, in words: `an element of an array`.
        #[serde(deserialize_with = "lasting")]
        what: Word,
    },
    /// More than every device allows.
    Limit {
        /// The limit.
        limit: Limit,
        /// As much is needed.
        value: u64,
        /// What needs as much, in words with the value: `its workgroups have 1024 invocations`.
        what: Arc<str>,
    },
    /// Vertices of a format that not every device reads.
    VertexFormat {
        /// The format.
        format: VertexFormat,
        /// The vertex attribute's name in the shader.
        name: Arc<str>,
    },
    /// The validator of SPIR-V doesn't know a word, so nothing says whether the shader is valid: its message.
    Unjudged(Arc<str>),
}

/// A word that lasts as long as the program. As a reference it would be borrowed from the text that is read.
type Word = &'static str;

/// Reads such a word. Each is kept once, and there are few.
fn lasting<'de, D: Deserializer<'de>>(from: D) -> Result<Word, D::Error> {
    static WORDS: Mutex<BTreeSet<Word>> = Mutex::new(BTreeSet::new());
    let word = String::deserialize(from)?;
    let mut words = WORDS.lock().unwrap_or_else(PoisonError::into_inner);
    Ok(words.get(&*word).copied().unwrap_or_else(|| {
        let word = &*word.leak();
        words.insert(word);
        word
    }))
}

/// What a device has, for [`Need::unmet`].
pub struct Abilities<'d> {
    /// The device in messages: its name in backticks, or `this device`.
    pub device: &'d str,
    /// Its limits, if they are known.
    pub limits: Option<&'d Limits>,
    /// Whether it has the feature of this name.
    pub has: &'d dyn Fn(&str) -> bool,
    /// Whether it reads vertices of this format, or that isn't known.
    pub reads_vertices: &'d dyn Fn(VertexFormat) -> bool,
}

impl Need {
    /// Why a device doesn't meet it, in words; `None` if it does, or if that isn't known.
    #[must_use]
    pub fn unmet(&self, abilities: &Abilities<'_>) -> Option<String> {
        let device = abilities.device;
        let what = match &self.kind {
            NeedKind::Feature { name, what } if !(abilities.has)(name) => {
                format!("{what} needs the feature {name}, which {device} doesn't have")
            }
            NeedKind::Limit { limit, value, what } => {
                let most = abilities.limits?.of(*limit);
                (*value > most).then(|| format!("{what}; {device} allows {most} ({})", limit.name()))?
            }
            NeedKind::VertexFormat { format, name } if !(abilities.reads_vertices)(*format) => {
                format!("the vertex attribute `{name}` has the format {format}, of which {device} reads no vertices")
            }
            NeedKind::Feature { .. } | NeedKind::VertexFormat { .. } | NeedKind::Unjudged(_) => return None,
        };
        Some(if self.place.is_empty() { what } else { format!("{}: {what}", self.place) })
    }
}
