//! The views of a frame: from where, and how large, each of its parts is drawn.

use super::Jitter;
use crate::base::Span;
use crate::device::Profile;
use crate::vulkan::Rotation;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Index of a view in [`crate::frame::Frame::views`]; 0, the main one, also where a frame lists none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct ViewIndex(pub u32);

/// An eye of a viewer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Eye {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

impl Eye {
    /// Both, the left one first.
    pub const BOTH: [Eye; 2] = [Eye::Left, Eye::Right];

    /// Its name in lower case.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Eye::Left => "left",
            Eye::Right => "right",
        }
    }

    /// The name of this eye's own version of something called `name`.
    #[must_use]
    pub fn named(self, name: &str) -> Arc<str> {
        format!("{name} ({})", self.name()).into()
    }
}

/// How a frame is drawn for two eyes. The pipeline file is the same for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stereo {
    /// It is drawn for one eye: images that each eye has of its own are there once.
    #[default]
    Off,
    /// Images that each eye has of its own are drawn for one eye and then for the other, into separate images.
    MultiPass,
    /// Both eyes' images lie side by side in one of twice the width; each draw is recorded for the left half and then for the
    /// right one, each with its viewport and scissor.
    DoubleWide,
    /// Each draw has twice the instances, every other one for the right eye: into layers of one image where vertex shaders
    /// can choose the layer, else into halves, where a clip distance cuts what reaches over the seam.
    Instanced,
    /// Both eyes' images are layers of one, and the device draws everything into each of them (`viewMask`).
    Multiview,
}

impl Stereo {
    /// All, in the order of how much they ask of a device.
    pub const ALL: [Stereo; 5] =
        [Stereo::Off, Stereo::MultiPass, Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];

    /// The modes for two eyes, the fastest first: how often a draw is recorded, and the cost of telling eyes apart.
    pub const FASTEST_FIRST: [Stereo; 4] =
        [Stereo::Multiview, Stereo::Instanced, Stereo::DoubleWide, Stereo::MultiPass];

    /// Its name, as it is written on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Stereo::Off => "off",
            Stereo::MultiPass => "multi-pass",
            Stereo::DoubleWide => "double-wide",
            Stereo::Instanced => "instanced",
            Stereo::Multiview => "multiview",
        }
    }

    /// Whether the number of an instance tells the eye where one image holds both eyes' parts: no buffer can say the instances then.
    pub(crate) const fn is_by_instance(self) -> bool {
        match self {
            Stereo::DoubleWide | Stereo::Instanced => true,
            Stereo::Off | Stereo::MultiPass | Stereo::Multiview => false,
        }
    }

    /// The form in which one image holds both eyes' parts on `device` (`None`: a device with no more than Vulkan 1.3
    /// demands); `None`: each eye has an image of its own.
    #[must_use]
    pub fn form(self, device: Option<&Profile>) -> Option<EyeForm> {
        match self {
            Stereo::Off | Stereo::MultiPass => None,
            Stereo::DoubleWide => Some(EyeForm::Halves),
            Stereo::Instanced if device.is_some_and(|device| device.vertex_layer) => Some(EyeForm::Layers),
            Stereo::Instanced => Some(EyeForm::Halves),
            Stereo::Multiview => Some(EyeForm::Layers),
        }
    }

    /// Why `device` can't draw in this mode, in words.
    #[must_use]
    pub fn lacks(self, device: &Profile) -> Option<String> {
        match self {
            Stereo::Multiview if device.refuted_multiview => {
                Some("it says that it draws several views at once, and a test showed that it doesn't".to_owned())
            }
            Stereo::Multiview if device.untested_multiview => {
                Some("it says that it draws several views at once, and that couldn't be tested".to_owned())
            }
            Stereo::Multiview if device.max_multiview_views < 2 => {
                Some(format!("it draws {} views at once, and two are needed", device.max_multiview_views))
            }
            Stereo::Instanced if self.form(Some(device)) == Some(EyeForm::Halves) => match device.max_clip_distances {
                None => Some(
                    "its profile doesn't say that vertex shaders can choose the layer, nor how many clip distances shaders \
                     have, and one of the two is needed"
                        .to_owned(),
                ),
                Some(0) => Some(
                    "its vertex shaders can't choose the layer and have no clip distance, and one of the two is needed"
                        .to_owned(),
                ),
                Some(_) => None,
            },
            _ => None,
        }
    }

    /// The first of `wanted` that `device` can draw; else why it can't draw any of them.
    ///
    /// # Errors
    /// In words, for each of them.
    pub fn first_fit(wanted: &[Stereo], device: &Profile) -> Result<Stereo, String> {
        let mut why = Vec::new();
        for stereo in wanted {
            match stereo.lacks(device) {
                None => return Ok(*stereo),
                Some(lacks) => why.push(format!("`{}` can't draw {}: {lacks}", device.name, stereo.name())),
            }
        }
        Err(why.join("; "))
    }
}

/// The form in which one image holds both eyes' parts. Sizes in a frame or a Plan are those of one eye's part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EyeForm {
    /// In two array layers, the left eye's first.
    Layers,
    /// Side by side, the left eye's in the left half of the upright picture.
    Halves,
}

impl EyeForm {
    /// How many eyes' parts an image holds.
    pub(crate) const fn parts(form: Option<EyeForm>) -> u64 {
        match form {
            Some(EyeForm::Layers | EyeForm::Halves) => 2,
            None => 1,
        }
    }

    /// Array layers that an image is made with.
    #[must_use]
    pub const fn layers(form: Option<EyeForm>, layers: u32) -> u32 {
        match form {
            Some(EyeForm::Layers) => layers.saturating_mul(2),
            Some(EyeForm::Halves) | None => layers,
        }
    }

    /// Width, height and depth that an image is made with. One eye's part of it, turned by `rotation`, has the given ones.
    #[must_use]
    pub const fn extent(form: Option<EyeForm>, [width, height, depth]: [u32; 3], rotation: Rotation) -> [u32; 3] {
        match (form, rotation) {
            (Some(EyeForm::Halves), Rotation::Identity | Rotation::Rotate180) => {
                [width.saturating_mul(2), height, depth]
            }
            (Some(EyeForm::Halves), Rotation::Rotate90 | Rotation::Rotate270) => {
                [width, height.saturating_mul(2), depth]
            }
            (Some(EyeForm::Layers) | None, _) => [width, height, depth],
        }
    }
}

/// The eye that a view is seen with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ViewEye {
    /// The eye.
    pub eye: Eye,
    /// The view between both eyes.
    pub of: ViewIndex,
}

/// One view of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// Width and height of its picture in texels, each at least 1. Draws from a camera take the ratio from here.
    pub extent: [u32; 2],
    /// The scene's camera of that name; `None`: the scene's default camera.
    pub camera: Option<Arc<str>>,
    /// The costs that its passes may have.
    pub allows: Allowances,
    /// How its camera's picture is shifted from frame to frame; `None`: not at all.
    pub jitter: Option<Jitter>,
    /// The eye that it is seen with; `None`: it is seen from between the eyes, or there is one.
    pub eye: Option<ViewEye>,
}

/// The costs that a view may have. Conditions of a pipeline ask for them; the compiler only hands them on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Allowances {
    /// Several samples a texel.
    pub msaa: bool,
    /// Light beyond what a display shows.
    pub hdr: bool,
    /// Drawing in another size than that of its picture.
    pub scale: bool,
}

impl Default for Allowances {
    fn default() -> Allowances {
        Allowances { msaa: true, hdr: true, scale: true }
    }
}
