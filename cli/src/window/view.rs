//! How a window shows its frame: for one eye or two, and turned as on screens that are mounted turned.

use crate::error::Error;
use crate::system::text;
use framewright::{Renderer, Stereo, Swapchain};
use framewright_graph::plan::{Plan, Resource};
use framewright_graph::vulkan::Rotation;

/// How a window shows its frame.
pub(super) struct View {
    rotation: Rotation,
    stereo: Stereo,
}

impl View {
    pub(super) fn new(rotation: Rotation, stereo: Stereo) -> View {
        View { rotation, stereo }
    }

    /// Fits the frame to the window's images.
    ///
    /// # Errors
    /// Those of [`Renderer::fit`].
    pub(super) fn fit(&self, renderer: &mut Renderer, swapchain: &Swapchain) -> Result<(), Error> {
        let Some(extent) = swapchain.extent() else { return Ok(()) };
        // A preview: the window isn't turned, and shows the picture as a turned screen would be given it.
        let [width, height] = self.rotation.extent(extent);
        if self.wants_two_eyes() && width % 2 == 1 {
            text::say("note: a picture of an odd width can't be halved for two eyes: one is shown");
        }
        let two = self.wants_two_eyes() && width.is_multiple_of(2);
        renderer.set_stereo(if two { self.stereo } else { Stereo::Off })?;
        renderer.fit(swapchain)?;
        if self.rotation.turns() {
            renderer.set_extent([if two { width / 2 } else { width }, height])?;
            renderer.set_rotation(self.rotation);
        }
        Ok(())
    }

    /// Whether both eyes are to be shown, where the picture can be halved.
    pub(super) fn wants_two_eyes(&self) -> bool {
        self.stereo != Stereo::Off
    }

    /// Shows one eye's picture, or both beside each other, from the next fit on.
    pub(super) fn turn_eyes(&mut self) {
        self.stereo = if self.stereo == Stereo::Off { Stereo::DoubleWide } else { Stereo::Off };
    }

    /// Turns the picture by a quarter from the next fit on, and says by how much it is turned.
    pub(super) fn turn_screen(&mut self) {
        let at = Rotation::ALL.iter().position(|rotation| *rotation == self.rotation).unwrap_or(0);
        self.rotation = Rotation::ALL[(at + 1) % Rotation::ALL.len()];
        text::say(&format!("rotated by {}°", self.rotation.degrees()));
    }
}

/// Whether the first output of a Plan has the pictures of both eyes beside each other.
pub(super) fn shows_two_eyes(plan: &Plan) -> bool {
    let output = plan.outputs.first().map(|output| output.resource);
    matches!(output, Some(Resource::Image(image)) if plan.image(image).eyes.is_some())
}
