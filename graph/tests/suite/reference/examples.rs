//! Every example of the reference is right: those of whole files, those of each form, and those of each word.

use crate::reference::catalogue;
use crate::testing::pipelines::Pictures;
use framewright_graph::base::{self, FilePath, Sources};
use framewright_graph::language;

/// A pipeline in which everything that examples name is declared. Places for more are marked by `{…}`.
const HOST: &str = r#"Pipeline(
    version: 1,
    settings: [
        (name: "setting", value: Integer(default: 4, min: 1, max: 9)), (name: "bloom", value: Bool(default: true)),
        {settings}
    ],
    presets: [{presets}],
    views: [(name: "main"), {views}],
    textures: [{textures}],
    fragments: [{fragments}
        (name: "halve", parameters: [(name: "source", value: Image), (name: "target", value: Image), {parameters}],
            passes: [(name: "shrink", draw: FullScreen("downsample"), sample: {"source": "source"}, color: ["target"])]),
    ],
    images: [
        (name: "screen", format: Output, size: Output), (name: "target", format: Output, size: Output),
        (name: "depth", format: DepthStencil, size: Output),
        (name: "image", format: Color(hdr: true), size: Fixed(64, 64), samples: 1, mips: 3, layers: 6, lifetime: History),
        {images}
    ],
    buffers: [(name: "buffer", bytes: 64, lifetime: Persistent), (name: "name", bytes: 64), {buffers}],
    passes: [(name: "first", draw: FullScreen("plain"), color: ["screen"]), {passes}],
    outputs: ["screen", {outputs}],
)"#;

/// The host with something in one of its places.
fn with(place: &str, inside: &str) -> String {
    let filled = HOST.replace(&format!("{{{place}}}"), inside);
    ["settings", "presets", "views", "textures", "fragments", "parameters", "images", "buffers", "passes", "outputs"]
        .iter()
        .fold(filled, |text, place| text.replace(&format!("{{{place}}}"), ""))
}

/// A file that an example of a form stands in.
pub(crate) fn whole(form: &str, example: &str) -> String {
    let pass = |fields: &str| with("passes", &format!("(name: \"it\", {fields})"));
    let draw = |fields: &str| pass(&format!("draw: FullScreen(\"plain\"), {fields}"));
    match form {
        "Pipeline" | "Extending" | "Extension" | "Library" | "Settings" => example.to_owned(),
        "Setting" => with("settings", example),
        "Preset" => {
            let settings = "(name: \"msaa\", value: OneOf(default: 4, of: [1, 2, 4, 8])),";
            with("presets", example).replace("settings: [", &format!("settings: [{settings}"))
        }
        "Fragment" => {
            with("fragments", &format!("{example},")).replace("(name: \"halve\", par", "(name: \"other\", par")
        }
        "Parameter" => with("parameters", &format!("{example},")),
        "Use" | "Anchor" | "Pass" => with("passes", example),
        "View" => with("views", example),
        "Texture" => with("textures", example),
        "Image" => with("images", example),
        "Buffer" => with("buffers", example),
        "Output" => with("outputs", example),
        "Copy" => pass(&format!("copy: {example}")),
        "Blit" => pass(&format!("blit: {example}")),
        "Fill" => pass(&format!("fill: {example}")),
        "Part" => pass(&format!("custom: \"it\", writes: [\"target\"], reads: [{example}]")),
        "DeclaredUse" => pass(&format!("custom: \"it\", writes: [\"image\"], uses: [{example}]")),
        "Sample" => draw(&format!("color: [\"target\"], sample: {{\"source\": {example}}}")),
        "Storage" => draw(&format!("color: [\"target\"], storage: {{\"source\": {example}}}")),
        "Stages" => pass(&format!("draw: Vertices(3), shader: {example}, color: [\"target\"]")),
        "ColorTarget" => draw(&format!("color: [{example}]")),
        "Blend" => draw(&format!("color: [(image: \"target\", blend: {example})]")),
        "Raster" => draw(&format!("color: [\"target\"], raster: {example}")),
        "DepthBias" => draw(&format!("color: [\"target\"], raster: (depth_bias: {example})")),
        "DepthTarget" => draw(&format!("depth: {example}")),
        "Stencil" => draw(&format!("depth: (image: \"depth\", stencil: {example})")),
        "State" => with(
            "images",
            &format!("(name: \"it\", format: Output, size: Output, lifetime: Imported(before: {example}))"),
        ),
        _ => panic!("say in tests/suite/reference/examples.rs where an example of {form} stands"),
    }
}

/// A file that a word stands in, by the name of the table that it is of.
pub(crate) fn whole_word(words: &str, word: &str) -> String {
    let image = |field: &str| {
        let others = [("format", "Output"), ("size", "Fixed(8, 8)")];
        let others = others.iter().filter(|(name, _)| *name != field).map(|(name, value)| format!("{name}: {value}, "));
        with("images", &format!("(name: \"it\", {}{field}: {word})", others.collect::<String>()))
    };
    match words {
        "SettingValue" => whole("Setting", &format!("(name: \"it\", value: {word})")),
        "ParameterValue" => {
            let parameter = format!("(name: \"it\", value: {word})");
            with("fragments", &format!("(name: \"it\", passes: [], parameters: [{parameter}]),"))
        }
        "ViewSize" => with("views", &format!("(name: \"it\", size: {word})")),
        "Format" => image("format"),
        "Size" => image("size"),
        "Samples" => image("samples"),
        "Mips" => image("mips"),
        "Layers" => image("layers"),
        "Resolve" => {
            let format = match word {
                "Average" | "Weighted" => "Color",
                _ => "Depth",
            };
            with("images", &format!("(name: \"it\", format: {format}, size: Output, samples: 4, resolve: {word})"))
        }
        "ColorPolicy" => with("images", "").replace("version: 1,", &format!("version: 1, color: {word},")),
        "DepthFormatPolicy" => with("images", "").replace("version: 1,", &format!("version: 1, depth_format: {word},")),
        "DepthPolicy" => with("images", "").replace("version: 1,", &format!("version: 1, depth: {word},")),
        "Shape" => image("shape"),
        "Lifetime" => image("lifetime"),
        "Bytes" => with("buffers", &format!("(name: \"it\", bytes: {word})")),
        "State" => {
            let buffer = ["Uniform", "Vertex", "Index", "Indirect", "Host"].contains(&word);
            let lifetime = format!("lifetime: Imported(before: {word})");
            match buffer {
                true => with("buffers", &format!("(name: \"it\", bytes: 64, {lifetime})")),
                false => with("images", &format!("(name: \"it\", format: Output, size: Output, {lifetime})")),
            }
        }
        "Draw" => {
            let shader = if word.starts_with("FullScreen") { "" } else { "shader: \"plain\", " };
            with("passes", &format!("(name: \"it\", draw: {word}, {shader}color: [\"target\"])"))
        }
        "Run" => with(
            "passes",
            &format!(
                "(name: \"it\", run: {}, draw: FullScreen(\"plain\"), color: [\"target\"])",
                word.replace("\"face\"", "5")
            ),
        ),
        "Groups" => {
            let pass = format!("(name: \"it\", dispatch: \"it\", groups: {word}, storage: {{\"it\": \"buffer\"}})");
            with("passes", &pass)
        }
        "StandIn" => {
            let word = word
                .replace("to: \"image\"", "to: \"target\"")
                .replace("Clear(image: \"image\"", "Clear(image: \"target\"");
            let pass = format!(
                "(name: \"it\", when: \"bloom\", draw: FullScreen(\"plain\"), color: [\"target\"], otherwise: {word})"
            );
            with("passes", &pass)
        }
        "Change" => format!("Pipeline(version: 1, extends: \"base.ron\", changes: [{word}])"),
        "Count" => whole("Part", &format!("(image: \"image\", mip: 0, mips: {word})")),
        "Face" => whole("Sample", word),
        "EyeImage" => whole("ColorTarget", word).replace("mips: 3,", "mips: 3, per_eye: true,"),
        _ => panic!("say in tests/suite/reference/examples.rs where a word of {words} stands"),
    }
}

/// That a file is read, and can be put together without its shaders.
#[track_caller]
fn right(what: &str, text: &str) {
    let mut sources = Sources::default();
    let read = match text.trim_start() {
        settings if settings.starts_with("Settings") => {
            let msaa = "(name: \"msaa\", value: OneOf(default: 4, of: [1, 2, 4, 8])),";
            let host = with("presets", "(name: \"low\", set: {\"msaa\": 1})")
                .replace("settings: [", &format!("settings: [{msaa}"));
            let document = language::read(&mut sources, "host.ron", "host.ron", host).expect("the host is right");
            document.read_settings(&mut sources, "a.ron", "a.ron", text.to_owned()).map(|_| ())
        }
        library if library.starts_with("Fragments") => {
            let host = with("fragments", "").replace("presets:", "include: [\"a.ron\"], presets:");
            let mut one = One(text.as_bytes().to_vec());
            language::read_with(&mut sources, &mut one, "host.ron", "host.ron", host).map(|_| ())
        }
        extension if extension.starts_with("Extension") => {
            let extending = "Pipeline(version: 1, extends: \"forward.ron\", extensions: [\"a.ron\"])";
            let mut two = Based(text.as_bytes().to_vec());
            language::read_with(&mut sources, &mut two, "host.ron", "host.ron", extending.to_owned()).map(|_| ())
        }
        _ if text.contains("extends:") => {
            language::read_with(&mut sources, &mut Based(Vec::new()), "a.ron", "a.ron", text.to_owned()).map(|_| ())
        }
        _ => language::read_with(&mut sources, &mut Pictures, "a.ron", "a.ron", text.to_owned()).map(|_| ()),
    };
    if let Err(errors) = read {
        panic!("{what}\n{}", base::render(&sources, &errors));
    }
}

/// `base.ron` and the shipped `forward.ron`, which others extend, and another file.
struct Based(Vec<u8>);

impl language::Files for Based {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<language::FoundFile, language::ReadFailure> {
        let second = "(name: \"second\", draw: FullScreen(\"plain\"), color: [\"screen\"])";
        let base = with("passes", second).into_bytes();
        let bytes = match path {
            "base.ron" => base,
            "forward.ron" => include_bytes!("../../../../examples/pipelines/forward.ron").to_vec(),
            _ => self.0.clone(),
        };
        Ok(language::FoundFile { shown: path.to_owned(), relative: path.into(), bytes })
    }
}

/// One file, found by every name.
struct One(Vec<u8>);

impl language::Files for One {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<language::FoundFile, language::ReadFailure> {
        Ok(language::FoundFile { shown: path.to_owned(), relative: path.into(), bytes: self.0.clone() })
    }
}

#[test]
fn every_example_of_a_form_is_right() {
    let all = catalogue::all();
    for (name, table) in all.tables.iter().filter(|(name, _)| !all.inner.contains(name)) {
        right(name, &whole(name, &catalogue::example(table)));
    }
}

#[test]
fn every_way_to_write_a_word_is_right() {
    for (name, words) in catalogue::all().words {
        for word in words.all.iter().flat_map(|word| word.written()) {
            right(&format!("{name}: {word}"), &whole_word(name, word));
        }
    }
}
