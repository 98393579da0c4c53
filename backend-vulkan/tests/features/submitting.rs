//! Frames among the program's own work: semaphores that they wait for and signal, images that are chosen for each, and command
//! buffers that the program submits.

use crate::foreign::{destroy_image, own_image};
use crate::frames::{Small, Uses, dispatch, draw, frame, library, on_each_driver, planned, texels, words};
use crate::queues::{drawn_beside, executor_beside};
use crate::testing::Nothing;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame, Groups, Image, Lifetime};
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::{Accesses, FillValue, Format, Layout, Stages, State, Subresources};
use framewright_vulkan::ash::vk;
use framewright_vulkan::{Device, Error, Executor, ExecutorOptions, SemaphorePoint, Submission};
use std::time::Duration;

const WHOLE: Subresources = Subresources::WHOLE;
const ONE: Groups = Groups::Count([1, 1, 1]);

const SHADERS: &[(&str, &str)] = &[
    (
        "count.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) buffer Words { uint word[]; };
        void main() { word[0] += 1; }",
    ),
    (
        "counted.frag",
        "#version 460
        layout(set = 0, binding = 0) readonly buffer Words { uint word[]; };
        layout(location = 0) out uint color;
        void main() { color = 100 * word[0] + uint(gl_FragCoord.x) + 10 * uint(gl_FragCoord.y); }",
    ),
    (
        "same.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(location = 0) out uint color;
        void main() { color = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r; }",
    ),
];

const PERSISTENT: Lifetime = Lifetime::Persistent { initial: FillValue::Bits([0; 4]) };
const UNKNOWN: State = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::Undefined };
const SAMPLED: State = State {
    stages: Stages::FRAGMENT_SHADER,
    accesses: Accesses::SHADER_SAMPLED_READ,
    layout: Layout::ShaderReadOnlyOptimal,
};

fn imported(before: State) -> Image {
    Image {
        lifetime: Lifetime::Imported { before, after: Some(SAMPLED), owner: None },
        ..Image::new("window", Format::R32_UINT, 2, 2)
    }
}

/// Counts its frames in a buffer that persists, and draws the count into the imported image `window`.
fn counting() -> Frame {
    let mut small = Small::default();
    let count = small.buffer_with("count", 1, PERSISTENT);
    let window = small.image_like(imported(UNKNOWN));
    small.pass(dispatch("count", ONE).block("Words", count, (true, true)));
    let pass = draw("counted", Draw::FullScreen).block("Words", count, (true, false));
    small.pass(pass.draws(window, WHOLE, None));
    small.image_output(window);
    small.frame
}

/// Copies the imported image `window`.
fn looking() -> Frame {
    let mut small = Small::default();
    let window = small.image_like(imported(SAMPLED));
    let seen = small.image("seen", Format::R32_UINT, [2, 2]);
    small.pass(draw("same", Draw::FullScreen).samples("source", window, WHOLE).draws(seen, WHOLE, None));
    small.image_output(seen);
    small.frame
}

fn executor(device: &Device, plan: &Plan, frames_in_flight: u32) -> Executor {
    let options = ExecutorOptions { frames_in_flight, timeout: Duration::from_secs(20), ..ExecutorOptions::default() };
    Executor::new(device, plan, &mut library(SHADERS), &options).expect("an executor")
}

/// The texels of an image of the program's, which a Plan of its own copies.
fn seen(device: &Device, image: vk::Image) -> Vec<u32> {
    let mut executor = executor(device, &planned(device, &looking(), &Options::default()), 1);
    // SAFETY: the image is made as the Plan says, outlives the executor, and was left as the Plan finds it.
    unsafe { executor.import_image("window", image) }.expect("it is external");
    frame(&mut executor);
    texels(&mut executor, "seen", 0)
}

/// The texels that frame number `frame` draws.
fn drawn(frame: u32) -> Vec<u32> {
    [0, 1, 10, 11].map(|at| 100 * (frame + 1) + at).into()
}

/// A semaphore of the program's.
pub(crate) struct Semaphore<'d> {
    device: &'d Device,
    raw: vk::Semaphore,
}

impl Semaphore<'_> {
    fn new(device: &Device, ty: vk::SemaphoreType) -> Semaphore<'_> {
        let mut ty = vk::SemaphoreTypeCreateInfo::default().semaphore_type(ty);
        let info = vk::SemaphoreCreateInfo::default().push_next(&mut ty);
        // SAFETY: the device lives.
        Semaphore { device, raw: unsafe { device.raw().create_semaphore(&info, None) }.expect("a semaphore") }
    }

    pub(crate) fn timeline(device: &Device) -> Semaphore<'_> {
        Semaphore::new(device, vk::SemaphoreType::TIMELINE)
    }

    pub(crate) fn at(&self, value: u64) -> SemaphorePoint {
        SemaphorePoint::timeline(self.raw, value)
    }

    pub(crate) fn signal(&self, value: u64) {
        let info = vk::SemaphoreSignalInfo::default().semaphore(self.raw).value(value);
        // SAFETY: the value is larger than any before.
        unsafe { self.device.raw().signal_semaphore(&info) }.expect("signalled");
    }

    fn value(&self) -> u64 {
        // SAFETY: the semaphore is a timeline that lives.
        unsafe { self.device.raw().get_semaphore_counter_value(self.raw) }.expect("its value")
    }

    fn wait(&self, value: u64) {
        let (semaphores, values) = ([self.raw], [value]);
        let info = vk::SemaphoreWaitInfo::default().semaphores(&semaphores).values(&values);
        // SAFETY: the semaphore lives.
        unsafe { self.device.raw().wait_semaphores(&info, 20_000_000_000) }.expect("in time");
    }
}

impl Drop for Semaphore<'_> {
    fn drop(&mut self) {
        // Lavapipe of Mesa 22.3 touches a timeline for a moment after it told of the value that was waited for.
        // SAFETY: each test waits for the frames that use it.
        unsafe {
            self.device.raw().device_wait_idle().expect("the device works");
            self.device.raw().destroy_semaphore(self.raw, None);
        }
    }
}

/// Runs three frames that wait for one semaphore and signal another, and holds each back for a while.
fn wait_and_signal(device: &Device, executor: &mut Executor) {
    let [begin, end] = [Semaphore::timeline(device), Semaphore::timeline(device)];
    for frame in 1..=3 {
        let (waits, signals) = ([begin.at(frame)], [end.at(frame)]);
        let among = Submission { waits: &waits, signals: &signals, ..Submission::default() };
        // SAFETY: the timelines live until all is waited for, and their values rise.
        unsafe { executor.submit_with(&mut Nothing, &among) }.expect("a frame");
        std::thread::sleep(Duration::from_millis(20));
        assert_eq!(end.value(), frame - 1, "frame {frame} began before it might");
        begin.signal(frame);
        end.wait(frame);
    }
    // Also what the executor waits for beside the semaphores.
    executor.wait(2).expect("it has ended");
}

#[test]
fn a_frame_waits_for_semaphores_of_the_program_s_and_signals_others() {
    on_each_driver(|device| {
        let plan = planned(device, &counting(), &Options::default());
        for frames_in_flight in [1, 2] {
            let mut executor = executor(device, &plan, frames_in_flight);
            wait_and_signal(device, &mut executor);
            assert_eq!(words(&mut executor, "count"), [3]);
        }
    });
}

#[test]
fn all_queues_of_a_frame_wait_for_semaphores_of_the_program_s_and_end_before_others_are_signalled() {
    on_each_driver(|device| {
        for frames_in_flight in [1, 2] {
            let mut executor = executor_beside(device, frames_in_flight);
            wait_and_signal(device, &mut executor);
            assert_eq!(texels(&mut executor, "shown", 0), drawn_beside());
        }
    });
}

#[test]
fn a_binary_semaphore_orders_the_frames_of_two_executors() {
    on_each_driver(|device| {
        let between = Semaphore::new(device, vk::SemaphoreType::BINARY);
        let [drawing, looking] = [counting(), looking()].map(|frame| planned(device, &frame, &Options::default()));
        let [mut drawing, mut looking] = [drawing, looking].map(|plan| executor(device, &plan, 2));
        let own = own_image(device);
        let point = [SemaphorePoint::binary(between.raw)];
        // SAFETY: the image is made as the Plans say and outlives the executors. The semaphore is signalled before it is waited for,
        // and the second executor's frame is waited for before the first one's next.
        unsafe {
            drawing.import_image("window", own.0).expect("it is external");
            looking.import_image("window", own.0).expect("it is external");
            for frame in 0..3 {
                let signals = Submission { signals: &point, ..Submission::default() };
                drawing.submit_with(&mut Nothing, &signals).expect("a frame");
                let waits = Submission { waits: &point, ..Submission::default() };
                let seen = looking.submit_with(&mut Nothing, &waits).expect("a frame");
                looking.wait(seen).expect("it ends");
                assert_eq!(texels(&mut looking, "seen", 0), drawn(frame));
            }
        }
        drop((drawing, looking));
        // SAFETY: the executors were dropped.
        unsafe { destroy_image(device, own) };
    });
}

#[test]
fn each_frame_draws_into_the_image_that_is_chosen_for_it() {
    on_each_driver(|device| {
        let plan = planned(device, &counting(), &Options::default());
        for frames_in_flight in [1, 3] {
            let mut executor = executor(device, &plan, frames_in_flight);
            let mut own: Vec<_> = (0..3).map(|_| own_image(device)).collect();
            let raw: Vec<_> = own.iter().map(|(image, _)| *image).collect();
            let choices = [2, 0, 1, 1, 2, 0, 2];
            // SAFETY: the images are made as the Plan says and outlive the executor; nothing else touches them meanwhile.
            unsafe {
                executor.import_images("window", &raw).expect("it is external");
                for choice in choices {
                    let images = [("window", choice)];
                    let among = Submission { images: &images, ..Submission::default() };
                    executor.submit_with(&mut Nothing, &among).expect("a frame");
                    assert_eq!(executor.raw_image("window"), Some(raw[choice]));
                }
            }
            executor.wait(6).expect("the last one");
            assert_eq!(texels(&mut executor, "window", 0), drawn(6));
            for (image, last) in raw.iter().zip([5, 3, 6]) {
                assert_eq!(seen(device, *image), drawn(last), "{frames_in_flight} in flight");
            }
            // Fewer in their place.
            // SAFETY: as above; the image that isn't handed in again is no longer used.
            unsafe {
                executor.import_images("window", &raw[..2]).expect("it is external");
                destroy_image(device, own.pop().expect("three"));
            }
            frame(&mut executor);
            assert_eq!(seen(device, raw[0]), drawn(7));
            drop(executor);
            for image in own {
                // SAFETY: the executor was dropped.
                unsafe { destroy_image(device, image) };
            }
        }
    });
}

#[test]
fn an_image_that_is_not_there_can_not_be_chosen_and_the_next_frame_is_right() {
    on_each_driver(|device| {
        let mut executor = executor(device, &planned(device, &counting(), &Options::default()), 2);
        for (name, choice) in [("window", 1), ("windows", 0), ("count", 0)] {
            let images = [(name, choice)];
            let among = Submission { images: &images, ..Submission::default() };
            // SAFETY: nothing is asked for but an image, which is refused.
            let refused = unsafe { executor.submit_with(&mut Nothing, &among) }.expect_err("there is none");
            assert_eq!(refused.to_string(), format!("`{name}` has no image {choice} of the program's"));
        }
        // SAFETY: no image is given.
        let refused = unsafe { executor.import_images("window", &[]) }.expect_err("none");
        assert_eq!(refused.to_string(), "no images were given for `window`");
        frame(&mut executor);
        assert_eq!(texels(&mut executor, "window", 0), drawn(0));
    });
}

/// A command pool of the graphics queue with some command buffers, and the queue.
struct Commands<'d> {
    device: &'d Device,
    pool: vk::CommandPool,
    buffers: Vec<vk::CommandBuffer>,
    queue: vk::Queue,
}

impl Commands<'_> {
    fn new(device: &Device, count: u32) -> Commands<'_> {
        let (raw, family) = (device.raw(), device.graphics_queue_family());
        let info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        // SAFETY: the device lives, and has a queue of the family.
        unsafe {
            let pool = raw.create_command_pool(&info, None).expect("a pool");
            let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(count);
            let buffers = raw.allocate_command_buffers(&info).expect("command buffers");
            Commands { device, pool, buffers, queue: raw.get_device_queue(family, 0) }
        }
    }

    /// Records a command buffer that isn't in use.
    ///
    /// # Safety
    /// As of what `record` does.
    unsafe fn record<T>(&self, buffer: usize, record: impl FnOnce(vk::CommandBuffer) -> T) -> T {
        let (raw, commands) = (self.device.raw(), self.buffers[buffer]);
        let info = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the caller's promise.
        unsafe {
            raw.begin_command_buffer(commands, &info).expect("begun");
            let recorded = record(commands);
            raw.end_command_buffer(commands).expect("ended");
            recorded
        }
    }

    /// # Safety
    /// The command buffer must have been recorded and not submitted.
    unsafe fn submit(&self, buffer: usize, done: SemaphorePoint) {
        // SAFETY: the caller's promise.
        unsafe { self.submit_behind(buffer, &[], done) };
    }

    /// # Safety
    /// That of [`Commands::submit`].
    unsafe fn submit_behind(&self, buffer: usize, waits: &[SemaphorePoint], done: SemaphorePoint) {
        let info = |it: &SemaphorePoint| {
            vk::SemaphoreSubmitInfo::default().semaphore(it.semaphore).value(it.value).stage_mask(it.stages)
        };
        let waits: Vec<_> = waits.iter().map(info).collect();
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(self.buffers[buffer])];
        let signals = [info(&done)];
        let submits = [vk::SubmitInfo2::default()
            .wait_semaphore_infos(&waits)
            .command_buffer_infos(&buffers)
            .signal_semaphore_infos(&signals)];
        // SAFETY: the caller's promise.
        unsafe { self.device.raw().queue_submit2(self.queue, &submits, vk::Fence::null()) }.expect("submitted");
    }
}

impl Drop for Commands<'_> {
    fn drop(&mut self) {
        // SAFETY: each test waits for the commands.
        unsafe { self.device.raw().destroy_command_pool(self.pool, None) };
    }
}

#[test]
fn frames_are_recorded_into_command_buffers_that_the_program_submits() {
    on_each_driver(|device| {
        let plan = planned(device, &counting(), &Options::default());
        for frames_in_flight in [1, 2] {
            let (commands, done) = (Commands::new(device, 2), Semaphore::timeline(device));
            let own: Vec<_> = (0..2).map(|_| own_image(device)).collect();
            let raw: Vec<_> = own.iter().map(|(image, _)| *image).collect();
            let mut executor = executor(device, &plan, frames_in_flight);
            // SAFETY: the images are made as the Plan says and outlive the executor. Each command buffer is submitted once, after the
            // one before it, and recorded again when it is done.
            unsafe {
                executor.import_images("window", &raw).expect("it is external");
                for number in 0..8 {
                    let buffer = number as usize % 2;
                    if number > 1 {
                        done.wait(number - 1);
                    }
                    let point = done.at(number + 1);
                    let frame = commands.record(buffer, |commands| {
                        executor.record_into(commands, point, &[("window", buffer)], &mut Nothing)
                    });
                    assert_eq!(frame.expect("a frame"), number);
                    commands.submit(buffer, point);
                }
            }
            executor.wait(7).expect("it ends");
            assert!(executor.report(7).is_ok());
            assert_eq!([seen(device, raw[0]), seen(device, raw[1])], [drawn(6), drawn(7)]);
            // One that is submitted here goes on from there.
            frame(&mut executor);
            assert_eq!(texels(&mut executor, "window", 0), drawn(8));
            drop(executor);
            for image in own {
                // SAFETY: the executor was dropped.
                unsafe { destroy_image(device, image) };
            }
        }
    });
}

#[test]
fn a_frame_that_the_program_submits_is_over_when_its_semaphore_says_so() {
    on_each_driver(|device| {
        let [gate, done] = [Semaphore::timeline(device), Semaphore::timeline(device)];
        let commands = Commands::new(device, 1);
        let mut executor = executor(device, &planned(device, &counting(), &Options::default()), 1);
        // SAFETY: the command buffer is submitted once.
        unsafe {
            let record = |commands| executor.record_into(commands, done.at(1), &[], &mut Nothing);
            commands.record(0, record).expect("a frame");
            commands.submit_behind(0, &[gate.at(1)], done.at(1));
        }
        std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(Duration::from_millis(50));
                gate.signal(1);
            });
            executor.wait(0).expect("it ends");
            assert_eq!(done.value(), 1);
        });
    });
}

#[test]
fn a_frame_that_was_recorded_and_never_submitted_is_taken_back() {
    on_each_driver(|device| {
        let (commands, done) = (Commands::new(device, 1), Semaphore::timeline(device));
        let mut executor = executor(device, &planned(device, &counting(), &Options::default()), 1);
        // SAFETY: the command buffer is never submitted.
        unsafe {
            let record = |commands| executor.record_into(commands, done.at(1), &[], &mut Nothing);
            let recorded = commands.record(0, record).expect("a frame");
            executor.discard(recorded);
        }
        frame(&mut executor);
        assert_eq!(words(&mut executor, "count"), [1]);
    });
}

#[test]
fn a_frame_of_several_queues_is_in_no_command_buffer_of_the_program_s() {
    on_each_driver(|device| {
        let mut executor = executor_beside(device, 1);
        let (commands, done) = (Commands::new(device, 1), Semaphore::timeline(device));
        // SAFETY: the command buffer isn't submitted.
        let refused =
            unsafe { commands.record(0, |commands| executor.record_into(commands, done.at(1), &[], &mut Nothing)) };
        assert!(matches!(refused, Err(Error::BadPlan { .. })), "{refused:?}");
        frame(&mut executor);
        assert_eq!(texels(&mut executor, "shown", 0), drawn_beside());
    });
}

#[test]
fn external_images_have_the_states_of_the_plan() {
    on_each_driver(|device| {
        let executor = executor(device, &planned(device, &counting(), &Options::default()), 1);
        let states = executor.external_states("window").expect("it is external");
        assert_eq!(states.before.layout, vk::ImageLayout::UNDEFINED);
        assert_eq!(states.after.layout, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
        assert_eq!(states.after.stages, vk::PipelineStageFlags2::FRAGMENT_SHADER);
        assert_eq!(states.after.accesses, vk::AccessFlags2::SHADER_SAMPLED_READ);
        assert_eq!(executor.external_states("count"), None);
    });
}

/// How often each of some frames allocated, which choose one of three images in turn, and wait for and signal semaphores.
fn allocations(device: &Device, executor: &mut Executor, images: bool) -> Vec<u64> {
    let [begin, end] = [Semaphore::timeline(device), Semaphore::timeline(device)];
    let mut frame = |number: u64| {
        let (waits, signals, images) =
            ([begin.at(number)], [end.at(number)], [("window", number as usize % 3)][..usize::from(images)].to_vec());
        let among = Submission { waits: &waits, signals: &signals, images: &images };
        begin.signal(number);
        // SAFETY: the timelines live until all is waited for, and their values rise. Nothing else touches the images.
        let counted = allocation_counter::measure(|| unsafe {
            executor.submit_with(&mut Nothing, &among).expect("a frame");
        });
        counted.count_total
    };
    let counted = (1..=12).map(&mut frame).collect();
    executor.wait(11).expect("the last one");
    counted
}

#[test]
fn a_frame_among_the_programs_work_allocates_nothing_whichever_image_it_draws_into() {
    on_each_driver(|device| {
        let mut executor = executor(device, &planned(device, &counting(), &Options::default()), 2);
        let own: Vec<_> = (0..3).map(|_| own_image(device)).collect();
        let raw: Vec<_> = own.iter().map(|(image, _)| *image).collect();
        // SAFETY: the images are made as the Plan says and outlive the executor.
        unsafe { executor.import_images("window", &raw) }.expect("it is external");
        // Each image and each place of a frame in flight was used.
        let counted = allocations(device, &mut executor, true);
        assert_eq!(counted[6..], [0; 6], "{counted:?}");
        drop(executor);
        for image in own {
            // SAFETY: the executor was dropped.
            unsafe { destroy_image(device, image) };
        }
        let counted = allocations(device, &mut executor_beside(device, 2), false);
        assert_eq!(counted[6..], [0; 6], "{counted:?}");
    });
}
