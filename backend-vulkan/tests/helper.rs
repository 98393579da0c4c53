//! Helper processes that die, or are none, as a program that names one meets them.
#![cfg(unix)]

use framewright_graph::base::OutsideChoice;
use framewright_graph::device::Profile;
use framewright_graph::frame::{Draw, Stereo};
use framewright_graph::shader::{DrawInterface, ShaderInterfaces, ShaderMessage, ShaderProblem, Variant};
use framewright_vulkan::helper::Limits;
use framewright_vulkan::{Cache, Device, DeviceOptions, Helper, PrecompiledShaders, ShaderLibrary};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// One test at a time: a program can't be started while a child that another test just forked still holds it open for writing.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A device that is tested by this helper; `None`, with a message, where the machine has none. In CI that is a failure.
fn tested_by(helper: &Helper) -> Option<Device> {
    match Device::open(&DeviceOptions { helper: Some(helper.clone()), ..DeviceOptions::default() }) {
        Ok(device) => Some(device),
        Err(error) => {
            assert!(std::env::var_os("CI").is_none(), "in CI this is a failure: {error}");
            eprintln!("SKIPPED: {error}");
            None
        }
    }
}

/// A program in `folder` that runs these lines of a shell and notes each start in the file `starts`.
fn program(folder: &Path, lines: &str) -> PathBuf {
    let path = folder.join("program");
    let starts = folder.join("starts");
    fs::write(&path, format!("#!/bin/sh\necho start >> '{}'\n{lines}\n", starts.display())).expect("written");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("it may run");
    path
}

fn starts(folder: &Path) -> usize {
    fs::read_to_string(folder.join("starts")).unwrap_or_default().lines().count()
}

#[test]
fn a_device_whose_self_test_dies_is_used_without_the_feature_and_that_is_kept() {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a folder");
    let dies = program(folder.path(), "kill -SEGV $$");
    let helper =
        Helper::program(&dies, Limits::default()).with_cache(Some(Cache::in_folder(folder.path().join("cache"))));
    let Some(device) = tested_by(&helper) else { return };
    let profile = device.profile();
    assert_eq!((profile.max_multiview_views, profile.refuted_multiview), (1, true));
    assert_eq!(profile.depth_resolve, [], "{:?}", profile.refuted_depth_resolve);
    assert!(!profile.refuted_depth_resolve.is_empty());
    let without = device.used_without();
    let said = "its self-test crashed (SIGSEGV)";
    assert!(without.len() == 2 && without.iter().all(|what| what.ends_with(said)), "{without:?}");
    assert_eq!(starts(folder.path()), 2, "each test has a process of its own");

    let again = tested_by(&helper).expect("the same device");
    assert_eq!(again.profile(), profile);
    assert_eq!(again.used_without(), without);
    assert_eq!(starts(folder.path()), 2, "it isn't tested again");

    // Another build of the program may have mended it.
    program(folder.path(), "kill -SEGV $$ # again");
    let again = tested_by(&helper).expect("the same device");
    assert_eq!(again.used_without(), without);
    assert_eq!(starts(folder.path()), 4);
}

#[test]
fn a_self_test_that_overflows_the_stack_says_so_however_much_was_said_before() {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a folder");
    let overflows = program(
        folder.path(),
        "head -c 1000000 /dev/zero | tr '\\0' 'a' >&2\necho \"thread 'helper' has overflowed its stack\" >&2\nkill -ABRT $$",
    );
    let helper = Helper::program(&overflows, Limits::default()).with_cache(None);
    let Some(device) = tested_by(&helper) else { return };
    let without = device.used_without();
    let said = "its self-test needed a stack of more than 8 MiB, which is its limit";
    assert!(without.len() == 2 && without.iter().all(|what| what.ends_with(said)), "{without:?}");
}

#[test]
fn a_self_test_that_hangs_is_told_of_and_given_up_and_not_tried_again_until_its_file_is_removed() {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a folder");
    let (hangs, cache) = (program(folder.path(), "exec sleep 1000"), folder.path().join("cache"));
    let limits = Limits { self_test: Duration::from_secs(2), ..Limits::default() };
    let helper = Helper::program(&hangs, limits).with_cache(Some(Cache::in_folder(&cache)));
    let told = Arc::new(Mutex::new(Vec::new()));
    let tell = told.clone();
    helper.when_a_test_takes_long(move |test| tell.lock().expect("no panic").push(test.clone()));
    let told = || told.lock().expect("no panic").clone();
    let Some(device) = tested_by(&helper) else { return };
    let without = device.used_without();
    let file =
        fs::read_dir(cache.join("self-tests")).expect("a folder").next().expect("a file").expect("a file").path();
    let said = format!(
        "its self-test took longer than 2 s, which is its limit; to have it tested again, remove {}",
        file.display()
    );
    assert!(without.len() == 2 && without.iter().all(|what| what.ends_with(&said)), "{without:?}");
    assert_eq!(told().len(), 2, "{:?}", told());
    assert!(told().iter().all(|it| it.device == device.summary().name && it.limit == Duration::from_secs(2)));
    // That may be the machine's doing.
    let profile = device.profile();
    assert!(profile.untested_multiview && !profile.refuted_multiview && profile.refuted_depth_resolve.is_empty());

    let again = tested_by(&helper).expect("the same device");
    assert_eq!((again.used_without(), again.profile()), (without.clone(), profile));
    assert_eq!((starts(folder.path()), told().len()), (2, 2), "nothing waits again");
    fs::remove_file(&file).expect("removed");
    let limits = Limits { self_test: Duration::from_secs(1), ..Limits::default() };
    let helper = Helper::program(&hangs, limits).with_cache(Some(Cache::in_folder(&cache)));
    let said = said.replace("2 s", "1 s");
    let without = tested_by(&helper).expect("the same device").used_without();
    assert!(without.len() == 2 && without.iter().all(|what| what.ends_with(&said)), "{without:?}");
    assert_eq!(starts(folder.path()), 4);

    // Where it can't be kept nothing is there to remove.
    let helper = helper.with_cache(None);
    let without = tested_by(&helper).expect("the same device").used_without();
    assert!(without.iter().all(|what| what.ends_with("longer than 1 s, which is its limit")), "{without:?}");
}

#[test]
fn a_self_test_that_can_not_be_started_leaves_the_device_without_the_feature_and_is_not_kept() {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a folder");
    let cache = folder.path().join("cache");
    let helper =
        Helper::program(folder.path().join("nothing"), Limits::default()).with_cache(Some(Cache::in_folder(&cache)));
    let Some(device) = tested_by(&helper) else { return };
    let without = device.used_without();
    assert!(
        without.len() == 2 && without.iter().all(|what| what.contains("its self-test can't be started")),
        "{without:?}"
    );
    assert!(!cache.exists());
    // That is no finding about the device.
    let profile = device.profile();
    assert!(profile.untested_multiview && !profile.refuted_multiview && profile.max_multiview_views == 1);
    assert!(!profile.untested_depth_resolve.is_empty() && profile.refuted_depth_resolve.is_empty());
    assert_eq!(profile.depth_resolve, []);
    let said = Stereo::Multiview.lacks(&profile).expect("it isn't used");
    assert!(said.ends_with("and that couldn't be tested"), "{said}");
    let text = profile.to_ron().expect("a text");
    assert!(text.contains("untested_multiview: true") && !text.contains("refuted_"), "{text}");
    assert_eq!(Profile::from_ron(&text).expect("it is read").untested_depth_resolve, profile.untested_depth_resolve);
}

const SHADERS: &[(&str, &str)] = &[
    ("full_screen.vert", "#version 460\nvoid main() { gl_Position = vec4(0.0); }\n"),
    ("plain.frag", "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n"),
];

/// The problem of a sound shader that is compiled with this helper.
fn compiled(program: &Path) -> ShaderProblem {
    let limits = Limits { time: Duration::from_secs(2), ..Limits::default() };
    let library = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let mut library = library.with_helper(&Helper::program(program, limits));
    library.draw_shader("plain", Draw::FullScreen, &Variant::default()).expect_err("no helper")
}

fn unusable(program: &Path) -> String {
    match compiled(program) {
        ShaderProblem::Machine { what } => what,
        other => panic!("{other:?}"),
    }
}

/// That a shader can't be used, though nothing is wrong with the helper.
fn unsupported(program: &Path) -> String {
    match compiled(program) {
        ShaderProblem::Unsupported { what } => what,
        other => panic!("{other:?}"),
    }
}

fn broken(program: &Path) -> ShaderMessage {
    match compiled(program) {
        ShaderProblem::DoesNotCompile { messages } => messages[0].clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_program_that_is_no_helper_is_an_error_and_nothing_waits_for_it() {
    let _alone = alone();
    let begin = Instant::now();
    let folder = tempfile::tempdir().expect("a folder");
    assert!(unusable(&folder.path().join("none")).contains("can't be started"));
    // It says back what it is told.
    assert!(unusable(&program(folder.path(), "exec cat")).contains("doesn't speak as a helper does"));
    assert!(
        unusable(&program(folder.path(), "echo 'a line of a program that knows nothing of helpers'"))
            .contains("can't be")
    );
    // The system or a person ended it, or it ended itself: no shader is to blame.
    let again = ", and so did the one that took its place";
    for (lines, how) in [("exit 7", "exit status: 7"), ("kill -KILL $$", "SIGKILL"), ("kill -TERM $$", "SIGTERM")] {
        fs::remove_file(folder.path().join("starts")).expect("it was started");
        let said = unusable(&program(folder.path(), lines));
        assert_eq!(said, format!("the helper process that compiles shaders died ({how}){again}"));
        assert_eq!(starts(folder.path()), 2, "it is asked again once");
    }
    assert!(unusable(Path::new("/bin/false")).contains("died (exit status: 1)"));
    assert!(unusable(Path::new("/bin/true")).contains("it ended, which a helper doesn't"));
    let crashed = broken(&program(folder.path(), "kill -SEGV $$"));
    assert_eq!(crashed.text, "shipped:plain.frag: the GLSL compiler crashed (SIGSEGV)");
    assert_eq!(crashed.limit, None);
    let quote = crashed.quote.expect("the shader's file");
    assert_eq!((&*quote.file, quote.line, &*quote.text), ("shipped:plain.frag", 1, "#version 460"));
    // It reads nothing and says nothing.
    let late = broken(&program(folder.path(), "exec sleep 1000"));
    assert_eq!(late.text, "shipped:plain.frag: the GLSL compiler took longer than 2 s, which is its limit");
    assert_eq!(late.limit, Some(OutsideChoice::ShaderTime));
    let overflows = "echo \"thread 'helper' has overflowed its stack\" >&2\nkill -ABRT $$";
    assert_eq!(broken(&program(folder.path(), overflows)).limit, Some(OutsideChoice::ShaderStack));
    let full = "echo 'terminate called after throwing an instance of std::bad_alloc' >&2\nkill -ABRT $$";
    assert_eq!(broken(&program(folder.path(), full)).limit, Some(OutsideChoice::ShaderMemory));
    assert!(begin.elapsed() < Duration::from_secs(30));
}

#[test]
fn a_helper_that_died_between_two_shaders_is_started_anew() {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a folder");
    // Each process answers one question and dies at the next.
    let answer = "{\"CompileFailure\":{\"Messages\":[\"said by the helper\"]}}";
    let says = format!(
        "head -c 4 > /dev/null\nprintf '\\{:03o}\\0\\0\\0%s' '{answer}'\nsleep 0.3\nkill -KILL $$",
        answer.len()
    );
    let helper = Helper::program(program(folder.path(), &says), Limits::default()).with_cache(None);
    for number in 1..=2 {
        // A library keeps what it was told.
        let library = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
        let mut library = library.with_helper(&helper);
        match library.draw_shader("plain", Draw::FullScreen, &Variant::default()).expect_err("the helper says so") {
            ShaderProblem::DoesNotCompile { messages } => assert_eq!(messages[0].text, "said by the helper"),
            other => panic!("{other:?}"),
        }
        assert_eq!(starts(folder.path()), number);
        // It is dead by now.
        std::thread::sleep(Duration::from_millis(600));
    }
}

#[test]
fn a_helper_without_a_compiler_is_told_and_precompiled_shaders_need_none() {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a folder");
    let answer = "{\"CompileFailure\":\"NoCompiler\"}";
    let says = format!("printf '\\{:03o}\\0\\0\\0%s' '{answer}'\nexec cat > /dev/null", answer.len());
    let without = program(folder.path(), &says);
    let said = format!(
        "shipped:plain.frag: it must be compiled, and the program {} was built without the feature `shader-compiler`",
        without.display()
    );
    assert_eq!(unsupported(&without), format!("{said}; no folder of precompiled shaders was named"));

    let precompiled = PrecompiledShaders::in_folder(folder.path().join("spirv"));
    let library = || ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let usual = Variant::default();
    let compiled = library().with_precompiled(Some(precompiled.clone().adding()));
    let compiled = { compiled }.compiled("plain", Draw::FullScreen, &usual).expect("there is a compiler here");
    let helper = Helper::program(&without, Limits::default()).with_cache(None);
    let mut library = library().with_precompiled(Some(precompiled)).with_helper(&helper);
    let found = library.compiled("plain", Draw::FullScreen, &usual).expect("it was compiled ahead");
    assert_eq!((found.vertex, found.fragment), (compiled.vertex, compiled.fragment));
    let other = Variant { depth_only: true, ..usual };
    let refused = library.compiled("plain", Draw::FullScreen, &other).expect_err("that was not");
    let spirv = folder.path().join("spirv");
    let what = format!("{said}; {} holds no SPIR-V of it as this pass needs it", spirv.display());
    assert_eq!(refused, ShaderProblem::Unsupported { what });
}
