//! Self-tests of drivers: what a device says it can do is tried before it is used, in a helper process if there is one.
//!
//! What a test found is kept for the device and the version of its driver. A device whose test ends the process is used
//! without the feature.

use crate::depth_resolve::{self, DepthResolve};
use crate::device::Device;
use crate::helper::{Helper, NoAnswer};
use crate::{layer, multiview};
use framewright_graph::vocabulary::ResolveMode;
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
        let Some(helper) = helper else { return SelfTests::run(device, None).0 };
        let (key, file) = (key(device, helper), file(device, helper));
        if let Some(known) = file.as_deref().and_then(|file| known(file, &key)) {
            return known;
        }
        let (found, lasting) = SelfTests::run(device, Some(helper));
        if let Some(file) = file.filter(|_| lasting) {
            keep(&file, Kept { key, found: found.clone() });
        }
        found
    }

    /// What they find now, in helper processes if there is a helper, and whether they would find it again.
    fn run(device: &Device, helper: Option<&Helper>) -> (SelfTests, bool) {
        let identity = &device.summary().identity;
        let views = Tested::of(match helper {
            Some(helper) => helper.draws_views(identity),
            None => Ok(multiview::probe(device).map_err(|error| error.to_string())),
        });
        let draws_views = views.found.unwrap_or(false);
        let depth = Tested::of(match helper {
            Some(helper) => helper.depth_resolve(identity, draws_views),
            None => Ok(depth_resolve::probe(device, draws_views).map_err(|error| error.to_string())),
        });
        let found = SelfTests {
            depth_resolve: depth.found.unwrap_or_else(|| DepthResolve::without_answer(device, depth.lasts)),
            depth_resolve_unknown: depth.why,
            draws_views,
            draws_views_unknown: views.why,
            draws_views_untested: !views.lasts,
        };
        (found, depth.lasts && views.lasts)
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

/// What came of a self-test.
struct Tested<T> {
    /// What it found.
    found: Option<T>,
    /// Why it found nothing.
    why: Option<String>,
    /// Whether it would end so again. If not, it says nothing of the device.
    lasts: bool,
}

impl<T> Tested<T> {
    /// By the answer of a helper process, or the same of this process.
    fn of(answer: Result<Result<T, String>, NoAnswer>) -> Tested<T> {
        let (found, why, lasts) = match answer {
            Ok(Ok(found)) => (Some(found), None, true),
            Ok(Err(why)) => (None, Some(format!("its self-test couldn't be done: {why}")), false),
            Err(end) => (None, Some(format!("its self-test {end}")), lasts(&end)),
        };
        Tested { found, why, lasts }
    }
}

/// Whether a self-test would end so again. A busy machine is slow, a helper that can't be started now may be there later, and
/// these signals come from others: the user, or a system that is short of memory.
fn lasts(end: &NoAnswer) -> bool {
    match end {
        NoAnswer::Died(how) => !["SIGHUP", "SIGINT", "SIGKILL", "SIGTERM"].contains(&how.as_str()),
        NoAnswer::Stack(_) => true,
        NoAnswer::Memory(_) | NoAnswer::TooLong(_) | NoAnswer::Cancelled | NoAnswer::Unusable(_) => false,
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

/// Keeps what was found. Where that isn't possible it is found anew each time.
fn keep(file: &Path, kept: Kept) {
    if let (Some(folder), Ok(text)) = (file.parent(), serde_json::to_vec_pretty(&kept)) {
        let _ = layer::replace(folder, file, &text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::DeviceOptions;
    use std::time::Duration;

    #[test]
    fn a_self_test_without_an_answer_is_a_finding_only_if_the_driver_ended_it() {
        let tested = |answer: Result<Result<bool, String>, NoAnswer>| Tested::of(answer);
        for ended in [NoAnswer::Died("SIGSEGV".to_owned()), NoAnswer::Stack(1 << 20)] {
            let tested = tested(Err(ended));
            assert!(tested.found.is_none() && tested.why.is_some() && tested.lasts);
        }
        let not_done = [
            Ok(Err("no memory".to_owned())),
            Err(NoAnswer::TooLong(Duration::from_secs(1))),
            Err(NoAnswer::Cancelled),
            Err(NoAnswer::Died("SIGKILL".to_owned())),
            Err(NoAnswer::Unusable("it is none".to_owned())),
        ];
        for ended in not_done {
            let tested = tested(ended);
            assert!(tested.found.is_none() && tested.why.is_some() && !tested.lasts);
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
