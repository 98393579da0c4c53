//! What a program and its helper process say to each other: frames of bytes, each behind its length, mostly of JSON.

use crate::depth_resolve::DepthResolve;
use crate::shaders::{Failure, IncludedFile, Job};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Write};

/// The first argument of a program that is started as a helper. The second is the limit of its memory in bytes, 0 for none,
/// and the third the size of its stack.
pub(super) const ARGUMENT: &str = "--framewright-helper";

/// Set in the environment of helpers, so that a program that doesn't serve as one starts no others.
pub(super) const MARK: &str = "FRAMEWRIGHT_HELPER";

/// Longer frames are no frames of ours.
pub(super) const LARGEST_FRAME: usize = 1 << 28;

/// What the program says.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Request {
    /// Compile this.
    Compile(Job),
    /// The file that was asked for, or why there is none.
    Included(Result<IncludedFile, String>),
    /// Test this device.
    SelfTest { test: SelfTest, device: String },
}

/// What the helper says.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Answer {
    /// The file `from` includes `name`.
    Include { from: String, name: String },
    /// It compiles: the next frame is SPIR-V.
    Spirv,
    /// It doesn't compile.
    Failure(Failure),
    /// How the device resolves depth.
    DepthResolve(DepthResolve),
    /// Whether the device draws several views at once.
    DrawsViews(bool),
    /// The test can't be done.
    NotTested(String),
}

/// A self-test of a driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum SelfTest {
    /// How it resolves depth, for several views at once too if it draws them.
    DepthResolve { draws_views: bool },
    /// Whether it draws several views at once.
    Multiview,
}

/// Writes a frame.
pub(super) fn write_frame(to: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    let length = u32::try_from(bytes.len()).ok().filter(|_| bytes.len() <= LARGEST_FRAME).ok_or_else(invalid)?;
    to.write_all(&length.to_le_bytes())?;
    to.write_all(bytes)?;
    to.flush()
}

/// Reads a frame; one of more than `most` bytes is an error.
pub(super) fn read_frame(from: &mut impl Read, most: usize) -> io::Result<Vec<u8>> {
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
pub(super) fn write(to: &mut impl Write, what: &impl Serialize) -> io::Result<()> {
    write_frame(to, &serde_json::to_vec(what)?)
}

/// What a frame of JSON says.
pub(super) fn parse<T: DeserializeOwned>(frame: &[u8]) -> io::Result<T> {
    Ok(serde_json::from_slice(frame)?)
}

/// Something that isn't of this protocol.
pub(super) fn invalid() -> io::Error {
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
