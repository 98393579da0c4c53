//! Recording of a prepared frame's commands.

mod asked_names;
mod bindings;
mod bound_sets;
mod breadcrumbs;
mod canvas;
mod contents;
mod custom;
mod custom_image;
mod dispatch;
mod draw_source;
mod eye_target;
mod fragments;
mod frame_resources;
mod guarded_source;
mod index_type;
mod observers;
mod pass_watch;
mod recorded_frame;
mod recorder;
mod scope;
mod secondary;
mod secondary_recorder;
mod state;
mod step;
mod timing;

pub use custom::CustomRecorder;
pub use custom_image::CustomImage;
pub use dispatch::DispatchRecorder;
pub use draw_source::DrawSource;
pub use eye_target::EyeTarget;
pub use index_type::IndexType;
pub use recorder::Recorder;
pub use secondary_recorder::SecondaryRecorder;
pub use timing::{FrameReport, PassReport, StepReport};

pub(crate) use breadcrumbs::Breadcrumbs;
pub(crate) use contents::UntouchedTexels;
pub(crate) use fragments::FragmentCounts;
pub(crate) use guarded_source::GuardedSource;
pub(crate) use observers::Observers;
pub(crate) use pass_watch::PassWatch;
pub(crate) use recorded_frame::RecordedFrame;
pub(crate) use step::Recording;
pub(crate) use timing::{Timing, report};
