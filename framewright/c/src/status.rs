//! What became of a call.

use framewright::Error;
use framewright::graph::base::escape;
use framewright::vulkan::{self, Blame};
use std::any::Any;

/// What became of a call. `framewright_last_error` has the words.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FramewrightStatus {
    /// All went well.
    Ok = 0,
    /// The call is wrong: a pointer is NULL, a text isn't UTF-8, a structure has another size, a name isn't known, or it isn't the time.
    Misuse = 1,
    /// A file is missing, or can't be read.
    File = 2,
    /// The user's files or choices are wrong. `framewright_last_mistake` has the mistakes one by one.
    Mistakes = 3,
    /// The machine lacks something: a driver, a device, a feature, the validation layer.
    Machine = 4,
    /// There is not enough memory.
    OutOfMemory = 5,
    /// The device is lost, or didn't answer in time: nothing that was made from it can be used any more.
    DeviceLost = 6,
    /// The library has a mistake, and a call panicked. The handle that was used can only be freed.
    Panic = 7,
}

/// Why a call failed.
#[derive(Debug)]
pub(crate) enum Problem {
    /// The caller's mistake, in words.
    Misuse(String),
    /// An error of the library.
    Library(Error),
    /// A page can't be served at an address.
    #[cfg(feature = "viewer")]
    Served {
        /// The address.
        address: String,
        /// The system's error.
        why: std::io::Error,
    },
    /// A panic, with what it said.
    Panic(String),
}

impl Problem {
    pub(crate) fn of_panic(payload: &(dyn Any + Send)) -> Problem {
        let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
        Problem::Panic(text)
    }

    pub(crate) fn status(&self) -> FramewrightStatus {
        match self {
            Problem::Misuse(_) => FramewrightStatus::Misuse,
            Problem::Library(error) => status(error),
            #[cfg(feature = "viewer")]
            Problem::Served { why, .. } if why.kind() == std::io::ErrorKind::InvalidInput => FramewrightStatus::Misuse,
            #[cfg(feature = "viewer")]
            Problem::Served { .. } => FramewrightStatus::Machine,
            Problem::Panic(_) => FramewrightStatus::Panic,
        }
    }

    pub(crate) fn text(&self) -> String {
        match self {
            // Names in it are the caller's and the pipeline's.
            Problem::Misuse(what) => escape(what),
            Problem::Library(error) => error.to_string(),
            #[cfg(feature = "viewer")]
            Problem::Served { address, why } => format!("no page can be served at `{}`: {why}", escape(address)),
            Problem::Panic(what) => format!("the library panicked: {what}"),
        }
    }
}

impl<E: Into<Error>> From<E> for Problem {
    fn from(error: E) -> Problem {
        Problem::Library(error.into())
    }
}

fn status(error: &Error) -> FramewrightStatus {
    match error {
        Error::Missing { .. } | Error::Unreadable { .. } | Error::TooLarge { .. } | Error::NotText { .. } => {
            FramewrightStatus::File
        }
        Error::UnknownOutput { .. } => FramewrightStatus::Misuse,
        Error::Mistakes { mistakes } if mistakes.is_of_machine() => FramewrightStatus::Machine,
        Error::Stereo { .. } => FramewrightStatus::Machine,
        Error::Vulkan(error) => status_of_vulkan(error),
        _ => FramewrightStatus::Mistakes,
    }
}

fn status_of_vulkan(error: &vulkan::Error) -> FramewrightStatus {
    use vulkan::Error;
    match error {
        Error::DeviceLost { .. } | Error::Timeout { .. } | Error::Cancelled { .. } => FramewrightStatus::DeviceLost,
        Error::OutOfMemory { .. } => FramewrightStatus::OutOfMemory,
        // Of what this interface hands in, names and images alone.
        Error::BadResource { .. } => FramewrightStatus::Misuse,
        Error::AtStep { error, .. } => status_of_vulkan(error),
        other => match other.blame() {
            Blame::Environment => FramewrightStatus::Machine,
            Blame::Files => FramewrightStatus::Mistakes,
            Blame::Program => FramewrightStatus::Misuse,
        },
    }
}
