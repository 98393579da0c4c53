//! What differs between operating systems: the only file of this crate that asks which one it is built for.

use std::fs::{File, Metadata, OpenOptions};
use std::io;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

/// Has a file that grows beyond what the user may write (`ulimit -f`) answered by an error of the write, like a full disk: the signal
/// would end the command in the middle of a file. To be called before there are other threads, which take it over.
pub(crate) fn survive_large_files() {
    #[cfg(unix)]
    {
        use nix::sys::signal::{SigSet, Signal};
        // That can only fail for a signal that doesn't exist.
        let _ = SigSet::from(Signal::SIGXFSZ).thread_block();
    }
}

/// Whether a file is a pipe with a name. Windows has none among its files.
pub(crate) fn is_pipe(file: &Metadata) -> bool {
    #[cfg(unix)]
    return std::os::unix::fs::FileTypeExt::is_fifo(&file.file_type());
    #[cfg(not(unix))]
    {
        let _ = file;
        false
    }
}

/// Opens a pipe or device for writing, without waiting; `None`: nothing reads from the pipe yet.
///
/// # Errors
/// Those of the system.
pub(crate) fn open_stream(path: &Path) -> io::Result<Option<File>> {
    let mut options = OpenOptions::new();
    options.write(true);
    #[cfg(unix)]
    {
        use nix::libc;
        std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK);
        match options.open(path) {
            Err(error) if error.raw_os_error() == Some(libc::ENXIO) && is_pipe(&path.metadata()?) => Ok(None),
            opened => opened.map(Some),
        }
    }
    #[cfg(not(unix))]
    options.open(path).map(Some)
}

/// Waits until more can be written to a stream, but no longer than `most`.
///
/// # Errors
/// Those of the system.
pub(crate) fn wait_to_write(stream: &File, most: Duration) -> io::Result<()> {
    #[cfg(unix)]
    {
        use nix::errno::Errno;
        use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
        use std::os::fd::AsFd;
        let most = PollTimeout::try_from(most).unwrap_or(PollTimeout::ZERO);
        match poll(&mut [PollFd::new(stream.as_fd(), PollFlags::POLLOUT)], most) {
            Ok(_) | Err(Errno::EINTR) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }
    #[cfg(not(unix))]
    {
        let _ = stream;
        std::thread::sleep(most);
        Ok(())
    }
}

/// Has a temporary file made with the rights of any other new file: `tempfile` would make it the user's alone.
pub(crate) fn with_usual_rights(file: &mut tempfile::Builder<'_, '_>) {
    #[cfg(unix)]
    file.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    #[cfg(not(unix))]
    let _ = file;
}

/// Goes on as another program: in this process's place, or else until its end. Comes back only if it can't be started.
pub(crate) fn become_program(command: &mut Command) -> io::Error {
    #[cfg(unix)]
    return std::os::unix::process::CommandExt::exec(command);
    #[cfg(not(unix))]
    match command.status() {
        Ok(status) => std::process::exit(status.code().unwrap_or(super::Exit::Environment as i32)),
        Err(error) => error,
    }
}
