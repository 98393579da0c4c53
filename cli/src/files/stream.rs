//! Writes to pipes and devices.
//!
//! A pipe keeps its writer waiting until a reader comes, and again whenever the reader is slow. Ctrl-C ends both waits.

use crate::error::Error;
use crate::system::{interrupt, text};
use std::fs::{File, OpenOptions};
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
        if let Some(stream) = open(path).map_err(problem)? {
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
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => wait(&stream).map_err(problem)?,
            Err(error) => return Err(problem(error)),
        }
        go_on()?;
    }
    Ok(())
}

/// Opens a pipe or device without waiting; `None`: nothing reads from the pipe yet.
#[cfg(unix)]
fn open(path: &Path) -> io::Result<Option<File>> {
    use nix::libc;
    use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
    match OpenOptions::new().write(true).custom_flags(libc::O_NONBLOCK).open(path) {
        Err(error) if error.raw_os_error() == Some(libc::ENXIO) && path.metadata()?.file_type().is_fifo() => Ok(None),
        opened => opened.map(Some),
    }
}

#[cfg(not(unix))]
fn open(path: &Path) -> io::Result<Option<File>> {
    OpenOptions::new().write(true).open(path).map(Some)
}

/// Waits for a moment until more can be written.
#[cfg(unix)]
fn wait(stream: &File) -> io::Result<()> {
    use nix::errno::Errno;
    use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
    use std::os::fd::AsFd;
    let slice = PollTimeout::try_from(SLICE).unwrap_or(PollTimeout::ZERO);
    match poll(&mut [PollFd::new(stream.as_fd(), PollFlags::POLLOUT)], slice) {
        Ok(_) | Err(Errno::EINTR) => Ok(()),
        Err(error) => Err(error.into()),
    }
}

#[cfg(not(unix))]
fn wait(_: &File) -> io::Result<()> {
    std::thread::sleep(SLICE);
    Ok(())
}
