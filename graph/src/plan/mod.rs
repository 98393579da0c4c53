//! The Plan: the compiler's decisions, as plain data with a stable JSON form.
//!
//! A Plan is self-sufficient: this process or another program can check it and replay it without the
//! pipeline file. Names of stages, accesses, layouts, usages, formats and operations are Vulkan's, without prefix. Sets of
//! flags are written `A | B`. Everything is in execution order; same input, same bytes. `docs/plan-format.md` describes the
//! JSON form field by field.
//!
//! Accesses of a step:
//! - A [`Work::Render`] scope accesses its attachments as their load, store and resolve operations say (colour in
//!   `COLOR_ATTACHMENT_OUTPUT`; depth loads in `EARLY_FRAGMENT_TESTS`, stores in `LATE_FRAGMENT_TESTS`; *every* resolve in
//!   `COLOR_ATTACHMENT_OUTPUT`), and each of its passes accesses what its `accesses` list.
//! - A [`Work::Dispatch`] or [`Work::Custom`] makes its accesses.
//! - A [`Work::Resolve`], [`Work::Copy`] or [`Work::Blit`] reads its source and writes its target in the stage of that name
//!   (`RESOLVE`, `COPY`, `BLIT`); a [`Work::Fill`] writes its target in `CLEAR`.
//! - [`Work::Export`] accesses nothing: its barriers leave images in the state that their [`Role`] promises, or change their
//!   layout before several queues read them.
//!
//! Order. Steps stand in the order in which they are submitted; those of one queue run in that order, as far as their
//! barriers make them. A [`Wait`] of a step holds up the whole step, barriers included, until a step on another queue has
//! finished, its writes made available; it makes them visible in the stages that it names.
//!
//! Frames. The same Plan is executed frame after frame on the same queues; the host may submit the next before the last has
//! finished. Nothing orders frames but the Plan's own barriers and waits: transient memory is handed from the last step that
//! uses it to the first one in the next frame, and what persists is found in the state in which the frame before left it.
//! At the end of a frame each persistent image or buffer becomes the one that `becomes` names: itself, or for history the
//! one that stands for one frame further back, and the oldest becomes the newest again. What the host writes or reads itself
//! (parameters, object data, outputs) is not the Plan's: the executor keeps one copy for each frame in flight.

use crate::base::Place;
use crate::frame::change::Action;
use crate::frame::{DecidedProperty, EyeForm, Stereo};
use crate::vulkan::{ResolveMode, Rotation};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

mod cause;
mod coverage;
mod entries;
mod features;
mod ids;
mod json;
mod moved_bytes;
pub(crate) mod names;
mod note;
mod on_chip;
mod output;
mod outside;
mod owners;
mod part;
mod reason;
mod resources;
mod step;
pub(crate) mod text;
mod totals;
mod values;
mod variants;
mod view;
mod walk;
mod work;

pub use crate::frame::NoteKind;
pub use cause::{Cause, InsertionCause};
pub use entries::{About, Entry, EntryKind, Item};
pub use features::UsedFeature;
pub use ids::{BufferId, ImageId, Resource, StepId, ViewId};
pub use json::PlanError;
pub use moved_bytes::MovedBytes;
pub use note::{Note, Stage};
pub use output::Output;
pub use outside::{OutsideTransfer, OutsideWay};
pub use reason::{NextUse, Reason};
pub use resources::{Buffer, ChosenFormat, FirstContents, Heap, Image, Placement, Role};
pub use step::{BufferHazard, Hazard, ImageBarrier, MemoryBarrier, Queue, Step, Wait};
pub use text::{Detail, Outline, Text};
pub use totals::Totals;
pub use view::{View, ViewEye};
pub use work::{
    Access, Attachment, AttachmentKind, AttachmentResolve, Binding, BindingKind, BufferAccess, DepthState, Fill, Param,
    Pass, RenderScope, Side, Transfer, Work,
};

/// The version of the JSON form that this library writes and reads.
pub const FORMAT_VERSION: u32 = 14;

/// The work of a frame on a device, step by step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// [`FORMAT_VERSION`] of the library that wrote it.
    pub format_version: u32,
    /// The device it was made for.
    pub device: DeviceUsed,
    /// Settings in force.
    pub settings: Vec<SettingUsed>,
    /// Changes that files made to the pipeline that they extend, in their order.
    pub changes: Vec<Change>,
    /// The properties of images and passes that settings and facts decided, with their values. A subject may be one that the
    /// frame names and the Plan doesn't have: an image that became part of another one, or a pass that was culled.
    pub decided: Arc<[DecidedProperty]>,
    /// Width and height of the output that was asked for. A Plan without views shows the scene with this ratio.
    pub extent: [u32; 2],
    /// How the frame is drawn for two eyes, by scopes whose attachments hold both eyes' parts ([`Image::eyes`]).
    pub stereo: Stereo,
    /// The views that passes draw for, the main one first; empty if the frame names none. A [`ViewId`] is an index into this
    /// list.
    pub views: Vec<View>,
    /// Every image; an [`ImageId`] is an index into this list.
    pub images: Vec<Image>,
    /// Every buffer; a [`BufferId`] is an index into this list.
    pub buffers: Vec<Buffer>,
    /// Blocks of memory that transient images or buffers share.
    pub heaps: Vec<Heap>,
    /// Steps in the order in which they are submitted.
    pub steps: Vec<Step>,
    /// Images and buffers that leave the frame, in the pipeline's order.
    pub outputs: Vec<Output>,
    /// Decisions that no step shows: work that was left out, lowered, not merged or not folded, and why.
    pub notes: Vec<Note>,
    /// Sums.
    pub totals: Totals,
}

/// The device that a Plan was made for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceUsed {
    /// Name in its profile.
    pub name: String,
    /// Whether memory needs are the device's own (`true`) or estimated from a profile.
    pub exact_memory: bool,
}

/// A setting in force.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SettingUsed {
    /// Name.
    pub name: Arc<str>,
    /// Value, as it is shown.
    pub value: String,
}

/// A change that a file made to the pipeline that it extends.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// The change.
    pub action: Action,
    /// Its place in the file.
    pub at: Option<Place>,
}

impl Plan {
    /// The image with the id `id`.
    ///
    /// # Panics
    /// If the Plan has no such image; a Plan that came from outside must have passed [`Plan::from_json`].
    #[must_use]
    pub fn image(&self, id: ImageId) -> &Image {
        &self.images[id.0 as usize]
    }

    /// The role of an image or buffer.
    ///
    /// # Panics
    /// As [`Plan::image`].
    #[must_use]
    pub fn role(&self, resource: Resource) -> &Role {
        match resource {
            Resource::Image(image) => &self.image(image).role,
            Resource::Buffer(BufferId(buffer)) => &self.buffers[buffer as usize].role,
        }
    }

    /// The rotation of a rendering scope's picture: that of its attachments.
    #[must_use]
    pub fn rotation(&self, scope: &RenderScope) -> Rotation {
        self.first_attachment(scope).map_or(Rotation::Identity, |it| it.rotation)
    }

    /// How a rendering scope's attachments hold both eyes' parts, if they do: then each of its draws is for both.
    #[must_use]
    pub fn eyes(&self, scope: &RenderScope) -> Option<EyeForm> {
        self.first_attachment(scope).and_then(|it| it.eyes)
    }

    /// How images hold both eyes' parts that the program reaches in a pass which it records for both eyes at once; `None`: it doesn't.
    #[must_use]
    pub fn both_eyes(&self, pass: &Pass) -> Option<EyeForm> {
        let both = pass.accesses.iter().filter(|access| pass.both_eyes && access.eye.is_none());
        both.map(|access| self.image(access.image)).find_map(|image| image.eyes)
    }

    /// How a resolve that is a step of its own makes one value of samples (`vkCmdResolveImage2`): integers take sample zero.
    #[must_use]
    pub fn mode_of(&self, resolve: &Transfer) -> ResolveMode {
        match resolve.source {
            Side::Image { image, .. } if self.image(image).format.is_integer() => ResolveMode::SampleZero,
            // A resolve has two images.
            Side::Image { .. } | Side::Buffer { .. } => ResolveMode::Average,
        }
    }

    fn first_attachment(&self, scope: &RenderScope) -> Option<&Image> {
        scope.attachments.first().and_then(|first| self.images.get(first.image.0 as usize))
    }
}
