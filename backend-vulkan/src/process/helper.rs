//! The program that is started as a helper, and what it is asked.

use super::compiler_answer::CompilerAnswer;
use super::helper_process::{HelperProcess, NoAnswer, Streams};
use super::limits::Limits;
use super::protocol::{Answer, CompileFailure, CompileJob, IncludedFile, Request, SampleResolve, SelfTest};
use crate::base::{Cache, Cancel};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;
use std::{fmt, io};

/// The function that hears of self-tests that take long.
type TestListener = dyn Fn(&LongTest) + Send + Sync;

/// A self-test that takes long.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct LongTest {
    /// The device's own name.
    pub device: String,
    /// How long each of its two self-tests may take.
    pub limit: Duration,
}

/// A program that is started as a helper process when it is needed. Clones share one process.
#[derive(Debug, Clone)]
pub struct Helper {
    program: PathBuf,
    limits: Limits,
    cache: Option<Cache>,
    /// The process that compiles, once one was started and as long as it lives.
    compiler: Arc<Mutex<Option<HelperProcess>>>,
    /// Cancels waits for the helper process.
    cancel: Arc<Cancel>,
    /// Hears of self-tests that take long.
    tell: Arc<LongTestListener>,
}

/// The listener for self-tests that take long, if one was set.
#[derive(Default)]
struct LongTestListener(OnceLock<Box<TestListener>>);

impl fmt::Debug for LongTestListener {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("LongTestListener").field(&self.0.get().is_some()).finish()
    }
}

/// The device that a self-test is about.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DeviceName<'d> {
    /// Its own name.
    pub(crate) name: &'d str,
    /// All that tells it from other devices and its driver from other drivers and versions.
    pub(crate) identity: &'d str,
}

impl Helper {
    /// The program at `program`, whose `main` calls [`serve`](crate::helper::serve).
    ///
    /// Findings of the drivers' self-tests and compiled shaders are kept in the user's cache: [`Cache::of_user`].
    #[must_use]
    pub fn program(program: impl Into<PathBuf>, limits: Limits) -> Helper {
        Helper {
            program: program.into(),
            limits,
            cache: Cache::of_user(),
            compiler: Arc::default(),
            cancel: Arc::default(),
            tell: Arc::default(),
        }
    }

    /// The running program itself, whose `main` calls [`serve`](crate::helper::serve).
    ///
    /// # Errors
    /// If the system doesn't tell where the program lies.
    pub fn this_program(limits: Limits) -> io::Result<Helper> {
        Ok(Helper::program(std::env::current_exe()?, limits))
    }

    /// With another cache; `None`: nothing is kept, so each process compiles and tests anew.
    #[must_use]
    pub fn with_cache(self, cache: Option<Cache>) -> Helper {
        Helper { cache, ..self }
    }

    /// Has every wait for a helper process end soon after `asked` becomes true, for all clones. It is asked about 20 times a
    /// second, from another thread. Only the first call counts.
    ///
    /// The process is ended. A shader that it was compiling has an error then, which its library keeps; a device that it was
    /// testing counts as not tested.
    pub fn cancel_when(&self, asked: impl Fn() -> bool + Send + Sync + 'static) {
        self.cancel.when(asked);
    }

    /// Has `tell` called when a self-test of a device has gone on for two seconds: it may take as long as
    /// [`Limits::self_test`] says, and the program waits for it. It is called at most once for each test, from another thread, for
    /// all clones, and mustn't block: until it comes back the test isn't given up. Only the first call counts.
    pub fn when_a_test_takes_long(&self, tell: impl Fn(&LongTest) + Send + Sync + 'static) {
        let _ = self.tell.0.set(Box::new(tell));
    }

    /// The program that is started.
    pub(crate) fn path(&self) -> &Path {
        &self.program
    }

    /// The limits of its processes.
    pub(crate) fn limits(&self) -> &Limits {
        &self.limits
    }

    /// What cancels waits.
    pub(crate) fn cancel(&self) -> &Arc<Cancel> {
        &self.cancel
    }

    /// The cache, if anything is kept.
    pub(crate) fn cache(&self) -> Option<&Cache> {
        self.cache.as_ref()
    }

    /// Compiles one stage. `includes` finds the files that it includes.
    pub(crate) fn compile(
        &self,
        job: &CompileJob,
        includes: &mut dyn FnMut(&str, &str) -> Result<IncludedFile, String>,
    ) -> Result<Result<CompilerAnswer, CompileFailure>, NoAnswer> {
        let mut compiler = self.compiler.lock().unwrap_or_else(PoisonError::into_inner);
        let running = match compiler.take() {
            Some(running) => running,
            None => self.start(&self.limits)?,
        };
        let (compiled, running) = running.within(self.limits.time, &self.cancel, None, |streams| {
            streams.send(&Request::Compile(job.clone()))?;
            loop {
                match streams.receive()? {
                    Answer::Include { from, name } => streams.send(&Request::Included(includes(&from, &name)))?,
                    Answer::Spirv(verdict) => {
                        return Ok(Ok(CompilerAnswer { spirv: streams.receive_words()?, verdict }));
                    }
                    Answer::CompileFailure(failure) => return Ok(Err(failure)),
                    Answer::SampleResolve(_) | Answer::DrawsViews(_) | Answer::NotTested(_) => {
                        return Err(Streams::garbage());
                    }
                }
            }
        })?;
        match (&compiled, self.limits.memory) {
            (Err(CompileFailure::OutOfMemory), Some(memory)) => return Err(NoAnswer::Memory(memory)),
            // Whether a compiler that failed can go on isn't known.
            (Err(CompileFailure::OutOfMemory | CompileFailure::Internal(_)), _) => {}
            (
                Ok(_) | Err(CompileFailure::NoCompiler | CompileFailure::Messages(_) | CompileFailure::TooLarge(_)),
                _,
            ) => {
                *compiler = running;
            }
        }
        Ok(compiled)
    }

    /// How the device resolves samples, for several views at once too if it `draws_views`; the inner error says
    /// why that can't be tried.
    pub(crate) fn sample_resolve(
        &self,
        device: DeviceName<'_>,
        draws_views: bool,
    ) -> Result<Result<SampleResolve, String>, NoAnswer> {
        self.test(SelfTest::SampleResolve { draws_views }, device, |answer| match answer {
            Answer::SampleResolve(found) => Some(found),
            _ => None,
        })
    }

    /// Whether the device draws several views at once; the inner error says why that can't be tried.
    pub(crate) fn draws_views(&self, device: DeviceName<'_>) -> Result<Result<bool, String>, NoAnswer> {
        self.test(SelfTest::Multiview, device, |answer| match answer {
            Answer::DrawsViews(found) => Some(found),
            _ => None,
        })
    }

    /// Starts a process, unless waits for it would be given up.
    fn start(&self, limits: &Limits) -> Result<HelperProcess, NoAnswer> {
        if self.cancel.is_asked() { Err(NoAnswer::Cancelled) } else { HelperProcess::start(&self.program, limits) }
    }

    /// Tests a device in a process of its own: drivers need more memory than the GLSL compiler may have.
    fn test<T>(
        &self,
        test: SelfTest,
        device: DeviceName<'_>,
        found: impl FnOnce(Answer) -> Option<T>,
    ) -> Result<Result<T, String>, NoAnswer> {
        let limits = Limits { memory: None, ..self.limits.clone() };
        let tell = || {
            if let Some(tell) = self.tell.0.get() {
                tell(&LongTest { device: device.name.to_owned(), limit: limits.self_test });
            }
        };
        let found = self.start(&limits)?.within(limits.self_test, &self.cancel, Some(&tell), |streams| {
            streams.send(&Request::SelfTest { test, device: device.identity.to_owned() })?;
            match streams.receive()? {
                Answer::NotTested(why) => Ok(Err(why)),
                answer => found(answer).map(Ok).ok_or_else(Streams::garbage),
            }
        });
        found.map(|(answer, _)| answer)
    }
}
