//! Passes that leave texels out, by every means that a file or its shader has: what they leave must stay as it was.
//!
//! ```text
//! seed ─► generate ─► chains ─┬─► text ─► a pipeline file and its shaders ─► compile ─► verify ─► execute, in every way ─┐
//!                             └─► meaning (texel after texel on the CPU) ─────────────────────────────────────┴─► the same
//! ```
//!
//! A [`means`] is a row of a table: a shader, the fields of its pass, and what becomes of one texel. The compiler must find out by itself
//! which of them cover: nothing here tells it.

pub mod generate;
pub mod judge;
pub mod meaning;
pub mod means;
pub mod text;

use means::Means;

/// Width and height of all images.
pub const EXTENT: [u32; 2] = [16, 8];

/// The contents of some image or buffer, and what is done to it from above to below.
#[derive(Debug, Clone)]
pub struct Chain {
    /// What it is.
    pub kind: Kind,
    /// How long it lives; its depth lives as long.
    pub life: Life,
    /// What is done first, if it isn't left to the frame before.
    pub base: Option<Base>,
    /// What is done to it then.
    pub links: Vec<Link>,
}

/// What passes are done to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// An image with this many samples. A means may add depth.
    Picture(u32),
    /// A buffer of one word for each texel of an image.
    Words,
}

/// How long contents live.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Life {
    /// For one frame.
    Transient,
    /// For all frames, as one image.
    Persistent,
    /// For one frame more.
    History,
}

/// A pass that says what all texels are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Base {
    /// A full-screen draw covers them; of a buffer, a dispatch that promises to write it all.
    Covers,
    /// A draw that leaves all of them out clears them; a buffer is filled.
    Clears,
}

/// A pass that leaves texels out.
#[derive(Debug, Clone, Copy)]
pub struct Link {
    /// The means by which it does so.
    pub means: &'static Means,
    /// Which texels it leaves out: a number of [`means::PATTERNS`].
    pub pattern: usize,
    /// A number below 60, which is told by what it writes.
    pub value: u8,
    /// Whether a pass reads the contents right after it.
    pub shown: bool,
}

impl Chain {
    /// Whether depth is drawn, too.
    #[must_use]
    pub fn has_depth(&self) -> bool {
        self.links.iter().any(|link| link.means.depth)
    }

    /// Whether stencil is drawn, too.
    #[must_use]
    pub fn has_stencil(&self) -> bool {
        self.links.iter().any(|link| link.means.stencil)
    }

    /// Whether a pass may sample its depth as one value: of several samples, if it can be drawn again from the frame's start.
    #[must_use]
    pub fn shows_depth(&self) -> bool {
        let drawn_again = !self.has_stencil() && self.base.is_some();
        self.has_depth() && (self.kind != Kind::Picture(4) || drawn_again)
    }
}
