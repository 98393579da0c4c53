//! One flat frame: what a pipeline file says once settings, conditions, facts and sizes are put in.
//!
//! This is what [`crate::compile`] reads. It still says only *what*: no barrier, layout, load or store operation, resolve
//! or alias. It is plain data, so an embedding program may also build it without any file.

use crate::format::Format;
use crate::source::{Sources, Span};
use crate::vocabulary::{CompareOp, Filter, Stages};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Index of an image in [`Frame::images`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ImageIndex(pub u32);

/// A frame: images, passes in the order that gives them meaning, outputs.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// The texts that spans point into.
    pub sources: Arc<Sources>,
    /// The settings in force, by name, as they are shown.
    pub settings: Vec<(Arc<str>, String)>,
    /// The images that passes name.
    pub images: Vec<Image>,
    /// Passes in file order. A pass reads the version of an image that stands *before itself*.
    pub passes: Vec<Pass>,
    /// Images whose last version the frame is made for.
    pub outputs: Vec<Output>,
    /// Passes that conditions switched off, and why.
    pub switched_off: Vec<SwitchedOff>,
}

/// An image of a frame.
#[derive(Debug, Clone)]
pub struct Image {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// Texel format.
    pub format: Format,
    /// Width, height, depth in texels, each at least 1.
    pub extent: [u32; 3],
    /// Mip levels, at least 1.
    pub mips: u32,
    /// Array layers, at least 1.
    pub layers: u32,
    /// Samples a texel that were asked for: 1, 2, 4, 8 or 16. `adapt` lowers it to what the device has.
    pub samples: u32,
}

/// An image that leaves the frame.
#[derive(Debug, Clone)]
pub struct Output {
    /// Which image.
    pub image: ImageIndex,
    /// Where it was named.
    pub span: Span,
}

/// A pass that a condition switched off.
#[derive(Debug, Clone)]
pub struct SwitchedOff {
    /// Its name.
    pub name: Arc<str>,
    /// Where the condition stands.
    pub span: Span,
    /// The condition with its value: "tone_mapping = false".
    pub because: String,
}

/// One pass.
#[derive(Debug, Clone)]
pub struct Pass {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// What it does.
    pub work: Work,
    /// Images that its shaders sample.
    pub sampled: Vec<Sampled>,
    /// Images that its shaders write (and perhaps read) without attachments.
    pub storage: Vec<Storage>,
    /// Colour attachments by location.
    pub color: Vec<ColorTarget>,
    /// Depth attachment.
    pub depth: Option<DepthTarget>,
    /// Values for the shader's parameter block, by member name.
    pub params: Vec<(Arc<str>, ParamValue)>,
}

/// What a pass does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Work {
    /// Draws into its attachments.
    Draw {
        /// What is drawn.
        draw: Draw,
        /// The shader's name.
        shader: Arc<str>,
        /// Whether its fragment shader discards fragments: then a full-screen draw doesn't cover.
        discards: bool,
    },
    /// Runs compute shaders.
    Dispatch {
        /// The shader's name.
        shader: Arc<str>,
    },
    /// Stands in for a pass that is off: `to` takes what `from` holds.
    Forward {
        /// Source.
        from: ImageIndex,
        /// Target.
        to: ImageIndex,
        /// The condition that switched the pass off: "tone_mapping = false".
        because: String,
    },
}

/// What a raster pass draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Draw {
    /// One of the scene's draw lists.
    Objects(DrawList),
    /// The sky, behind everything.
    Sky,
    /// One triangle that covers every pixel.
    FullScreen,
}

/// The scene's draw lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum DrawList {
    /// Objects that hide what is behind them.
    Opaque,
    /// Objects with holes: fragments whose alpha is below the material's cut-off are discarded.
    Masked,
    /// Objects that let through what is behind them, sorted back to front.
    Transparent,
}

/// An image that a pass samples.
#[derive(Debug, Clone)]
pub struct Sampled {
    /// The name by which the shader knows it.
    pub binding: Arc<str>,
    /// Which image.
    pub image: ImageIndex,
    /// Where the image was named.
    pub span: Span,
    /// Whether the shader reads single samples (the face `Samples`); else it wants one value a texel (`Resolved`).
    pub per_sample: bool,
    /// Filter between texels.
    pub filter: Filter,
    /// Shader stages that sample it.
    pub stages: Stages,
}

/// An image that a pass accesses as storage.
#[derive(Debug, Clone)]
pub struct Storage {
    /// The name by which the shader knows it.
    pub binding: Arc<str>,
    /// Which image.
    pub image: ImageIndex,
    /// Where the image was named.
    pub span: Span,
    /// Whether earlier contents are read or kept. A storage write that is not `read` replaces the image whole.
    pub read: bool,
    /// Whether it is written.
    pub write: bool,
    /// Shader stages that access it.
    pub stages: Stages,
}

/// A colour attachment.
#[derive(Debug, Clone)]
pub struct ColorTarget {
    /// Which image.
    pub image: ImageIndex,
    /// Where the image was named.
    pub span: Span,
    /// Clear value (linear), if the pass starts from a cleared image.
    pub clear: Option<[f32; 4]>,
    /// How new colour meets old.
    pub blend: Blend,
}

/// How new colour meets old.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub enum Blend {
    /// New replaces old.
    #[default]
    Replace,
    /// `new·a + old·(1 − a)`.
    Alpha,
    /// `new + old·(1 − a)`: colour that was multiplied by its alpha.
    Premultiplied,
    /// `new + old`.
    Additive,
}

/// A depth attachment.
#[derive(Debug, Clone)]
pub struct DepthTarget {
    /// Which image.
    pub image: ImageIndex,
    /// Where the image was named.
    pub span: Span,
    /// Clear value (reversed depth: 0 is infinitely far), if the pass starts from a cleared image.
    pub clear: Option<f32>,
    /// The comparison.
    pub test: CompareOp,
    /// Whether passing fragments write depth.
    pub write: bool,
}

/// A value for a shader parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ParamValue {
    /// A truth value, given to the shader as a 32-bit 0 or 1.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
}
