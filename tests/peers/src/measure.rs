//! The least times of systems that take turns.

use rustix::time::{ClockId, clock_gettime};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// How long a system runs until it is another one's turn: its data are in the processor's caches again soon.
const TURN: Duration = Duration::from_millis(50);
const TURNS: usize = 10;

/// A system with a graph to compile.
pub(crate) trait Candidate {
    /// Builds and compiles the graph once.
    fn run(&mut self) -> Result<Times, String>;

    /// The barriers of the run before, if the system tells.
    fn barriers(&self) -> Option<Barriers>;
}

/// The result of `work`, and the time that it takes: on the processor, where other work on the machine interrupts it.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let processor = || Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).expect("processor time is positive");
    let (processor_before, before) = (processor(), Instant::now());
    let made = work();
    let elapsed = before.elapsed();
    (made, elapsed.min(processor() - processor_before))
}

/// The two parts of a run.
#[derive(Clone, Copy)]
pub(crate) struct Times {
    pub(crate) build: Duration,
    pub(crate) compile: Duration,
}

/// The barriers of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Barriers {
    /// Image barriers.
    pub(crate) images: u64,
    /// Calls of `vkCmdPipelineBarrier` or `vkCmdPipelineBarrier2`.
    pub(crate) calls: u64,
}

/// The figures of a candidate, or why there are none.
pub(crate) type Found = Result<(Times, Option<Barriers>), String>;

/// The least of each part over all runs. A candidate that fails is not asked again.
pub(crate) fn least<const N: usize>(
    candidates: [Result<Box<dyn Candidate + '_>, String>; N],
    short: bool,
) -> [Found; N] {
    let mut turns = candidates.map(|candidate| {
        let mut candidate = candidate?;
        // The second frame can differ from the first one; later ones are like it.
        run(candidate.as_mut())?;
        let times = run(candidate.as_mut())?;
        let barriers = candidate.barriers();
        Ok((candidate, times, barriers))
    });
    for _ in 0..if short { 0 } else { TURNS } {
        turns = turns.map(|turn| {
            let (mut candidate, mut least, barriers) = turn?;
            let begin = Instant::now();
            while begin.elapsed() < TURN {
                let times = run(candidate.as_mut())?;
                least.build = least.build.min(times.build);
                least.compile = least.compile.min(times.compile);
            }
            Ok((candidate, least, barriers))
        });
    }
    turns.map(|turn| turn.map(|(_, least, barriers)| (least, barriers)))
}

fn run(candidate: &mut dyn Candidate) -> Result<Times, String> {
    catch_unwind(AssertUnwindSafe(|| candidate.run())).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(format!("panicked: {}", text.unwrap_or("no message")))
    })
}
