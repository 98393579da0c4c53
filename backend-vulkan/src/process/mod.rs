//! The helper process as the program sees it: how it is started, what it is asked, what bounds it.

mod compiled;
mod helper;
mod limits;
mod protocol;
mod running;

pub use helper::{Helper, LongTest};
pub use limits::Limits;

pub(crate) use compiled::{Compiled, Finding, Verdict};
pub(crate) use helper::DeviceName;
pub(crate) use protocol::{
    ARGUMENT, Answer, CompileFailure, CompileJob, IncludedFile, LARGEST_FRAME, LARGEST_SPIRV, Request, SampleResolve,
    SelfTest, invalid, parse, read_frame, write, write_frame,
};
pub(crate) use running::NoAnswer;
