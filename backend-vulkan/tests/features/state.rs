//! State that is set already isn't set again, and state that may have changed is.

use crate::frames::{Small, Uses, draw, on_each_driver, planned};
use crate::testing::{OVER_ALL, WHITE};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::DrawInterface;
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::ash::vk;
use framewright_vulkan::{Device, DrawSource, Error, Executor, ExecutorOptions, Recorder, ShaderLibrary};

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

/// How many texels each of two passes made white.
fn white(device: &Device, scissor: Scissor) -> [usize; 2] {
    let mut small = Small::default();
    let [first, second] = ["first", "second"].map(|name| small.image(name, Format::R8G8B8A8_UNORM, [SIDE; 2]));
    small.pass(draw("first", Draw::Objects(DrawList::Opaque)).draws(first, WHOLE, Some([0.0; 4])));
    small.pass(draw("second", Draw::FullScreen).draws(second, WHOLE, Some([0.0; 4])));
    small.image_output(first);
    small.image_output(second);
    let plan = planned(device, &small.frame, &Options::default());
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
    executor.frame(&mut Source(device, scissor)).expect("a frame");
    [0, 1].map(|output| {
        let texels = executor.read(output).expect("a picture").bytes;
        texels.chunks_exact(4).filter(|texel| texel == &[255; 4]).count()
    })
}

#[test]
fn a_pass_begins_with_its_own_state_whatever_the_pass_before_set() {
    on_each_driver(|device| {
        assert_eq!(white(device, Scissor::Corner), [1, 16]);
        assert_eq!(white(device, Scissor::OwnCorner), [1, 16]);
    });
}

#[test]
fn after_commands_of_its_own_a_program_can_set_again_what_was_set() {
    on_each_driver(|device| assert_eq!(white(device, Scissor::OwnCornerThenAll), [16, 16]));
}
