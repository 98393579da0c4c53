//! The stable codes of the errors that end a command.

use crate::error::Error;
use framewright_graph::base::Code;
use framewright_lab::Error as LabError;
use framewright_passes::scene::SceneError;

impl Error {
    /// The code; `None`: it consists of mistakes with codes of their own.
    pub(crate) fn code(&self) -> Option<Code> {
        Some(match self {
            Error::Mistakes { .. } => return None,
            Error::Scene(problem) => return of_scene(problem),
            Error::Missing { .. } => Code::FILE_MISSING,
            Error::Read { .. } => Code::FILE_UNREADABLE,
            Error::TooLarge { .. } => Code::FILE_TOO_LARGE,
            Error::NotText { .. } => Code::FILE_NOT_TEXT,
            Error::OutsideRoot { .. } | Error::OutsideResults { .. } => Code::FILE_OUTSIDE_ROOT,
            Error::SceneMistakes { .. } => Code::SCENE_GLTF,
            Error::Library(error) => of_library(error),
            Error::Profile { .. } | Error::UnknownProfile { .. } | Error::ProfileIsNoDevice { .. } => {
                Code::DEVICE_PROFILE
            }
            Error::Vulkan(error) => error.code(),
            Error::NoWindow { .. } | Error::NoWindowLibrary { .. } => Code::NO_WINDOW,
            Error::NoRenderDoc | Error::NothingTaken { .. } => Code::RENDERDOC,
            Error::Lab(error) => of_lab(error),
            Error::Held { .. } => Code::FOLDER_HELD,
            Error::OtherSweep { .. }
            | Error::Results { .. }
            | Error::Joining(_)
            | Error::NoFlicker { .. }
            | Error::NoReport { .. }
            | Error::NoBaseline { .. } => Code::RESULTS,
            Error::NoPlan { .. } | Error::Plan(_) => Code::NO_PLAN,
            Error::NothingToExplain { .. } | Error::UnknownCode { .. } => Code::NOTHING_TO_EXPLAIN,
            Error::CustomPass { .. } => Code::CUSTOM_UNKNOWN,
            Error::TooManyNodes { .. } | Error::TooManyPairs { .. } => Code::TOO_MANY,
            Error::WithoutPage { .. } | Error::ChoiceForPlan { .. } | Error::OwnChoice { .. } => Code::OPTIONS,
            Error::OtherResults { .. }
            | Error::ReadAndWritten { .. }
            | Error::WrittenTwice { .. }
            | Error::AlreadyExists { .. } => Code::WOULD_BE_LOST,
            Error::NotFloats { .. } | Error::NoPicture { .. } => Code::NO_PICTURE,
            Error::NoOutput { .. } => Code::UNKNOWN_OUTPUT,
            Error::Restart(_) | Error::Helper(_) => Code::OWN_PROCESS,
            Error::NoModule { .. } | Error::BadModule => Code::NO_MODULE,
            Error::Interrupted { .. } | Error::InterruptedMeasuring { .. } | Error::InterruptedWriting { .. } => {
                Code::INTERRUPTED
            }
            Error::Violations { .. } | Error::Csv(_) | Error::Unwritable(_) | Error::Json(_) => Code::OWN_MISTAKE,
            Error::Stereo { .. } => Code::STEREO_UNSUPPORTED,
            Error::ShaderCompiler { .. } => Code::SHADER_COMPILER,
            Error::Write { .. } | Error::NoFolder { .. } | Error::Cache { .. } | Error::Print(_) => {
                Code::FILE_UNWRITABLE
            }
            Error::NoName { .. } => Code::NAME_FORM,
            Error::Port { .. } => Code::PORT,
            Error::ViewerAddress { .. } | Error::NoViewer { .. } => Code::NO_VIEWER,
        })
    }
}

fn of_scene(problem: &SceneError) -> Option<Code> {
    Some(match problem {
        SceneError::Text { .. } => return None,
        SceneError::Kind { .. } => Code::SCENE_KIND,
        SceneError::Unreadable { .. } | SceneError::LeftOut { .. } => Code::FILE_UNREADABLE,
        SceneError::TooLarge { .. } => Code::FILE_TOO_LARGE,
        SceneError::NotText { .. } => Code::FILE_NOT_TEXT,
        SceneError::Gltf { .. } => Code::SCENE_GLTF,
    })
}

fn of_library(error: &framewright::Error) -> Code {
    match error {
        framewright::Error::UnknownOutput { .. } => Code::UNKNOWN_OUTPUT,
        // The others are errors of this command.
        _ => Code::OWN_MISTAKE,
    }
}

fn of_lab(error: &LabError) -> Code {
    match error {
        LabError::Sweep { .. } => Code::SWEEP,
        LabError::Picture { .. } => Code::NO_PICTURE,
        LabError::NoLight { .. } => Code::FILE_UNREADABLE,
        LabError::Sizes { .. } | LabError::NothingFinite { .. } => Code::NOT_COMPARABLE,
        LabError::Program(_) => Code::FILE_UNWRITABLE,
        // The others are errors of this command.
        _ => Code::OWN_MISTAKE,
    }
}
