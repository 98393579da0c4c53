//! Writes to pipes and devices.
//!
//! A pipe keeps its writer waiting until a reader comes, and again whenever the reader is slow. Ctrl-C ends both waits.

use crate::error::Error;
use crate::system::{interrupt, platform, text};
use std::io;
use std::io::Write;
use std::path::Path;
use std::time::Duration;

/// How often a wait asks whether the user wants to stop.
const SLICE: Duration = Duration::from_millis(50);

/// Writes all of `contents` to the pipe or device at `path`.
///
/// # Errors
/// [`Error::Write`], [`Error::InterruptedWriting`].
pub(crate) fn write(path: &Path, mut contents: &[u8]) -> Result<(), Error> {
    let problem = |source| Error::Write { path: path.to_owned(), source };
    let go_on = || match interrupt::asked() {
        true => Err(Error::InterruptedWriting { path: path.to_owned() }),
        false => Ok(()),
    };
    let mut told = false;
    let mut stream = loop {
        if let Some(stream) = platform::open_stream(path).map_err(problem)? {
            break stream;
        }
        if !told {
            text::say(&format!("note: waiting until something reads the pipe `{}`", text::path(path)));
            told = true;
        }
        std::thread::sleep(SLICE);
        go_on()?;
    };
    while !contents.is_empty() {
        match stream.write(contents) {
            Ok(0) => return Err(problem(io::ErrorKind::WriteZero.into())),
            Ok(written) => contents = &contents[written..],
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                platform::wait_to_write(&stream, SLICE).map_err(problem)?
            }
            Err(error) => return Err(problem(error)),
        }
        go_on()?;
    }
    Ok(())
}
