//! Settings of glibc's allocator that every measured process has.
//!
//! glibc gives freed memory back to the system and asks for it again, at times for each frame. So that this isn't what is
//! measured, a process starts itself again with `MALLOC_TRIM_THRESHOLD_`, `MALLOC_MMAP_THRESHOLD_` and `MALLOC_TOP_PAD_` set.

use std::env;
use std::process::{Command, exit};

/// Environment variables for glibc's memory. The first one also marks a process that was started with them.
pub(crate) const MEMORY: [(&str, &str); 3] = [
    ("MALLOC_TRIM_THRESHOLD_", "4000000000"),
    ("MALLOC_MMAP_THRESHOLD_", "4000000000"),
    ("MALLOC_TOP_PAD_", "67108864"),
];

/// Runs this program again with the settings, and exits as it exited, unless this process has them. `Err`: it can't be
/// started again.
pub(crate) fn with_settings() -> std::io::Result<()> {
    if env::var_os(MEMORY[0].0).is_none() {
        let status = Command::new(env::current_exe()?).args(env::args_os().skip(1)).envs(MEMORY).status()?;
        exit(status.code().unwrap_or(1));
    }
    Ok(())
}
