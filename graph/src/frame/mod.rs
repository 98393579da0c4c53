//! One flat frame: the contents of a pipeline file once settings, conditions, facts and sizes are put in.
//!
//! A frame is the input of [`crate::compile`]. It has no barrier, layout, load or store operation, resolve or alias yet.
//! It is plain data, so an embedding program may also build it without any file.

mod access;
mod buffer_role;
mod cadence;
mod capture;
pub mod change;
pub(crate) mod check;
mod coverage;
mod decided_property;
mod declared_use;
mod draw;
mod exact;
mod index;
mod indirect_draws;
mod jitter;
mod note_kind;
mod output;
mod param;
mod part;
mod pass;
mod raster;
mod resource;
mod texture;
pub(crate) mod tracked_parts;
mod uses;
mod view;
mod work;

pub(crate) use access::{Access, Effect, VisitAccess};
pub use buffer_role::BufferRole;
pub use cadence::Cadence;
pub use capture::{Capture, CaptureName, Captures, capture_name};
pub use decided_property::{DecidedBy, DecidedProperty, NamedValue, Property, Subject};
pub use declared_use::DeclaredUse;
pub use draw::{Cascade, Draw, DrawList, Metres, Share};
pub use index::{BufferIndex, ImageIndex, Resource};
pub use indirect_draws::IndirectDraws;
pub use jitter::{Jitter, LONGEST as LONGEST_JITTER};
pub use note_kind::NoteKind;
pub use output::Output;
pub(crate) use param::PARAM_COMPONENTS;
pub use param::{FrameValue, ParamValue};
pub(crate) use part::{TargetShape, allocated_at};
pub use pass::Pass;
pub use raster::{BlendEquation, DepthBias, RasterState};
pub use resource::{Buffer, ChosenFormat, Image, Lifetime, Resolve, ResolveWay, SAMPLE_COUNTS};
pub(crate) use resource::{allocated_extent, least_part, level_extent};
pub use texture::{
    ColorSpace, NoTextures, TextureFile, TextureInfo, TextureProblem, Textures, WantedTexels, becomes, format_problem,
    picture_extent,
};
pub use uses::{Blend, BufferUse, ColorTarget, DepthTarget, Face, SampledImage, StencilState, Storage, TransferUse};
pub use view::{Allowances, Eye, EyeForm, Stereo, View, ViewEye, ViewIndex};
pub use work::{Groups, Work};

use crate::base::{Sources, Span};
use change::Change;
use std::sync::Arc;

/// A frame: images, buffers, passes in the order that gives them meaning, outputs.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// The texts that spans point into.
    pub sources: Arc<Sources>,
    /// The settings in force, by name, as they are shown.
    pub settings: Vec<(Arc<str>, String)>,
    /// Changes that files made to the pipeline that they extend, in their order.
    pub changes: Vec<Change>,
    /// Width and height of the output that was asked for.
    pub extent: [u32; 2],
    /// How the frame is drawn for two eyes, by passes whose targets hold both eyes' parts.
    pub stereo: Stereo,
    /// The views, the main one first. None: one that is the scene's default camera's.
    pub views: Vec<View>,
    /// The images that passes name.
    pub images: Vec<Image>,
    /// The buffers that passes name.
    pub buffers: Vec<Buffer>,
    /// Passes in file order. A pass reads the version of an image that stands *before itself*.
    pub passes: Vec<Pass>,
    /// Images and buffers whose last version the frame is made for.
    pub outputs: Vec<Output>,
    /// The properties of images and passes that settings and facts decided.
    pub decided: Arc<[DecidedProperty]>,
    /// Passes, and images that passes sample, that conditions switched off, and why.
    pub switched_off: Vec<SwitchedOff>,
    /// Warnings: allowed, but probably a mistake.
    pub remarks: Vec<Remark>,
}

impl Frame {
    /// The name of an image or buffer.
    pub(crate) fn name(&self, of: Resource) -> &Arc<str> {
        match of {
            Resource::Image(image) => &self.images[image.0 as usize].name,
            Resource::Buffer(buffer) => &self.buffers[buffer.0 as usize].name,
        }
    }
}

/// A warning about a pass or an image: allowed, but probably a mistake.
#[derive(Debug, Clone, PartialEq)]
pub struct Remark {
    /// Its kind.
    pub kind: NoteKind,
    /// The name of the pass or the image.
    pub subject: Arc<str>,
    /// The place of the pass or the image.
    pub span: Span,
    /// The warning in words.
    pub text: String,
}

/// A pass, or an image that it samples, that a condition switched off.
#[derive(Debug, Clone, PartialEq)]
pub struct SwitchedOff {
    /// The pass's name.
    pub name: Arc<str>,
    /// The shader's name for the image that isn't sampled; `None`: the pass doesn't run.
    pub sampled: Option<Arc<str>>,
    /// Where the condition stands.
    pub span: Span,
    /// The condition with its value: "tone_mapping = false".
    pub because: String,
}
