//! Why the compiler decided something: names and figures, which become a sentence only where it is shown.

use crate::vulkan::{LoadOp, StoreOp};
use serde::de::{Deserialize, Deserializer};
use serde::ser::{Serialize, Serializer};
use std::fmt::{self, Display, Formatter};
use std::sync::Arc;

/// Why the compiler decided something. It is shown, written to JSON and compared as its sentence. Comparing puts the sentences
/// together only where their parts differ.
#[derive(Debug, Clone)]
pub enum Reason {
    /// An attachment is loaded and stored so.
    LoadStore {
        /// The load operation.
        load: LoadOp,
        /// The pass that uses the attachment first.
        first: Option<Arc<str>>,
        /// Why that pass may leave texels as they were, if nothing else makes it need them.
        untouched: Option<Arc<str>>,
        /// The store operation.
        store: StoreOp,
        /// The next use of its contents.
        next: NextUse,
    },
    /// A pass draws into attachments that its scope has already.
    SharesAttachments {
        /// The names of their images.
        attachments: Box<[Arc<str>]>,
        /// The pass before it.
        before: Option<Arc<str>>,
        /// Bytes of the attachments.
        bytes: u64,
    },
    /// A pass reads at its own position an image that its scope drew.
    ReadsLocally {
        /// The image's name.
        image: Arc<str>,
        /// Its bytes.
        bytes: u64,
    },
    /// The sentence itself: of a Plan that was read, or written by hand.
    Sentence(Box<str>),
}

/// The next use of an attachment's contents.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NextUse {
    /// A pass of this name uses them.
    Pass(Arc<str>),
    /// An inserted resolve or copy reads them.
    Transfer,
    /// They outlive the frame.
    AfterFrame,
    /// They are overwritten.
    Replaced,
    /// None.
    Never,
}

impl Display for Reason {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let name = |name: &Option<Arc<str>>| name.clone().unwrap_or_default();
        match self {
            Reason::LoadStore { load, first, untouched, store, next } => {
                let first = name(first);
                match load {
                    LoadOp::Clear => write!(f, "`{first}` clears it; "),
                    LoadOp::Load => match untouched {
                        Some(why) => write!(
                            f,
                            "`{first}` may leave texels as they were: {why}; `covers: true` promises that it sets them all; "
                        ),
                        None => write!(f, "`{first}` continues on what is there; "),
                    },
                    LoadOp::DontCare => write!(f, "`{first}` covers every pixel; "),
                }?;
                next.fmt_after(*store, f)
            }
            Reason::SharesAttachments { attachments, before, bytes } => {
                f.write_str("draws into ")?;
                for (at, attachment) in attachments.iter().enumerate() {
                    write!(f, "{}`{attachment}`", if at > 0 { " and " } else { "" })?;
                }
                let (before, saved) = (name(before), mebibytes(*bytes));
                write!(f, " like `{before}`: {saved:.1} MiB need neither be stored nor loaded")
            }
            Reason::ReadsLocally { image, bytes } => {
                write!(
                    f,
                    "reads `{image}` at its own position: {:.1} MiB need not be read from memory",
                    mebibytes(*bytes)
                )
            }
            Reason::Sentence(sentence) => f.write_str(sentence),
        }
    }
}

impl NextUse {
    /// Writes why the contents are stored so.
    fn fmt_after(&self, store: StoreOp, f: &mut Formatter<'_>) -> fmt::Result {
        let is_used = matches!(self, NextUse::Pass(_) | NextUse::Transfer | NextUse::AfterFrame);
        match store {
            StoreOp::None if !is_used => return f.write_str("only tested here"),
            StoreOp::None => f.write_str("only tested here, and ")?,
            StoreOp::Store | StoreOp::DontCare => {}
        }
        match self {
            NextUse::Pass(name) => write!(f, "`{name}` uses it next"),
            NextUse::Transfer => f.write_str("it is resolved or copied next"),
            NextUse::AfterFrame => f.write_str("it outlives the frame"),
            NextUse::Replaced => f.write_str("what comes next starts afresh"),
            NextUse::Never => f.write_str("nobody needs it afterwards"),
        }
    }
}

fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

impl From<&str> for Reason {
    fn from(sentence: &str) -> Reason {
        Reason::Sentence(sentence.into())
    }
}

impl PartialEq for Reason {
    fn eq(&self, other: &Reason) -> bool {
        self.has_parts_of(other) || self.to_string() == other.to_string()
    }
}

impl Reason {
    /// Whether both are put together of the same parts. If not, their sentences may be the same.
    fn has_parts_of(&self, other: &Reason) -> bool {
        use Reason::{LoadStore, ReadsLocally, Sentence, SharesAttachments};
        match (self, other) {
            (
                LoadStore { load, first, untouched, store, next },
                LoadStore { load: load_2, first: first_2, untouched: untouched_2, store: store_2, next: next_2 },
            ) => (load, first, untouched, store, next) == (load_2, first_2, untouched_2, store_2, next_2),
            (
                SharesAttachments { attachments, before, bytes },
                SharesAttachments { attachments: attachments_2, before: before_2, bytes: bytes_2 },
            ) => (attachments, before, bytes) == (attachments_2, before_2, bytes_2),
            (ReadsLocally { image, bytes }, ReadsLocally { image: image_2, bytes: bytes_2 }) => {
                (image, bytes) == (image_2, bytes_2)
            }
            (Sentence(sentence), Sentence(other)) => sentence == other,
            _ => false,
        }
    }
}

impl Serialize for Reason {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Reason {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Reason, D::Error> {
        String::deserialize(deserializer).map(|sentence| Reason::Sentence(sentence.into()))
    }
}
