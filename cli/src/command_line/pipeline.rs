//! A pipeline with its settings, and how its Plan is made: what many commands take.

use super::values::{Assignment, Modes, assignment, order, rotation, shader_compiler, stereo};
use clap::{Args, ValueEnum};
use framewright::ShaderCompilers;
use framewright_graph::compile::{Options, Order};
use framewright_graph::frame::Stereo;
use framewright_graph::vulkan::Rotation;
use std::path::PathBuf;

/// The heading of options that limit shaders. It stands at each of them: a heading for the next ones would hold for all that follow.
const SHADERS: &str = "Limits of shaders";
/// The heading of options about the making of a Plan.
const PLANNING: &str = "How the Plan is made, which changes no picture";

/// The use of the cache.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct CachingArguments {
    /// Compile all shaders and test the driver anew: the cache is neither read nor written. See `framewright cache`.
    #[arg(long)]
    pub(crate) no_cache: bool,
}

/// A pipeline and its settings.
#[derive(Debug, Clone, Args)]
pub(crate) struct PipelineArguments {
    /// Pipeline file; if there is none by that name, a shipped pipeline's name.
    #[arg(value_name = "PIPELINE")]
    pub(crate) file: PathBuf,
    /// Give settings the values that a preset of the pipeline has for them.
    #[arg(long, value_name = "NAME")]
    pub(crate) preset: Option<String>,
    /// Give settings the values that a settings file has for them. Repeatable; of several values for one setting the last
    /// counts. They are stronger than presets; a preset that such a file names counts if `--preset` names none.
    #[arg(long, value_name = "SETTINGS.ron")]
    pub(crate) settings: Vec<PathBuf>,
    /// Give a setting a value. Repeatable; of several values for one setting the last counts. Stronger than settings files
    /// and presets.
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub(crate) set: Vec<Assignment>,
    /// Apply an extension to the pipeline, after those that it names itself. Repeatable; later ones see what earlier ones did.
    #[arg(long, value_name = "EXTENSION.ron")]
    pub(crate) extend: Vec<PathBuf>,
    /// Folder that holds all files which the pipeline names, and the pipeline; by default the one that the pipeline lies
    /// in. Files outside of it are not read.
    #[arg(long, value_name = "DIR", conflicts_with = "allow_outside")]
    pub(crate) root: Option<PathBuf>,
    /// Read files that the pipeline names wherever they lie. For files that you trust.
    #[arg(long)]
    pub(crate) allow_outside: bool,
    /// Check shaders against what the draws of another program bring along, and custom passes against those that it records. The
    /// program writes the file: see docs/embedding.md. What is drawn is drawn by this command, without such a file.
    #[arg(long, value_name = "INTERFACE.ron")]
    pub(crate) interface: Option<PathBuf>,
    /// How to draw for two eyes what each has of its own: `off`, `multi-pass`, `double-wide`, `instanced` or `multiview`; of several
    /// with commas between them the first that the device can draw, `auto`: the fastest. Pictures of both stand side by side.
    #[arg(long, value_name = "off|auto|MODE[,MODE]", default_value = "off", value_parser = stereo)]
    pub(crate) stereo: Modes,
    /// Take compiled shaders from this folder, and add those that are compiled: for programs without a compiler. The folder must be
    /// trusted: drivers are given what it holds.
    #[arg(long, value_name = "DIR")]
    pub(crate) precompiled: Option<PathBuf>,
    /// Have shaders in HLSL, Slang or WGSL compiled by a command: `hlsl=dxc`, `"slang=slangc -O0"`, `wgsl=naga`. Repeatable. It is run
    /// without a shell. The environment may name them: `FRAMEWRIGHT_HLSL_COMPILER`, `FRAMEWRIGHT_SLANG_COMPILER`,
    /// `FRAMEWRIGHT_WGSL_COMPILER`. Docs/hlsl.md has more.
    #[arg(long, value_name = "LANGUAGE=COMMAND", value_parser = shader_compiler)]
    pub(crate) shader_compiler: Vec<ShaderCompilers>,
    #[command(flatten)]
    pub(crate) caching: CachingArguments,
    #[command(flatten)]
    pub(crate) limits: ShaderLimits,
}

impl PipelineArguments {
    /// An option that chooses something for a pipeline, if there is one. A Plan leaves nothing to choose.
    #[must_use]
    pub(crate) fn chosen(&self) -> Option<&'static str> {
        let chosen = [
            ("--set", !self.set.is_empty()),
            ("--preset", self.preset.is_some()),
            ("--settings", !self.settings.is_empty()),
            ("--extend", !self.extend.is_empty()),
            ("--interface", self.interface.is_some()),
            ("--stereo", self.stereo.0 != [Stereo::Off]),
        ];
        first(&chosen)
    }
}

/// The first option that is given.
fn first(options: &[(&'static str, bool)]) -> Option<&'static str> {
    options.iter().find(|(_, given)| *given).map(|(option, _)| *option)
}

/// Limits on compiling one stage of a shader. It happens in a process of its own, which ends where it needs more: that is a
/// mistake of the shader.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct ShaderLimits {
    /// Seconds that compiling one stage of a shader may take.
    #[arg(long, help_heading = SHADERS, value_name = "S", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=86400))]
    pub(crate) shader_seconds: u32,
    /// Memory that it may take, all of the compiling process counted (on Linux).
    #[arg(long, help_heading = SHADERS, value_name = "MIB", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(128..=1048576))]
    pub(crate) shader_memory: u32,
    /// Stack that it may take.
    #[arg(long, help_heading = SHADERS, value_name = "MIB", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub(crate) shader_stack: u32,
}

/// How a Plan is made. None of this may change a picture.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct PlanningArguments {
    /// Order of execution: the file's, the one that scores best, one that keeps little memory alive, or any.
    #[arg(long, help_heading = PLANNING, value_name = "file|default|low-memory|random:SEED", default_value = "default", value_parser = order)]
    order: Order,
    /// Do without a saving, to see what it is worth.
    #[arg(long, help_heading = PLANNING, value_name = "SAVING", value_enum)]
    naive: Option<Saving>,
    /// Use one queue, even where the device has more.
    #[arg(long, help_heading = PLANNING)]
    one_queue: bool,
    /// Fill memory that changes hands with garbage before each first use.
    #[arg(long, help_heading = PLANNING)]
    pub(crate) poison: bool,
    /// Give each image and buffer memory of its own.
    #[arg(long, help_heading = PLANNING)]
    no_alias: bool,
    /// Rotate shown outputs clockwise by this angle, for a rotated screen. Pictures are read back upright.
    #[arg(long, help_heading = PLANNING, value_name = "0|90|180|270", default_value = "0", value_parser = rotation)]
    pub(crate) rotate: Rotation,
}

impl PlanningArguments {
    /// An option that chooses how a Plan is made, if there is one.
    #[must_use]
    pub(crate) fn chosen(&self) -> Option<&'static str> {
        let usual = Options::default();
        let options = self.options();
        let chosen = [
            ("--order", options.order != usual.order),
            ("--naive", options.demote != usual.demote),
            ("--one-queue", options.queues != usual.queues),
            ("--poison", options.poison != usual.poison),
            ("--no-alias", options.alias != usual.alias),
            ("--rotate", self.rotate != Rotation::default()),
        ];
        first(&chosen)
    }

    /// The compiler's options.
    #[must_use]
    pub(crate) fn options(self) -> Options {
        Options {
            alias: !self.no_alias,
            poison: self.poison,
            readable: false,
            order: self.order,
            demote: self.naive != Some(Saving::Resolves),
            queues: !self.one_queue,
        }
    }
}

/// A saving that a Plan may do without.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Saving {
    /// Full-screen draws, which gain nothing from several samples, stay in multisampled images, so that more is resolved.
    Resolves,
}
