//! Self-tests of drivers: what a device says it can do is tried before it is used, in a helper process if there is one.
//!
//! What a test found is kept for the device and the version of its driver. A device whose test ends the process is used
//! without the feature.

use crate::depth_resolve::{self, DepthResolve};
use crate::device::Device;
use crate::helper::{Helper, NoAnswer};
use crate::{layer, multiview};
use framewright_graph::vulkan::ResolveMode;
use serde::{Deserialize, Serialize};
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// What the self-tests of a device found.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct SelfTests {
    /// How it resolves depth.
    pub(crate) depth_resolve: DepthResolve,
    /// Why the test of that gave no answer.
    depth_resolve_unknown: Option<String>,
    /// Whether it draws several views at once, if it says so.
    pub(crate) draws_views: bool,
    /// Why the test of that gave no answer.
    draws_views_unknown: Option<String>,
    /// Whether that test couldn't be done, which says nothing of the device.
    pub(crate) draws_views_untested: bool,
}

/// A file with what was found.
#[derive(Debug, Serialize, Deserialize)]
struct Kept {
    /// The device, its driver and the program that tested it.
    key: String,
    found: SelfTests,
}

impl SelfTests {
    /// What the self-tests of `device` find, or found before.
    pub(crate) fn of(device: &Device, helper: Option<&Helper>) -> SelfTests {
        let Some(helper) = helper else { return Both::test(device, None).found(device, None) };
        let (key, file) = (key(device, helper), file(device, helper));
        if let Some(known) = file.as_deref().and_then(|file| known(file, &key)) {
            return known;
        }
        let both = Both::test(device, Some(helper));
        let kept = file.filter(|_| both.are_kept()).and_then(|file| {
            let found = both.found(device, Some(&file));
            keep(&file, &Kept { key, found: found.clone() }).then_some(found)
        });
        kept.unwrap_or_else(|| both.found(device, None))
    }

    /// What the device says it can do and is used without, and why. `multiview`: it says that it draws several views.
    pub(crate) fn used_without(&self, multiview: bool) -> Vec<String> {
        let resolves = |of: &str, unused: &[ResolveMode]| {
            let modes: Vec<String> = unused.iter().map(|mode| format!("{mode:?}")).collect();
            (!modes.is_empty()).then(|| {
                let why = self.depth_resolve_unknown.as_deref().unwrap_or("it resolves to other values");
                format!("{of} by {}: {why}", modes.join(", "))
            })
        };
        let DepthResolve { refuted, untested, .. } = &self.depth_resolve;
        let depth = resolves("depth resolves", if untested.is_empty() { refuted } else { untested });
        let layered = resolves("depth resolves of several layers at once", &self.depth_resolve.refuted_layered);
        let views = (multiview && !self.draws_views).then(|| {
            let why = self.draws_views_unknown.as_deref().unwrap_or("it draws other pictures");
            format!("multiview: {why}")
        });
        [depth, layered, views].into_iter().flatten().collect()
    }
}

/// What came of both self-tests.
struct Both {
    views: Tested<bool>,
    depth: Tested<DepthResolve>,
}

impl Both {
    /// Tests a device now, in helper processes if there is a helper.
    fn test(device: &Device, helper: Option<&Helper>) -> Both {
        let summary = device.summary();
        let views = Tested::of(match helper {
            Some(helper) => helper.draws_views(summary),
            None => Ok(multiview::probe(device).map_err(|error| error.to_string())),
        });
        let draws_views = views.found.unwrap_or(false);
        let depth = Tested::of(match helper {
            Some(helper) => helper.depth_resolve(summary, draws_views),
            None => Ok(depth_resolve::probe(device, draws_views).map_err(|error| error.to_string())),
        });
        Both { views, depth }
    }

    /// Whether what they found is kept. A test that took too long may have met a busy machine only; but what hangs would cost every
    /// command the same time again.
    fn are_kept(&self) -> bool {
        [self.views.end, self.depth.end].iter().all(|end| *end != End::NotDone)
    }

    /// What they found, kept in a file if there is one.
    fn found(&self, device: &Device, kept: Option<&Path>) -> SelfTests {
        let depth = self.depth.found.clone();
        let fails = self.depth.end == End::Finding;
        SelfTests {
            depth_resolve: depth.unwrap_or_else(|| DepthResolve::without_answer(device, fails)),
            depth_resolve_unknown: self.depth.why(kept),
            draws_views: self.views.found.unwrap_or(false),
            draws_views_unknown: self.views.why(kept),
            draws_views_untested: self.views.end != End::Finding,
        }
    }
}

/// What the end of a self-test says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// Something of the device: it would end so again.
    Finding,
    /// That it takes too long, at least now.
    TooLong,
    /// Nothing: it couldn't be done.
    NotDone,
}

/// What came of a self-test.
struct Tested<T> {
    /// What it found.
    found: Option<T>,
    /// Why it found nothing.
    why: Option<String>,
    /// What its end says.
    end: End,
}

impl<T> Tested<T> {
    /// By the answer of a helper process, or the same of this process.
    fn of(answer: Result<Result<T, String>, NoAnswer>) -> Tested<T> {
        let (found, why, end) = match answer {
            Ok(Ok(found)) => (Some(found), None, End::Finding),
            Ok(Err(why)) => (None, Some(format!("its self-test couldn't be done: {why}")), End::NotDone),
            Err(end) => (None, Some(format!("its self-test {end}")), end_of(&end)),
        };
        Tested { found, why, end }
    }

    /// Why it found nothing; and if only time was short, how it is tried again in spite of the file that keeps that.
    fn why(&self, kept: Option<&Path>) -> Option<String> {
        match (self.end, kept) {
            (End::TooLong, Some(file)) => {
                self.why.as_ref().map(|why| format!("{why}; to have it tested again, remove {}", file.display()))
            }
            _ => self.why.clone(),
        }
    }
}

/// What it says that a helper process gave no answer. A helper that can't be started now may be there later, and these signals come
/// from others: the user, or a system that is short of memory.
fn end_of(end: &NoAnswer) -> End {
    match end {
        NoAnswer::Died(how) if ["SIGHUP", "SIGINT", "SIGKILL", "SIGTERM"].contains(&how.as_str()) => End::NotDone,
        NoAnswer::Died(_) | NoAnswer::Stack(_) => End::Finding,
        NoAnswer::TooLong(_) => End::TooLong,
        NoAnswer::Memory(_) | NoAnswer::Cancelled | NoAnswer::Unusable(_) => End::NotDone,
    }
}

/// All that what is found depends on: the device, its driver and that one's version, and the program that tests it, which
/// another build replaces.
fn key(device: &Device, helper: &Helper) -> String {
    let program = fs::metadata(helper.path()).ok();
    let written = program.as_ref().and_then(|it| it.modified().ok());
    let written = written.and_then(|it| it.duration_since(UNIX_EPOCH).ok()).map_or(0, |it| it.as_nanos());
    let bytes = program.map_or(0, |it| it.len());
    let (identity, path, version) = (&device.summary().identity, helper.path().display(), env!("CARGO_PKG_VERSION"));
    format!("{identity}; framewright {version}; {path}, {bytes} bytes, written {written}")
}

/// Where it is kept: one file for each device and program, whatever their versions.
fn file(device: &Device, helper: &Helper) -> Option<PathBuf> {
    let mut hasher = DefaultHasher::new();
    (&device.summary().name, helper.path()).hash(&mut hasher);
    helper.cache().map(|cache| cache.join(format!("{:016x}.json", hasher.finish())))
}

/// What a file says, if it can be read and is about this.
fn known(file: &Path, key: &str) -> Option<SelfTests> {
    let kept: Kept = serde_json::from_slice(&fs::read(file).ok()?).ok()?;
    (kept.key == key).then_some(kept.found)
}

/// Keeps what was found, and says whether that was possible. Where it isn't it is found anew each time.
fn keep(file: &Path, kept: &Kept) -> bool {
    match (file.parent(), serde_json::to_vec_pretty(kept)) {
        (Some(folder), Ok(text)) => layer::replace(folder, file, &text).is_ok(),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::DeviceOptions;
    use std::time::Duration;

    #[test]
    fn a_self_test_without_an_answer_is_a_finding_only_if_the_driver_ended_it() {
        let no_answer = |answer: Result<Result<bool, String>, NoAnswer>| {
            let tested = Tested::of(answer);
            assert!(tested.found.is_none() && tested.why.is_some());
            tested.end
        };
        for ended in [NoAnswer::Died("SIGSEGV".to_owned()), NoAnswer::Stack(1 << 20)] {
            assert_eq!(no_answer(Err(ended)), End::Finding);
        }
        assert_eq!(no_answer(Err(NoAnswer::TooLong(Duration::from_secs(1)))), End::TooLong);
        let not_done = [
            Ok(Err("no memory".to_owned())),
            Err(NoAnswer::Cancelled),
            Err(NoAnswer::Died("SIGKILL".to_owned())),
            Err(NoAnswer::Unusable("it is none".to_owned())),
        ];
        for ended in not_done {
            assert_eq!(no_answer(ended), End::NotDone);
        }
    }

    #[test]
    fn of_depth_whose_self_test_gave_no_answer_no_mode_is_used() {
        let Ok(device) = Device::open(&DeviceOptions::default()) else {
            assert!(std::env::var_os("CI").is_none(), "CI must have a device");
            return;
        };
        for fails in [true, false] {
            let DepthResolve { has, refuted, refuted_layered, untested } = DepthResolve::without_answer(&device, fails);
            assert!(has.is_empty() && refuted_layered.is_empty());
            assert!(refuted.contains(&ResolveMode::SampleZero) == fails && refuted.is_empty() != fails);
            assert!(untested.contains(&ResolveMode::SampleZero) != fails && untested.is_empty() == fails);
        }
    }
}
