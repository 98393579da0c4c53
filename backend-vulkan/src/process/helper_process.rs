//! A helper process, seen from the program: how it is started, spoken with, and what its end says.

use super::limits::Limits;
use super::protocol::{self, ARGUMENT, Answer, LARGEST_FRAME, LARGEST_SPIRV, MARK, Request};
use crate::base::{Cancel, ChildInput, SLICE, apart_from_interrupts, in_words, is_crash, start_with_input};
use std::io::{BufReader, Read};
use std::panic::resume_unwind;
use std::path::Path;
use std::process::{Child, ChildStderr, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};
use std::{env, io, thread};

/// A self-test that isn't over by then takes long.
const LONG: Duration = Duration::from_secs(2);

/// How long a helper that has stopped to answer may take to end by itself.
const GRACE: Duration = Duration::from_secs(2);

/// How many bytes of a helper's standard error are kept: its end says why the helper died.
const LAST_WORDS: usize = 4096;

/// Why a helper process gave no answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NoAnswer {
    /// The process took too long.
    #[error("took longer than {} s, which is its limit", .0.as_secs_f64())]
    TooLong(Duration),
    /// Its stack overflowed.
    #[error("needed a stack of more than {} MiB, which is its limit", .0 >> 20)]
    Stack(usize),
    /// The process ran out of memory.
    #[error("needed more memory than {} MiB, which is its limit", .0 >> 20)]
    Memory(u64),
    /// The process made a mistake in memory or the like.
    #[error("crashed ({0})")]
    Crashed(String),
    /// Something else ended the process, or it ended itself.
    #[error("died ({0})")]
    Died(String),
    /// The program asked for the wait to be given up.
    #[error("was cancelled")]
    Cancelled,
    /// The program can't be started, or isn't a helper.
    #[error("can't be started: {0}")]
    Unusable(String),
}

impl NoAnswer {
    /// Whether another process may answer the same question.
    pub(crate) fn may_be_chance(&self) -> bool {
        matches!(self, NoAnswer::Crashed(_) | NoAnswer::Died(_) | NoAnswer::Unusable(_))
    }
}

/// A process that was started. It is ended with this, and ends by itself when this process does.
#[derive(Debug)]
pub(super) struct HelperProcess {
    child: Mutex<Child>,
    streams: Streams,
    /// The last lines that the process wrote to its error stream before it died.
    said: Receiver<Vec<u8>>,
    limits: Limits,
}

/// Both directions of the talk with a helper.
#[derive(Debug)]
pub(super) struct Streams {
    to: ChildInput,
    from: BufReader<ChildStdout>,
}

impl Streams {
    /// Says something.
    pub(super) fn send(&mut self, request: &Request) -> io::Result<()> {
        protocol::write(&mut self.to, request)
    }

    /// Waits for an answer.
    pub(super) fn receive(&mut self) -> io::Result<Answer> {
        protocol::parse(&protocol::read_frame(&mut self.from, LARGEST_FRAME)?)
    }

    /// Waits for SPIR-V.
    pub(super) fn receive_words(&mut self) -> io::Result<Vec<u32>> {
        let bytes = protocol::read_frame(&mut self.from, LARGEST_SPIRV)?;
        let (words, rest) = bytes.as_chunks();
        if rest.is_empty() {
            Ok(words.iter().map(|word| u32::from_le_bytes(*word)).collect())
        } else {
            Err(Streams::garbage())
        }
    }

    /// An answer that makes no sense.
    pub(super) fn garbage() -> io::Error {
        protocol::invalid()
    }
}

impl HelperProcess {
    /// Starts `program` as a helper with these limits.
    pub(super) fn start(program: &Path, limits: &Limits) -> Result<HelperProcess, NoAnswer> {
        let shown = program.display();
        if env::var_os(MARK).is_some() {
            return Err(NoAnswer::Unusable(format!(
                "this is a helper itself, whose `main` doesn't call `helper::serve`: {shown}"
            )));
        }
        let mut command = Command::new(program);
        command.args([ARGUMENT, &limits.memory.unwrap_or(0).to_string(), &limits.stack.to_string()]).env(MARK, "1");
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        // Ctrl-C is for the program, which then ends its helper.
        apart_from_interrupts(&mut command);
        let unusable = |error: io::Error| NoAnswer::Unusable(format!("{shown}: {error}"));
        let (mut child, to) = start_with_input(command).map_err(unusable)?;
        let (Some(from), Some(said)) = (child.stdout.take(), child.stderr.take()) else {
            return Err(NoAnswer::Unusable(format!("{shown}: no pipes")));
        };
        let streams = Streams { to, from: BufReader::new(from) };
        let said = last_words(said).map_err(unusable)?;
        Ok(HelperProcess { child: Mutex::new(child), streams, said, limits: limits.clone() })
    }

    /// Talks with the process until `time` is over or `cancel` is asked for. `long` is called once if the talk goes on for
    /// [`LONG`]. The process comes back beside the answer, unless it was ended because the answer came too late. After an
    /// error it is ended.
    pub(super) fn within<T>(
        mut self,
        time: Duration,
        cancel: &Cancel,
        long: Option<&(dyn Fn() + Sync)>,
        talk: impl FnOnce(&mut Streams) -> io::Result<T>,
    ) -> Result<(T, Option<HelperProcess>), NoAnswer> {
        let (child, streams) = (&self.child, &mut self.streams);
        let (answer, killed) = thread::scope(|scope| {
            let (done, end) = mpsc::channel::<()>();
            let watch = scope.spawn(move || {
                let why = given_up(&end, time, cancel, long);
                if why.is_some() {
                    kill(child);
                }
                why
            });
            let answer = talk(streams);
            drop(done);
            (answer, watch.join().unwrap_or_else(|panic| resume_unwind(panic)))
        });
        match (answer, killed) {
            (Ok(answer), killed) => Ok((answer, killed.is_none().then_some(self))),
            (Err(_), Some(killed)) => Err(killed),
            (Err(error), None) => Err(self.end(&error)),
        }
    }

    /// How it came to its end, after an error of a talk with it.
    fn end(&mut self, error: &io::Error) -> NoAnswer {
        let since = Instant::now();
        let child = self.child.get_mut().unwrap_or_else(PoisonError::into_inner);
        // The pipes close shortly before the process ends: its exit status comes a moment later.
        let status = loop {
            match child.try_wait() {
                Ok(Some(status)) => break status,
                Ok(None) if since.elapsed() < GRACE && error.kind() != io::ErrorKind::InvalidData => {
                    thread::sleep(Duration::from_millis(1));
                }
                _ => return NoAnswer::Unusable(format!("it doesn't speak as a helper does: {error}")),
            }
        };
        if status.success() {
            return NoAnswer::Unusable("it ended, which a helper doesn't".to_owned());
        }
        // Where a process that it started still holds the pipe, nothing is known.
        let said = self.said.recv_timeout(GRACE).unwrap_or_default();
        let said = String::from_utf8_lossy(&said);
        match self.limits.memory {
            _ if said.contains("has overflowed its stack") => NoAnswer::Stack(self.limits.stack),
            Some(memory) if said.contains("bad_alloc") || said.contains("memory allocation of") => {
                NoAnswer::Memory(memory)
            }
            _ if is_crash(status) => NoAnswer::Crashed(in_words(status)),
            _ => NoAnswer::Died(in_words(status)),
        }
    }
}

impl Drop for HelperProcess {
    fn drop(&mut self) {
        kill(&self.child);
        // It is dead; this only lets the system forget it.
        let _ = self.child.get_mut().unwrap_or_else(PoisonError::into_inner).wait();
    }
}

/// Reads all that a helper says: its driver may say more than a pipe holds. When it has ended, the last words come.
fn last_words(mut stream: ChildStderr) -> io::Result<Receiver<Vec<u8>>> {
    let (hand_on, said) = mpsc::channel();
    let read = move || {
        let (mut last, mut more) = (Vec::new(), [0; LAST_WORDS]);
        loop {
            match stream.read(&mut more) {
                Ok(0) => break,
                Ok(count) => {
                    last.extend_from_slice(&more[..count]);
                    last.drain(..last.len().saturating_sub(LAST_WORDS));
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                // A stream that can't be read ends here.
                Err(_) => break,
            }
        }
        // Without an end of the helper nobody asks for it.
        let _ = hand_on.send(last);
    };
    thread::Builder::new().name("helper's words".to_owned()).spawn(read)?;
    Ok(said)
}

/// Waits for the end of a talk; or says why that is given up.
fn given_up(
    end: &Receiver<()>,
    time: Duration,
    cancel: &Cancel,
    mut long: Option<&(dyn Fn() + Sync)>,
) -> Option<NoAnswer> {
    let begun = Instant::now();
    loop {
        let left = time.saturating_sub(begun.elapsed());
        if end.recv_timeout(left.min(SLICE)) != Err(RecvTimeoutError::Timeout) {
            return None;
        }
        let passed = begun.elapsed();
        if passed >= LONG
            && let Some(long) = long.take()
        {
            long();
        }
        if cancel.is_asked() {
            return Some(NoAnswer::Cancelled);
        }
        if passed >= time {
            return Some(NoAnswer::TooLong(time));
        }
    }
}

/// Ends a process, which may have ended already.
fn kill(child: &Mutex<Child>) {
    let _ = child.lock().unwrap_or_else(PoisonError::into_inner).kill();
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_helper_that_was_ended_while_its_answer_came_is_not_used_again() {
        let start = || HelperProcess::start(Path::new("true"), &Limits::default()).expect("it starts");
        let late = |_: &mut Streams| {
            thread::sleep(Duration::from_millis(200));
            Ok(3)
        };
        let (answer, goes_on) =
            start().within(Duration::from_millis(1), &Cancel::default(), None, late).expect("an answer");
        assert!(answer == 3 && goes_on.is_none());
        let (answer, goes_on) =
            start().within(Duration::from_secs(60), &Cancel::default(), None, late).expect("an answer");
        assert!(answer == 3 && goes_on.is_some());
        let cancel = Cancel::default();
        cancel.when(|| true);
        let (answer, goes_on) = start().within(Duration::from_secs(60), &cancel, None, late).expect("an answer");
        assert!(answer == 3 && goes_on.is_none());
    }
}
