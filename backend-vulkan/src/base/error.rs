//! Everything that can go wrong here, as data; the sentence is made where it is shown.

use super::{BrokenPromise, named};
use ash::vk;
use framewright_graph::base::{amount, escape};
use framewright_graph::device::MemoryNeeds;
use framewright_graph::frame::TextureProblem;
use framewright_graph::plan::UsedFeature;
use framewright_graph::shader::ShaderProblem;
use framewright_graph::verify::Violation;

/// The packages that bring a loader, a driver that needs no graphics card, and a validation layer.
pub const INSTALL: &str =
    "apt-get install --no-install-recommends libvulkan1 mesa-vulkan-drivers vulkan-validationlayers chromium-common";

/// An error of this crate. Names that come from files stand in it unescaped; [`std::fmt::Display`] escapes them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is no Vulkan loader, or it can't be loaded.
    #[error("no Vulkan loader: {reason}; mend it with: {INSTALL}")]
    NoLoader {
        /// The system's words.
        reason: String,
    },
    /// The loader found no driver, or no driver has a device.
    #[error("no Vulkan driver with a device; mend it with: {INSTALL}{}", loader_variables(""))]
    NoDevice,
    /// The loader can't make an instance: a file that describes a driver or a layer is broken, or what it leads to is.
    #[error(
        "the Vulkan loader can't make an instance{} ({}): a file that it reads is broken, or leads to a \
         library that can't be loaded; VK_LOADER_DEBUG=all shows which; mend it with: {INSTALL}{}",
        if *validation { " with the validation layer" } else { "" },
        named(result),
        loader_variables(", or mend what they lead to")
    )]
    NoInstance {
        /// Vulkan's own result.
        result: vk::Result,
        /// Whether the validation layer was asked for.
        validation: bool,
    },
    /// No device fits the name or number that was asked for.
    #[error("no device {}{}; there are: {}", escape(wanted), did_you_mean(near), list(known))]
    UnknownDevice {
        /// The name or number that was asked for.
        wanted: String,
        /// The nearest name.
        near: Option<String>,
        /// The devices that exist, by number.
        known: Vec<String>,
    },
    /// The device is less than the minimum.
    #[error("{} lacks {}; choose another device, or install a newer driver: {INSTALL}", escape(device), missing.join(", "))]
    Lacking {
        /// The device.
        device: String,
        /// All that it lacks.
        missing: Vec<String>,
    },
    /// A device that the program made itself was made without something that is needed.
    #[error("{} was created without {}: add what it lacks where the device is created", escape(device), missing.join(", "))]
    NotEnabled {
        /// The device.
        device: String,
        /// All that it was created without.
        missing: Vec<String>,
    },
    /// The device was made without features that a Plan uses, or has none of them.
    #[error(
        "{} {} what the Plan uses: {}; {}choose another device",
        escape(device),
        if *adopted { "was created without" } else { "lacks" },
        uses(missing),
        if *adopted { "switch it on where the device is created, or " } else { "" }
    )]
    WithoutFeatures {
        /// The device.
        device: String,
        /// The features, each with what uses it.
        missing: Vec<UsedFeature>,
        /// Whether the program made the device itself.
        adopted: bool,
    },
    /// Validation was asked for and there is no validation layer.
    #[error("no layer VK_LAYER_KHRONOS_validation{}; mend it with: {INSTALL}{}", looked(layer_path), disabled())]
    NoValidationLayer {
        /// `VK_LAYER_PATH`, if it is set.
        layer_path: Option<String>,
    },
    /// The validation layer didn't report a mistake that was made on purpose: its silence would prove nothing.
    #[error(
        "the validation layer {} did not report {planted}, which was planted to test it: its {checks} are switched off, or their \
         messages are left out; {}",
        escape(layer),
        unset(settings)
    )]
    LayerIsBlind {
        /// The layer.
        layer: String,
        /// The planted mistake.
        planted: &'static str,
        /// The checks that find it.
        checks: &'static str,
        /// The layer's settings, from the environment and its file.
        settings: Vec<String>,
    },
    /// Settings keep the validation layer from reporting some mistakes: its silence would prove nothing.
    #[error("the validation layer {} keeps mistakes to itself; {}", escape(layer), unset(settings))]
    LayerIsMuted {
        /// The layer.
        layer: String,
        /// The settings, from the environment and the layer's file.
        settings: Vec<String>,
    },
    /// A file of this crate's own can't be written (the layer's manifest).
    #[error(
        "can't write {}: {reason}; mend it with: XDG_CACHE_HOME naming a folder that is yours, or \
         VK_LAYER_PATH naming the layer's own",
        escape(path)
    )]
    CantWrite {
        /// The file.
        path: String,
        /// The system's words.
        reason: String,
    },
    /// A Vulkan call failed.
    #[error("{doing} failed: {}", named(result))]
    Vulkan {
        /// The operation that failed.
        doing: &'static str,
        /// Vulkan's own result.
        result: vk::Result,
    },
    /// The device is lost.
    #[error("the device was lost while {doing}: the driver gave up; the system's log may say why")]
    DeviceLost {
        /// The operation that was under way.
        doing: &'static str,
    },
    /// The device didn't finish in time.
    #[error("the device did not finish {doing} within {seconds} s")]
    Timeout {
        /// The operation that was under way.
        doing: &'static str,
        /// How long it was waited for.
        seconds: u64,
    },
    /// An error of a frame that was executed step by step, or with breadcrumbs.
    #[error("{error}, at {}", escape(step))]
    AtStep {
        /// The step: its number in the Plan, and its passes. With breadcrumbs one for each queue that was at work.
        step: String,
        /// The error.
        error: Box<Error>,
    },
    /// The program asked for the wait to be given up ([`Device::cancel_when`](crate::Device::cancel_when)).
    #[error("{doing} was cancelled before the device was done")]
    Cancelled {
        /// The operation that was under way.
        doing: &'static str,
    },
    /// No driver can show anything on the display that the device was to be opened for.
    #[error("the driver shows nothing on this display: it lacks {}; choose another driver, or install one: {INSTALL}", missing.join(", "))]
    NoSurfaces {
        /// The instance extensions that are missing.
        missing: Vec<String>,
    },
    /// Nothing can be shown in a window, or in this one.
    #[error("{} can't show anything in this window: {why}", escape(device))]
    CantPresent {
        /// The device.
        device: String,
        /// Why.
        why: &'static str,
    },
    /// The window's surface is lost: the window is gone, or the window system has let go of it.
    #[error("the surface of the window was lost while {doing}: make another one")]
    SurfaceLost {
        /// The operation that was under way.
        doing: &'static str,
    },
    /// There is not enough memory, or none of the right kind.
    #[error("no memory for {}, {}{}: {reason}", escape(what), amount::bytes(*bytes), among(parts))]
    OutOfMemory {
        /// The thing that the memory is for.
        what: String,
        /// The number of bytes.
        bytes: u64,
        /// Images or buffers that were to share the memory, if there is more than one: names and bytes.
        parts: Vec<(String, u64)>,
        /// The allocator's words.
        reason: String,
    },
    /// A resource can't be made of what was given.
    #[error("{}", escape(what))]
    BadResource {
        /// The resource, and why it can't be made.
        what: String,
    },
    /// An image's file gives no texture.
    #[error("image `{}`: the texture `{}` {}", escape(image), escape(path), escape(&problem.to_string()))]
    Texture {
        /// The image.
        image: String,
        /// The file, as the Plan names it.
        path: String,
        /// Why.
        problem: TextureProblem,
    },
    /// A shader has no usable form.
    #[error("shader `{}`: {}", escape(name), problem_text(problem))]
    Shader {
        /// Its name.
        name: String,
        /// Why.
        problem: ShaderProblem,
    },
    /// A shader doesn't fit what its pass gives it.
    #[error("pass `{}`: {}", escape(pass), escape(what))]
    Mismatch {
        /// The pass.
        pass: String,
        /// The part that doesn't fit, and why.
        what: String,
    },
    /// A Plan can't be executed as it is.
    #[error("the Plan can't be executed: {}", escape(what))]
    BadPlan {
        /// Why.
        what: String,
    },
    /// A Plan breaks rules of the Vulkan memory model.
    #[error("the Plan is wrong: {}", sentences(violations))]
    Violations {
        /// Each mistake.
        violations: Vec<Violation>,
    },
    /// An image or buffer takes other memory here than the Plan assumes.
    #[error(
        "`{}` needs {} on {}, and the Plan, made for {}, gives it {}: compile it for this device",
        escape(resource),
        in_memory(actual),
        escape(device),
        escape(planned_for),
        in_memory(planned)
    )]
    OtherMemoryNeeds {
        /// The image or buffer.
        resource: String,
        /// This device.
        device: String,
        /// The device that the Plan was made for.
        planned_for: String,
        /// The memory that it needs here.
        actual: MemoryNeeds,
        /// The memory that the Plan gives it.
        planned: MemoryNeeds,
    },
    /// The code that draws a pass misused the recorder.
    #[error("pass `{}`, while recording: {what}", escape(pass))]
    Recording {
        /// The pass.
        pass: String,
        /// The misuse, in words.
        what: String,
    },
    /// Custom passes did what the pipeline doesn't say of them: [`ExecutorOptions::check_uses`](crate::ExecutorOptions::check_uses) has
    /// found it. The frame is done all the same.
    #[error("{}", broken(promises))]
    BrokenPromises {
        /// What they did, at least one thing.
        promises: Vec<BrokenPromise>,
    },
    /// A frame was to be drawn before the program imported again what it had imported for the Plan before.
    #[error("the Plan is another one: `{}` is to be imported again", escape(name))]
    NotImported {
        /// The image or buffer.
        name: String,
    },
    /// The draw source gave up.
    #[error("{}", escape(what))]
    DrawSource {
        /// Its own words.
        what: String,
    },
}

/// Who can mend an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blame {
    /// The user's files or choices.
    Files,
    /// The machine: driver, layer, device, memory.
    Environment,
    /// A program that uses this library.
    Program,
}

impl Error {
    /// Who can mend it.
    #[must_use]
    pub fn blame(&self) -> Blame {
        match self {
            Error::NoLoader { .. }
            | Error::NoDevice
            | Error::NoInstance { .. }
            | Error::UnknownDevice { .. }
            | Error::Lacking { .. }
            | Error::NoValidationLayer { .. }
            | Error::LayerIsBlind { .. }
            | Error::LayerIsMuted { .. }
            | Error::CantWrite { .. }
            | Error::Vulkan { .. }
            | Error::DeviceLost { .. }
            | Error::CantPresent { .. }
            | Error::NoSurfaces { .. }
            | Error::SurfaceLost { .. }
            | Error::Timeout { .. }
            | Error::OutOfMemory { .. } => Blame::Environment,
            Error::Shader {
                problem: ShaderProblem::Machine { .. } | ShaderProblem::Compiler { of_machine: true, .. },
                ..
            } => Blame::Environment,
            Error::Texture { problem, .. } if problem.is_of_machine() => Blame::Environment,
            Error::AtStep { error, .. } => error.blame(),
            Error::Shader { .. }
            | Error::Texture { .. }
            | Error::Mismatch { .. }
            | Error::BadResource { .. }
            | Error::DrawSource { .. } => Blame::Files,
            Error::BadPlan { .. }
            | Error::NotEnabled { .. }
            | Error::WithoutFeatures { .. }
            | Error::NotImported { .. }
            | Error::Cancelled { .. }
            | Error::Violations { .. }
            | Error::OtherMemoryNeeds { .. }
            | Error::Recording { .. }
            | Error::BrokenPromises { .. } => Blame::Program,
        }
    }

    /// A failed Vulkan call, for `map_err`.
    pub(crate) fn vulkan(doing: &'static str) -> impl FnOnce(vk::Result) -> Error {
        move |result| match result {
            vk::Result::ERROR_DEVICE_LOST => Error::DeviceLost { doing },
            result => Error::Vulkan { doing, result },
        }
    }
}

fn uses(missing: &[UsedFeature]) -> String {
    let all: Vec<String> = missing.iter().map(|it| format!("{} ({})", it.name, escape(&it.by))).collect();
    all.join(", ")
}

fn did_you_mean(near: &Option<String>) -> String {
    near.as_ref().map_or_else(String::new, |near| format!(" (did you mean {}?)", escape(near)))
}

fn among(parts: &[(String, u64)]) -> String {
    if parts.is_empty() {
        return String::new();
    }
    let parts = parts.iter().map(|(name, bytes)| (&**name, *bytes)).collect();
    format!(" for {}", escape(&amount::largest(parts)))
}

/// Variables that lead the loader to drivers and layers, in the order of its own documentation
/// (`LoaderInterfaceArchitecture.md`, "Table of Debug Environment Variables").
const LOADER_VARIABLES: [&str; 11] = [
    "VK_DRIVER_FILES",
    "VK_ICD_FILENAMES",
    "VK_ADD_DRIVER_FILES",
    "VK_LOADER_DRIVERS_SELECT",
    "VK_LOADER_DRIVERS_DISABLE",
    "VK_LAYER_PATH",
    "VK_ADD_LAYER_PATH",
    "VK_IMPLICIT_LAYER_PATH",
    "VK_INSTANCE_LAYERS",
    "VK_LOADER_LAYERS_ENABLE",
    "VK_LOADER_LAYERS_DISABLE",
];

/// The command that unsets those of the variables above that are set, with their values and `after` behind it; nothing if none is.
fn loader_variables(after: &str) -> String {
    let value =
        |name: &&'static str| Some((*name, format!("{name}={}", escape(&std::env::var_os(name)?.to_string_lossy()))));
    let (names, values): (Vec<&str>, Vec<String>) = LOADER_VARIABLES.iter().filter_map(value).unzip();
    if names.is_empty() {
        return String::new();
    }
    format!("; or: unset {} (now {}){after}", names.join(" "), values.join(", "))
}

/// Needs of memory.
fn in_memory(needs: &MemoryNeeds) -> String {
    let MemoryNeeds { bytes, alignment, type_bits } = *needs;
    let types = (0..u32::BITS).filter(|ty| type_bits >> ty & 1 == 1).map(|ty| ty.to_string()).collect::<Vec<_>>();
    format!("{bytes} bytes, aligned to {alignment}, of the memory types {}", types.join(", "))
}

/// What to do about settings of the validation layer.
fn unset(settings: &[String]) -> String {
    match settings {
        [] => "check VK_LAYER_SETTINGS_PATH, VK_LAYER_PATH and vk_layer_settings.txt".to_owned(),
        settings => format!("take these settings back: {}", list(settings)),
    }
}

fn looked(layer_path: &Option<String>) -> String {
    layer_path.as_ref().map_or_else(String::new, |path| format!(" in VK_LAYER_PATH={}", escape(path)))
}

/// The variable by which the loader hides layers, if it is set: there may be a layer that it doesn't show.
fn disabled() -> String {
    const HIDES: &str = "VK_LOADER_LAYERS_DISABLE";
    let value = std::env::var_os(HIDES).filter(|value| !value.is_empty());
    value.map_or_else(String::new, |value| {
        format!("; or: unset {HIDES} (now {HIDES}={}), which hides layers", escape(&value.to_string_lossy()))
    })
}

fn list(texts: &[String]) -> String {
    texts.iter().map(|text| escape(text)).collect::<Vec<_>>().join("; ")
}

fn broken(promises: &[BrokenPromise]) -> String {
    promises.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

fn sentences(violations: &[Violation]) -> String {
    violations.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

fn problem_text(problem: &ShaderProblem) -> String {
    match problem {
        ShaderProblem::Missing { looked_in, known } => {
            format!("not found in {}; known shaders: {}", list(looked_in), list(known))
        }
        ShaderProblem::DoesNotCompile { messages } => {
            format!("doesn't compile: {}", list(&messages.iter().map(ToString::to_string).collect::<Vec<_>>()))
        }
        ShaderProblem::Unsupported { what } | ShaderProblem::BadModule { what } | ShaderProblem::Machine { what } => {
            format!("can't be used: {}", escape(what))
        }
        ShaderProblem::Compiler { what, help, .. } if help.is_empty() => format!("isn't compiled: {}", escape(what)),
        ShaderProblem::Compiler { what, help, .. } => format!("isn't compiled: {}; {}", escape(what), escape(help)),
        ShaderProblem::EntryPoint { file, stage, named, of_stage, .. } => {
            let named = named.as_ref().map_or_else(String::new, |named| format!(" `{}`", escape(named)));
            format!("{}: no single entry point{named} of a {stage} stage; there are: {}", escape(file), list(of_stage))
        }
    }
}
