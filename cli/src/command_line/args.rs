//! The command line: what can be said, and what each word means.

use crate::command_line::attaching::AttachArguments;
use crate::command_line::choosing::ChooseArguments;
use crate::command_line::comparing::CompareArguments;
use crate::command_line::differing::DiffArguments;
use crate::command_line::explaining::ExplainArguments;
use crate::command_line::measuring::MeasureArguments;
use crate::command_line::merging::MergeArguments;
pub(crate) use crate::command_line::pipeline::{CachingArguments, PipelineArguments, PlanningArguments, ShaderLimits};
use crate::command_line::scenes::{DrawingDevice, DrawnScene, SceneArguments};
use crate::command_line::serving::ServeArguments;
use crate::command_line::subject::SubjectArguments;
use crate::command_line::values::{AnswerFormat, DEFAULT_SIZE, Dump, OutputFile, Size, dump, output_file};
use crate::command_line::windows::WindowArguments;
use crate::system::text;
use clap::{Args, Parser, Subcommand, ValueEnum};
use framewright_vulkan::ExecutorOptions;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A pipeline file says what a frame is made of; framewright finds out how, and draws it.
#[derive(Debug, Parser)]
#[command(name = "framewright", version, about, after_help = EXIT_CODES, disable_help_subcommand = true)]
pub(crate) struct CommandLine {
    /// The subcommand.
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXIT_CODES: &str = "Exit codes:
  0    all is well
  1    a file is wrong or missing, or a check found something
  2    the command line is wrong
  3    the environment lacks something: driver, layer, device, permission, disk
  130  interrupted by Ctrl-C";

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Read a pipeline, compile its shaders and its Plan, and verify the Plan. Needs no GPU.
    ///
    /// Passes that the settings turn off, and their shaders, are left out: check them with `--set`, or all variants at once
    /// with `--all-variants`.
    Check(CheckArguments),
    /// Print the Plan of a pipeline: its passes, scopes, resolves, memory and barriers, each with its cause. Needs no GPU.
    ///
    /// A file that ends with .json is a Plan, which is verified and shown as it is.
    Inspect(InspectArguments),
    /// Print the differences between two Plans: what another file, setting or device does to passes, resolves, barriers and memory.
    /// Needs no GPU.
    Diff(DiffArguments),
    /// Print why a pass, an image, a resolve or a barrier is in a Plan, or isn't, or what the code of a mistake means. Needs no GPU.
    ///
    /// A file that ends with .json is a Plan, which is verified first.
    Explain(ExplainArguments),
    /// Draw a scene through a pipeline.
    Run(RunArguments),
    /// Show the page of a pipeline, with the scene that it draws, in a browser of this machine. It follows every change to the files
    /// of the pipeline and the scene; settings are turned in the page.
    Serve(ServeArguments),
    /// Show the page of a program that runs, in a browser of this machine, or save the frame that it draws. Needs no GPU.
    ///
    /// The program serves the page: it says its address.
    Attach(AttachArguments),
    /// Show a scene through a pipeline in a window. It follows every change to the files of the pipeline and the scene; the mouse moves
    /// the camera, and keys turn settings.
    Window(WindowArguments),
    /// Print what the conditions of a pipeline may ask of a scene, and what decided each answer. Needs no GPU.
    Facts(FactsArguments),
    /// Print the errors of a picture beside a reference: FLIP, RMSE and others. Needs no GPU.
    Compare(CompareArguments),
    /// Measure a sweep over settings: time, memory and error of each choice beside a converged reference.
    Measure(MeasureArguments),
    /// Print the best settings under a budget, of those that were measured. Needs no GPU.
    Choose(ChooseArguments),
    /// Join the results of several sweeps in one folder. Needs no GPU.
    Merge(MergeArguments),
    /// Write a pipeline to begin with.
    New(NewArguments),
    /// Print the language of pipeline files as a JSON Schema (draft 2020-12), or a file as the JSON that the schema describes.
    Schema(SchemaArguments),
    /// List the Vulkan devices of this machine, or save the profile of one.
    Devices(DevicesArguments),
    /// Print what is kept from one call to the next: compiled shaders, and findings about drivers; or remove it.
    Cache(CacheArguments),
}

/// `framewright check`.
#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    /// Device to compile for: the name of a shipped profile, a profile file, or `all` for every shipped one.
    #[arg(long, value_name = "NAME|PROFILE.ron|all")]
    pub(crate) device: Option<OsString>,
    /// Check every combination of settings, facts of the scene that the pipeline asks for, and devices. Settings that
    /// `--set` chooses don't vary.
    #[arg(long)]
    pub(crate) all_variants: bool,
    /// Check only enough variants that every pair of values of any two settings, facts and devices occurs.
    #[arg(long, requires = "all_variants")]
    pub(crate) pairwise: bool,
    /// Variants that are checked at the same time; by default as many as there are processors.
    #[arg(long, value_name = "N", requires = "all_variants", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) planning: PlanningArguments,
    /// Size of the output in pixels.
    #[arg(long, value_name = "WxH", default_value_t = DEFAULT_SIZE)]
    pub(crate) size: Size,
    /// Upper bounds on what a frame may take: resolves, barriers, memory, bytes moved and others. A Plan beyond one is a mistake.
    #[arg(long, value_name = "BUDGET.ron")]
    pub(crate) budget: Option<PathBuf>,
    /// Form of the answer.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: CheckFormat,
}

/// Form of an answer of `check`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum CheckFormat {
    /// For people.
    #[default]
    Human,
    /// For programs.
    Json,
    /// SARIF 2.1.0, which code hosts show beside the lines.
    Sarif,
    /// JUnit's XML, which CI systems show as tests.
    Junit,
    /// Annotations of GitHub Actions.
    Github,
}

/// Where captured pictures go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CapturedPictures {
    /// Small ones on the page.
    Page,
    /// These, and whole ones as files beside it.
    Full,
}

/// `framewright inspect`.
#[derive(Debug, Args)]
pub(crate) struct InspectArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    #[command(flatten)]
    pub(crate) subject: SubjectArguments,
    /// Form of the Plan.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: PlanFormat,
    /// Draw the scene, and put every image after every pass that wrote it on the page; with `full`, also whole pictures into a folder beside
    /// it. Needs a Vulkan device, whose Plan is shown.
    #[arg(long, value_enum, num_args = 0..=1, require_equals = true, default_missing_value = "page")]
    #[arg(requires = "scene", requires = "output", conflicts_with = "device")]
    pub(crate) capture: Option<CapturedPictures>,
    /// Put a compiler on the page too: there settings, size, device and the text of the pipeline are changed, passes left out, and the
    /// differences shown.
    #[arg(long, conflicts_with = "capture")]
    pub(crate) what_if: bool,
    /// Leave the texts of the pipeline's files out of the page.
    #[arg(long, conflicts_with = "what_if")]
    pub(crate) no_sources: bool,
    /// Say the stages and accesses of each barrier too, and the bytes that each step moves.
    #[arg(long)]
    pub(crate) verbose: bool,
    /// Report that `run` wrote of the same Plan: its times are shown on the page.
    #[arg(long, value_name = "FILE.json", conflicts_with = "capture")]
    pub(crate) report: Option<PathBuf>,
    /// File to write instead of printing.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// The arguments of `run` that a Plan leaves nothing to choose of.
const SAID_BY_PLAN: [&str; 15] = [
    "preset",
    "settings",
    "set",
    "extend",
    "stereo",
    "size",
    "dump",
    "dump_all",
    "save_plan",
    "order",
    "naive",
    "one_queue",
    "no_alias",
    "rotate",
    "bisect",
];

/// `framewright run`.
#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    /// The file is no pipeline, but the JSON form of a Plan. It is verified, and executed as it is: all that it says itself
    /// can't be chosen any more. Files that it names are looked for where a pipeline's are.
    #[arg(long, conflicts_with_all = SAID_BY_PLAN)]
    pub(crate) plan: bool,
    #[command(flatten)]
    pub(crate) drawn: DrawnScene,
    /// Size of the output in pixels.
    #[arg(long, value_name = "WxH", default_value_t = DEFAULT_SIZE)]
    pub(crate) size: Size,
    /// How many times the frame is drawn; GPU times are medians over them.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) frames: u32,
    /// Picture to write: the pipeline's first output, or the one that is named, as a .png file without its alpha, or a
    /// floating-point one bit for bit as an .exr file. Repeatable. Without this none is written.
    #[arg(short, long, value_name = "[OUTPUT=]FILE.png", value_parser = output_file)]
    pub(crate) output: Vec<OutputFile>,
    /// Also write the last version of an image, resolved if it is multisampled; this may change the Plan. Repeatable.
    #[arg(long, value_name = "IMAGE=FILE.png", value_parser = dump)]
    pub(crate) dump: Vec<Dump>,
    /// Folder for every image after every pass that wrote it, in the last frame. These are drawn by Plans of their own.
    #[arg(long, value_name = "DIR")]
    pub(crate) dump_all: Option<PathBuf>,
    /// File for the Plan that is drawn, as JSON: `--plan` takes it.
    #[arg(long, value_name = "PLAN.json")]
    pub(crate) save_plan: Option<PathBuf>,
    /// Run under the validation layer, first making sure that it sees mistakes. Warnings and errors are findings.
    #[arg(long)]
    pub(crate) validate: bool,
    /// File for the report: device, memory, barriers, passes and every validation message, as JSON.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// File for a trace of the frames, which Perfetto and Chrome's trace viewer open: steps and passes by queue, recording, memory.
    #[arg(long, value_name = "TRACE.json")]
    pub(crate) trace: Option<PathBuf>,
    /// Have RenderDoc take the frame of this number, the first being 1. RenderDoc must have started this command.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) renderdoc: Option<u32>,
    /// Have each step wait for all before it, whatever its barriers say. If that changes the picture, a barrier is missing.
    #[arg(long)]
    pub(crate) full_barriers: bool,
    /// Submit each step by itself and wait for it. A device that is lost or stops is told with its step.
    #[arg(long)]
    pub(crate) step_by_step: bool,
    /// Have the device note each step that it begins. A device that is lost or stops is told with the step that it was at.
    #[arg(long)]
    pub(crate) breadcrumbs: bool,
    /// Draw every image after every pass that wrote it twice, once in this mode too, and name the first that differs.
    #[arg(long, value_enum, conflicts_with_all = ["output", "dump", "dump_all", "save_plan", "validate", "trace", "renderdoc"])]
    pub(crate) bisect: Option<DebugMode>,
    #[command(flatten)]
    pub(crate) planning: PlanningArguments,
    #[command(flatten)]
    pub(crate) device: DrawingDevice,
}

/// A way to plan or to execute that may not change a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum DebugMode {
    /// Each step waits for all before it.
    FullBarriers,
    /// Each step is submitted by itself and waited for.
    StepByStep,
    /// Memory that changes hands is filled with garbage.
    Poison,
    /// Each image and buffer has memory of its own.
    NoAlias,
    /// Passes run in the order of the file.
    FileOrder,
    /// There is one queue.
    OneQueue,
}

impl RunArguments {
    /// How Plans are executed, but for times.
    pub(crate) fn executor_options(&self) -> ExecutorOptions {
        ExecutorOptions {
            poison: self.planning.poison,
            full_barriers: self.full_barriers,
            step_by_step: self.step_by_step,
            breadcrumbs: self.breadcrumbs,
            ..ExecutorOptions::default()
        }
    }

    /// Files that are written.
    pub(crate) fn written(&self) -> impl Iterator<Item = &Path> + Clone {
        let outputs = self.output.iter().map(|output| &*output.file);
        let dumped = self.dump.iter().map(|dump| &*dump.file);
        let texts = [&self.report, &self.trace, &self.save_plan];
        outputs.chain(dumped).chain(texts.into_iter().filter_map(|file| file.as_deref()))
    }
}

/// `framewright facts`.
#[derive(Debug, Args)]
pub(crate) struct FactsArguments {
    /// Scene: a .glb or .gltf file, or a scene of our own in RON; if there is none by that name, a shipped scene's name.
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) reading: SceneArguments,
    /// Answer for programs.
    #[arg(long)]
    pub(crate) json: bool,
}

/// `framewright new`.
#[derive(Debug, Args)]
pub(crate) struct NewArguments {
    /// Name of the pipeline, perhaps behind a folder: letters, digits, `_` and `-`. The file is NAME.ron, and there must be none
    /// yet.
    #[arg(value_name = "NAME")]
    pub(crate) name: PathBuf,
}

/// `framewright schema`.
#[derive(Debug, Args)]
pub(crate) struct SchemaArguments {
    /// File to print as JSON: a pipeline, a file of fragments or a settings file.
    #[arg(value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
}

/// `framewright devices`.
#[derive(Debug, Args)]
pub(crate) struct DevicesArguments {
    /// File for the profile of a device, with the memory needs of the usual images: `--device` of `check` and `inspect`
    /// takes it where the device is not.
    #[arg(long, value_name = "PROFILE.ron")]
    pub(crate) save: Option<PathBuf>,
    /// Device whose profile is saved: its number or name in this list, or a part of its name.
    #[arg(long, value_name = "NAME|INDEX", requires = "save")]
    pub(crate) device: Option<OsString>,
    /// Form of the list.
    #[arg(long, value_enum, default_value_t, conflicts_with = "save")]
    pub(crate) format: AnswerFormat,
    #[command(flatten)]
    pub(crate) caching: CachingArguments,
}

/// `framewright cache`.
#[derive(Debug, Args)]
pub(crate) struct CacheArguments {
    /// Remove all of it.
    #[arg(long)]
    pub(crate) clear: bool,
    /// Form of the answer.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: AnswerFormat,
}

/// Form of a Plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum PlanFormat {
    /// For people.
    #[default]
    Tree,
    /// For programs, and for replay.
    Json,
    /// A graph in Graphviz's language.
    Dot,
    /// A graph in Mermaid's language, for Markdown.
    Mermaid,
    /// A graph as a picture.
    Svg,
    /// A page to explore, in one file.
    Html,
}

/// Reads the command line.
///
/// # Errors
/// clap's message, with what the user typed escaped. Help and version are such "errors" too.
pub(crate) fn parse(arguments: impl Iterator<Item = OsString>) -> Result<CommandLine, clap::Error> {
    let arguments: Vec<OsString> = arguments.collect();
    let result = CommandLine::try_parse_from(&arguments).and_then(agree);
    result.map_err(|error| {
        // clap repeats arguments as they are. Asked again with escaped ones, it repeats those.
        let escaped = arguments.iter().map(|argument| text::escape(&argument.to_string_lossy()));
        CommandLine::try_parse_from(escaped).and_then(agree).err().unwrap_or(error)
    })
}

/// Checks what no single argument shows: images dumped twice, files written twice, a stack that memory doesn't hold.
fn agree(line: CommandLine) -> Result<CommandLine, clap::Error> {
    let conflict = |message: String| {
        Err(<CommandLine as clap::CommandFactory>::command().error(clap::error::ErrorKind::ArgumentConflict, message))
    };
    if let Command::Run(run) = &line.command {
        if let Some(image) = twice(run.dump.iter().map(|dump| &dump.image)) {
            return conflict(format!("the image `{}` is dumped twice", text::escape(image)));
        }
        if let Some(frame) = run.renderdoc.filter(|frame| *frame > run.frames) {
            return conflict(format!("`--renderdoc` asks for frame {frame}, and `--frames` draws {}", run.frames));
        }
        if let Some(file) = twice(run.written()) {
            return conflict(format!("`{}` would be written twice", text::path(file)));
        }
    }
    let Some((pipeline, drawn)) = line.command.pipeline() else { return Ok(line) };
    if let (Some(by), Some(_)) = (drawn, &pipeline.interface) {
        return conflict(format!(
            "{by} scenes of the command's own, which bring along what its shaders know: `--interface` is for `check`, `inspect`, \
             `diff` and `explain`, which draw nothing"
        ));
    }
    let ShaderLimits { shader_memory, shader_stack, .. } = pipeline.limits;
    if shader_stack + BESIDE_STACK > shader_memory {
        return conflict(format!(
            "`--shader-stack` ({shader_stack} MiB) is a part of `--shader-memory` ({shader_memory} MiB), and must leave at \
             least {BESIDE_STACK} MiB of it"
        ));
    }
    Ok(line)
}

impl Command {
    /// The arguments of its pipeline, if it takes one. If it draws the pipeline, also the words "X draws", with which the sentence
    /// begins that refuses `--interface`.
    fn pipeline(&self) -> Option<(&PipelineArguments, Option<&'static str>)> {
        Some(match self {
            Command::Check(check) => (&check.pipeline, None),
            Command::Inspect(inspect) => (&inspect.pipeline, inspect.capture.map(|_| "`--capture` draws")),
            Command::Diff(diff) => (&diff.pipeline, None),
            Command::Explain(ExplainArguments::Thing(thing)) => (&thing.pipeline, None),
            Command::Run(run) => (&run.pipeline, Some("`run` draws")),
            Command::Serve(serve) => (&serve.pipeline, Some("`serve` draws")),
            Command::Window(window) => (&window.pipeline, Some("`window` draws")),
            Command::Measure(measure) => (&measure.pipeline, Some("`measure` draws")),
            _ => return None,
        })
    }
}

/// MiB of memory that a process needs beside its stack to compile a usual shader.
const BESIDE_STACK: u32 = 64;

fn twice<'a, T: PartialEq + 'a + ?Sized>(items: impl Iterator<Item = &'a T> + Clone) -> Option<&'a T> {
    let mut rest = items;
    while let Some(item) = rest.next() {
        if rest.clone().any(|other| other == item) {
            return Some(item);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;
    use framewright_graph::compile::{Options, Order};

    fn read(arguments: &[&str]) -> Result<CommandLine, String> {
        let all = std::iter::once("framewright").chain(arguments.iter().copied()).map(OsString::from);
        parse(all).map_err(|error| error.to_string())
    }

    #[test]
    fn what_is_said_of_a_plan_reaches_the_compiler() {
        let options = |words: &[&str]| {
            let Ok(CommandLine { command: Command::Check(check) }) = read(&[&["check", "a.ron"], words].concat())
            else {
                panic!("{words:?} is right");
            };
            check.planning.options()
        };
        assert_eq!(options(&[]), Options::default());
        assert_eq!(options(&["--order", "random:3"]), Options { order: Order::Random(3), ..Options::default() });
        assert_eq!(options(&["--naive", "resolves"]), Options { demote: false, ..Options::default() });
        assert_eq!(options(&["--one-queue"]), Options { queues: false, ..Options::default() });
        let both = Options { poison: true, alias: false, ..Options::default() };
        assert_eq!(options(&["--poison", "--no-alias"]), both);
    }

    /// A heading for the next options holds for all that follow, so an option may end up under another's.
    #[test]
    fn each_option_stands_under_its_own_heading_in_the_help_of_every_command() {
        let limits = ["max_flip", "max_rmse", "max_error", "max_relative_mse", "min_psnr", "min_ssim"];
        let own = |command: &str, option: &str| match option {
            "shader_seconds" | "shader_memory" | "shader_stack" => Some("Limits of shaders"),
            "order" | "naive" | "one_queue" | "poison" | "no_alias" | "rotate" => Some("How the Plan is made"),
            limit if limits.contains(&limit) || limit.starts_with("max_") => {
                Some(if command == "choose" { "Limits, of which at least one" } else { "Limits; beyond one" })
            }
            _ => None,
        };
        let mut command = CommandLine::command();
        command.build();
        for command in command.get_subcommands() {
            for option in command.get_arguments().filter(|option| option.get_long().is_some()) {
                let (id, heading) = (option.get_id().as_str(), option.get_help_heading());
                let expected = own(command.get_name(), id);
                let is_own = heading.zip(expected).is_some_and(|(found, own)| found.starts_with(own));
                assert!(is_own || heading == expected, "{} --{id}: {heading:?}", command.get_name());
            }
        }
    }

    #[test]
    fn control_characters_in_arguments_are_shown_escaped() {
        let message = read(&["check", "a.ron", "--format", "\u{1b}[31mred\n"]).expect_err("not a format");
        assert!(message.contains("'\\u{1b}[31mred\\n'"), "{message}");
        let run = ["run", "a.ron", "--scene", "s.ron", "--dump", "\u{7}=a.png", "--dump", "\u{7}=b.png"];
        let message = read(&run).expect_err("twice");
        assert!(message.contains("the image `\\u{7}` is dumped twice"), "{message}");
        assert!(!message.contains('\u{7}'), "{message:?}");
    }

    #[test]
    fn the_stack_of_shaders_leaves_some_of_their_memory() {
        let drawn = ["run", "window"].map(|command| [command, "a.ron", "--scene", "s.ron"]);
        for words in [&["check", "a.ron"][..], &["inspect", "a.ron"], &["explain", "a.ron", "x"], &drawn[0], &drawn[1]]
        {
            let stack = |stack: &str| read(&[words, &["--shader-memory", "256", "--shader-stack", stack]].concat());
            for large in ["193", "256", "257"] {
                let message = stack(large).expect_err("too large");
                let said = format!("`--shader-stack` ({large} MiB) is a part of `--shader-memory` (256 MiB)");
                assert!(message.contains(&said), "{message}");
            }
            assert!(stack("192").is_ok());
        }
    }

    #[test]
    fn nothing_is_written_twice() {
        let run = ["run", "a.ron", "--scene", "s.ron", "-o", "x.png", "--dump", "depth=x.png"];
        assert!(read(&run).expect_err("twice").contains("`x.png` would be written twice"));
    }

    #[test]
    fn pictures_are_png_or_openexr() {
        let run = ["run", "a.ron", "--scene", "s.ron", "-o", "x.jpg"];
        assert!(read(&run).expect_err("neither").contains("must end in .png or .exr"));
    }
}
