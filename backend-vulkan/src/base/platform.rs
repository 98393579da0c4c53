//! What differs between operating systems: the only file of this crate that asks which one it is built for.

use std::fs::{DirBuilder, File, Metadata, OpenOptions};
use std::io;
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus};

/// Has a file opened without waiting and without following a link in its place: nobody may write to a pipe of that name, ever.
/// Windows has no such pipes in folders, and makes links for administrators alone.
pub(super) fn at_once(options: &mut OpenOptions) {
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(options, libc::O_NONBLOCK | libc::O_NOFOLLOW);
    #[cfg(not(unix))]
    let _ = options;
}

/// Whether a file belongs to this user, and nobody else may write it. On Windows that is a matter of the folder, which lies in the
/// user's profile.
pub(super) fn is_own(file: &Metadata) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        file.uid() == nix::unistd::geteuid().as_raw() && file.mode() & 0o022 == 0
    }
    #[cfg(not(unix))]
    {
        let _ = file;
        true
    }
}

/// Has folders made that only this user may use.
pub(super) fn private(folders: &mut DirBuilder) {
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(folders, 0o700);
    #[cfg(not(unix))]
    let _ = folders;
}

/// Has a temporary file made with the rights of any other new file: `tempfile` would make it the user's alone.
pub(crate) fn with_usual_rights(file: &mut tempfile::Builder<'_, '_>) {
    #[cfg(unix)]
    file.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    #[cfg(not(unix))]
    let _ = file;
}

/// The folder of the user's caches where `XDG_CACHE_HOME` names none: `~/.cache`, on Windows `%LOCALAPPDATA%`.
pub(super) fn caches_of_user(variable: impl Fn(&str) -> Option<PathBuf>) -> Option<PathBuf> {
    if cfg!(windows) { variable("LOCALAPPDATA") } else { variable("HOME").map(|home| home.join(".cache")) }
}

/// A library that is in this process already, by its name on Unix and on Windows.
pub(crate) fn loaded_library(names: [&str; 2]) -> Option<libloading::Library> {
    #[cfg(unix)]
    {
        use libloading::os::unix;
        let flags = libc::RTLD_NOW | libc::RTLD_NOLOAD;
        // SAFETY: nothing is loaded, and no code of the library runs.
        unsafe { unix::Library::open(Some(names[0]), flags) }.ok().map(Into::into)
    }
    #[cfg(windows)]
    {
        libloading::os::windows::Library::open_already_loaded(names[1]).ok().map(Into::into)
    }
}

/// This program's end of the standard input of a process that it starts.
#[cfg(unix)]
pub(crate) type ChildInput = std::os::unix::net::UnixStream;
/// This program's end of the standard input of a process that it starts.
#[cfg(not(unix))]
pub(crate) type ChildInput = std::process::ChildStdin;

/// Starts a process and gives its standard input. On Unix that is a socket: writing to a pipe whose reader has died ends every program that
/// doesn't ignore the signal for it, and programs in C don't.
///
/// # Errors
/// Those of the system.
pub(crate) fn start_with_input(mut command: Command) -> io::Result<(Child, ChildInput)> {
    #[cfg(unix)]
    {
        let (own, of_child) = ChildInput::pair()?;
        let child = command.stdin(std::os::fd::OwnedFd::from(of_child)).spawn()?;
        Ok((child, own))
    }
    #[cfg(not(unix))]
    {
        let mut child = command.stdin(std::process::Stdio::piped()).spawn()?;
        let input = child.stdin.take().ok_or(io::ErrorKind::BrokenPipe)?;
        Ok((child, input))
    }
}

/// Whether a process ended by a mistake of its own, such as one in memory. Others end it by other signals, and it ends itself by an exit code.
pub(crate) fn is_crash(status: ExitStatus) -> bool {
    #[cfg(unix)]
    {
        let signal = std::os::unix::process::ExitStatusExt::signal(&status);
        let own = [libc::SIGABRT, libc::SIGBUS, libc::SIGFPE, libc::SIGILL, libc::SIGSEGV, libc::SIGSYS, libc::SIGTRAP];
        signal.is_some_and(|signal| own.contains(&signal))
    }
    // Windows tells a crash by a code with its highest bit set.
    #[cfg(not(unix))]
    {
        status.code().is_some_and(i32::is_negative)
    }
}

/// Has Ctrl-C interrupt this program and not the one that it starts.
pub(crate) fn apart_from_interrupts(command: &mut Command) {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    #[cfg(windows)]
    {
        const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
        std::os::windows::process::CommandExt::creation_flags(command, CREATE_NEW_PROCESS_GROUP);
    }
    #[cfg(not(any(unix, windows)))]
    let _ = command;
}

/// Ends a process that was started [apart from interrupts](apart_from_interrupts), on Unix with all that it started.
pub(crate) fn end_with_children(child: &mut Child) {
    #[cfg(unix)]
    if let Ok(group) = i32::try_from(child.id()) {
        use nix::sys::signal::{Signal, killpg};
        // It may have ended already.
        let _ = killpg(nix::unistd::Pid::from_raw(group), Signal::SIGKILL);
    }
    let _ = child.kill();
}

/// How a process ended: the signal's name, where one ended it.
pub(crate) fn in_words(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(number) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return nix::sys::signal::Signal::try_from(number).map_or_else(|_| status.to_string(), |it| it.to_string());
    }
    status.to_string()
}

/// Puts limits on this process, which is a helper: on its memory, which only Linux keeps to, and no core file is written when it
/// crashes. A limit that can't be set leaves the one on time.
pub(crate) fn limit_this_process(memory: Option<u64>) {
    #[cfg(unix)]
    {
        use nix::sys::resource::{Resource, setrlimit};
        let _ = setrlimit(Resource::RLIMIT_CORE, 0, 0);
        #[cfg(target_os = "linux")]
        if let Some(memory) = memory {
            let _ = setrlimit(Resource::RLIMIT_AS, memory, memory);
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = memory;
}

/// This process's standard output, which from now on is the caller's alone: what drivers and compilers print goes to standard
/// error. On Windows it still goes to standard output.
///
/// # Errors
/// Those of the system.
pub(crate) fn take_standard_output() -> io::Result<File> {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        let output = io::stdout().as_fd().try_clone_to_owned()?;
        nix::unistd::dup2_stdout(io::stderr())?;
        Ok(output.into())
    }
    #[cfg(windows)]
    {
        use std::os::windows::io::AsHandle;
        Ok(io::stdout().as_handle().try_clone_to_owned()?.into())
    }
    #[cfg(not(any(unix, windows)))]
    Err(io::ErrorKind::Unsupported.into())
}

/// Ends this process at once, without the functions that libraries have registered for its end: those of a software driver
/// crash while its threads are still at work. What this program itself has not yet written is lost. Where the system isn't Unix,
/// those functions do run.
pub fn end_process(code: u8) -> ! {
    #[cfg(unix)]
    // SAFETY: `_exit` only ends the process.
    unsafe {
        libc::_exit(code.into())
    }
    #[cfg(not(unix))]
    std::process::exit(code.into())
}
