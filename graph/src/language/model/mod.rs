//! A pipeline as data: images, buffers, passes, views, outputs and settings.

mod area;
mod choices;
mod decisions;
mod part;
mod part_uses;
mod pass;
mod pipeline;
mod references;
mod resources;
mod setting;
mod view;

pub(crate) use area::{Area, LARGEST_SIZE, area, times};
pub use choices::{Choice, ChosenBy, ChosenValue, Preset, SettingsFile};
pub(crate) use choices::{in_force, unknown_preset};
pub use decisions::{Decided, Decisions};
pub use part::{BufferPart, ImagePart, Part, Selection};
pub(crate) use part_uses::{PartRef, Use};
pub use pass::{
    Color, DeclaredUse, Depth, Face, Forward, Groups, LeftOutSample, OffReason, Param, Pass, PassDecisions, Sample,
    SamplerState, StandIn, Storage, StorageAccess, Uniform, Work,
};
pub use pipeline::{Instance, Output, Pipeline, RemovedPass};
pub use references::{BufferRef, ImageRef, ResourceRef};
pub use resources::{
    Buffer, Bytes, Fill, Format, Image, Layers, Lifetime, Mips, Precision, Precisions, Resolves, Samples,
    Shape as ImageShape, Size, State,
};
pub use setting::{Setting, SettingKind, last_step, nth as nth_step};
pub use view::View;
