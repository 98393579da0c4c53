//! A command of the user's: run without a shell, and bounded in time, in what it prints and in what it writes.

use crate::base::{Cancel, SLICE, apart_from_interrupts, end_with_children};
use std::io::{self, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};

/// How many bytes of each stream are kept. The rest is read and dropped.
const MOST_WORDS: u64 = 256 << 10;

/// How long the streams of a process that has ended may stay open: one that it started may still hold them.
const GRACE: Duration = Duration::from_secs(2);

/// What bounds a command.
pub(crate) struct Bounds<'b> {
    pub(crate) time: Duration,
    pub(crate) cancel: &'b Cancel,
    /// Whether it has written too much.
    pub(crate) wrote_too_much: &'b dyn Fn() -> bool,
}

/// Why a command was given up.
#[derive(Debug)]
pub(crate) enum GivenUp {
    CantStart(io::Error),
    TooLong(Duration),
    WroteTooMuch,
    Cancelled,
}

/// Runs a command until it ends. The text is what it printed, errors first.
///
/// # Errors
/// It can't be started, or was ended for a bound.
pub(crate) fn run(mut command: Command, bounds: &Bounds<'_>) -> Result<(ExitStatus, String), GivenUp> {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    // Ctrl-C is for the program, which then ends what it started.
    apart_from_interrupts(&mut command);
    let mut child = command.spawn().map_err(GivenUp::CantStart)?;
    let streams = (child.stderr.take().map(words), child.stdout.take().map(words));
    let ended = until_end(&mut child, bounds);
    if ended.is_err() {
        end_with_children(&mut child);
        // It is dead; this only lets the system forget it.
        let _ = child.wait();
    }
    let status = ended?;
    let said = [streams.0, streams.1].into_iter().flatten().map(|said| {
        let bytes = said.ok().and_then(|said| said.recv_timeout(GRACE).ok()).unwrap_or_default();
        String::from_utf8_lossy(&bytes).into_owned()
    });
    Ok((status, said.collect::<Vec<_>>().join("\n")))
}

fn until_end(child: &mut Child, bounds: &Bounds<'_>) -> Result<ExitStatus, GivenUp> {
    let begun = Instant::now();
    let mut pause = Duration::from_millis(1);
    loop {
        if let Some(status) = child.try_wait().map_err(GivenUp::CantStart)? {
            return Ok(status);
        }
        if bounds.cancel.is_asked() {
            return Err(GivenUp::Cancelled);
        }
        if (bounds.wrote_too_much)() {
            return Err(GivenUp::WroteTooMuch);
        }
        if begun.elapsed() >= bounds.time {
            return Err(GivenUp::TooLong(bounds.time));
        }
        thread::sleep(pause);
        pause = (pause * 2).min(SLICE);
    }
}

/// Reads a stream to its end, and keeps its beginning.
fn words(mut stream: impl Read + Send + 'static) -> io::Result<Receiver<Vec<u8>>> {
    let (hand_on, said) = mpsc::channel();
    let read = move || {
        let mut kept = Vec::new();
        // A stream that can't be read ends there.
        let _ = stream.by_ref().take(MOST_WORDS).read_to_end(&mut kept);
        let _ = io::copy(&mut stream, &mut io::sink());
        // After the grace nobody asks for it.
        let _ = hand_on.send(kept);
    };
    thread::Builder::new().name("compiler's words".to_owned()).spawn(read)?;
    Ok(said)
}
