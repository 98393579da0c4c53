//! The command line: what can be said, and what each word means.

use crate::text;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;

/// Width and height of the output where the command line says none, in pixels.
pub(crate) const DEFAULT_SIZE: Size = Size { width: 1280, height: 720 };

/// Largest width or height that the command line takes, in pixels.
pub(crate) const MAX_SIZE: u32 = 16384;

/// A pipeline file says what a frame is made of; framewright finds out how, and draws it.
#[derive(Debug, Parser)]
#[command(name = "framewright", version, about, after_help = EXIT_CODES, disable_help_subcommand = true)]
pub(crate) struct CommandLine {
    /// What to do.
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
    /// Passes that the settings turn off, and their shaders, are left out: check them with `--set`.
    Check(Check),
    /// Print the Plan of a pipeline: its passes, scopes, resolves, memory and barriers, each with its cause. Needs no GPU.
    Inspect(Inspect),
    /// Draw a scene through a pipeline.
    Run(Run),
    /// List the Vulkan devices of this machine.
    Devices(Devices),
}

/// `framewright check`.
#[derive(Debug, Args)]
pub(crate) struct Check {
    /// Pipeline and settings.
    #[command(flatten)]
    pub(crate) pipeline: Pipeline,
    /// Device to compile for: the name of a shipped profile, or a profile file.
    #[arg(long, value_name = "NAME|PROFILE.ron")]
    pub(crate) device: Option<OsString>,
    /// Form of the answer.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: CheckFormat,
}

/// `framewright inspect`.
#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// Pipeline and settings.
    #[command(flatten)]
    pub(crate) pipeline: Pipeline,
    /// Scene whose facts conditions see; without one they see a scene that holds everything.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: Option<PathBuf>,
    /// Size of the output in pixels.
    #[arg(long, value_name = "WxH", default_value_t = DEFAULT_SIZE)]
    pub(crate) size: Size,
    /// Device to compile for: the name of a shipped profile, or a profile file.
    #[arg(long, value_name = "NAME|PROFILE.ron")]
    pub(crate) device: Option<OsString>,
    /// Debug switches.
    #[command(flatten)]
    pub(crate) debug: Debug,
    /// Form of the Plan.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: PlanFormat,
    /// File to write instead of printing.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// `framewright run`.
#[derive(Debug, Args)]
pub(crate) struct Run {
    /// Pipeline and settings.
    #[command(flatten)]
    pub(crate) pipeline: Pipeline,
    /// Scene to draw: a .glb file, or a scene of our own in RON.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    /// Size of the output in pixels.
    #[arg(long, value_name = "WxH", default_value_t = DEFAULT_SIZE)]
    pub(crate) size: Size,
    /// How many times the frame is drawn; GPU times are medians over them.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) frames: u32,
    /// Picture to write: the pipeline's first output, without its alpha. Without this none is written.
    #[arg(short, long, value_name = "OUT.png", value_parser = picture)]
    pub(crate) output: Option<PathBuf>,
    /// Also write the last version of an image, resolved if it is multisampled; this may change the Plan. Repeatable.
    #[arg(long, value_name = "IMAGE=FILE.png", value_parser = dump)]
    pub(crate) dump: Vec<Dump>,
    /// Run under the validation layer, first making sure that it sees mistakes. Warnings and errors are findings.
    #[arg(long)]
    pub(crate) validate: bool,
    /// File for the report: device, memory, barriers, passes and every validation message, as JSON.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Debug switches.
    #[command(flatten)]
    pub(crate) debug: Debug,
    /// Device to draw on: its number or name in `framewright devices`, or a part of its name.
    #[arg(long, value_name = "NAME|INDEX")]
    pub(crate) device: Option<OsString>,
}

/// `framewright devices`.
#[derive(Debug, Args)]
pub(crate) struct Devices {
    /// Form of the list.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: CheckFormat,
}

/// A pipeline and its settings.
#[derive(Debug, Args)]
pub(crate) struct Pipeline {
    /// Pipeline file; if there is none by that name, a shipped pipeline's name.
    #[arg(value_name = "PIPELINE")]
    pub(crate) file: PathBuf,
    /// Give a setting a value. Repeatable; of several values for one setting the last counts.
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub(crate) set: Vec<Assignment>,
}

/// Switches that must not change a picture.
#[derive(Debug, Args)]
pub(crate) struct Debug {
    /// Fill memory that changes hands with garbage before each first use.
    #[arg(long)]
    pub(crate) poison: bool,
    /// Give each image memory of its own.
    #[arg(long)]
    pub(crate) no_alias: bool,
}

/// Form of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum CheckFormat {
    /// For people.
    #[default]
    Human,
    /// For programs.
    Json,
}

/// Form of a Plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum PlanFormat {
    /// For people.
    #[default]
    Tree,
    /// For programs, and for replay.
    Json,
}

/// Width and height in pixels, each 1…[`MAX_SIZE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    /// Width.
    pub(crate) width: u32,
    /// Height.
    pub(crate) height: u32,
}

/// `NAME=VALUE`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Assignment {
    /// The setting.
    pub(crate) name: String,
    /// Its value, not yet read.
    pub(crate) value: String,
}

/// `IMAGE=FILE.png`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Dump {
    /// The image's name in the pipeline.
    pub(crate) image: String,
    /// The file.
    pub(crate) file: PathBuf,
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

impl std::str::FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Size, String> {
        let (width, height) = text.split_once(['x', 'X']).ok_or("expected WIDTHxHEIGHT, such as 1280x720")?;
        let side = |name: &str, digits: &str| {
            if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
                return Err("expected WIDTHxHEIGHT, such as 1280x720".to_owned());
            }
            match digits.parse::<u32>() {
                Ok(pixels @ 1..=MAX_SIZE) => Ok(pixels),
                _ => Err(format!("the {name} must be 1 to {MAX_SIZE} pixels")),
            }
        };
        Ok(Size { width: side("width", width)?, height: side("height", height)? })
    }
}

fn assignment(text: &str) -> Result<Assignment, String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok(Assignment { name: name.to_owned(), value: value.to_owned() }),
        _ => Err("expected NAME=VALUE, such as msaa=4".to_owned()),
    }
}

fn dump(text: &str) -> Result<Dump, String> {
    match text.split_once('=') {
        Some((image, file)) if !image.is_empty() => Ok(Dump { image: image.to_owned(), file: picture(file)? }),
        _ => Err("expected IMAGE=FILE.png, such as depth=depth.png".to_owned()),
    }
}

fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("png") => Ok(path),
        _ => Err("pictures are written as PNG: the file's name must end in .png".to_owned()),
    }
}

/// Reads the command line.
///
/// # Errors
/// What clap says, with what the user typed escaped. Help and version are such "errors" too.
pub(crate) fn parse(arguments: impl Iterator<Item = OsString>) -> Result<CommandLine, clap::Error> {
    let arguments: Vec<OsString> = arguments.collect();
    let result = CommandLine::try_parse_from(&arguments).and_then(agree);
    result.map_err(|error| {
        // clap repeats arguments as they are. Asked again with escaped ones, it repeats those.
        let escaped = arguments.iter().map(|argument| text::escape(&argument.to_string_lossy()));
        CommandLine::try_parse_from(escaped).and_then(agree).err().unwrap_or(error)
    })
}

/// What no single argument shows: images dumped twice, files written twice.
fn agree(line: CommandLine) -> Result<CommandLine, clap::Error> {
    let conflict = |message: String| {
        Err(<CommandLine as clap::CommandFactory>::command().error(clap::error::ErrorKind::ArgumentConflict, message))
    };
    if let Command::Run(run) = &line.command {
        if let Some(image) = twice(run.dump.iter().map(|dump| &dump.image)) {
            return conflict(format!("the image `{}` is dumped twice", text::escape(image)));
        }
        let files = run.output.iter().chain(run.dump.iter().map(|dump| &dump.file)).chain(&run.report);
        if let Some(file) = twice(files) {
            return conflict(format!("`{}` would be written twice", text::path(file)));
        }
    }
    Ok(line)
}

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

    fn read(arguments: &[&str]) -> Result<CommandLine, String> {
        let all = std::iter::once("framewright").chain(arguments.iter().copied()).map(OsString::from);
        parse(all).map_err(|error| error.to_string())
    }

    #[test]
    fn a_size_is_two_numbers_within_limits() {
        assert_eq!("640x480".parse(), Ok(Size { width: 640, height: 480 }));
        assert_eq!("16384x1".parse(), Ok(Size { width: 16384, height: 1 }));
        for wrong in ["", "640", "640x", "x480", "-1x480", "+1x480", "6 40x480", "640x480x1"] {
            assert_eq!(wrong.parse::<Size>(), Err("expected WIDTHxHEIGHT, such as 1280x720".to_owned()), "{wrong}");
        }
        assert_eq!("0x480".parse::<Size>(), Err("the width must be 1 to 16384 pixels".to_owned()));
        assert_eq!("640x16385".parse::<Size>(), Err("the height must be 1 to 16384 pixels".to_owned()));
        assert_eq!("1x99999999999999999999".parse::<Size>(), Err("the height must be 1 to 16384 pixels".to_owned()));
    }

    #[test]
    fn a_value_may_hold_an_equals_sign() {
        assert_eq!(assignment("name=a=b"), Ok(Assignment { name: "name".to_owned(), value: "a=b".to_owned() }));
        assert!(assignment("=4").is_err());
        assert!(assignment("msaa").is_err());
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
    fn nothing_is_written_twice() {
        let run = ["run", "a.ron", "--scene", "s.ron", "-o", "x.png", "--dump", "depth=x.png"];
        assert!(read(&run).expect_err("twice").contains("`x.png` would be written twice"));
    }

    #[test]
    fn pictures_are_png() {
        let run = ["run", "a.ron", "--scene", "s.ron", "-o", "x.jpg"];
        assert!(read(&run).expect_err("not a PNG").contains("must end in .png"));
    }
}
