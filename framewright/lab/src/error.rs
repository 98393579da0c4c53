//! Everything that can go wrong when pictures are compared, or choices measured.

use crate::picture::{DecodingError, EncodingError};
use framewright_graph::base::escape;
use std::path::{Path, PathBuf};

/// An error of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An error of the pipeline, of what was chosen for it, or of the device.
    #[error(transparent)]
    Framewright(#[from] framewright::Error),
    /// A picture can't be encoded.
    #[error("the picture of `{}` can't be encoded: {problem}", escape(image))]
    Picture {
        /// The image's name.
        image: String,
        /// What is wrong.
        problem: EncodingError,
    },
    /// A file is no picture to compare.
    #[error("the picture `{}` can't be read: {}", shown(path), escape(&problem.to_string()))]
    NoLight {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: DecodingError,
    },
    /// Pictures are of different sizes.
    #[error("`{}` is {}, and `{}` is {}: only pictures of one size are compared", shown(&reference.0), pixels(reference.1), shown(&picture.0), pixels(picture.1))]
    Sizes {
        /// The picture that is right, with its width and height.
        reference: (PathBuf, [usize; 2]),
        /// The one that is compared with it.
        picture: (PathBuf, [usize; 2]),
    },
    /// Pictures without anything to compare.
    #[error("no pixel is finite in both `{}` and `{}`: there is nothing to compare", shown(reference), shown(picture))]
    NothingFinite {
        /// The picture that is right.
        reference: PathBuf,
        /// The one that is compared with it.
        picture: PathBuf,
    },
    /// A sweep that can't be measured.
    #[error("{what}")]
    Sweep {
        /// The reason.
        what: String,
    },
    /// The program asked to stop.
    #[error("stopped after {drawn} of {wanted} frames")]
    Stopped {
        /// The frames that were drawn.
        drawn: u32,
        /// All frames.
        wanted: u32,
    },
    /// A reference has no JSON form.
    #[error("the reference has no JSON form: {0}")]
    Json(#[from] serde_json::Error),
    /// The program can't keep a file.
    #[error("{0}")]
    Program(Box<dyn std::error::Error + Send + Sync>),
}

impl From<framewright_vulkan::Error> for Error {
    fn from(error: framewright_vulkan::Error) -> Error {
        Error::Framewright(error.into())
    }
}

impl Error {
    /// Whether every further choice of a sweep would meet the same error: a device that is lost, a full disk, a wrong choice for all.
    #[must_use]
    pub fn ends_a_sweep(&self) -> bool {
        use framewright::Error as Face;
        use framewright_vulkan::Error::{DeviceLost, Timeout};
        match self {
            Error::Framewright(Face::Vulkan(DeviceLost { .. } | Timeout { .. }) | Face::OutsideRoot { .. }) => true,
            Error::Framewright(Face::Mistakes { mistakes }) => mistakes.of_choices,
            Error::Sizes { .. } | Error::Sweep { .. } | Error::Stopped { .. } | Error::Program(_) => true,
            Error::Framewright(_)
            | Error::Picture { .. }
            | Error::NoLight { .. }
            | Error::NothingFinite { .. }
            | Error::Json(_) => false,
        }
    }
}

fn shown(path: &Path) -> String {
    escape(&path.to_string_lossy())
}

fn pixels([width, height]: [usize; 2]) -> String {
    format!("{width}×{height}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_vulkan::Error as Problem;

    #[test]
    fn a_lost_device_and_a_full_disk_end_a_sweep_and_a_choice_that_can_not_be_drawn_does_not() {
        assert!(Error::from(Problem::DeviceLost { doing: "drawing" }).ends_a_sweep());
        let full = std::io::Error::from(std::io::ErrorKind::StorageFull);
        assert!(Error::Program(full.into()).ends_a_sweep());
        let own = framewright::Error::CustomPass { pass: "particles".to_owned(), name: "sparks".to_owned() };
        assert!(!Error::from(own).ends_a_sweep());
    }
}
