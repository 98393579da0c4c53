//! Frames in few words, and their execution on each driver.

use crate::testing::{Nothing, OVER_ALL, find_layer, findings, skip};
use framewright_graph::base::Span;
use framewright_graph::compile::{Options, compile};
use framewright_graph::frame::{
    Blend, Buffer, BufferIndex, BufferRole, BufferUse, ColorTarget, DepthTarget, Draw, Frame, Groups, Image,
    ImageIndex, Lifetime, Pass, Resource, SampledImage, Storage, TransferUse, Work,
};
use framewright_graph::plan::Plan;
use framewright_graph::shader::DrawInterface;
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Aspects, Format, Stages, Subresources};
use framewright_tests::drivers::Driver;
use framewright_vulkan::ash::vk;
use framewright_vulkan::raw_window_handle::RawDisplayHandle;
use framewright_vulkan::{
    Blame, CustomRecorder, Device, DeviceChoice, DeviceOptions, DrawSource, Error, Executor, ExecutorOptions, Recorder,
    ShaderLibrary,
};
use std::sync::OnceLock;

/// Shader files: name, GLSL text.
pub(crate) type Shaders = &'static [(&'static str, &'static str)];

/// A triangle over the whole target, and `x + 10 y` for each of its texels.
const COMMON: Shaders = &[
    ("full_screen.vert", OVER_ALL),
    (
        "number.frag",
        "#version 460
        layout(location = 0) out uint color;
        void main() { color = uint(gl_FragCoord.x) + 10 * uint(gl_FragCoord.y); }",
    ),
];

/// Lists SwiftShader beside the driver that the environment names, before anything in this process uses the loader.
fn find_drivers() {
    static FOUND: OnceLock<()> = OnceLock::new();
    FOUND.get_or_init(|| {
        find_layer();
        let Some(swiftshader) = Driver::SwiftShader.manifest() else { return };
        for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
            let Ok(files) = std::env::var(name) else { continue };
            if !files.is_empty() && !files.contains(swiftshader) {
                // SAFETY: every test of this binary comes through here before it touches the loader, which is the only
                // code that reads the environment without the standard library's lock.
                unsafe { std::env::set_var(name, format!("{files}:{swiftshader}")) };
            }
        }
        // SAFETY: as above. Where one of the variables above is set, the loader ignores this one.
        unsafe { std::env::set_var("VK_ADD_DRIVER_FILES", swiftshader) };
    });
}

/// The software drivers, or the one device that the environment asks for.
fn drivers() -> Vec<String> {
    match std::env::var("FRAMEWRIGHT_TEST_DEVICE") {
        Ok(name) => vec![name],
        Err(_) => Driver::SOFTWARE.map(|driver| driver.name().to_owned()).into(),
    }
}

/// Runs `test` on a validated device of each driver that is here, and fails on everything that the layer finds until the
/// device is closed.
pub(crate) fn on_each_driver(test: impl Fn(&Device)) {
    on_each_driver_with(|device| {
        let (name, messages) = (device.summary().name.clone(), device.messages());
        test(&device);
        drop(device);
        assert_eq!(findings(&messages), [], "{name}");
    });
}

/// The same for tests that look at the layer's findings themselves.
pub(crate) fn on_each_driver_with(test: impl Fn(Device)) {
    on_each_driver_for(None, test);
}

/// The same for tests that show pictures on a display.
pub(crate) fn on_each_driver_for(display: Option<RawDisplayHandle>, test: impl Fn(Device)) {
    find_drivers();
    for name in drivers() {
        let device = match Device::open(&DeviceOptions {
            choice: DeviceChoice::Name(name),
            validation: true,
            display,
            ..DeviceOptions::default()
        }) {
            Ok(device) => device,
            Err(error) if error.blame() == Blame::Environment => {
                skip(&error);
                continue;
            }
            Err(error) => panic!("{error}"),
        };
        device.canary().expect("the layer is awake");
        test(device);
    }
}

/// A frame that grows.
#[derive(Default)]
pub(crate) struct Small {
    pub(crate) frame: Frame,
}

impl Small {
    /// A transient flat image of one mip level, one layer and one sample.
    pub(crate) fn image(&mut self, name: &str, format: Format, [width, height]: [u32; 2]) -> ImageIndex {
        self.image_like(Image::new(name, format, width, height))
    }

    pub(crate) fn image_like(&mut self, image: Image) -> ImageIndex {
        self.frame.images.push(image);
        ImageIndex(index(&self.frame.images))
    }

    /// A transient buffer of `words` words.
    pub(crate) fn buffer(&mut self, name: &str, words: u64) -> BufferIndex {
        self.buffer_with(name, words, Lifetime::Transient)
    }

    pub(crate) fn buffer_with(&mut self, name: &str, words: u64, lifetime: Lifetime) -> BufferIndex {
        self.frame.buffers.push(Buffer { name: name.into(), span: Span::NONE, bytes: 4 * words, lifetime });
        BufferIndex(index(&self.frame.buffers))
    }

    pub(crate) fn pass(&mut self, pass: Pass) {
        self.frame.passes.push(pass);
    }

    pub(crate) fn output(&mut self, resource: Resource) {
        self.frame.outputs.push(resource.into());
    }

    pub(crate) fn image_output(&mut self, image: ImageIndex) {
        self.output(Resource::Image(image));
    }

    pub(crate) fn buffer_output(&mut self, buffer: BufferIndex) {
        self.output(Resource::Buffer(buffer));
    }
}

fn index<T>(list: &[T]) -> u32 {
    u32::try_from(list.len() - 1).expect("few")
}

/// One mip level, all layers and planes.
pub(crate) const fn mip(level: u32) -> Subresources {
    Subresources { base_mip: level, mips: 1, ..Subresources::WHOLE }
}

/// One layer, all mip levels and planes.
pub(crate) const fn layer(number: u32) -> Subresources {
    Subresources { base_layer: number, layers: 1, ..Subresources::WHOLE }
}

/// One plane, all mip levels and layers.
pub(crate) const fn plane(aspects: Aspects) -> Subresources {
    Subresources { aspects, ..Subresources::WHOLE }
}

/// A compute pass; its shader bears its name.
pub(crate) fn dispatch(name: &str, groups: Groups) -> Pass {
    Pass::new(name, Work::Dispatch { shader: name.into(), groups })
}

/// A pass that draws; its shader bears its name.
pub(crate) fn draw(name: &str, draw: Draw) -> Pass {
    Pass::new(name, Work::Draw { draw, shader: name.into(), discards: false, per_sample: false })
}

pub(crate) fn transfer(name: &str, work: Work, sides: &[(Resource, Subresources, bool)]) -> Pass {
    let side = |(resource, range, write): &(Resource, Subresources, bool)| TransferUse {
        resource: *resource,
        range: *range,
        frames_ago: 0,
        span: Span::NONE,
        write: *write,
        keeps: false,
    };
    Pass { transfers: sides.iter().map(side).collect(), ..Pass::new(name, work) }
}

pub(crate) fn copy(name: &str, from: (Resource, Subresources), to: (Resource, Subresources)) -> Pass {
    transfer(name, Work::Copy, &[(from.0, from.1, false), (to.0, to.1, true)])
}

/// Adds what a pass uses, by the shader's names.
pub(crate) trait Uses {
    fn samples(self, binding: &str, image: ImageIndex, range: Subresources) -> Pass;
    /// The image as it was `frames_ago` frames before.
    fn samples_earlier(self, binding: &str, image: ImageIndex, frames_ago: u32) -> Pass;
    fn stores(self, binding: &str, image: ImageIndex, range: Subresources) -> Pass;
    fn loads(self, binding: &str, image: ImageIndex, range: Subresources) -> Pass;
    /// Reads and writes the same texels.
    fn modifies(self, binding: &str, image: ImageIndex) -> Pass;
    /// A storage block: whether it is read, and written.
    fn block(self, binding: &str, buffer: BufferIndex, access: (bool, bool)) -> Pass;
    fn block_earlier(self, binding: &str, buffer: BufferIndex, frames_ago: u32) -> Pass;
    fn uniform(self, binding: &str, buffer: BufferIndex) -> Pass;
    /// A buffer that no shader names.
    fn takes(self, buffer: BufferIndex, role: BufferRole) -> Pass;
    fn draws(self, image: ImageIndex, range: Subresources, clear: Option<[f64; 4]>) -> Pass;
    fn tests(self, depth: DepthTarget) -> Pass;
}

fn stages(pass: &Pass) -> Stages {
    if matches!(pass.work, Work::Dispatch { .. }) { Stages::COMPUTE_SHADER } else { Stages::FRAGMENT_SHADER }
}

fn sampled(pass: &Pass, binding: &str, image: ImageIndex, range: Subresources) -> SampledImage {
    SampledImage { range, ..SampledImage::new(binding, image, stages(pass)) }
}

fn stored(mut pass: Pass, binding: &str, image: ImageIndex, range: Subresources, access: (bool, bool)) -> Pass {
    let (stages, (read, write)) = (stages(&pass), access);
    pass.storage.push(Storage {
        binding: binding.into(),
        image,
        range,
        span: Span::NONE,
        read,
        write,
        eye: None,
        stages,
    });
    pass
}

fn used(mut pass: Pass, binding: &str, buffer: BufferIndex, frames_ago: u32, role: BufferRole) -> Pass {
    let (binding, stages) = (Some(binding.into()), stages(&pass));
    pass.buffers.push(BufferUse { binding, buffer, frames_ago, span: Span::NONE, role, stages });
    pass
}

impl Uses for Pass {
    fn samples(mut self, binding: &str, image: ImageIndex, range: Subresources) -> Pass {
        self.sampled.push(sampled(&self, binding, image, range));
        self
    }

    fn samples_earlier(mut self, binding: &str, image: ImageIndex, frames_ago: u32) -> Pass {
        self.sampled.push(SampledImage { frames_ago, ..sampled(&self, binding, image, Subresources::WHOLE) });
        self
    }

    fn stores(self, binding: &str, image: ImageIndex, range: Subresources) -> Pass {
        stored(self, binding, image, range, (false, true))
    }

    fn loads(self, binding: &str, image: ImageIndex, range: Subresources) -> Pass {
        stored(self, binding, image, range, (true, false))
    }

    fn modifies(self, binding: &str, image: ImageIndex) -> Pass {
        stored(self, binding, image, Subresources::WHOLE, (true, true))
    }

    fn block(self, binding: &str, buffer: BufferIndex, (read, write): (bool, bool)) -> Pass {
        used(self, binding, buffer, 0, BufferRole::Storage { read, write })
    }

    fn block_earlier(self, binding: &str, buffer: BufferIndex, frames_ago: u32) -> Pass {
        used(self, binding, buffer, frames_ago, BufferRole::Storage { read: true, write: false })
    }

    fn uniform(self, binding: &str, buffer: BufferIndex) -> Pass {
        used(self, binding, buffer, 0, BufferRole::Uniform)
    }

    fn takes(mut self, buffer: BufferIndex, role: BufferRole) -> Pass {
        let stages = Stages::empty();
        self.buffers.push(BufferUse { binding: None, buffer, frames_ago: 0, span: Span::NONE, role, stages });
        self
    }

    fn draws(mut self, image: ImageIndex, range: Subresources, clear: Option<[f64; 4]>) -> Pass {
        self.color.push(ColorTarget {
            image,
            range,
            span: Span::NONE,
            clear,
            blend: Blend::Replace,
            write_mask: Default::default(),
        });
        self
    }

    fn tests(mut self, depth: DepthTarget) -> Pass {
        self.depth = Some(depth);
        self
    }
}

/// The Plan of a frame, with which the checker is content.
pub(crate) fn planned(device: &Device, frame: &Frame, options: &Options) -> Plan {
    let plan = compile(frame, &device.profile(), &mut device.memory(), options);
    let plan = plan.unwrap_or_else(|errors| panic!("{errors:?}"));
    let violations = verify(&plan);
    assert!(violations.is_empty(), "{violations:?}\n{}", plan.tree());
    plan
}

/// The shaders of a test, and behind them those that many tests have in common.
pub(crate) fn library(shaders: Shaders) -> ShaderLibrary {
    let all: Shaders = [shaders, COMMON].concat().leak();
    ShaderLibrary::new(Vec::new(), all, |_| DrawInterface::default())
}

/// Executes a frame in ways that must not show: plainly, with memory shared, with shared memory poisoned, and step by step with full
/// barriers.
pub(crate) fn in_each_way(device: &Device, frame: &Frame, shaders: Shaders, test: impl Fn(&mut Executor)) {
    for (alias, poison, slowly) in
        [(false, false, false), (true, false, false), (true, true, false), (true, false, true)]
    {
        let plan = planned(device, frame, &Options { alias, poison, ..Options::default() });
        let options = ExecutorOptions {
            poison,
            full_barriers: slowly,
            step_by_step: slowly,
            timestamps: poison || slowly,
            ..ExecutorOptions::default()
        };
        test(&mut Executor::new(device, &plan, &mut library(shaders), &options).expect("an executor"));
    }
}

/// Executes a frame as [`in_each_way`] does, on each driver.
pub(crate) fn everywhere(frame: &Frame, shaders: Shaders, test: impl Fn(&mut Executor)) {
    on_each_driver(|device| in_each_way(device, frame, shaders, &test));
}

/// Records custom passes with a function.
pub(crate) struct Custom<F>(pub(crate) F);

impl<F: FnMut(&mut CustomRecorder<'_>)> DrawSource for Custom<F> {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Ok(0)
    }

    fn custom(&mut self, _: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        (self.0)(recorder);
        Ok(())
    }
}

/// The features that let shaders choose elements of an array of sampled images by numbers that change, and by those that differ within
/// a draw: Vulkan's names, and whether the device has them.
pub(crate) fn indexing(device: &Device) -> [(&'static str, bool); 2] {
    let (instance, physical) = device.raw_physical();
    let mut more = vk::PhysicalDeviceDescriptorIndexingFeatures::default();
    let mut all = vk::PhysicalDeviceFeatures2::default().push_next(&mut more);
    // SAFETY: the physical device belongs to the instance, and the chained structure outlives the call.
    unsafe { instance.get_physical_device_features2(physical, &mut all) };
    let dynamic = all.features.shader_sampled_image_array_dynamic_indexing;
    let different = more.shader_sampled_image_array_non_uniform_indexing;
    [
        ("shaderSampledImageArrayDynamicIndexing", dynamic == vk::TRUE),
        ("shaderSampledImageArrayNonUniformIndexing", different == vk::TRUE),
    ]
}

/// What is said of a shader that needs a feature.
pub(crate) fn lacks(shader: &str, feature: &str) -> String {
    format!("pass `{shader}`: the fragment stage needs the feature {feature}, which this device doesn't have")
}

/// What is said of a shader that needs a feature, without the shader's place.
pub(crate) fn placeless(said: &str) -> String {
    let placed = said.split_once("`: ").and_then(|(pass, rest)| Some((pass, rest.split_once(": ")?.1)));
    let placed = placed.filter(|(_, what)| what.contains(" needs the feature "));
    placed.map_or_else(|| said.to_owned(), |(pass, what)| format!("{pass}`: {what}"))
}

/// Draws one frame.
pub(crate) fn frame(executor: &mut Executor) {
    executor.frame(&mut Nothing).expect("a frame");
}

/// The words of a buffer that outlives the frame.
pub(crate) fn words(executor: &mut Executor, buffer: &str) -> Vec<u32> {
    to_words(&executor.read_buffer(buffer).expect("its bytes"))
}

/// The texels of a level of an image of one 32-bit component a texel.
pub(crate) fn texels(executor: &mut Executor, image: &str, mip: u32) -> Vec<u32> {
    to_words(&executor.read_image(image, Aspects::COLOR, mip).expect("its texels").bytes)
}

pub(crate) fn to_words(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks().0.iter().map(|word| u32::from_ne_bytes(*word)).collect()
}

pub(crate) fn to_bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_ne_bytes()).collect()
}
