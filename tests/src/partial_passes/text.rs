//! Chains as a pipeline file with shaders.

use super::meaning::{BASE, INITIAL, color, near};
use super::means::{File, PATTERNS};
use super::{Base, Chain, EXTENT, Kind, Life, Link};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A pipeline file, its shaders, and what its outputs show.
#[derive(Debug, Default)]
pub struct Text {
    /// The pipeline file.
    pub pipeline: String,
    /// Shaders by file name.
    pub shaders: BTreeMap<String, String>,
    /// The outputs in their order.
    pub outputs: Vec<Output>,
}

/// What an output shows.
#[derive(Debug, Clone, Copy)]
pub struct Output {
    /// Which chain.
    pub chain: usize,
    /// Which of the states that are shown of it.
    pub shown: usize,
    /// What of it.
    pub what: What,
}

/// What is shown of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// Four components of colour.
    Color,
    /// Depth.
    Depth,
    /// A word, as red.
    Word,
}

const FUNCTIONS: &str = "\
bool keep(ivec2 p) { return $keep; }
vec4 color() { return vec4($value.0, 252.0 - $value.0, 0.0, 255.0) / 255.0; }
";
const OUT: &str = "\
#ifdef DEPTH_ONLY
vec4 c;
#else
layout(location = 0) out vec4 c;
#endif";
const SHOW: &str = "\
#version 460
layout(set = 0, binding = 0) uniform sampler2D a;
layout(location = 0) out vec4 c;
void main() { c = texelFetch(a, ivec2(gl_FragCoord.xy), 0); }
";
const SHOW_SAMPLES: &str = "\
#version 460
layout(set = 0, binding = 0) uniform sampler2DMS a;
layout(location = 0) out vec4 c;
vec4 sample_of(int number) { return texelFetch(a, ivec2(gl_FragCoord.xy), number); }
void main() { c = (sample_of(0) + sample_of(1) + sample_of(2) + sample_of(3)) / 4.0; }
";
const SHOW_DEPTH: &str = "\
#version 460
layout(set = 0, binding = 0) uniform sampler2D d;
layout(location = 0) out vec4 c;
void main() { c = vec4(texelFetch(d, ivec2(gl_FragCoord.xy), 0).x * 0.8); }
";
const SHOW_WORDS: &str = "\
#version 460
layout(set = 0, binding = 0) readonly buffer A { uint v[]; } a;
layout(location = 0) out vec4 c;
void main() { ivec2 p = ivec2(gl_FragCoord.xy); c = vec4(float(a.v[p.x + 16 * p.y]) / 255.0); }
";
const BEHIND: &str = "\
#version 460
void main() { gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 2.0, 1.0); }
";
/// How many times as much a quarter of depth is shown.
pub const QUARTER: u8 = 51;

/// The text of chains.
#[must_use]
pub fn text(chains: &[Chain]) -> Text {
    let mut text = Text::default();
    let (mut images, mut buffers, mut outputs) = (String::new(), String::new(), String::new());
    let mut passes: Vec<Vec<String>> = Vec::new();
    for (number, chain) in chains.iter().enumerate() {
        declare(&mut images, &mut buffers, number, chain);
        passes.push(text.chain(&mut images, &mut outputs, number, chain));
    }
    // One of each chain by turns: then many of them live at a time.
    let longest = passes.iter().map(Vec::len).max().unwrap_or(0);
    let turns = (0..longest).flat_map(|at| passes.iter().filter_map(move |of_chain| of_chain.get(at)));
    let passes: String = turns.flat_map(|pass| ["        ", pass, "\n"]).collect();
    text.pipeline = format!(
        "Pipeline(version: 1,\n    images: [\n{images}    ],\n    buffers: [\n{buffers}    ],\n    passes: [\n{passes}    ],\n    \
         outputs: [{outputs}],\n)\n"
    );
    text
}

fn declare(images: &mut String, buffers: &mut String, number: usize, chain: &Chain) {
    let [width, height] = EXTENT;
    let [red, green, blue, alpha] = INITIAL.color.map(|byte| f64::from(byte) / 255.0);
    let stencil = if chain.has_stencil() { (", 1", "D32_SFLOAT_S8_UINT") } else { ("", "D32_SFLOAT") };
    let life = |initial: String| match chain.life {
        Life::Transient => String::new(),
        Life::Persistent => format!(", lifetime: Persistent(initial: {initial})"),
        Life::History => format!(", lifetime: History(initial: {initial})"),
    };
    match chain.kind {
        Kind::Picture(samples) => {
            let color = life(format!("({red}, {green}, {blue}, {alpha})"));
            let size = format!("size: Fixed({width}, {height}), samples: {samples}");
            _ = writeln!(images, "        (name: \"a{number}\", format: R8G8B8A8_UNORM, {size}{color}),");
            if chain.has_depth() {
                let (more, format) = stencil;
                let depth = life(if more.is_empty() { "0.25".to_owned() } else { format!("(0.25{more})") });
                _ = writeln!(images, "        (name: \"d{number}\", format: {format}, {size}{depth}),");
            }
        }
        Kind::Words => {
            let word = life(INITIAL.color[0].to_string());
            _ = writeln!(buffers, "        (name: \"a{number}\", bytes: {}{word}),", 4 * width * height);
        }
    }
}

impl Text {
    /// The passes of a chain.
    fn chain(&mut self, images: &mut String, outputs: &mut String, number: usize, chain: &Chain) -> Vec<String> {
        let mut passes: Vec<String> = chain.base.map(|base| self.base(number, chain, base)).into_iter().collect();
        let mut shown = 0;
        for (at, link) in chain.links.iter().enumerate() {
            passes.push(self.link(images, number, chain, at, link));
            if link.shown {
                passes.extend(self.shows(images, outputs, number, chain, shown, 0));
                shown += 1;
            }
        }
        if chain.life == Life::History {
            passes.extend(self.shows(images, outputs, number, chain, shown, 1));
        }
        passes
    }

    fn base(&mut self, number: usize, chain: &Chain, base: Base) -> String {
        let (name, image) = (format!("base{number}"), format!("a{number}"));
        if chain.kind == Kind::Words {
            let word = color(BASE)[0];
            if base == Base::Clears {
                return format!("(name: \"{name}\", fill: (to: \"{image}\", value: {word})),");
            }
            let store = "layout(set = 0, binding = 0) writeonly buffer To { uint v[]; } to;\nvoid main() { to.v[p.x + 16 * p.y] = \
                         uint(color().x * 255.0 + 0.5); }";
            self.add("base_words", &File::Compute(store), 5, BASE);
            return format!(
                "(name: \"{name}\", dispatch: \"base_words\", groups: Invocations(16, 8), storage: {{\"to\": (buffer: \"{image}\", \
                 access: Write)}}),"
            );
        }
        let (stencil_clear, stencil_set) = match chain.has_stencil() {
            true => (", stencil: (clear: 1)", ", stencil: (reference: 1, pass: Replace)"),
            false => ("", ""),
        };
        let depth = |fields: String| match chain.has_depth() {
            true => format!(", depth: (image: \"d{number}\", {fields})"),
            false => String::new(),
        };
        match base {
            Base::Covers => {
                let shader = if chain.has_depth() { "base_depth" } else { "base" };
                let body = if chain.has_depth() { "c = color(); gl_FragDepth = 0.25;" } else { "c = color();" };
                self.add(shader, &File::Fragment(body), 5, BASE);
                let depth = depth(format!("test: Always{stencil_set}"));
                format!("(name: \"{name}\", draw: FullScreen(\"{shader}\"), color: [\"{image}\"]{depth}),")
            }
            Base::Clears => {
                self.add("behind", &File::Fragment("c = color();"), 5, BASE);
                self.shaders.insert("behind.vert".to_owned(), BEHIND.to_owned());
                let [red, green, blue, alpha] = color(BASE).map(|byte| f64::from(byte) / 255.0);
                let depth = depth(format!("clear: 0.5{stencil_clear}"));
                format!(
                    "(name: \"{name}\", draw: Vertices(3), shader: \"behind\", color: [(image: \"{image}\", clear: ({red}, {green}, \
                     {blue}, {alpha}))]{depth}),"
                )
            }
        }
    }

    fn link(&mut self, images: &mut String, number: usize, chain: &Chain, at: usize, link: &Link) -> String {
        let Link { means, pattern, value, .. } = link;
        let shader = format!("{}_{pattern}_{value}", means.name);
        for file in means.files {
            self.add(&shader, file, *pattern, *value);
        }
        let scratch = format!("z{number}_{at}");
        if means.pass.contains("$scratch") {
            let samples = super::meaning::samples(chain);
            _ = writeln!(
                images,
                "        (name: \"{scratch}\", format: R8G8B8A8_UNORM, size: Fixed({}, {}), samples: {samples}),",
                EXTENT[0], EXTENT[1]
            );
        }
        let fields = means.pass.replace("$shader", &shader).replace("$scratch", &scratch);
        let fields = fields.replace("$image", &format!("a{number}")).replace("$depth", &format!("d{number}"));
        format!("(name: \"p{number}_{at}_{}\", {fields}),", means.name)
    }

    /// Passes that show what there is, as outputs.
    fn shows(
        &mut self,
        images: &mut String,
        outputs: &mut String,
        number: usize,
        chain: &Chain,
        shown: usize,
        previous: u32,
    ) -> Vec<String> {
        let ago = if previous > 0 { format!(", previous: {previous}") } else { String::new() };
        let mut show = |letter: char, what: What, shader: &str, text: &str, reads: String| {
            let output = format!("{letter}{number}_{shown}");
            _ = writeln!(
                images,
                "        (name: \"{output}\", format: R8G8B8A8_UNORM, size: Fixed({}, {})),",
                EXTENT[0], EXTENT[1]
            );
            _ = write!(outputs, "(image: \"{output}\", encoding: Unorm), ");
            self.outputs.push(Output { chain: number, shown, what });
            self.shaders.insert(format!("{shader}.frag"), text.to_owned());
            format!("(name: \"show_{output}\", draw: FullScreen(\"{shader}\"), {reads}, color: [\"{output}\"]),")
        };
        if chain.kind == Kind::Words {
            let reads = format!("storage: {{\"a\": (buffer: \"a{number}\"{ago})}}");
            return vec![show('o', What::Word, "show_words", SHOW_WORDS, reads)];
        }
        let reads = format!("sample: {{\"a\": (image: \"a{number}\", filter: Nearest{ago})}}");
        // Earlier frames aren't resolved.
        let (shader, text) = match chain.kind {
            Kind::Picture(4) if previous > 0 => ("show_samples", SHOW_SAMPLES),
            _ => ("show", SHOW),
        };
        let mut passes = vec![show('o', What::Color, shader, text, reads)];
        if chain.shows_depth() && previous == 0 {
            let plane = if chain.has_stencil() { ", plane: Depth" } else { "" };
            let reads = format!("sample: {{\"d\": (image: \"d{number}\", filter: Nearest{plane})}}");
            passes.push(show('q', What::Depth, "show_depth", SHOW_DEPTH, reads));
        }
        passes
    }

    fn add(&mut self, shader: &str, file: &File, pattern: usize, value: u8) {
        let version = "#version 460\n#extension GL_EXT_demote_to_helper_invocation : require\n";
        let (ending, text) = match file {
            File::Fragment(body) => {
                let head = format!("{version}$out\n{FUNCTIONS}");
                ("frag", format!("{head}void main() {{\nivec2 p = ivec2(gl_FragCoord.xy);\n{body}\n}}\n"))
            }
            File::Bare(text) => ("frag", format!("{version}{FUNCTIONS}{text}\n")),
            File::Vertex(body) => ("vert", format!("#version 460\nvoid main() {{\n{body}\n}}\n")),
            File::Compute(text) => {
                let group = "layout(local_size_x = 8, local_size_y = 8) in;\n";
                let place = "#define p ivec2(gl_GlobalInvocationID.xy)\n";
                ("comp", format!("#version 460\n{group}{FUNCTIONS}{place}{text}\n"))
            }
        };
        let depth = format!("0.{}", u32::from(near(value)) * 25);
        let text = text.replace("$out", OUT).replace("$keep", PATTERNS[pattern].0).replace("$z", &depth);
        let text = text.replace("$value", &color(value)[0].to_string());
        self.shaders.insert(format!("{shader}.{ending}"), text);
    }
}
