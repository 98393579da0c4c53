//! Barriers that reach the driver, counted on their way: a device of the program's, with a function of the test's own in its table.

use crate::adopted::{adopted_with, made_with};
use crate::frames::{Small, Uses, dispatch, draw, frame, library, on_each_driver, planned, texels, words};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame, FrameValue, Groups, ParamValue};
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::ash::{self, vk};
use framewright_vulkan::{Device, DeviceFeatures, Executor, ExecutorOptions};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The driver's own function, for the test that counts now.
static DRIVER: Mutex<Option<vk::PFN_vkCmdPipelineBarrier2>> = Mutex::new(None);
static CALLS: AtomicU64 = AtomicU64::new(0);
static OWNERS: AtomicU64 = AtomicU64::new(0);
static LAYERS: AtomicU64 = AtomicU64::new(0);
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Has one test count at a time.
pub(crate) fn counting() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How many calls `work` makes, and how many barriers change the owner in them.
pub(crate) fn counted(work: impl FnOnce()) -> [u64; 2] {
    [&CALLS, &OWNERS, &LAYERS].iter().for_each(|counter| counter.store(0, Relaxed));
    work();
    [&CALLS, &OWNERS].map(|counter| counter.load(Relaxed))
}

/// How many layers of images changed the owner in what was [counted] last.
pub(crate) fn counted_layers() -> u64 {
    LAYERS.load(Relaxed)
}

/// A device with a queue of the first family, whose barriers are counted, and what destroys it.
pub(crate) fn counting_device(like: &Device) -> (ash::Device, Device) {
    let (instance, physical) = like.raw_physical();
    // SAFETY: the physical device belongs to the instance.
    let mut features = unsafe { DeviceFeatures::of(instance, physical) }.expect("it is enough");
    let extensions = features.extensions().to_vec();
    let mut chain = features.chain();
    let raw = made_with(like, &mut chain, &extensions);
    *DRIVER.lock().expect("no test panicked here") = Some(raw.fp_v1_3().cmd_pipeline_barrier2);
    let name_of = instance.fp_v1_0().get_device_proc_addr;
    let load = |name: &std::ffi::CStr| -> *const std::ffi::c_void {
        if name == c"vkCmdPipelineBarrier2" {
            return count as *const std::ffi::c_void;
        }
        // SAFETY: the device lives.
        unsafe { name_of(raw.handle(), name.as_ptr()) }.map_or(std::ptr::null(), |found| found as *const _)
    };
    // SAFETY: each function has the type of its name.
    let table = unsafe { ash::Device::load_with(load, raw.handle()) };
    let device = adopted_with(like, &table, &chain, &extensions, &[0], None).expect("it is enough");
    (raw, device)
}

unsafe extern "system" fn count(commands: vk::CommandBuffer, info: *const vk::DependencyInfo<'_>) {
    CALLS.fetch_add(1, Relaxed);
    // SAFETY: the caller's structure, with as many barriers as it says.
    let owners = unsafe {
        let info = &*info;
        let images = (0..info.image_memory_barrier_count as usize).map(|at| &*info.p_image_memory_barriers.add(at));
        let buffers = (0..info.buffer_memory_barrier_count as usize).map(|at| &*info.p_buffer_memory_barriers.add(at));
        let images = images.filter(|it| it.src_queue_family_index != it.dst_queue_family_index);
        let layers: Vec<u64> = images.map(|it| it.subresource_range.layer_count.into()).collect();
        LAYERS.fetch_add(layers.iter().sum(), Relaxed);
        layers.len() + buffers.filter(|it| it.src_queue_family_index != it.dst_queue_family_index).count()
    };
    OWNERS.fetch_add(owners as u64, Relaxed);
    let driver = *DRIVER.lock().expect("no test panicked here");
    if let Some(driver) = driver {
        // SAFETY: the caller's arguments are passed on.
        unsafe { driver(commands, info) };
    }
}

const SHADERS: &[(&str, &str)] = &[
    (
        "clock.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform Params { uint number; float seconds; } params;
        layout(location = 0) out uint color;
        void main() { color = params.number + 1000 * uint(round(60.0 * params.seconds)); }",
    ),
    (
        "clock.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) uniform Params { uint number; } params;
        layout(set = 0, binding = 1) writeonly buffer Last { uint last; };
        void main() { last = params.number; }",
    ),
];

/// A draw and a dispatch with these parameters.
fn clocks([number, seconds]: [ParamValue; 2]) -> Frame {
    let mut small = Small::default();
    let shown = small.image("shown", Format::R32_UINT, [1, 1]);
    let last = small.buffer("last", 1);
    let mut by_draw = draw("clock", Draw::FullScreen).draws(shown, Subresources::WHOLE, None);
    by_draw.params = vec![("number".into(), number.clone()), ("seconds".into(), seconds)];
    small.pass(by_draw);
    let mut by_dispatch = dispatch("clock", Groups::Count([1, 1, 1])).block("Last", last, (false, true));
    (by_dispatch.name, by_dispatch.params) = ("clock of a dispatch".into(), vec![("number".into(), number)]);
    small.pass(by_dispatch);
    small.image_output(shown);
    small.buffer_output(last);
    small.frame
}

/// Parameters that each frame has its own of take no barrier: as many calls are recorded as with constants.
#[test]
fn do_9_values_of_a_frame_take_no_barrier() {
    let _alone = counting();
    let constant = [ParamValue::Integer(3), ParamValue::Number(0.5)];
    let of_frame = [FrameValue::Frame, FrameValue::Time].map(ParamValue::OfFrame);
    on_each_driver(|like| {
        let (raw, device) = counting_device(like);
        let calls = [constant.clone(), of_frame.clone()].map(|params| {
            let plan = planned(&device, &clocks(params), &Options::default());
            let options = ExecutorOptions { frames_in_flight: 2, ..ExecutorOptions::default() };
            let mut executor = Executor::new(&device, &plan, &mut library(SHADERS), &options).expect("an executor");
            frame(&mut executor);
            let [calls, owners] = counted(|| (0..4).for_each(|_| frame(&mut executor)));
            assert_eq!(owners, 0);
            (calls, texels(&mut executor, "shown", 0), words(&mut executor, "last"))
        });
        assert_eq!(calls[0].1, [3 + 30 * 1000]);
        assert_eq!((&calls[1].1[..], &calls[1].2[..]), (&[4 + 4 * 1000][..], &[4][..]));
        assert!(calls[0].0 > 0 && calls[0].0 == calls[1].0, "{} and {} calls", calls[0].0, calls[1].0);
        eprintln!("{} calls in four frames, with constants and with values of the frame", calls[0].0);
        drop(device);
        // SAFETY: nothing made from the device is left.
        unsafe { raw.destroy_device(None) };
    });
}

/// A parameter becomes one that each frame has its own of, and a constant again, in one executor.
#[test]
fn do_9_a_parameter_becomes_one_of_the_frame_in_the_same_executor() {
    let plans = |device: &Device| {
        let constant = [ParamValue::Integer(3), ParamValue::Number(0.5)];
        let of_frame = [FrameValue::Frame, FrameValue::Time].map(ParamValue::OfFrame);
        [constant, of_frame].map(|params| planned(device, &clocks(params), &Options::default()))
    };
    on_each_driver(|device| {
        let [constant, of_frame] = plans(device);
        let options = ExecutorOptions { frames_in_flight: 3, readback: true, ..ExecutorOptions::default() };
        let mut executor = Executor::new(device, &constant, &mut library(SHADERS), &options).expect("an executor");
        let mut drawn = 0;
        for (plan, expected) in [(&constant, None), (&of_frame, Some(())), (&constant, None), (&of_frame, Some(()))] {
            executor.change(plan).expect("values alone");
            for _ in 0..5 {
                executor.submit(&mut crate::testing::Nothing).expect("a frame");
            }
            for number in drawn + 2..drawn + 5 {
                let shown = executor.read_back_image(number.into(), 0).expect("texels").bytes;
                let expected = expected.map_or(3 + 30 * 1000, |()| number + 1000 * number);
                assert_eq!(crate::frames::to_words(&shown), [expected], "frame {number}");
            }
            drawn += 5;
        }
    });
}
