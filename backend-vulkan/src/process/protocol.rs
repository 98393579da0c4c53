//! The protocol between a program and its helper process: frames of bytes, each behind its length, mostly of JSON.

use super::compiler_answer::Verdict;
use crate::base::ShaderStage;
use framewright_graph::shader::FileLanguage;
use framewright_graph::vulkan::ResolveMode;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::io;
use std::io::{Read, Write};

/// The first argument of a program that is started as a helper. The second is the limit of its memory in bytes, 0 for none,
/// and the third the size of its stack.
pub(crate) const ARGUMENT: &str = "--framewright-helper";

/// Set in the environment of helpers, so that a program that doesn't serve as one starts no others.
pub(crate) const MARK: &str = "FRAMEWRIGHT_HELPER";

/// Most bytes of SPIR-V of one stage: usual ones have some ten thousand. What it uses is read from it in the program's own process.
pub const LARGEST_SPIRV: usize = 16 << 20;

/// Longer frames are no frames of ours.
pub(crate) const LARGEST_FRAME: usize = 1 << 28;

/// Frames from the program.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Request {
    /// A stage to compile.
    Compile(CompileJob),
    /// The file that was asked for, or why there is none.
    Included(Result<IncludedFile, String>),
    /// A device to test.
    SelfTest { test: SelfTest, device: String },
}

/// Frames from the helper.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Answer {
    /// The file `from` includes `name`.
    Include { from: String, name: String },
    /// The stage compiles, and is judged so: the next frame is SPIR-V.
    Spirv(Verdict),
    /// The stage doesn't compile.
    CompileFailure(CompileFailure),
    /// How the device resolves samples.
    SampleResolve(SampleResolve),
    /// Whether the device draws several views at once.
    DrawsViews(bool),
    /// The test can't be done.
    NotTested(String),
}

/// A self-test of a driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum SelfTest {
    /// Resolves of depth and integers, of depth for several views at once too if the device draws them.
    SampleResolve { draws_views: bool },
    /// Drawing of several views at once.
    Multiview,
}

/// One stage to compile.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct CompileJob {
    /// The stage.
    pub(crate) stage: ShaderStage,
    /// The language; `None`: GLSL.
    pub(crate) language: Option<FileLanguage>,
    /// The entry point; `None`: `main`, or all that there are.
    pub(crate) entry: Option<String>,
    /// The name of its file that messages show.
    pub(crate) shown: String,
    /// The text of that file, or one made of it.
    pub(crate) text: String,
    /// Macros with what they stand for.
    pub(crate) macros: Vec<(String, String)>,
}

/// A file that a shader includes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct IncludedFile {
    /// The name that messages show.
    pub(crate) shown: String,
    /// Its text.
    pub(crate) text: String,
    /// What tells the file from others, if it says `#pragma once`: included again it has no text.
    pub(crate) once: Option<u64>,
}

/// Why a stage doesn't compile.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) enum CompileFailure {
    /// The program was built without a compiler.
    NoCompiler,
    /// The compiler's messages, each with the file and line that it is about.
    Messages(Vec<String>),
    /// The compiler ran out of memory.
    OutOfMemory,
    /// The compiler failed itself, in its own words.
    Internal(String),
    /// The bytes of its SPIR-V, which are more than [`LARGEST_SPIRV`].
    TooLarge(usize),
}

/// How samples are resolved: the modes of depth, and whether integers are right.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct SampleResolve {
    /// Modes that the device has.
    pub(crate) has: Vec<ResolveMode>,
    /// Modes that the device claims, and doesn't have.
    pub(crate) refuted: Vec<ResolveMode>,
    /// Modes that the device has for one layer, and not for several.
    pub(crate) refuted_layered: Vec<ResolveMode>,
    /// Modes that the device claims, where no test could be done.
    pub(crate) untested: Vec<ResolveMode>,
    /// Whether integers are resolved to another sample than sample zero.
    pub(crate) refuted_integers: bool,
}

/// Writes a frame.
pub(crate) fn write_frame(to: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    let length = u32::try_from(bytes.len()).ok().filter(|_| bytes.len() <= LARGEST_FRAME).ok_or_else(invalid)?;
    to.write_all(&length.to_le_bytes())?;
    to.write_all(bytes)?;
    to.flush()
}

/// Reads a frame; one of more than `most` bytes is an error.
pub(crate) fn read_frame(from: &mut impl Read, most: usize) -> io::Result<Vec<u8>> {
    let mut length = [0; 4];
    from.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length);
    if length as usize > most {
        return Err(invalid());
    }
    let mut bytes = Vec::new();
    from.take(length.into()).read_to_end(&mut bytes)?;
    if bytes.len() < length as usize { Err(io::ErrorKind::UnexpectedEof.into()) } else { Ok(bytes) }
}

/// Writes something as a frame of JSON.
pub(crate) fn write(to: &mut impl Write, what: &impl Serialize) -> io::Result<()> {
    write_frame(to, &serde_json::to_vec(what)?)
}

/// The value of a frame of JSON.
pub(crate) fn parse<T: DeserializeOwned>(frame: &[u8]) -> io::Result<T> {
    Ok(serde_json::from_slice(frame)?)
}

/// Something that isn't of this protocol.
pub(crate) fn invalid() -> io::Error {
    io::ErrorKind::InvalidData.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_that_says_it_is_longer_than_it_may_be_is_not_read() {
        let mut frame = Vec::new();
        write_frame(&mut frame, b"words").expect("written");
        assert_eq!(read_frame(&mut &*frame, 5).expect("read"), b"words");
        assert_eq!(read_frame(&mut &*frame, 4).expect_err("too long").kind(), io::ErrorKind::InvalidData);
    }
}
