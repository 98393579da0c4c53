//! Each pass begins with its own state, though state that is set already isn't set again.

use crate::frames::{Custom, Small, Uses, draw, on_each_driver, planned, transfer};
use crate::testing::{OVER_ALL, WHITE};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, DrawList, Resource, Work};
use framewright_graph::shader::DrawInterface;
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::ash::vk;
use framewright_vulkan::{
    CustomRecorder, Device, DrawSource, Error, Executor, ExecutorOptions, Recorder, ShaderLibrary,
};

const WHOLE: Subresources = Subresources::WHOLE;
const SIDE: u32 = 4;
const SHADERS: &[(&str, &str)] =
    &[("full_screen.vert", OVER_ALL), ("objects.vert", OVER_ALL), ("first.frag", WHITE), ("second.frag", WHITE)];

/// Where a pass says that texels may change.
#[derive(Debug, Clone, Copy)]
enum Scissor {
    /// In the upper left corner, by the recorder.
    Corner,
    /// In the upper left corner, by a command of the program's own.
    OwnCorner,
    /// The same, and then everywhere by the recorder.
    OwnCornerThenAll,
}

struct Source<'d>(&'d Device, Scissor);

impl DrawSource for Source<'_> {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        match self.1 {
            Scissor::Corner => recorder.set_scissor([0, 0], [1, 1]),
            Scissor::OwnCorner | Scissor::OwnCornerThenAll => {
                let corner = vk::Rect2D { extent: vk::Extent2D { width: 1, height: 1 }, ..vk::Rect2D::default() };
                let commands = recorder.raw();
                // SAFETY: the command buffer is being recorded, and the scissor is dynamic and lies within the picture.
                unsafe { self.0.raw().cmd_set_scissor(commands, 0, &[corner]) };
            }
        }
        if matches!(self.1, Scissor::OwnCornerThenAll) {
            recorder.set_scissor([0, 0], [SIDE, SIDE]);
        }
        recorder.draw(0..3, 0..1);
        Ok(1)
    }
}

/// How many texels two passes made white, each of its image. `between`: a custom pass between them, from one image to the other.
fn white(device: &Device, first: Draw, between: bool, source: &mut dyn DrawSource) -> [usize; 2] {
    let mut small = Small::default();
    let images = ["first", "second"].map(|name| small.image(name, Format::R8G8B8A8_UNORM, [SIDE; 2]));
    small.pass(draw("first", first).draws(images[0], WHOLE, Some([0.0; 4])));
    if between {
        let [from, to] = images.map(Resource::Image);
        let mut own =
            transfer("own", Work::Custom { callback: "own".into() }, &[(from, WHOLE, false), (to, WHOLE, true)]);
        own.side_effect = true;
        small.pass(own);
    }
    small.pass(draw("second", Draw::FullScreen).draws(images[1], WHOLE, Some([0.0; 4])));
    images.iter().for_each(|image| small.image_output(*image));
    let plan = planned(device, &small.frame, &Options::default());
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
    executor.frame(source).expect("a frame");
    [0, 1].map(|output| {
        let texels = executor.read(output).expect("a picture").bytes;
        texels.chunks_exact(4).filter(|texel| texel == &[255; 4]).count()
    })
}

const OBJECTS: Draw = Draw::Objects(DrawList::Opaque);

#[test]
fn a_pass_begins_with_its_own_state_whatever_the_pass_before_set() {
    on_each_driver(|device| {
        assert_eq!(white(device, OBJECTS, false, &mut Source(device, Scissor::Corner)), [1, 16]);
        assert_eq!(white(device, OBJECTS, false, &mut Source(device, Scissor::OwnCorner)), [1, 16]);
    });
}

#[test]
fn after_commands_of_its_own_a_program_can_set_again_what_was_set() {
    on_each_driver(|device| {
        assert_eq!(white(device, OBJECTS, false, &mut Source(device, Scissor::OwnCornerThenAll)), [16, 16])
    });
}

#[test]
fn a_pass_behind_a_custom_one_begins_with_its_own_state_too() {
    on_each_driver(|device| {
        let mut source = Custom(|recorder: &mut CustomRecorder<'_>| {
            recorder.copy("first", "second");
            let corner = vk::Rect2D { extent: vk::Extent2D { width: 1, height: 1 }, ..vk::Rect2D::default() };
            let commands = recorder.raw();
            // SAFETY: the command buffer is being recorded.
            unsafe { device.raw().cmd_set_scissor(commands, 0, &[corner]) };
        });
        assert_eq!(white(device, Draw::FullScreen, true, &mut source), [16, 16]);
    });
}
