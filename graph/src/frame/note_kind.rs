//! The kinds of notes on a frame and its Plan.

use serde::{Deserialize, Serialize};

/// The kind of a note: what it tells of its subject. A stable code of a note belongs to its kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoteKind {
    /// A condition switches a pass off.
    Off,
    /// A condition leaves out an image that a pass samples.
    LeftOut,
    /// A pass can't be drawn for two eyes.
    NotForTwoEyes,
    /// An image is drawn for one eye after the other.
    EyesApart,
    /// A pass draws once for both eyes what each eye sees.
    SharedByEyes,
    /// A matrix is the same for both eyes.
    SeenAlike,
    /// Something stays from frame to frame, since its writer doesn't run in each.
    Stays,
    /// A pass keeps what it doesn't write.
    Kept,
    /// A policy for formats isn't followed: something else fixes the format.
    PolicyHindered,
    /// A policy for formats chose a depth format that is too coarse for the scene.
    PolicyTooCoarse,
    /// A depth format is too coarse for the scene.
    TooCoarse,
    /// A pass draws one view into an image of another view.
    OtherView,
    /// A shader may leave a value unset.
    Unset,
    /// No target takes what a shader puts out.
    Untaken,
    /// No output needs what a pass writes.
    Unneeded,
    /// An image has another format than was asked for.
    OtherFormat,
    /// Images have another number of samples than was asked for.
    OtherSamples,
    /// Whether a shader is valid SPIR-V isn't known.
    UnknownSpirv,
    /// The first instance of a draw must be 0.
    FirstInstance,
    /// Alpha to coverage is off.
    NoAlphaToCoverage,
    /// An image with one sample needs no resolve.
    NotResolved,
    /// A pass that is off leaves an image as it is.
    Untouched,
    /// Two images are one.
    OneImage,
    /// A pass draws with one sample in place of several.
    OneSample,
    /// A pass draws with several samples, although it fills its target evenly.
    SeveralSamples,
    /// Only the graphics queue can run a pass.
    GraphicsOnly,
    /// A pass uses something that is handed in and that another queue uses.
    SharedWithQueue,
    /// The best queue of a pass wasn't found out.
    QueueUndecided,
    /// The queue of a pass was weighed by what it saves and what waits cost.
    QueueWeighed,
    /// A resolve is a step of its own.
    ResolvedAlone,
    /// A pass opens a rendering scope of its own.
    OwnScope,
    /// A pass reads from memory what it reads at its own position.
    ReadFromMemory,
}
