//! The helper process as the program sees it: how it is started, what it is asked, what bounds it.

mod bounded_command;
mod compiler_answer;
mod helper;
mod helper_process;
mod limits;
mod protocol;

pub use helper::{Helper, LongTest};
pub use limits::Limits;
pub use protocol::LARGEST_SPIRV;

pub(crate) use bounded_command::{Bounds, GivenUp, run};
pub(crate) use compiler_answer::{CompilerAnswer, Finding, Verdict};
pub(crate) use helper::DeviceName;
pub(crate) use helper_process::NoAnswer;
pub(crate) use protocol::{
    ARGUMENT, Answer, CompileFailure, CompileJob, IncludedFile, LARGEST_FRAME, Request, SampleResolve, SelfTest,
    invalid, parse, read_frame, write, write_frame,
};
