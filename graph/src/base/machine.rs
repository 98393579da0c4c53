//! Errors of the system that are about the machine, and not about a file.

use std::io::{self, ErrorKind};

/// Errors that the standard library has no kind for: input and output failed, too many files are open in the system, or in the process.
#[cfg(unix)]
const WITHOUT_KIND: [i32; 3] = [5, 23, 24];
/// Too many files are open; input and output failed.
#[cfg(not(unix))]
const WITHOUT_KIND: [i32; 2] = [4, 1117];

/// Whether an error is about the machine: rights, room, memory, or how many files may be open. All others are about the file or its name.
#[must_use]
pub fn is_of_machine(error: &io::Error) -> bool {
    let kind = matches!(
        error.kind(),
        ErrorKind::PermissionDenied
            | ErrorKind::OutOfMemory
            | ErrorKind::StorageFull
            | ErrorKind::QuotaExceeded
            | ErrorKind::ReadOnlyFilesystem
            | ErrorKind::ResourceBusy
            | ErrorKind::StaleNetworkFileHandle
            | ErrorKind::TimedOut
            | ErrorKind::WouldBlock
    );
    kind || error.raw_os_error().is_some_and(|number| WITHOUT_KIND.contains(&number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn what_the_machine_lacks_is_told_from_what_is_wrong_with_a_file() {
        // errno.h, the same on Linux, macOS and the BSDs; EAGAIN, which a process without a free slot gets, as they call it.
        let (eio, enomem, eacces, enfile, emfile, enospc, erofs) = (5, 12, 13, 23, 24, 28, 30);
        for number in [eio, enomem, eacces, enfile, emfile, enospc, erofs] {
            assert!(is_of_machine(&io::Error::from_raw_os_error(number)), "{number}");
        }
        let (enoent, enotdir, eisdir, einval) = (2, 20, 21, 22);
        for number in [enoent, enotdir, eisdir, einval] {
            assert!(!is_of_machine(&io::Error::from_raw_os_error(number)), "{number}");
        }
    }
}
