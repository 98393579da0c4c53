//! Commands that compile HLSL, Slang and WGSL, as the user or the program names them. No pipeline names one: files may be a stranger's.

use crate::base::{ShaderStage, identity_of};
use framewright_graph::base::nearest;
use framewright_graph::shader::FileLanguage;
use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The commands that compile shaders in HLSL, Slang and WGSL. Without one, HLSL is compiled by shaderc, and Slang and WGSL aren't.
///
/// A command is run without a shell, in a folder of its own that holds the shader and what it includes, with nothing on its standard
/// input, and within the limits of a [`Helper`](crate::Helper).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ShaderCompilers {
    commands: BTreeMap<FileLanguage, CompilerCommand>,
}

/// Why a command can't be a compiler.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct BadCompiler(String);

/// A command.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct CompilerCommand {
    /// As it was named.
    text: String,
    program: String,
    /// What stands behind the program: words of the user's, then those of a known compiler.
    words: Vec<String>,
    /// Words that only a named entry point asks for.
    of_entry: &'static [&'static str],
}

/// A compiler whose arguments are known.
struct KnownCompiler {
    name: &'static str,
    languages: &'static [FileLanguage],
    arguments: &'static [&'static str],
    of_entry: &'static [&'static str],
    /// Where it comes from.
    from: &'static str,
}

/// What stands for something in an argument.
const INPUT: &str = "{input}";
const OUTPUT: &str = "{output}";
const FOLDER: &str = "{folder}";
const MACRO: &str = "{macro}";
const ENTRY: &str = "{entry}";

/// All of them.
const STAND_INS: [&str; 8] = [INPUT, OUTPUT, FOLDER, MACRO, ENTRY, "{stage}", "{ending}", "{profile}"];

/// What looks as if it stood for something in an argument.
fn stand_ins(word: &str) -> impl Iterator<Item = &str> {
    word.match_indices('{').filter_map(|(start, _)| {
        // A shell's variable is none of ours.
        let end = start + word[start..].find('}').filter(|_| !word[..start].ends_with('$'))? + 1;
        word[start + 1..end - 1].chars().all(|it| it.is_ascii_lowercase()).then(|| &word[start..end])
    })
}

const KNOWN: [KnownCompiler; 5] = [
    KnownCompiler {
        name: "dxc",
        languages: &[FileLanguage::Hlsl],
        arguments: &[
            "-spirv",
            "-fspv-target-env=vulkan1.3",
            "-T",
            "{profile}",
            "-E",
            "{entry}",
            "-I",
            FOLDER,
            "-D",
            MACRO,
            "-Fo",
            OUTPUT,
            INPUT,
        ],
        of_entry: &[],
        from: "the Vulkan SDK has it",
    },
    KnownCompiler {
        name: "glslangValidator",
        languages: &[FileLanguage::Hlsl],
        arguments: &[
            "-D",
            "-V",
            "--target-env",
            "vulkan1.3",
            // Its front end of HLSL marks storage blocks as versions up to 1.3 do.
            "--target-env",
            "spirv1.3",
            "-S",
            "{ending}",
            "-e",
            "{entry}",
            "--auto-map-bindings",
            "-I{folder}",
            "-D{macro}",
            "-o",
            OUTPUT,
            INPUT,
        ],
        of_entry: &[],
        from: "on Debian and Ubuntu `apt install glslang-tools` installs it",
    },
    KnownCompiler {
        name: "glslc",
        languages: &[FileLanguage::Hlsl],
        arguments: &[
            "-x",
            "hlsl",
            "-fshader-stage={stage}",
            "-fentry-point={entry}",
            "--target-env=vulkan1.3",
            "--target-spv=spv1.3",
            "-fauto-bind-uniforms",
            "-I",
            FOLDER,
            "-D{macro}",
            "-o",
            OUTPUT,
            INPUT,
        ],
        of_entry: &[],
        from: "on Debian and Ubuntu `apt install glslc` installs it",
    },
    KnownCompiler {
        name: "slangc",
        languages: &[FileLanguage::Slang, FileLanguage::Hlsl],
        arguments: &[INPUT, "-target", "spirv", "-fvk-use-entrypoint-name", "-I", FOLDER, "-D{macro}", "-o", OUTPUT],
        of_entry: &["-entry", "{entry}", "-stage", "{stage}"],
        from: "the Vulkan SDK has it, and https://github.com/shader-slang/slang/releases",
    },
    KnownCompiler {
        name: "naga",
        languages: &[FileLanguage::Wgsl],
        arguments: &[INPUT, OUTPUT],
        of_entry: &[],
        from: "`cargo install naga-cli` installs it",
    },
];

/// What a compiler is told of a stage.
pub(super) struct StageToCompile<'t> {
    pub(super) stage: ShaderStage,
    pub(super) entry: Option<&'t str>,
    pub(super) macros: &'t [(String, String)],
    pub(super) folders: &'t [String],
    pub(super) input: &'t str,
    pub(super) output: &'t str,
}

impl ShaderCompilers {
    /// The compilers that the environment names: `FRAMEWRIGHT_HLSL_COMPILER`, `FRAMEWRIGHT_SLANG_COMPILER` and
    /// `FRAMEWRIGHT_WGSL_COMPILER`.
    ///
    /// # Errors
    /// Those of [`ShaderCompilers::set`], with the variable.
    pub fn of_environment() -> Result<ShaderCompilers, BadCompiler> {
        let mut compilers = ShaderCompilers::default();
        for language in FileLanguage::ALL.into_iter().filter(|it| *it != FileLanguage::Spirv) {
            let variable = format!("FRAMEWRIGHT_{}_COMPILER", word(language).to_uppercase());
            if let Some(command) = env::var_os(&variable).filter(|command| !command.is_empty()) {
                let set = compilers.set(language, &command.to_string_lossy());
                set.map_err(|BadCompiler(what)| BadCompiler(format!("{variable}: {what}")))?;
            }
        }
        Ok(compilers)
    }

    /// Whether what compiles a language knows the index of a view: shaderc, glslang and glslc don't, DXC and slangc do. A command that isn't
    /// known is taken for one that does. GLSL asks for it by an extension.
    pub(super) fn knows_views(&self, language: Option<FileLanguage>) -> bool {
        let of_glslang = |command: &CompilerCommand| {
            known(&command.program).is_some_and(|known| ["glslangValidator", "glslc"].contains(&known.name))
        };
        language.is_none_or(|language| {
            language != FileLanguage::Hlsl || self.of(language).is_some_and(|it| !of_glslang(it))
        })
    }

    /// Has shaders of a language compiled by a command: a program and arguments, divided by spaces; what stands in `"` is one of
    /// them.
    ///
    /// Of `dxc`, `glslangValidator`, `glslc`, `slangc` and `naga` the arguments are known: those in the command come before them. Of
    /// others the command has all: `{input}` and `{output}` stand for files, `{entry}` for the entry point, `{stage}` for `vertex`,
    /// `fragment` or `compute`, `{ending}` for `vert`, `frag` or `comp`, `{profile}` for one as `ps_6_6`. An argument with `{macro}` or
    /// `{folder}` is repeated for each macro `NAME=VALUE` and each folder of includes.
    ///
    /// # Errors
    /// It has no program, or no arguments are known for it.
    pub fn set(&mut self, language: FileLanguage, command: &str) -> Result<(), BadCompiler> {
        let command = CompilerCommand::of(language, command).map_err(BadCompiler)?;
        self.commands.insert(language, command);
        Ok(())
    }

    /// Does the same with the language and the command in one text: `slang=slangc -O0`.
    ///
    /// # Errors
    /// Those of [`ShaderCompilers::set`]; or it names no such language.
    pub fn set_named(&mut self, text: &str) -> Result<(), BadCompiler> {
        let bad = |what: String| Err(BadCompiler(what));
        let words = ["hlsl", "slang", "wgsl"];
        let Some((named, command)) = text.split_once('=') else {
            return bad(format!("`{text}` names no compiler: write a language and a command, `slang=slangc`"));
        };
        let language = FileLanguage::ALL.into_iter().find(|it| *it != FileLanguage::Spirv && word(*it) == named);
        let Some(language) = language else {
            let meant = nearest(named, words).map_or_else(String::new, |it| format!("; did you mean `{it}`?"));
            return bad(format!("`{named}` is no language that is compiled so: {} are{meant}", words.join(", ")));
        };
        self.set(language, command)
    }

    /// Takes over the commands of others, which are stronger.
    pub fn and(&mut self, stronger: &ShaderCompilers) {
        self.commands.extend(stronger.commands.clone());
    }

    pub(super) fn of(&self, language: FileLanguage) -> Option<&CompilerCommand> {
        self.commands.get(&language)
    }
}

impl CompilerCommand {
    fn of(language: FileLanguage, text: &str) -> Result<CompilerCommand, String> {
        let mut words = divided(text)?.into_iter();
        let Some(program) = words.next() else { return Err("the command is empty".to_owned()) };
        let mut words: Vec<String> = words.collect();
        if let Some(unknown) = words.iter().flat_map(|word| stand_ins(word)).find(|it| !STAND_INS.contains(it)) {
            return Err(format!("`{unknown}` stands for nothing: there are {}", STAND_INS.join(", ")));
        }
        let mut of_entry: &[&str] = &[];
        if !words.iter().any(|word| word.contains(INPUT)) {
            let Some(known) = known(&program) else {
                return Err(format!(
                    "the arguments of `{program}` aren't known: write them, as in `{program} -E {{entry}} -o {{output}} {{input}}`"
                ));
            };
            if !known.languages.contains(&language) {
                return Err(format!("`{}` doesn't compile {}", known.name, language.facts().name));
            }
            words.extend(known.arguments.iter().map(|word| (*word).to_owned()));
            of_entry = known.of_entry;
        }
        if !words.iter().any(|word| word.contains(OUTPUT)) {
            return Err(format!(
                "the arguments of `{program}` don't say where it writes: `{OUTPUT}` stands for that file"
            ));
        }
        Ok(CompilerCommand { text: text.to_owned(), program, words, of_entry })
    }

    /// The program, as it was named.
    pub(super) fn program(&self) -> &str {
        &self.program
    }

    /// The file of the program, if there is one.
    pub(super) fn file(&self) -> Option<PathBuf> {
        let program = Path::new(&self.program);
        let with_suffix = |path: PathBuf| {
            let named = PathBuf::from(format!("{}{}", path.display(), env::consts::EXE_SUFFIX));
            [path, named].into_iter().find(|path| path.is_file())
        };
        if program.components().count() > 1 {
            return std::path::absolute(program).ok().and_then(with_suffix);
        }
        let folders = env::var_os("PATH")?;
        env::split_paths(&folders).find_map(|folder| with_suffix(folder.join(program)))
    }

    /// Where the program comes from, if that is known.
    pub(super) fn from(&self) -> Option<&'static str> {
        known(&self.program).map(|known| known.from)
    }

    /// All that decides what it makes of a stage, but the program itself.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Whether it is told which entry point is wanted.
    pub(super) fn is_told_entry(&self) -> bool {
        let mut words = self.words.iter().map(String::as_str).chain(self.of_entry.iter().copied());
        words.any(|word| word.contains(ENTRY))
    }

    /// What tells its files from others: those of the program and of the libraries near it, and those that its words name, as
    /// `sh tool.sh` does.
    pub(super) fn identity(&self, program: &Path) -> String {
        let resolved = program.canonicalize().unwrap_or_else(|_| program.to_owned());
        let named = self.words.iter().map(|word| std::path::absolute(word).unwrap_or_else(|_| word.into()));
        let mut files: Vec<PathBuf> = named.filter(|file| file.is_file()).collect();
        let beside = resolved.parent().into_iter().flat_map(|folder| [folder.to_owned(), folder.join("../lib")]);
        let mut libraries: Vec<PathBuf> = beside.flat_map(libraries).collect();
        libraries.sort();
        files.extend(libraries);
        std::iter::once(program)
            .chain(files.iter().map(PathBuf::as_path))
            .map(identity_of)
            .collect::<Vec<_>>()
            .join("; ")
    }

    /// The arguments for a stage.
    pub(super) fn arguments(&self, told: &StageToCompile<'_>) -> Vec<String> {
        let facts = told.stage.facts();
        let macros: Vec<String> = told.macros.iter().map(|(name, value)| defined(name, value)).collect();
        let of_entry = told.entry.map_or(&[][..], |_| self.of_entry).iter().copied();
        let words: Vec<&str> = self.words.iter().map(String::as_str).chain(of_entry).collect();
        let mut arguments = Vec::new();
        let mut at = 0;
        while let Some(word) = words.get(at) {
            // `-I {folder}` is repeated as a whole, and so is `-I{folder}`.
            let next = words.get(at + 1).copied();
            let repeated = |word: &str| word.contains(FOLDER) || word.contains(MACRO);
            let pair =
                word.starts_with('-') && !repeated(word) && next.is_some_and(|next| [FOLDER, MACRO].contains(&next));
            let (flag, word) = if pair { (Some(*word), next.unwrap_or_default()) } else { (None, *word) };
            at += if pair { 2 } else { 1 };
            let values: &[String] = match word {
                word if word.contains(FOLDER) => told.folders,
                word if word.contains(MACRO) => &macros,
                _ => &[],
            };
            if repeated(word) {
                for value in values {
                    arguments.extend(flag.map(str::to_owned));
                    arguments.push(put(word, &[(FOLDER, value), (MACRO, value)]));
                }
                continue;
            }
            let values = [
                (INPUT, told.input),
                (OUTPUT, told.output),
                (ENTRY, told.entry.unwrap_or("main")),
                ("{stage}", facts.name),
                ("{ending}", facts.ending.trim_start_matches('.')),
                ("{profile}", profile(told.stage)),
            ];
            arguments.push(put(word, &values));
        }
        arguments
    }
}

/// The libraries in a folder: `lib*.so*`.
fn libraries(folder: PathBuf) -> Vec<PathBuf> {
    let all = fs::read_dir(folder).into_iter().flatten().flatten().filter(|entry| {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        name.starts_with("lib") && name.contains(".so")
    });
    all.map(|entry| entry.path()).collect()
}

/// A word with values in place of the names. What a value holds stays as it is.
fn put(word: &str, values: &[(&str, &str)]) -> String {
    let (mut made, mut rest) = (String::new(), word);
    while let Some(start) = rest.find('{') {
        let (before, behind) = rest.split_at(start);
        made.push_str(before);
        let named = values.iter().find(|(name, _)| behind.starts_with(name));
        let (name, value) = named.copied().unwrap_or(("{", "{"));
        made.push_str(value);
        rest = &behind[name.len()..];
    }
    made + rest
}

/// A language as options name it.
fn word(language: FileLanguage) -> &'static str {
    language.facts().ending.trim_start_matches('.')
}

fn profile(stage: ShaderStage) -> &'static str {
    match stage {
        ShaderStage::Vertex => "vs_6_6",
        ShaderStage::Fragment => "ps_6_6",
        ShaderStage::Compute => "cs_6_6",
    }
}

/// The compiler of this name, whatever folder it lies in.
fn known(program: &str) -> Option<&'static KnownCompiler> {
    let name = Path::new(program).file_stem()?.to_str()?;
    let name = if name == "glslang" { "glslangValidator" } else { name };
    KNOWN.iter().find(|known| known.name == name)
}

/// A macro as compilers are told of it.
fn defined(name: &str, value: &str) -> String {
    format!("{name}={value}")
}

/// The words of a command: divided by spaces, but where they stand in `"`.
fn divided(text: &str) -> Result<Vec<String>, String> {
    let (mut words, mut word, mut quoted) = (Vec::new(), None::<String>, false);
    for letter in text.chars() {
        match letter {
            '"' => {
                quoted = !quoted;
                word.get_or_insert_default();
            }
            letter if letter.is_whitespace() && !quoted => words.extend(word.take()),
            letter => word.get_or_insert_default().push(letter),
        }
    }
    if quoted {
        return Err(format!("a `\"` has no second one: {text}"));
    }
    words.extend(word);
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_for_something_is_replaced_once() {
        let values = [(INPUT, "./{output}.hlsl"), (OUTPUT, "out.spv")];
        assert_eq!(put("{input}", &values), "./{output}.hlsl");
        assert_eq!(put("-a{b}{output}{", &values), "-a{b}out.spv{");
    }
}
