//! Images that two devices share (DO-11): memory of one that the other imports, and owners that change with each frame.

use crate::adopted::{adopted_with, made_with};
use crate::counted_barriers::{counted, counted_layers, counting, counting_device};
use crate::foreign::{destroy_buffer, destroy_image, own_buffer, own_image, own_image_with_layers};
use crate::frames::{
    Small, Uses, copy, dispatch, draw, frame, library, on_each_driver, planned, texels, to_bytes, words,
};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Cadence, Draw, EyeForm, Frame, Groups, Image, Lifetime, Pass, Resource, Stereo};
use framewright_graph::plan::{Plan, Queue};
use framewright_graph::vulkan::{Accesses, Aspects, Format, Layout, Stages, State, Subresources};
use framewright_vulkan::ash::{self, khr, vk};
use framewright_vulkan::{Device, DeviceFeatures, Executor, ExecutorOptions, OutsideOwner};
use std::ffi::CStr;

const WHOLE: Subresources = Subresources::WHOLE;
const OPAQUE: vk::ExternalMemoryHandleTypeFlags = vk::ExternalMemoryHandleTypeFlags::OPAQUE_FD;
const SHARED: State = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::General };

const SHADERS: &[(&str, &str)] = &[
    (
        "double.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(location = 0) out uint color;
        void main() { color = 2 * texelFetch(source, ivec2(gl_FragCoord.xy), 0).r; }",
    ),
    (
        "increase.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) buffer Words { uint word[]; };
        void main() { for (int i = 0; i < 3; ++i) word[i] += 1; }",
    ),
];

fn shared(before: State, after: Option<State>) -> Image {
    shared_with(before, after, None)
}

fn shared_with(before: State, after: Option<State>, owner: Option<OutsideOwner>) -> Image {
    Image { lifetime: Lifetime::Imported { before, after, owner }, ..Image::new("shared", Format::R32_UINT, 2, 2) }
}

/// Draws numbers into the image that is shared, and leaves it for the other device.
fn gives() -> Frame {
    let mut small = Small::default();
    let shared = small.image_like(shared(State { layout: Layout::Undefined, ..SHARED }, Some(SHARED)));
    small.pass(draw("number", Draw::FullScreen).draws(shared, WHOLE, None));
    small.frame
}

/// Samples the image that the other device drew into.
fn takes() -> Frame {
    takes_from(None)
}

/// The same of an image that somebody has between frames, as the pipeline says.
fn takes_from(owner: Option<OutsideOwner>) -> Frame {
    let mut small = Small::default();
    let shared = small.image_like(shared_with(SHARED, Some(SHARED), owner));
    let doubled = small.image("doubled", Format::R32_UINT, [2, 2]);
    small.pass(draw("double", Draw::FullScreen).samples("source", shared, WHOLE).draws(doubled, WHOLE, None));
    small.image_output(doubled);
    small.frame
}

fn executor(device: &Device, frame: &Frame) -> Executor {
    let plan = planned(device, frame, &Options::default());
    Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default()).expect("an executor")
}

/// A device with external memory.
fn sharing(like: &Device) -> (ash::Device, Device) {
    let (instance, physical) = like.raw_physical();
    // SAFETY: the physical device belongs to the instance.
    let mut features = unsafe { DeviceFeatures::of(instance, physical) }.expect("it is enough");
    let mut extensions: Vec<&CStr> = features.extensions().to_vec();
    extensions.push(khr::external_memory_fd::NAME);
    let mut chain = features.chain();
    let raw = made_with(like, &mut chain, &extensions);
    let device = adopted_with(like, &raw, &chain, &extensions, &[0], None).expect("it is enough");
    (raw, device)
}

/// How the Plan's image is created, for memory that another device has.
fn image(executor: &Executor, raw: &ash::Device) -> vk::Image {
    let mut external = vk::ExternalMemoryImageCreateInfo::default().handle_types(OPAQUE);
    let info = executor.image_info("shared").expect("there is such an image");
    let info = info.usage(info.usage | vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::COLOR_ATTACHMENT);
    // SAFETY: the device lives.
    unsafe { raw.create_image(&info.push_next(&mut external), None) }.expect("an image")
}

#[test]
fn do_11_two_devices_share_an_image_that_changes_its_owner() {
    on_each_driver(|like| {
        let (instance, physical) = like.raw_physical();
        // SAFETY: the physical device belongs to the instance.
        let known = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
        if !known.iter().any(|it| it.extension_name_as_c_str() == Ok(khr::external_memory_fd::NAME)) {
            return eprintln!("SKIPPED: {} shares no memory", like.summary().name);
        }
        let ((first_raw, first), (second_raw, second)) = (sharing(like), sharing(like));
        let (mut gives, mut takes) = (executor(&first, &gives()), executor(&second, &takes()));
        let images = [image(&gives, &first_raw), image(&takes, &second_raw)];
        // SAFETY: both images are made alike, on the same physical device; the memory of the first is imported for the second, which
        // has the same needs.
        let memories = unsafe {
            let needs = first_raw.get_image_memory_requirements(images[0]);
            let kind = needs.memory_type_bits.trailing_zeros();
            let mut exported = vk::ExportMemoryAllocateInfo::default().handle_types(OPAQUE);
            let mut dedicated = vk::MemoryDedicatedAllocateInfo::default().image(images[0]);
            let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind);
            let memory = first_raw.allocate_memory(&info.push_next(&mut exported).push_next(&mut dedicated), None);
            let memory = memory.expect("memory");
            first_raw.bind_image_memory(images[0], memory, 0).expect("it fits");
            let functions = khr::external_memory_fd::Device::new(instance, &first_raw);
            let handle = vk::MemoryGetFdInfoKHR::default().memory(memory).handle_type(OPAQUE);
            let fd = functions.get_memory_fd(&handle).expect("a handle");
            let mut imported = vk::ImportMemoryFdInfoKHR::default().handle_type(OPAQUE).fd(fd);
            let mut dedicated = vk::MemoryDedicatedAllocateInfo::default().image(images[1]);
            let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind);
            let there = second_raw.allocate_memory(&info.push_next(&mut imported).push_next(&mut dedicated), None);
            let there = there.expect("the handle is one of this driver");
            second_raw.bind_image_memory(images[1], there, 0).expect("it fits");
            [memory, there]
        };
        // SAFETY: the images are as the Plans say and outlive the executors. Each frame is waited for before the other device goes on.
        unsafe {
            gives.import_image("shared", images[0]).expect("it is external");
            takes.import_image("shared", images[1]).expect("it is external");
        }
        gives.set_owner("shared", Some(OutsideOwner::External)).expect("it is external");
        takes.set_owner("shared", Some(OutsideOwner::External)).expect("it is external");
        for _ in 0..3 {
            frame(&mut gives);
            frame(&mut takes);
            assert_eq!(texels(&mut takes, "doubled", 0), [0, 2, 20, 22]);
        }
        let read =
            takes.read_image("shared", framewright_graph::vulkan::Aspects::COLOR, 0).expect_err("it was given back");
        assert!(read.to_string().contains("given back to its outside owner"), "{read}");
        drop((gives, takes, first, second));
        // SAFETY: nothing made from the devices is left but these.
        unsafe {
            for (raw, (image, memory)) in [&first_raw, &second_raw].into_iter().zip(images.into_iter().zip(memories)) {
                raw.destroy_image(image, None);
                raw.free_memory(memory, None);
                raw.destroy_device(None);
            }
        }
    });
}

#[test]
fn do_11_only_what_is_external_has_an_outside_owner_and_foreign_ones_need_the_extension() {
    on_each_driver(|device| {
        let mut executor = executor(device, &takes());
        let unknown = executor.set_owner("doubt", Some(OutsideOwner::External)).expect_err("there is none");
        assert_eq!(unknown.to_string(), "the Plan has no external image or buffer `doubt`");
        let (instance, physical) = device.raw_physical();
        // SAFETY: the physical device belongs to the instance.
        let known = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
        let has = known.iter().any(|it| it.extension_name_as_c_str() == Ok(ash::ext::queue_family_foreign::NAME));
        match executor.set_owner("shared", Some(OutsideOwner::Foreign)) {
            Ok(()) => assert!(has),
            Err(error) => {
                assert!(!has && error.to_string().contains(" lacks VK_EXT_queue_family_foreign"), "{error}");
                return;
            }
        }
        let own = own_image(device);
        // SAFETY: it is made as the Plan says and outlives the executor; what is in it doesn't matter.
        unsafe { executor.import_image("shared", own.0).expect("it is external") };
        executor.set_owner("shared", None).expect("it is external");
        drop(executor);
        // SAFETY: the executor was dropped.
        unsafe { destroy_image(device, own) };
    });
}

/// The owners that the device takes something from.
fn owners(executor: &mut Executor) -> Vec<OutsideOwner> {
    let all = [OutsideOwner::External, OutsideOwner::Foreign];
    all.into_iter().filter(|owner| executor.set_owner("shared", Some(*owner)).is_ok()).collect()
}

/// What is said where somebody else has the image.
fn is_outside(executor: &mut Executor) {
    let read = executor.read_image("shared", Aspects::COLOR, 0).expect_err("it is outside").to_string();
    assert!(read.contains("given back to its outside owner"), "{read}");
    let given = to_bytes(&[1, 2, 3, 4]);
    let written = executor.write_image("shared", Aspects::COLOR, 0, &given).expect_err("it is outside").to_string();
    assert!(written.contains("its outside owner has it"), "{written}");
}

#[test]
fn do_11_an_owner_changes_and_outlasts_the_executor() {
    on_each_driver(|device| {
        let own = own_image(device);
        for owner in owners(&mut executor(device, &takes())) {
            let [mut gives, mut takes, mut next] = [gives(), takes(), takes()].map(|frame| executor(device, &frame));
            let picture = |executor: &mut Executor| assert_eq!(texels(executor, "doubled", 0), [0, 2, 20, 22]);
            // SAFETY: it is made as the Plans say and outlives the executors. On one device nobody takes it while it is given away.
            unsafe {
                gives.import_image("shared", own.0).expect("it is external");
                takes.import_image("shared", own.0).expect("it is external");
            }
            frame(&mut gives);
            takes.set_owner("shared", Some(owner)).expect("it is external");
            for _ in 0..2 {
                frame(&mut takes);
                picture(&mut takes);
                is_outside(&mut takes);
            }
            // It was given away, and the next frame keeps it.
            takes.set_owner("shared", None).expect("it is external");
            is_outside(&mut takes);
            frame(&mut takes);
            picture(&mut takes);
            assert_eq!(texels(&mut takes, "shared", 0), [0, 1, 10, 11]);
            // The device has it until the next frame gives it away.
            takes.set_owner("shared", Some(owner)).expect("it is external");
            assert_eq!(texels(&mut takes, "shared", 0), [0, 1, 10, 11]);
            frame(&mut takes);
            is_outside(&mut takes);
            let mut between = executor(device, &increased());
            between.migrate_from(takes).expect("they are of one device");
            next.migrate_from(between).expect("they are of one device");
            // SAFETY: as above.
            unsafe { next.import_image("shared", own.0) }.expect("it is external");
            is_outside(&mut next);
            frame(&mut next);
            picture(&mut next);
            is_outside(&mut next);
        }
        // SAFETY: the executors were dropped.
        unsafe { destroy_image(device, own) };
    });
}

/// Increases each word of a buffer that is shared.
fn increased() -> Frame {
    let mut small = Small::default();
    let accesses = Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE;
    let changed = State { stages: Stages::COMPUTE_SHADER, accesses, layout: Layout::Undefined };
    let own = small.buffer_with("words", 3, Lifetime::Imported { before: changed, after: Some(changed), owner: None });
    small.pass(dispatch("increase", Groups::Count([1, 1, 1])).block("Words", own, (true, true)));
    small.frame
}

#[test]
fn do_11_a_buffer_has_an_outside_owner() {
    on_each_driver(|device| {
        let own = own_buffer(device);
        let mut executor = executor(device, &increased());
        // SAFETY: it is made as the Plan says and outlives the executor; nothing else touches it.
        unsafe { executor.import_buffer("words", own.0) }.expect("it is external");
        executor.write_buffer("words", &to_bytes(&[1, 10, 100])).expect("no owner was told");
        executor.set_owner("words", Some(OutsideOwner::External)).expect("it is external");
        frame(&mut executor);
        frame(&mut executor);
        executor.set_owner("words", None).expect("it is external");
        let read = executor.read_buffer("words").expect_err("it was given back").to_string();
        assert!(read.contains("given back to its outside owner"), "{read}");
        let written = executor.write_buffer("words", &[0; 12]).expect_err("it was given back").to_string();
        assert!(written.contains("its outside owner has it"), "{written}");
        frame(&mut executor);
        assert_eq!(words(&mut executor, "words"), [4, 13, 103]);
        drop(executor);
        // SAFETY: the executor was dropped.
        unsafe { destroy_buffer(device, own) };
    });
}

/// The transfers that a Plan makes in each frame.
fn transfers(plan: &Plan) -> u64 {
    plan.steps.iter().map(|step| step.outside.len() as u64).sum()
}

#[test]
fn do_11_each_frame_records_the_transfers_of_its_plan_and_no_others() {
    let _alone = counting();
    on_each_driver(|like| {
        let (raw, device) = counting_device(like);
        let own = own_image(&device);
        let [mut gives, mut takes, mut alone] =
            [gives(), takes_from(Some(OutsideOwner::External)), takes_from(Some(OutsideOwner::External))]
                .map(|frame| executor(&device, &frame));
        // SAFETY: it is made as the Plans say and outlives the executors. On one device nobody takes it while it is given away.
        unsafe {
            gives.import_image("shared", own.0).expect("it is external");
            takes.import_image("shared", own.0).expect("it is external");
        }
        let owners = |executor: &mut Executor| counted(|| frame(executor))[1];
        assert_eq!([transfers(gives.plan()), transfers(takes.plan())], [0, 2]);
        assert_eq!(owners(&mut gives), 0);
        assert_eq!([(); 3].map(|()| owners(&mut takes)), [2; 3], "as the pipeline says");
        assert_eq!(texels(&mut takes, "doubled", 0), [0, 2, 20, 22]);
        // The program's word takes the place of the pipeline's. The first frame takes what was given away, the second keeps it.
        takes.set_owner("shared", None).expect("it is external");
        assert_eq!(transfers(takes.plan()), 0);
        assert_eq!([(); 3].map(|()| owners(&mut takes)), [1, 0, 0]);
        takes.set_owner("shared", Some(OutsideOwner::External)).expect("it is external");
        assert_eq!(transfers(takes.plan()), 2);
        assert_eq!([(); 3].map(|()| owners(&mut takes)), [1, 2, 2]);
        assert_eq!(texels(&mut takes, "doubled", 0), [0, 2, 20, 22]);
        // What the executor made itself nobody else has.
        assert_eq!(owners(&mut alone), 0);
        drop((gives, takes, alone));
        // SAFETY: the executors were dropped, and nothing made from the device is left.
        unsafe {
            destroy_image(&device, own);
            drop(device);
            raw.destroy_device(None);
        }
    });
}

/// Values alone change, and the owner that the program told stays; another owner in the Plan is more than a value.
#[test]
fn do_11_an_owner_that_was_told_outlasts_a_change_of_values() {
    on_each_driver(|device| {
        let plan = planned(device, &takes(), &Options::default());
        let owned = planned(device, &takes_from(Some(OutsideOwner::External)), &Options::default());
        let mut executor =
            Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default()).expect("an executor");
        assert!(executor.differs_beyond_values(&owned).is_some() && executor.change(&owned).is_err());
        executor.set_owner("shared", Some(OutsideOwner::External)).expect("it is external");
        assert_eq!(executor.plan(), &owned);
        assert_eq!(executor.differs_beyond_values(&plan), None);
        executor.change(&plan).expect("values alone");
        assert_eq!(executor.plan(), &owned);
        executor.change(&owned).expect("values alone");
        executor.set_owner("shared", None).expect("it is external");
        assert_eq!(executor.plan(), &plan);
    });
}

/// What several queues use can't have the owner that was told, which is known before an executor ends for the next one.
#[test]
fn do_11_a_plan_that_can_not_have_a_told_owner_is_known_before() {
    on_each_driver(|device| {
        let mut small = Small { frame: increased() };
        let again = small.frame.passes[0].clone();
        small.pass(Pass { name: "again".into(), ..again });
        let plan = planned(device, &small.frame, &Options::default());
        let mut several = plan.clone();
        several.steps[1].queue = Queue::Compute;
        let mut executor = executor(device, &increased());
        executor.check_owners(&several).expect("no owner was told");
        executor.set_owner("words", Some(OutsideOwner::External)).expect("it is external");
        executor.check_owners(&plan).expect("one queue uses it");
        let said = executor.check_owners(&several).expect_err("two queues use it").to_string();
        assert!(said.contains("several queues use `words`"), "{said}");
        frame(&mut executor);
    });
}

/// A Plan with a foreign owner is refused by a device without the extension.
#[test]
fn do_11_a_device_refuses_owners_that_it_can_take_nothing_from() {
    on_each_driver(|device| {
        let plan = planned(device, &takes_from(Some(OutsideOwner::Foreign)), &Options::default());
        let mut executor = executor(device, &takes());
        let told = executor.set_owner("shared", Some(OutsideOwner::Foreign));
        let made = Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default());
        match (told, made) {
            (Ok(()), Ok(made)) => assert_eq!(made.plan(), executor.plan()),
            (Err(told), Err(made)) => {
                assert!(made.to_string().contains("can't have a foreign owner"), "{made}");
                assert!(told.to_string().contains("lacks VK_EXT_queue_family_foreign"), "{told}");
            }
            (told, made) => panic!("{told:?}, {:?}", made.err()),
        }
    });
}

/// A step that is left out takes and gives all the same: the owner has the image between all frames (DO-9).
#[test]
fn do_11_frames_that_leave_its_user_out_take_it_and_give_it_back() {
    let _alone = counting();
    // It stays in one layout, so that no other step has to do with it.
    let copied = State { stages: Stages::COPY, accesses: Accesses::TRANSFER_READ, layout: Layout::TransferSrcOptimal };
    let mut given = gives();
    given.images[0] = shared(State { layout: Layout::Undefined, ..SHARED }, Some(copied));
    let mut small = Small::default();
    let shared = small.image_like(shared_with(copied, Some(copied), Some(OutsideOwner::External)));
    let [kept, shown] = ["kept", "shown"].map(|name| small.image(name, Format::R32_UINT, [2, 2]));
    let [from, to] = [shared, kept].map(Resource::Image);
    small.pass(Pass { run: Cadence::Once, ..copy("once", (from, WHOLE), (to, WHOLE)) });
    small.pass(draw("double", Draw::FullScreen).samples("source", kept, WHOLE).draws(shown, WHOLE, None));
    small.image_output(shown);
    on_each_driver(|like| {
        let (raw, device) = counting_device(like);
        let own = own_image(&device);
        let [mut gives, mut takes] = [&given, &small.frame].map(|frame| executor(&device, frame));
        // SAFETY: it is made as the Plans say and outlives the executors. On one device nobody takes it while it is given away.
        unsafe {
            gives.import_image("shared", own.0).expect("it is external");
            takes.import_image("shared", own.0).expect("it is external");
        }
        let owners = |executor: &mut Executor| counted(|| frame(executor))[1];
        frame(&mut gives);
        assert_eq!([(); 3].map(|()| owners(&mut takes)), [2; 3], "as the pipeline says");
        assert_eq!(texels(&mut takes, "shown", 0), [0, 2, 20, 22]);
        is_outside(&mut takes);
        takes.set_owner("shared", None).expect("it is external");
        assert_eq!([(); 3].map(|()| owners(&mut takes)), [1, 0, 0], "it is taken from whom it was given to");
        takes.set_owner("shared", Some(OutsideOwner::External)).expect("it is external");
        assert_eq!([(); 3].map(|()| owners(&mut takes)), [1, 2, 2]);
        assert_eq!(texels(&mut takes, "shown", 0), [0, 2, 20, 22]);
        drop((gives, takes));
        // SAFETY: the executors were dropped, and nothing made from the device is left.
        unsafe {
            destroy_image(&device, own);
            drop(device);
            raw.destroy_device(None);
        }
    });
}

/// Both eyes' parts of an image change hands together, in two layers or side by side (ST-2).
#[test]
fn do_11_an_image_of_both_eyes_changes_hands_whole() {
    let _alone = counting();
    on_each_driver(|like| {
        let (raw, device) = counting_device(like);
        let ways = [(Stereo::DoubleWide, EyeForm::Halves, [4, 2], 1), (Stereo::Multiview, EyeForm::Layers, [2, 2], 2)];
        for (stereo, form, size, layers) in ways {
            if stereo.lacks(&device.profile()).is_some() {
                continue;
            }
            let own = own_image_with_layers(&device, Format::R32_UINT, size, layers);
            let [mut gives, mut takes] = [gives(), takes_from(Some(OutsideOwner::External))].map(|mut frame| {
                frame.stereo = stereo;
                frame.images.iter_mut().for_each(|image| image.eyes = Some(form));
                executor(&device, &frame)
            });
            // SAFETY: it is made as the Plans say and outlives the executors. On one device nobody takes it while it is given away.
            unsafe {
                gives.import_image("shared", own.0).expect("it is external");
                takes.import_image("shared", own.0).expect("it is external");
            }
            frame(&mut gives);
            for _ in 0..2 {
                let owners = counted(|| frame(&mut takes))[1];
                assert_eq!((owners, counted_layers()), (2, 2 * u64::from(layers)), "{stereo:?}");
            }
            let doubled = texels(&mut takes, "doubled", 0);
            let [width, height] = size;
            let one = (0..width * height).map(|at| 2 * (at % width + 10 * (at / width)));
            let both: Vec<u32> = (0..layers).flat_map(|_| one.clone()).collect();
            assert_eq!(doubled, both, "{stereo:?}");
            is_outside(&mut takes);
            drop((gives, takes));
            // SAFETY: the executors were dropped.
            unsafe { destroy_image(&device, own) };
        }
        drop(device);
        // SAFETY: nothing made from the device is left.
        unsafe { raw.destroy_device(None) };
    });
}
