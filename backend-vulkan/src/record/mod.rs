//! A frame turned into commands.

mod custom;
mod dispatch;
mod draw_source;
mod frame;
mod poison;
mod recorder;
mod scope;
mod step;
mod timing;
mod transfer;

pub use custom::{CustomImage, CustomRecorder};
pub use draw_source::DrawSource;
pub use recorder::{CullMode, FrontFace, IndexType, Recorder};
pub use timing::{FrameReport, PassReport, StepReport};

pub(crate) use frame::{Frame, Recorded};
pub(crate) use timing::Timing;
