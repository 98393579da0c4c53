//! The stable codes of errors.

use super::Error;
use framewright_graph::base::Code;

impl Error {
    /// The rule that is broken, or what the machine lacks.
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Error::NoLoader { .. }
            | Error::NoDevice
            | Error::NoInstance { .. }
            | Error::UnknownDevice { .. }
            | Error::Vulkan { .. }
            | Error::DeviceLost { .. }
            | Error::Timeout { .. } => Code::DRIVER,
            Error::NoValidationLayer { .. } | Error::LayerIsBlind { .. } | Error::LayerIsMuted { .. } => {
                Code::VALIDATION_LAYER
            }
            Error::Lacking { .. } | Error::NotEnabled { .. } => Code::DEVICE_LACKS,
            Error::WithoutFeatures { .. } => Code::NOT_SWITCHED_ON,
            Error::CantWrite { .. } => Code::FILE_UNWRITABLE,
            Error::AtStep { error, .. } => error.code(),
            Error::Cancelled { .. } => Code::INTERRUPTED,
            Error::NoSurfaces { .. } | Error::CantPresent { .. } | Error::SurfaceLost { .. } => Code::NO_WINDOW,
            Error::OutOfMemory { .. } => Code::OUT_OF_MEMORY,
            Error::Texture { .. } => Code::TEXTURE_FILE,
            Error::Shader { problem, .. } => problem.code(),
            Error::Mismatch { .. } => Code::SHADER_UNFIT,
            Error::BadPlan { .. } | Error::OtherMemoryNeeds { .. } => Code::NO_PLAN,
            Error::Violations { .. } => Code::OWN_MISTAKE,
            Error::BadResource { .. }
            | Error::Recording { .. }
            | Error::NotImported { .. }
            | Error::BrokenPromises { .. }
            | Error::DrawSource { .. } => Code::DRAWING_PROGRAM,
        }
    }
}
