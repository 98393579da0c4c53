//! Passes of a frame, and their work.

use super::{
    BufferUse, Cadence, ColorTarget, DeclaredUse, DepthTarget, ParamValue, RasterState, SampledImage, Storage,
    TransferUse, ViewIndex, Work,
};
use crate::base::Span;
use crate::device::Need;
use std::sync::Arc;

/// One pass.
#[derive(Debug, Clone, PartialEq)]
pub struct Pass {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// The view that it draws for.
    pub view: ViewIndex,
    /// In which frames it runs.
    pub run: Cadence,
    /// The work of the pass.
    pub work: Work,
    /// Images that its shaders sample.
    pub sampled: Vec<SampledImage>,
    /// Images that its shaders write (and perhaps read) without attachments.
    pub storage: Vec<Storage>,
    /// Colour attachments by location.
    pub color: Vec<ColorTarget>,
    /// Depth (and stencil) attachment.
    pub depth: Option<DepthTarget>,
    /// How its primitives become fragments.
    pub raster: RasterState,
    /// Where that was said; of no place if nothing was.
    pub raster_span: Span,
    /// Whether the alpha of the first colour says how many samples are covered, where the targets have several.
    pub alpha_to_coverage: bool,
    /// Whether the file promises that it sets every texel of its targets; blending and tests need what is there all the same.
    pub covers: bool,
    /// Why it may leave texels of its targets as they were although it fills the screen, in words; `None`: it sets them all, or it
    /// doesn't fill the screen. If there are any words, a draw doesn't cover.
    pub untouched: Option<Arc<str>>,
    /// Why its shader can't draw its depth alone, for images of fewer samples, if it can't.
    pub no_depth_only: Option<Arc<str>>,
    /// Why its shader can't draw into an image that is turned, if it can't, behind the name of the pass.
    pub no_rotation: Option<Arc<str>>,
    /// What its shader and its resources ask of the device beyond what every device has.
    pub needs: Vec<Need>,
    /// Why the compiler inserted it; in frames that it is given, nothing is.
    pub inserted: Option<Arc<str>>,
    /// Buffers that it reads or writes by anything but a copy or fill.
    pub buffers: Vec<BufferUse>,
    /// Images and buffers that a copy, blit, fill or custom pass reads and writes by transfer: source before target.
    pub transfers: Vec<TransferUse>,
    /// How the commands of a custom pass use what it names. What isn't declared is used by any commands.
    pub uses: Vec<DeclaredUse>,
    /// Whether a custom pass that declares how it uses all that it names may be recorded for a queue for compute.
    pub any_queue: bool,
    /// Whether the program records a custom pass for both eyes at once: what it touches may hold both eyes' parts.
    pub both_eyes: bool,
    /// Whether it has an effect that no image or buffer shows: it is never culled.
    pub side_effect: bool,
    /// Values for the shader's parameter block, by member name.
    pub params: Vec<(Arc<str>, ParamValue)>,
    /// Values for the shader's specialization constants, by name.
    pub constants: Vec<(Arc<str>, ParamValue)>,
}

impl Pass {
    /// A pass that accesses nothing yet, and that no file declares.
    #[must_use]
    pub fn new(name: &str, work: Work) -> Pass {
        Pass {
            name: name.into(),
            span: Span::NONE,
            view: ViewIndex::default(),
            run: Cadence::Always,
            work,
            sampled: Vec::new(),
            storage: Vec::new(),
            color: Vec::new(),
            depth: None,
            raster: RasterState::default(),
            raster_span: Span::NONE,
            alpha_to_coverage: false,
            covers: false,
            untouched: None,
            no_depth_only: None,
            no_rotation: None,
            needs: Vec::new(),
            inserted: None,
            buffers: Vec::new(),
            transfers: Vec::new(),
            uses: Vec::new(),
            any_queue: false,
            both_eyes: false,
            side_effect: false,
            params: Vec::new(),
            constants: Vec::new(),
        }
    }
}
