//! The errors that end a command early.

use crate::command_line::options;
use crate::system::{Exit, links, text};
use framewright_graph::base;
use framewright_graph::base::{Diagnostic, NoText, Sources, for_shell, is_of_machine};
use framewright_graph::shader::ShaderProblem;
use framewright_graph::vulkan::Format;
use framewright_lab::Error as LabError;
use framewright_lab::results::{JoiningProblem, ResultsProblem};
use framewright_passes::scene::SceneError;
use framewright_vulkan::Blame;
use std::io;
use std::path::{Path, PathBuf};

/// An error that ends a command early.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Error {
    /// A file is missing, and nothing shipped has its name.
    #[error(
        "there is no {what} `{}`, and none of that name is shipped (shipped: {}){}",
        text::path(path),
        shipped.join(", "),
        with_ending(path)
    )]
    Missing { what: &'static str, path: PathBuf, shipped: Vec<&'static str> },
    /// A file can't be read.
    #[error("the {what} `{}` can't be read: {}{}", text::path(path), text::escape(&source.to_string()), allow(source, path))]
    Read { what: &'static str, path: PathBuf, source: io::Error },
    /// A file is larger than anything that a person writes.
    #[error("the {what} `{}` is larger than {}", text::path(path), text::bytes(*limit))]
    TooLarge { what: &'static str, path: PathBuf, limit: u64 },
    /// A file isn't text.
    #[error("the {what} `{}` is not text: {}", text::path(path), why.brief())]
    NotText { what: &'static str, path: PathBuf, why: NoText },
    /// The pipeline lies outside the folder that `--root` names.
    #[error(
        "`{}` lies outside of `{}`, which `--root` names: name a folder that the pipeline lies in",
        text::path(pipeline),
        text::path(root)
    )]
    OutsideRoot { pipeline: PathBuf, root: PathBuf },
    /// The pipeline is wrong, or what the command line asks of it.
    #[error("{}", base::render(&mistakes.sources, &mistakes.diagnostics))]
    Mistakes { mistakes: Box<Mistakes> },
    /// The scene is wrong.
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// The scene has mistakes, and none is passed over.
    #[error("`{}` has mistakes, and `--strict` passes over none:\n  {}", text::path(path), text::escape_lines(&mistakes.join("\n  ")))]
    SceneMistakes { path: PathBuf, mistakes: Vec<String> },
    /// Another error of the library that this command is made of.
    #[error("{}", text::escape_lines(&.0.to_string()))]
    Library(Box<framewright::Error>),
    /// A device profile is wrong.
    #[error("{}:{}", text::path(path), text::escape(&problem.to_string()))]
    Profile { path: PathBuf, problem: framewright_graph::device::ProfileError },
    /// `--device` names no profile.
    #[error("there is no device profile `{}`: give the file of one, or one that is shipped ({})", text::escape(name), shipped.join(", "))]
    UnknownProfile { name: String, shipped: Vec<&'static str> },
    /// There are more pairs of values than can be covered.
    #[error(
        "there are {pairs} pairs of values, and at most {most} are covered\nhelp: choose settings by `--set`: those don't vary"
    )]
    TooManyPairs { pairs: usize, most: usize },
    /// A profile was given where a device is needed.
    #[error(
        "`{}` is a device profile, and a device is needed here: name one (`framewright devices` lists them)",
        text::escape(name)
    )]
    ProfileIsNoDevice { name: String },
    /// An error of Vulkan, a shader or a draw source.
    #[error("{}{}", text::escape_lines(&.0.to_string()), remedy(.0))]
    Vulkan(#[from] framewright_vulkan::Error),
    /// No window can be opened.
    #[error(
        "no window can be opened: {}\nhelp: `DISPLAY` or `WAYLAND_DISPLAY` names the screen; without one, `xvfb-run framewright window …` shows it to nobody, and `framewright run` writes pictures",
        text::escape(reason)
    )]
    NoWindow { reason: String },
    /// RenderDoc isn't in this process.
    #[error(
        "RenderDoc isn't loaded: it starts the programs that it looks into\n\
         help: renderdoccmd capture --wait-for-exit --working-dir . framewright run …; Debian has it in renderdoccmd and librenderdoc"
    )]
    NoRenderDoc,
    /// RenderDoc took nothing.
    #[error("RenderDoc took nothing of frame {frame}: it isn't in the way to this device, or can't replay it")]
    NothingTaken { frame: u32 },
    /// A library of the window system is missing.
    #[error(
        "no window can be opened: a library is missing, which Debian has in {}\nhelp: apt-get install {}, or what has it on another system",
        packages.join(" or "),
        packages.join(" ")
    )]
    NoWindowLibrary { packages: &'static [&'static str] },
    /// An error of comparing or measuring.
    #[error("{0}")]
    Lab(LabError),
    /// A folder holds results of something else.
    #[error(
        "`{}` holds results of another sweep: `{field}` is {} there, and {} here\nhelp: name another folder",
        text::path(folder),
        text::escape(&values[0]),
        text::escape(&values[1])
    )]
    OtherSweep { folder: PathBuf, field: &'static str, values: Box<[String; 2]> },
    /// Another process measures into the same folder.
    #[error(
        "another process measures into `{}`\nhelp: wait until it ends, or name another folder; `framewright merge` joins folders",
        text::path(folder)
    )]
    Held { folder: PathBuf },
    /// A file of results that is none.
    #[error("`{}` {}", text::path(path), text::escape_lines(&problem.to_string()))]
    Results { path: PathBuf, problem: ResultsProblem },
    /// Results that can't be joined.
    #[error("{0}")]
    Joining(#[from] JoiningProblem),
    /// Results without flicker are asked for it.
    #[error(
        "the results in `{}` have no flicker, which `--max-flicker` limits\nhelp: measure it: `framewright measure … --flicker 16`",
        text::path(folder)
    )]
    NoFlicker { folder: PathBuf },
    /// Ratios are asked for where there is nothing that they are relative to.
    #[error(
        "`--max-ratio` holds times against those of the settings of the baseline ({}), which were not measured with {}\nhelp: measure them too, as a value of the sweep",
        text::escape(baseline),
        text::escape(group)
    )]
    NoBaseline { baseline: String, group: String },
    /// A file is no Plan, or not a right one.
    #[error("{}: {}", text::path(path), text::escape_lines(problem))]
    NoPlan { path: PathBuf, problem: String },
    /// A file is no report of a run, or not one of this Plan.
    #[error("{}: {}", text::path(path), text::escape_lines(problem))]
    NoReport { path: PathBuf, problem: String },
    /// The Plan doesn't know what is to be explained.
    #[error("there is no `{}` in the Plan{}", text::escape(thing), help.as_ref().map_or_else(String::new, |help| format!("\nhelp: {help}")))]
    NothingToExplain { thing: String, help: Option<String> },
    /// There is no such code.
    #[error("there is no code `{}`{}", text::escape(code), help.as_ref().map_or_else(String::new, |help| format!("\nhelp: {help}")))]
    UnknownCode { code: String, help: Option<String> },
    /// A pass that no scene draws.
    #[error(
        "nobody records `{}`, which the custom pass `{}` asks for\nhelp: the program that draws the pipeline records it; `framewright check --interface` checks a pipeline for such a program",
        text::escape(name),
        text::escape(pass)
    )]
    CustomPass { pass: String, name: String },
    /// What the option is about has no place but a page.
    #[error("`{option}` is about a page: add `--format html`")]
    WithoutPage { option: &'static str },
    /// The compiler for pages is missing.
    #[error(
        "the compiler that a page carries isn't there: neither `{}`\nhelp: in a checkout .ci/what-if.sh makes it; an archive of a release has it beside the command",
        places.iter().map(|place| text::path(place)).collect::<Vec<_>>().join("` nor `")
    )]
    NoModule { places: Vec<PathBuf> },
    /// The compiler for pages is something else.
    #[error("the file what-if.wasm is no compiler for pages\nhelp: in a checkout .ci/what-if.sh makes it anew")]
    BadModule,
    /// A graph that no picture can hold.
    #[error(
        "a picture of {nodes} passes can't be read: at most {most} are drawn; --format dot or json holds any number"
    )]
    TooManyNodes { nodes: usize, most: usize },
    /// A choice for a Plan that is made already.
    #[error("{option} chooses something for `{}`, which is a Plan: choices are for pipelines", text::path(path))]
    ChoiceForPlan { option: &'static str, path: PathBuf },
    /// A choice for one of two Plans that none can be made of.
    #[error("{option} {}: {}", text::escape(name), text::escape(problem))]
    OwnChoice { option: &'static str, name: String, problem: String },
    /// A picture of results lies elsewhere.
    #[error(
        "the picture `{}` lies outside of `{}`: a link leads there, and is not followed",
        text::path(path),
        text::path(folder)
    )]
    OutsideResults { path: PathBuf, folder: PathBuf },
    /// A folder holds results that would be lost.
    #[error(
        "`{}` holds other results, which would be lost\nhelp: join them too, and write to a new folder",
        text::path(folder)
    )]
    OtherResults { folder: PathBuf },
    /// A result that has no CSV form.
    #[error("the result has no CSV form: {0}")]
    Csv(#[from] csv::Error),
    /// A picture that its kind of file can't hold.
    #[error(
        "`{}` is {format}, and OpenEXR files hold floating-point numbers and integers: write it to a .png file",
        text::escape(image)
    )]
    NotFloats { image: String, format: Format },
    /// The program can't start itself anew.
    #[error("framewright can't start itself anew under the current validation layer: {}\nhelp: set VK_LAYER_PATH to the layer's folder", text::escape(&.0.to_string()))]
    Restart(io::Error),
    /// The program can't be its own helper.
    #[error("framewright doesn't find itself, to compile shaders in a process of their own: {}", text::escape(&.0.to_string()))]
    Helper(io::Error),
    /// Ctrl-C.
    #[error("interrupted after {frames} of {wanted} frames: nothing was written")]
    Interrupted { frames: u32, wanted: u32 },
    /// Ctrl-C while choices are measured.
    #[error(
        "interrupted after {measured} of {wanted} choices; those are kept, and the same command goes on with the others"
    )]
    InterruptedMeasuring { measured: usize, wanted: usize },
    /// Ctrl-C while a pipe is written.
    #[error("interrupted before all of `{}` was written", text::path(path))]
    InterruptedWriting { path: PathBuf },
    /// A Plan that breaks its own rules: the compiler is at fault, not the user.
    #[error("the Plan breaks its own rules, which is a mistake of framewright itself:\n  {}", violations.join("\n  "))]
    Violations {
        /// The violations that `verify` found, escaped.
        violations: Vec<String>,
    },
    /// The device can't draw for two eyes as was asked.
    #[error(
        "{why}\nhelp: `--stereo auto` takes the fastest way that it has; several, as `--stereo multiview,double-wide`, the first"
    )]
    Stereo { why: String },
    /// The environment names a compiler of shaders that can't be one.
    #[error("{}", text::escape(what))]
    ShaderCompiler { what: String },
    /// A picture was asked for of something that is none.
    #[error(
        "`{}` is a buffer, and only images become pictures: leave out `-o`, or dump an image",
        text::escape(output)
    )]
    NoPicture { output: String },
    /// A picture was asked for of something that doesn't leave the frame.
    #[error("{}", no_output(name, outputs, *image))]
    NoOutput { name: String, outputs: Vec<String>, image: bool },
    /// A profile that has no text form.
    #[error("the profile has no text form: {}", text::escape(.0))]
    Unwritable(String),
    /// A result that has no text form.
    #[error("the result has no JSON form: {0}")]
    Json(#[from] serde_json::Error),
    /// A Plan that has no JSON form.
    #[error("{}", text::escape_lines(&.0.to_string()))]
    Plan(#[from] framewright_graph::plan::PlanError),
    /// A file can't be written.
    #[error("`{}` can't be written: {}{}", text::path(path), text::escape(&source.to_string()), mend(source, Some(path)))]
    Write { path: PathBuf, source: io::Error },
    /// A file stands where a folder is wanted.
    #[error(
        "`{}` can't be written: it is a file, and a folder is wanted\nhelp: name another folder, or move the file away",
        text::path(path)
    )]
    NoFolder { path: PathBuf },
    /// A file would be written over one that is read.
    #[error("`{}` is {what}, which would be lost: name another file to write", text::path(path))]
    ReadAndWritten {
        /// Its role as an input.
        what: &'static str,
        /// The file, as it was named for writing.
        path: PathBuf,
    },
    /// Two names for files that are written lead to the same.
    #[error("`{}` would be written twice: another name leads to the same file", text::path(path))]
    WrittenTwice {
        /// The file, by its later name.
        path: PathBuf,
    },
    /// A file that is to be new is there already.
    #[error("there is a file `{}` already: choose another name, or move it away", text::path(path))]
    AlreadyExists { path: PathBuf },
    /// A name that no pipeline may have.
    #[error(
        "`{}` can't be the name of a pipeline: names are letters, digits, `_` and `-`, begin with a letter or `_`, and have at most 64 bytes",
        text::path(path)
    )]
    NoName { path: PathBuf },
    /// The cache can't be read or cleared.
    #[error("the cache `{}` can't be {done}: {}\nhelp: remove that folder, or name another one by the variable XDG_CACHE_HOME", text::path(folder), text::escape(&source.to_string()))]
    Cache { folder: PathBuf, done: &'static str, source: io::Error },
    /// The page can't be served at the port.
    #[error("the port {port} of 127.0.0.1 can't be used: {}\nhelp: name another one by `--port`; 0 takes any that is free", text::escape(&source.to_string()))]
    Port { port: u16, source: io::Error },
    /// What should lead to a viewer is no address of one.
    #[error("`{}` is no address of a viewer: {why}", text::escape(address))]
    ViewerAddress { address: String, why: String },
    /// No viewer answers at an address.
    #[error(
        "no viewer answers at {}: {}\nhelp: the program prints its whole address, a part of which is secret; it must run, and a tunnel to another machine be open: `ssh -L 7117:127.0.0.1:7117 MACHINE`",
        text::escape(url),
        text::escape(why)
    )]
    NoViewer { url: String, why: String },
    /// Standard output can't be written.
    #[error("standard output can't be written: {}{}", text::escape(&.0.to_string()), mend(.0, None))]
    Print(io::Error),
}

/// The mistakes of a pipeline.
#[derive(Debug)]
pub(crate) struct Mistakes {
    /// The texts that the mistakes point into.
    pub(crate) sources: Sources,
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// How the command ends: the files are wrong, the command line is, or files can't be read.
    pub(crate) exit: Exit,
}

impl From<framewright::Error> for Error {
    fn from(error: framewright::Error) -> Error {
        use framewright::Error as Face;
        match error {
            Face::Missing { what, path, shipped } => Error::Missing { what, path, shipped },
            Face::Unreadable { what, path, source } => Error::Read { what, path, source },
            Face::TooLarge { what, path, limit } => Error::TooLarge { what, path, limit },
            Face::NotText { what, path, why } => Error::NotText { what, path, why },
            Face::OutsideRoot { pipeline, root } => Error::OutsideRoot { pipeline, root },
            Face::Mistakes { mistakes } => {
                let exit = if mistakes.of_choices { Exit::Usage } else { Exit::Found };
                Error::mistakes(mistakes.sources, mistakes.diagnostics, exit)
            }
            Face::Scene(problem) => Error::Scene(problem),
            Face::Stereo { why } => Error::Stereo { why },
            Face::CustomPass { pass, name } => Error::CustomPass { pass, name },
            Face::Vulkan(framewright_vulkan::Error::Violations { violations }) => {
                Error::Violations { violations: violations.iter().map(|one| text::escape(&one.to_string())).collect() }
            }
            Face::Vulkan(problem) => Error::Vulkan(problem),
            other => Error::Library(Box::new(other)),
        }
    }
}

impl From<LabError> for Error {
    fn from(error: LabError) -> Error {
        match error {
            LabError::Framewright(error) => error.into(),
            LabError::Stopped { drawn, wanted } => Error::Interrupted { frames: drawn, wanted },
            LabError::Json(error) => Error::Json(error),
            LabError::Program(error) => match error.downcast::<Error>() {
                Ok(own) => *own,
                Err(other) => Error::Lab(LabError::Program(other)),
            },
            other => Error::Lab(other),
        }
    }
}

impl Error {
    /// Mistakes of a pipeline, or of what the command line asks of it, with the options that mend them.
    pub(crate) fn mistakes(sources: Sources, diagnostics: Vec<Diagnostic>, exit: Exit) -> Error {
        Error::Mistakes { mistakes: Box::new(Mistakes { sources, diagnostics: options::named(diagnostics), exit }) }
    }

    /// The text to print: the first line ends with the code. Mistakes of a pipeline have headings and codes of their own.
    #[must_use]
    pub(crate) fn shown(&self) -> String {
        let text = self.to_string();
        let Some(code) = self.code() else { return text.trim_end().to_owned() };
        match text.split_once('\n') {
            Some((first, more)) => format!("error: {first} [{code}]\n{more}"),
            None => format!("error: {text} [{code}]"),
        }
    }

    /// Whether it is about the pipeline, or what the command line asks of it.
    #[must_use]
    pub(crate) fn is_about_the_pipeline(&self) -> bool {
        matches!(self, Error::Mistakes { .. })
    }

    /// Whether a change to files, or another choice, may mend it while the program goes on.
    #[must_use]
    pub(crate) fn can_be_mended_in_files(&self) -> bool {
        use framewright_vulkan::Error::{DeviceLost, Timeout};
        !matches!(
            self,
            Error::Interrupted { .. } | Error::Vulkan(DeviceLost { .. } | Timeout { .. }) | Error::Helper(_)
        )
    }

    /// Whether the device may still be working for this process.
    #[must_use]
    pub(crate) fn leaves_the_device_at_work(&self) -> bool {
        matches!(
            self,
            Error::Interrupted { .. }
                | Error::InterruptedMeasuring { .. }
                | Error::Vulkan(framewright_vulkan::Error::Timeout { .. })
        ) || matches!(self, Error::Vulkan(framewright_vulkan::Error::AtStep { error, .. })
                if matches!(**error, framewright_vulkan::Error::Timeout { .. }))
    }

    /// The exit code of a command that this ended.
    #[must_use]
    pub(crate) fn exit(&self) -> Exit {
        match self {
            Error::Read { source, .. } if is_of_machine(source) => Exit::Environment,
            Error::Scene(problem) if problem.is_of_machine() => Exit::Environment,
            Error::Missing { .. }
            | Error::Read { .. }
            | Error::TooLarge { .. }
            | Error::NotText { .. }
            | Error::NotFloats { .. }
            | Error::Results { .. }
            | Error::Joining(_)
            | Error::NoFlicker { .. }
            | Error::NoBaseline { .. }
            | Error::NoPlan { .. }
            | Error::NoReport { .. }
            | Error::NothingToExplain { .. }
            | Error::TooManyNodes { .. }
            | Error::OutsideResults { .. }
            | Error::Csv(_)
            | Error::Profile { .. }
            | Error::Violations { .. }
            | Error::NoPicture { .. }
            | Error::AlreadyExists { .. }
            | Error::CustomPass { .. }
            | Error::Unwritable(_)
            | Error::Scene(_)
            | Error::SceneMistakes { .. }
            | Error::Json(_)
            | Error::Library(_)
            | Error::Plan(_) => Exit::Found,
            // What has no output at all is wrong itself.
            Error::NoOutput { outputs, .. } if outputs.is_empty() => Exit::Found,
            Error::Mistakes { mistakes } if mistakes.diagnostics.iter().any(|it| it.of_machine) => Exit::Environment,
            Error::Mistakes { mistakes } => mistakes.exit,
            Error::Vulkan(problem) => match problem.blame() {
                Blame::Environment => Exit::Environment,
                Blame::Files | Blame::Program => Exit::Found,
            },
            Error::NoOutput { .. }
            | Error::TooManyPairs { .. }
            | Error::OutsideRoot { .. }
            | Error::UnknownProfile { .. }
            | Error::ProfileIsNoDevice { .. }
            | Error::Lab(LabError::Sweep { .. })
            | Error::WithoutPage { .. }
            | Error::ChoiceForPlan { .. }
            | Error::OwnChoice { .. }
            | Error::OtherSweep { .. }
            | Error::Held { .. }
            | Error::ReadAndWritten { .. }
            | Error::OtherResults { .. }
            | Error::NoName { .. }
            | Error::UnknownCode { .. }
            | Error::ShaderCompiler { .. }
            | Error::WrittenTwice { .. }
            | Error::ViewerAddress { .. } => Exit::Usage,
            Error::Interrupted { .. } | Error::InterruptedMeasuring { .. } | Error::InterruptedWriting { .. } => {
                Exit::Interrupted
            }
            Error::Lab(_) => Exit::Found,
            Error::Write { .. }
            | Error::NoFolder { .. }
            | Error::Cache { .. }
            | Error::NoWindow { .. }
            | Error::NoWindowLibrary { .. }
            | Error::NoRenderDoc
            | Error::NothingTaken { .. }
            | Error::Port { .. }
            | Error::NoViewer { .. }
            | Error::Print(_)
            | Error::Restart(_)
            | Error::Helper(_)
            | Error::NoModule { .. }
            | Error::BadModule
            | Error::Stereo { .. } => Exit::Environment,
        }
    }
}

fn no_output(name: &str, outputs: &[String], image: bool) -> String {
    if outputs.is_empty() {
        return "there is no output, so there is no picture to write".to_owned();
    }
    let (name, outputs) = (text::escape(name), text::escape(&outputs.join("`, `")));
    let help =
        if image { format!("`--dump {name}=FILE.png` writes any image") } else { format!("there are `{outputs}`") };
    format!("there is no output named `{name}`\nhelp: {help}")
}

/// Help for a device that refuses.
fn remedy(problem: &framewright_vulkan::Error) -> String {
    match problem {
        framewright_vulkan::Error::OutOfMemory { .. } => {
            "\nhelp: choose a smaller --size, fewer samples, or fewer or smaller images; `framewright inspect` lists them with what each takes".to_owned()
        }
        framewright_vulkan::Error::Vulkan { .. } => {
            "\nhelp: the driver refused: choose another device with --device (`framewright devices` lists them), or install a newer driver".to_owned()
        }
        framewright_vulkan::Error::BadPlan { .. } | framewright_vulkan::Error::OtherMemoryNeeds { .. } => {
            "\nhelp: framewright run PIPELINE --scene SCENE --save-plan PLAN.json makes a Plan for this device, with --poison one that can be poisoned; without a scene do so framewright devices --save PROFILE.ron and framewright inspect PIPELINE --device PROFILE.ron --format json"
                .to_owned()
        }
        framewright_vulkan::Error::Lacking { .. } => {
            "\nhelp: --device chooses another (`framewright devices` lists them)".to_owned()
        }
        framewright_vulkan::Error::Shader { problem: ShaderProblem::DoesNotCompile { messages }, .. } => {
            let limit = messages.iter().find_map(|message| message.limit);
            limit.map_or_else(String::new, |limit| format!("\nhelp: {}", options::option(limit)))
        }
        _ => String::new(),
    }
}

/// The file that was meant, if one of this name with an ending lies there.
fn with_ending(path: &Path) -> String {
    let endings = ["ron", "glb", "gltf"].map(|ending| path.with_added_extension(ending));
    let meant = endings.into_iter().find(|path| path.is_file());
    meant.map_or_else(String::new, |meant| format!("\nhelp: did you mean `{}`?", text::path(&meant)))
}

/// Help for a file that can't be read.
fn allow(problem: &io::Error, file: &Path) -> String {
    match problem.kind() {
        io::ErrorKind::PermissionDenied => format!("\nhelp: chmod u+r {}", text::escape(&for_shell(file))),
        _ => String::new(),
    }
}

/// Help for a file, or standard output, that can't be written.
fn mend(problem: &io::Error, file: Option<&Path>) -> String {
    match problem.kind() {
        io::ErrorKind::NotFound => match file.map(links::destination).as_deref().and_then(Path::parent) {
            Some(folder) => {
                format!("\nhelp: its folder must exist: mkdir -p {}", text::escape(&for_shell(folder)))
            }
            None => String::new(),
        },
        io::ErrorKind::NotADirectory => "\nhelp: choose a place in a folder".to_owned(),
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "\nhelp: choose a place that is yours, or chmod u+w it".to_owned()
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "\nhelp: make room: df -h shows what is full".to_owned()
        }
        io::ErrorKind::FileTooLarge => "\nhelp: allow larger files: ulimit -f unlimited".to_owned(),
        io::ErrorKind::IsADirectory => "\nhelp: that is a folder: name a file in it".to_owned(),
        _ => String::new(),
    }
}
