//! Self-tests of drivers: what a device says it can do is tried before it is used, in a helper process if there is one.
//!
//! Findings are kept for the device and the version of its driver. A device whose test ends the process is used without the
//! feature.

use super::claims::depth_resolve_modes;
use crate::base::{identity_of, read_file, replace_file};
use crate::gpu::Device;
use crate::probe::{multiview, sample_resolve};
use crate::process::{DeviceName, Helper, NoAnswer, SampleResolve};
use framewright_graph::device::Profile;
use framewright_graph::vulkan::{ResolveMode, name_of};
use serde::{Deserialize, Serialize};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// The findings of a device's self-tests.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct SelfTests {
    /// How the device resolves samples.
    pub(crate) sample_resolve: SampleResolve,
    /// Why the self-test of resolves gave no answer.
    sample_resolve_unknown: Option<String>,
    /// Whether the device draws several views at once, if it claims to.
    pub(crate) draws_views: bool,
    /// Why the self-test of views gave no answer.
    draws_views_unknown: Option<String>,
    /// Whether the self-test of views couldn't be done, which says nothing of the device.
    pub(crate) draws_views_untested: bool,
}

/// A file with what was found.
#[derive(Debug, Serialize, Deserialize)]
struct CachedFindings {
    /// The device, its driver and the program that tested it.
    key: String,
    found: SelfTests,
}

impl SelfTests {
    /// The findings of `device`'s self-tests, from the file that keeps them or from new tests.
    pub(crate) fn of(device: &Device, helper: Option<&Helper>) -> SelfTests {
        let Some(helper) = helper else { return SelfTestRuns::test(device, None).found(device, None) };
        let (key, file) = (key(device, helper), file(device, helper));
        if let Some(known) = file.as_deref().and_then(|file| known(file, &key)) {
            return known;
        }
        let runs = SelfTestRuns::test(device, Some(helper));
        let kept = file.filter(|_| runs.are_kept()).and_then(|file| {
            let found = runs.found(device, Some(&file));
            keep(&file, &CachedFindings { key, found: found.clone() }).then_some(found)
        });
        kept.unwrap_or_else(|| runs.found(device, None))
    }

    /// Takes from the profile of a device that does all that it says what it failed, or wasn't tested for.
    pub(super) fn take_from(&self, profile: &mut Profile) {
        let SampleResolve { has, refuted, refuted_layered, untested, refuted_integers } = self.sample_resolve.clone();
        profile.depth_resolve = has;
        profile.refuted_depth_resolve = refuted;
        profile.refuted_layered_depth_resolve = refuted_layered;
        profile.untested_depth_resolve = untested;
        profile.refuted_integer_resolve = refuted_integers;
        if !self.draws_views {
            let claimed = std::mem::replace(&mut profile.max_multiview_views, 1) > 1;
            profile.untested_multiview = claimed && self.draws_views_untested;
            profile.refuted_multiview = claimed && !self.draws_views_untested;
        }
    }

    /// Features that the device claims and is used without, and why. `multiview`: the device claims to draw several views.
    pub(crate) fn used_without(&self, multiview: bool) -> Vec<String> {
        let resolves = |of: &str, unused: &[ResolveMode]| {
            let modes: Vec<String> = unused.iter().map(name_of).collect();
            (!modes.is_empty()).then(|| {
                let why = self.sample_resolve_unknown.as_deref().unwrap_or("it resolves to other values");
                format!("{of} by {}: {why}", modes.join(", "))
            })
        };
        let SampleResolve { refuted, untested, .. } = &self.sample_resolve;
        let depth = resolves("depth resolves", if untested.is_empty() { refuted } else { untested });
        let layered = resolves("depth resolves of several layers at once", &self.sample_resolve.refuted_layered);
        let integers = self.sample_resolve.refuted_integers;
        let integers = integers.then(|| "resolves of integers: it takes another sample than sample zero".to_owned());
        let views = (multiview && !self.draws_views).then(|| {
            let why = self.draws_views_unknown.as_deref().unwrap_or("it draws other pictures");
            format!("multiview: {why}")
        });
        [depth, layered, integers, views].into_iter().flatten().collect()
    }
}

/// The results of both self-tests.
struct SelfTestRuns {
    views: SelfTestRun<bool>,
    resolves: SelfTestRun<SampleResolve>,
}

impl SelfTestRuns {
    /// Tests a device now, in helper processes if there is a helper.
    fn test(device: &Device, helper: Option<&Helper>) -> SelfTestRuns {
        let summary = device.summary();
        let device_name = DeviceName { name: &summary.name, identity: &summary.identity };
        let views = SelfTestRun::of(match helper {
            Some(helper) => helper.draws_views(device_name),
            None => Ok(multiview::probe(device).map_err(|error| error.to_string())),
        });
        let draws_views = views.found.unwrap_or(false);
        let resolves = SelfTestRun::of(match helper {
            Some(helper) => helper.sample_resolve(device_name, draws_views),
            None => Ok(sample_resolve::probe(device, draws_views).map_err(|error| error.to_string())),
        });
        SelfTestRuns { views, resolves }
    }

    /// Whether what they found is kept. A test that took too long may have met a busy machine only; but what hangs would cost every
    /// command the same time again.
    fn are_kept(&self) -> bool {
        [self.views.end, self.resolves.end].iter().all(|end| *end != Outcome::NotDone)
    }

    /// The findings of both tests, which the file `kept` keeps if it is there.
    fn found(&self, device: &Device, kept: Option<&Path>) -> SelfTests {
        let resolves = self.resolves.found.clone();
        let fails = self.resolves.end == Outcome::Finding;
        SelfTests {
            sample_resolve: resolves.unwrap_or_else(|| without_answer(device, fails)),
            sample_resolve_unknown: self.resolves.why(kept),
            draws_views: self.views.found.unwrap_or(false),
            draws_views_unknown: self.views.why(kept),
            draws_views_untested: self.views.end != Outcome::Finding,
        }
    }
}

/// Findings that use no resolves of a device whose self-test gave no answer: draws resolve instead. `fails`: that is the device's doing.
fn without_answer(device: &Device, fails: bool) -> SampleResolve {
    let said = depth_resolve_modes(&device.gpu);
    let (refuted, untested) = if fails { (said, Vec::new()) } else { (Vec::new(), said) };
    SampleResolve { refuted, untested, ..SampleResolve::default() }
}

/// The meaning of a self-test's end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// A finding about the device: the test would end so again.
    Finding,
    /// The test takes too long, at least now.
    TooLong,
    /// Nothing about the device: the test couldn't be done.
    NotDone,
}

/// The result of a self-test.
struct SelfTestRun<T> {
    /// The finding of the test.
    found: Option<T>,
    /// Why the test found nothing.
    why: Option<String>,
    /// The meaning of the test's end.
    end: Outcome,
}

impl<T> SelfTestRun<T> {
    /// From the answer of a helper process, or of a test in this process.
    fn of(answer: Result<Result<T, String>, NoAnswer>) -> SelfTestRun<T> {
        let (found, why, end) = match answer {
            Ok(Ok(found)) => (Some(found), None, Outcome::Finding),
            Ok(Err(why)) => (None, Some(format!("its self-test couldn't be done: {why}")), Outcome::NotDone),
            Err(end) => (None, Some(format!("its self-test {end}")), outcome_of(&end)),
        };
        SelfTestRun { found, why, end }
    }

    /// Why it found nothing; and if only time was short, how it is tried again in spite of the file that keeps that.
    fn why(&self, kept: Option<&Path>) -> Option<String> {
        match (self.end, kept) {
            (Outcome::TooLong, Some(file)) => {
                self.why.as_ref().map(|why| format!("{why}; to have it tested again, remove {}", file.display()))
            }
            _ => self.why.clone(),
        }
    }
}

/// The meaning of a helper process that gave no answer. A helper that can't be started now may be there later, and these
/// signals come from others: the user, or a system that is short of memory.
fn outcome_of(end: &NoAnswer) -> Outcome {
    match end {
        NoAnswer::Died(how) if ["SIGHUP", "SIGINT", "SIGKILL", "SIGTERM"].contains(&how.as_str()) => Outcome::NotDone,
        NoAnswer::Crashed(_) | NoAnswer::Died(_) | NoAnswer::Stack(_) => Outcome::Finding,
        NoAnswer::TooLong(_) => Outcome::TooLong,
        NoAnswer::Memory(_) | NoAnswer::Cancelled | NoAnswer::Unusable(_) => Outcome::NotDone,
    }
}

/// Names what the findings depend on: the device with its driver and the driver's version, and the build of the program that tests.
fn key(device: &Device, helper: &Helper) -> String {
    format!("{}; {}", device.summary().identity, identity_of(helper.path()))
}

/// The file of the findings: one for each device and program, which all versions of them share.
fn file(device: &Device, helper: &Helper) -> Option<PathBuf> {
    let mut hasher = DefaultHasher::new();
    (&device.summary().name, helper.path()).hash(&mut hasher);
    helper.cache().map(|cache| cache.self_tests().join(format!("{:016x}.json", hasher.finish())))
}

/// Larger files are none of ours.
const LARGEST_FILE: u64 = 1 << 20;

/// The findings of a file, if it can be read and `key` is its own.
fn known(file: &Path, key: &str) -> Option<SelfTests> {
    let kept: CachedFindings = serde_json::from_slice(&read_file(file, LARGEST_FILE)?).ok()?;
    (kept.key == key).then_some(kept.found)
}

/// Keeps the findings in a file, and says whether that was possible. Where it isn't, each run tests anew.
fn keep(file: &Path, kept: &CachedFindings) -> bool {
    match (file.parent(), serde_json::to_vec_pretty(kept)) {
        (Some(folder), Ok(text)) => replace_file(folder, file, &text).is_ok(),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::DeviceOptions;
    use std::time::Duration;

    #[test]
    fn a_self_test_without_an_answer_is_a_finding_only_if_the_driver_ended_it() {
        let no_answer = |answer: Result<Result<bool, String>, NoAnswer>| {
            let tested = SelfTestRun::of(answer);
            assert!(tested.found.is_none() && tested.why.is_some());
            tested.end
        };
        for ended in [NoAnswer::Crashed("SIGSEGV".to_owned()), NoAnswer::Stack(1 << 20)] {
            assert_eq!(no_answer(Err(ended)), Outcome::Finding);
        }
        assert_eq!(no_answer(Err(NoAnswer::TooLong(Duration::from_secs(1)))), Outcome::TooLong);
        let not_done = [
            Ok(Err("no memory".to_owned())),
            Err(NoAnswer::Cancelled),
            Err(NoAnswer::Died("SIGKILL".to_owned())),
            Err(NoAnswer::Unusable("it is none".to_owned())),
        ];
        for ended in not_done {
            assert_eq!(no_answer(ended), Outcome::NotDone);
        }
    }

    #[test]
    fn of_depth_whose_self_test_gave_no_answer_no_mode_is_used() {
        let Ok(device) = Device::open(&DeviceOptions::default()) else {
            assert!(std::env::var_os("CI").is_none(), "CI must have a device");
            return;
        };
        for fails in [true, false] {
            let SampleResolve { has, refuted, refuted_layered, untested, .. } = without_answer(&device, fails);
            assert!(has.is_empty() && refuted_layered.is_empty());
            assert!(refuted.contains(&ResolveMode::SampleZero) == fails && refuted.is_empty() != fails);
            assert!(untested.contains(&ResolveMode::SampleZero) != fails && untested.is_empty() == fails);
        }
    }
}
