//! Recording of a prepared frame's commands.

mod bindings;
mod bound_sets;
mod breadcrumbs;
mod canvas;
mod custom;
mod custom_image;
mod dispatch;
mod draw_source;
mod fragments;
mod frame_resources;
mod guarded_source;
mod observers;
mod recorded_frame;
mod recorder;
mod scope;
mod state;
mod step;
mod timing;

pub use custom::CustomRecorder;
pub use custom_image::CustomImage;
pub use dispatch::DispatchRecorder;
pub use draw_source::DrawSource;
pub use recorder::{IndexType, Recorder};
pub use timing::{FrameReport, PassReport, StepReport};

pub(crate) use breadcrumbs::Breadcrumbs;
pub(crate) use fragments::FragmentCounts;
pub(crate) use guarded_source::GuardedSource;
pub(crate) use observers::Observers;
pub(crate) use recorded_frame::RecordedFrame;
pub(crate) use state::CommandState;
pub(crate) use step::Recording;
pub(crate) use timing::{Timing, report};
