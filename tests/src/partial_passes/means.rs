//! The table of means by which passes leave texels out.

use super::meaning::{At, Texel};

/// Means to leave texels out.
#[derive(Debug)]
pub struct Means {
    /// Its name, also that of its shaders.
    pub name: &'static str,
    /// What it can be done to.
    pub on: On,
    /// Whether it needs depth.
    pub depth: bool,
    /// Whether it needs stencil.
    pub stencil: bool,
    /// Its shaders.
    pub files: &'static [File],
    /// The fields of its pass.
    pub pass: &'static str,
    /// What becomes of a texel, or of one sample of it.
    pub effect: fn(&mut Texel, &At),
    /// Whether a file with it may be refused: Vulkan leaves open what it draws.
    pub may_be_refused: bool,
}

/// What means can be done to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum On {
    /// Images of one and of four samples.
    Pictures,
    /// Images of one sample.
    OneSample,
    /// Buffers.
    Words,
}

/// A shader, whose text has `$keep`, `$value` and `$z` for the condition of its pattern, its value, and its depth, and `$out` for a
/// colour output `c` that is none where depth is drawn alone.
#[derive(Debug)]
pub enum File {
    /// A fragment stage with one colour output `c`, as `$out` declares it.
    Fragment(&'static str),
    /// One that declares its outputs by itself, or has none.
    Bare(&'static str),
    /// A vertex stage.
    Vertex(&'static str),
    /// A compute stage.
    Compute(&'static str),
}

/// A set of texels: the condition in GLSL, with `p` for the place, and on the CPU.
pub type Pattern = (&'static str, fn(u32, u32) -> bool);

/// The sets of texels that passes write.
pub const PATTERNS: &[Pattern] = &[
    ("p.x < 8", |x, _| x < 8),
    ("p.y >= 3", |_, y| y >= 3),
    ("((p.x + p.y) & 1) == 0", |x, y| (x + y) & 1 == 0),
    ("p.x == 5 || p.y == 2", |x, y| x == 5 || y == 2),
    ("p.x < 0", |_, _| false),
    ("p.x >= 0", |_, _| true),
];

use File::{Bare, Compute, Fragment, Vertex};
use On::{OneSample, Pictures, Words};

const FULL: &str = r#"draw: FullScreen("$shader"), color: ["$image"]"#;
const TRIANGLE: &str = r#"draw: Vertices(3), shader: "$shader", color: ["$image"]"#;
/// A triangle that covers all, at a depth of its own.
const WHOLE: File =
    Vertex("gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, $z, 1.0);");
/// A triangle whose right edge runs between two columns of texels.
const LEFT: File = Vertex(
    "gl_Position = vec4(gl_VertexIndex == 2 ? vec2(-9.0, 0.0) : vec2(0.0, gl_VertexIndex == 0 ? -9.0 : 9.0), $z, 1.0);",
);
const PLAIN: File = Fragment("c = color();");
const DISCARDS: File = Fragment("if (!keep(p)) discard; c = color();");
const MASKS: File = Fragment("gl_SampleMask[0] = keep(p) ? -1 : 0; c = color();");
const MASKS_DEPTH: File = Bare("void main() { gl_SampleMask[0] = keep(ivec2(gl_FragCoord.xy)) ? -1 : 0; }");
const DISCARDS_DEPTH: File = Bare("void main() { if (!keep(ivec2(gl_FragCoord.xy))) discard; }");
const WITH_DEPTH: &str = r#"draw: Vertices(3), shader: "$shader", color: ["$image"], depth: "$depth""#;
const DEPTH_ALONE: &str = r#"draw: Vertices(3), shader: "$shader", depth: "$depth""#;
const FULL_DEPTH: &str = r#"draw: FullScreen("$shader"), color: ["$image"], depth: (image: "$depth", test: Always)"#;
const MARKS: &str = r#"draw: FullScreen("$shader"), color: ["$image"], depth: (image: "$depth", write: false, test: Always, stencil: (reference: 3, pass: Replace))"#;
const STORES: &str = r#"dispatch: "$shader", groups: Texels("$image"), storage: {"to": "$image"}"#;
const FRAGMENT_STORES: &str =
    r#"draw: FullScreen("$shader"), storage: {"to": "$image"}, color: [(image: "$scratch", clear: (0, 0, 0, 0))]"#;
const STORE_PART: File = Compute(
    "layout(set = 0, binding = 0, rgba8) uniform writeonly image2D to;\nvoid main() { if (keep(p)) imageStore(to, p, color()); }",
);
const WORDS_STORE: &str = r#"dispatch: "$shader", groups: Invocations(16, 8), storage: {"to": "$image"}"#;
const TWO_OUTPUTS: &str = r#"draw: FullScreen("$shader"), color: [(image: "$scratch", clear: (0, 0, 0, 0)), "$image"]"#;

/// Means for colour; others say what is different.
const COLOR: Means = Means {
    name: "",
    on: Pictures,
    depth: false,
    stencil: false,
    files: &[],
    pass: FULL,
    effect: kept,
    may_be_refused: false,
};
const DEPTH: Means = Means { depth: true, pass: WITH_DEPTH, effect: kept_nearer, ..COLOR };
const STENCIL: Means = Means { depth: true, stencil: true, pass: MARKS, effect: kept_marked, ..COLOR };

/// All means. Clip distances, write masks, culling and stages in SPIR-V join them when the language has them.
pub const MEANS: &[Means] = &[
    // By the fragment stage.
    Means { name: "covers", files: &[PLAIN], effect: all, ..COLOR },
    Means { name: "discards", files: &[DISCARDS], ..COLOR },
    Means {
        name: "discards_in_a_function",
        files: &[Bare(
            "layout(location = 0) out vec4 c;\nvoid leave(bool kept) { if (!kept) discard; }\nvoid main() { leave(keep(ivec2(gl_FragCoord.xy))); c = color(); }",
        )],
        ..COLOR
    },
    Means { name: "demotes", files: &[Fragment("c = color(); if (!keep(p)) demote;")], ..COLOR },
    Means { name: "returns_early", files: &[Fragment("c = color(); if (keep(p)) return; discard;")], ..COLOR },
    Means { name: "masks", files: &[MASKS], ..COLOR },
    Means {
        name: "masks_samples",
        files: &[Fragment("gl_SampleMask[0] = keep(p) ? 5 : 2; c = color();")],
        effect: some_samples,
        ..COLOR
    },
    Means {
        name: "masks_in_a_function",
        files: &[Bare(
            "layout(location = 0) out vec4 c;\nvoid leave(bool kept) { gl_SampleMask[0] = kept ? -1 : 0; }\nvoid main() { leave(keep(ivec2(gl_FragCoord.xy))); c = color(); }",
        )],
        ..COLOR
    },
    Means {
        name: "masks_what_it_reads",
        files: &[Fragment("gl_SampleMask[0] = keep(p) ? gl_SampleMaskIn[0] : 0; c = color();")],
        ..COLOR
    },
    Means {
        name: "reads_the_mask",
        files: &[Fragment("c = color(); if (bitCount(gl_SampleMaskIn[0]) < 2) c.r = 4.0 / 255.0;")],
        effect: tells_samples,
        ..COLOR
    },
    Means {
        name: "alpha_to_coverage",
        files: &[Fragment("c = color();\nif (!keep(p)) c.a = 0.0;")],
        pass: r#"draw: FullScreen("$shader"), color: ["$image"], alpha_to_coverage: true"#,
        effect: by_alpha,
        ..COLOR
    },
    Means {
        name: "alpha_to_coverage_of_vertices",
        files: &[WHOLE, Fragment("c = color();\nif (!keep(p)) c.a = 0.0;")],
        pass: r#"draw: Vertices(3), shader: "$shader", color: ["$image"], alpha_to_coverage: true"#,
        effect: by_alpha,
        ..COLOR
    },
    Means {
        name: "blends_nothing",
        files: &[Fragment("c = color();\nif (!keep(p)) c.a = 0.0;")],
        pass: r#"draw: FullScreen("$shader"), color: [(image: "$image", blend: Alpha)]"#,
        effect: blended,
        ..COLOR
    },
    Means {
        name: "never_writes",
        files: &[Bare(
            "layout(location = 0) out vec4 a;\nlayout(location = 1) out vec4 b;\nvoid main() { a = color(); }",
        )],
        pass: TWO_OUTPUTS,
        effect: none,
        may_be_refused: true,
        ..COLOR
    },
    Means {
        name: "writes_on_one_path",
        files: &[Bare(
            "layout(location = 0) out vec4 a;\nlayout(location = 1) out vec4 b;\nvoid main() { a = color(); if (keep(ivec2(gl_FragCoord.xy))) b = color(); }",
        )],
        pass: TWO_OUTPUTS,
        may_be_refused: true,
        ..COLOR
    },
    Means {
        name: "returns_before_it_writes",
        files: &[Fragment("if (!keep(p)) return; c = color();")],
        may_be_refused: true,
        ..COLOR
    },
    // By the vertex stage.
    Means { name: "own_vertices", files: &[LEFT, PLAIN], effect: left, ..COLOR },
    Means { name: "own_vertices_that_cover", files: &[WHOLE, PLAIN], effect: all, ..COLOR },
    Means {
        name: "own_vertices_behind_all",
        files: &[
            Vertex("gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 2.0, 1.0);"),
            PLAIN,
        ],
        effect: none,
        ..COLOR
    },
    Means { name: "own_vertices_and_a_mask", files: &[LEFT, MASKS], effect: kept_left, ..COLOR },
    Means { name: "vertices", files: &[LEFT, PLAIN], pass: TRIANGLE, effect: left, ..COLOR },
    Means { name: "vertices_and_a_mask", files: &[LEFT, MASKS], pass: TRIANGLE, effect: kept_left, ..COLOR },
    // By depth.
    Means {
        name: "depth_covers",
        files: &[Fragment("c = color(); gl_FragDepth = $z;")],
        pass: FULL_DEPTH,
        effect: all_near,
        ..DEPTH
    },
    Means {
        name: "depth_tests",
        files: &[Fragment("c = color(); gl_FragDepth = $z;")],
        pass: r#"draw: FullScreen("$shader"), color: ["$image"], depth: (image: "$depth", write: false)"#,
        effect: nearer,
        ..DEPTH
    },
    Means {
        name: "depth_tests_early",
        files: &[WHOLE, Bare("layout(early_fragment_tests) in;\n$out\nvoid main() { c = color(); }")],
        effect: nearer_writes,
        ..DEPTH
    },
    Means {
        name: "depth_never",
        files: &[PLAIN],
        pass: r#"draw: FullScreen("$shader"), color: ["$image"], depth: (image: "$depth", test: Never)"#,
        effect: none,
        ..DEPTH
    },
    Means { name: "depth_and_discard", files: &[WHOLE, DISCARDS], ..DEPTH },
    Means {
        name: "depth_and_discard_of_colour_too",
        files: &[
            WHOLE,
            Bare(
                "layout(location = 0) out vec4 c;\nvoid main() { if (!keep(ivec2(gl_FragCoord.xy))) discard; c = color(); }",
            ),
        ],
        ..DEPTH
    },
    Means { name: "depth_and_demote", files: &[WHOLE, Fragment("c = color(); if (!keep(p)) demote;")], ..DEPTH },
    Means { name: "depth_and_mask", files: &[WHOLE, MASKS], ..DEPTH },
    Means {
        name: "depth_and_mask_of_samples",
        files: &[WHOLE, Fragment("gl_SampleMask[0] = keep(p) ? 5 : 2; c = color();")],
        effect: some_samples_nearer,
        ..DEPTH
    },
    Means {
        name: "depth_and_mask_it_reads",
        files: &[WHOLE, Fragment("gl_SampleMask[0] = keep(p) ? gl_SampleMaskIn[0] : 0; c = color();")],
        ..DEPTH
    },
    Means {
        name: "depth_and_alpha_to_coverage",
        files: &[
            WHOLE,
            Fragment(
                "c = color();\n#ifndef ALPHA_TO_COVERAGE\nif (!keep(p)) discard;\n#endif\nif (!keep(p)) c.a = 0.0;",
            ),
        ],
        pass: r#"draw: Vertices(3), shader: "$shader", color: ["$image"], depth: "$depth", alpha_to_coverage: true"#,
        ..DEPTH
    },
    Means {
        name: "depth_and_early_tests_with_discard",
        files: &[
            WHOLE,
            Bare(
                "layout(early_fragment_tests) in;\n$out\nvoid main() { if (!keep(ivec2(gl_FragCoord.xy))) discard; c = color(); }",
            ),
        ],
        effect: early_discard,
        ..DEPTH
    },
    Means {
        name: "depth_alone_and_discard",
        files: &[WHOLE, DISCARDS_DEPTH],
        pass: DEPTH_ALONE,
        effect: kept_depth_alone,
        ..DEPTH
    },
    Means {
        name: "depth_alone_and_mask",
        files: &[WHOLE, MASKS_DEPTH],
        pass: DEPTH_ALONE,
        effect: kept_depth_alone,
        ..DEPTH
    },
    Means {
        name: "full_depth_and_discard",
        files: &[Fragment("if (!keep(p)) discard; c = color(); gl_FragDepth = $z;")],
        pass: FULL_DEPTH,
        effect: kept_near,
        ..DEPTH
    },
    Means {
        name: "full_depth_and_mask",
        files: &[Fragment("gl_SampleMask[0] = keep(p) ? -1 : 0; c = color(); gl_FragDepth = $z;")],
        pass: FULL_DEPTH,
        effect: kept_near,
        ..DEPTH
    },
    Means { name: "full_depth_of_own_vertices", files: &[LEFT, PLAIN], pass: FULL_DEPTH, effect: left_near, ..DEPTH },
    // By stencil.
    Means {
        name: "stencil_tests",
        files: &[PLAIN],
        pass: r#"draw: FullScreen("$shader"), color: ["$image"], depth: (image: "$depth", write: false, test: Always, stencil: (test: Equal, reference: 3))"#,
        effect: where_marked,
        ..STENCIL
    },
    Means { name: "stencil_and_discard", files: &[DISCARDS], ..STENCIL },
    Means { name: "stencil_and_mask", files: &[MASKS], ..STENCIL },
    Means { name: "stencil_of_own_vertices", files: &[LEFT, PLAIN], effect: left_marked, ..STENCIL },
    // By stores.
    Means { name: "stores_a_part", on: OneSample, files: &[STORE_PART], pass: STORES, ..COLOR },
    Means {
        name: "stores_a_part_and_says_so",
        on: OneSample,
        files: &[STORE_PART],
        pass: r#"dispatch: "$shader", groups: Texels("$image"), storage: {"to": (image: "$image", access: ReadWrite)}"#,
        ..COLOR
    },
    Means {
        name: "stores_and_returns_early",
        on: OneSample,
        files: &[Compute(
            "layout(set = 0, binding = 0, rgba8) uniform writeonly image2D to;\nvoid main() { if (!keep(p)) return; imageStore(to, p, color()); }",
        )],
        pass: STORES,
        ..COLOR
    },
    Means {
        name: "stores_too_few_groups",
        on: OneSample,
        files: &[Compute(
            "layout(set = 0, binding = 0, rgba8) uniform writeonly image2D to;\nvoid main() { imageStore(to, p, color()); }",
        )],
        pass: r#"dispatch: "$shader", groups: Count(1), storage: {"to": "$image"}"#,
        effect: left,
        ..COLOR
    },
    Means {
        name: "stores_without_a_word",
        on: OneSample,
        files: &[Compute(
            "layout(set = 0, binding = 0, rgba8) uniform image2D to;\nvoid main() { if (keep(p)) imageStore(to, p, color()); }",
        )],
        pass: STORES,
        ..COLOR
    },
    Means {
        name: "stores_from_fragments",
        on: OneSample,
        files: &[Bare(
            "layout(set = 0, binding = 0, rgba8) uniform writeonly image2D to;\nlayout(location = 0) out vec4 c;\nvoid main() { ivec2 p = ivec2(gl_FragCoord.xy); c = vec4(0.0); if (keep(p)) imageStore(to, p, color()); }",
        )],
        pass: FRAGMENT_STORES,
        ..COLOR
    },
    Means {
        name: "stores_all_as_promised",
        on: OneSample,
        files: &[Compute(
            "layout(set = 0, binding = 0, rgba8) uniform writeonly image2D to;\nvoid main() { imageStore(to, p, color()); }",
        )],
        pass: r#"dispatch: "$shader", groups: Texels("$image"), storage: {"to": (image: "$image", access: Write)}"#,
        effect: all,
        ..COLOR
    },
    Means {
        name: "words_in_part",
        on: Words,
        files: &[Compute(
            "layout(set = 0, binding = 0) writeonly buffer To { uint v[]; } to;\nvoid main() { if (keep(p)) to.v[p.x + 16 * p.y] = uint(color().x * 255.0 + 0.5); }",
        )],
        pass: WORDS_STORE,
        ..COLOR
    },
    Means {
        name: "words_in_part_and_says_so",
        on: Words,
        files: &[Compute(
            "layout(set = 0, binding = 0) writeonly buffer To { uint v[]; } to;\nvoid main() { if (keep(p)) to.v[p.x + 16 * p.y] = uint(color().x * 255.0 + 0.5); }",
        )],
        pass: r#"dispatch: "$shader", groups: Invocations(16, 8), storage: {"to": (buffer: "$image", access: ReadWrite)}"#,
        ..COLOR
    },
    Means {
        name: "words_and_returns_early",
        on: Words,
        files: &[Compute(
            "layout(set = 0, binding = 0) writeonly buffer To { uint v[]; } to;\nvoid main() { if (!keep(p)) return; to.v[p.x + 16 * p.y] = uint(color().x * 255.0 + 0.5); }",
        )],
        pass: WORDS_STORE,
        ..COLOR
    },
    Means {
        name: "words_without_a_word",
        on: Words,
        files: &[Compute(
            "layout(set = 0, binding = 0) buffer To { uint v[]; } to;\nvoid main() { if (keep(p)) to.v[p.x + 16 * p.y] = uint(color().x * 255.0 + 0.5); }",
        )],
        pass: WORDS_STORE,
        ..COLOR
    },
    Means {
        name: "words_from_fragments",
        on: Words,
        files: &[Bare(
            "layout(set = 0, binding = 0) writeonly buffer To { uint v[]; } to;\nlayout(location = 0) out vec4 c;\nvoid main() { ivec2 p = ivec2(gl_FragCoord.xy); c = vec4(0.0); if (keep(p)) to.v[p.x + 16 * p.y] = uint(color().x * 255.0 + 0.5); }",
        )],
        pass: FRAGMENT_STORES,
        ..COLOR
    },
    Means {
        name: "words_all_as_promised",
        on: Words,
        files: &[Compute(
            "layout(set = 0, binding = 0) writeonly buffer To { uint v[]; } to;\nvoid main() { to.v[p.x + 16 * p.y] = uint(color().x * 255.0 + 0.5); }",
        )],
        pass: r#"dispatch: "$shader", groups: Invocations(16, 8), storage: {"to": (buffer: "$image", access: Write)}"#,
        effect: all,
        ..COLOR
    },
];

fn none(_: &mut Texel, _: &At) {}

fn all(texel: &mut Texel, at: &At) {
    texel.color = at.color();
}

fn kept(texel: &mut Texel, at: &At) {
    if at.kept {
        all(texel, at);
    }
}

fn left(texel: &mut Texel, at: &At) {
    if at.x < 8 {
        all(texel, at);
    }
}

fn kept_left(texel: &mut Texel, at: &At) {
    if at.kept {
        left(texel, at);
    }
}

/// The samples that the shaders mask: bits of 5 or of 2.
fn some_samples(texel: &mut Texel, at: &At) {
    if at.masks_sample() {
        all(texel, at);
    }
}

/// A driver may clip a triangle into several, so that one of them covers some samples of a texel: at least two, if there are four.
fn tells_samples(texel: &mut Texel, at: &At) {
    all(texel, at);
    if at.samples == 1 {
        texel.color[0] = 4;
    }
}

/// With one sample, alpha covers nothing and is stored.
fn by_alpha(texel: &mut Texel, at: &At) {
    if at.samples == 1 {
        all(texel, at);
        texel.color[3] = if at.kept { 255 } else { 0 };
    } else {
        kept(texel, at);
    }
}

/// What has no alpha leaves colour as it is, and lets alpha be: 0 + 1 · what was there.
fn blended(texel: &mut Texel, at: &At) {
    kept(texel, at);
}

/// Depth is reversed: what is nearer is greater.
fn nearer(texel: &mut Texel, at: &At) {
    if at.near() >= texel.depth {
        all(texel, at);
    }
}

fn all_near(texel: &mut Texel, at: &At) {
    all(texel, at);
    texel.depth = at.near();
}

fn nearer_writes(texel: &mut Texel, at: &At) {
    if at.near() >= texel.depth {
        all_near(texel, at);
    }
}

fn kept_nearer(texel: &mut Texel, at: &At) {
    if at.kept {
        nearer_writes(texel, at);
    }
}

fn some_samples_nearer(texel: &mut Texel, at: &At) {
    if at.masks_sample() {
        nearer_writes(texel, at);
    }
}

/// Tests before the fragment stage write depth where that leaves colour out.
fn early_discard(texel: &mut Texel, at: &At) {
    if at.near() >= texel.depth {
        texel.depth = at.near();
        kept(texel, at);
    }
}

fn kept_depth_alone(texel: &mut Texel, at: &At) {
    if at.kept && at.near() >= texel.depth {
        texel.depth = at.near();
    }
}

fn kept_near(texel: &mut Texel, at: &At) {
    if at.kept {
        all_near(texel, at);
    }
}

fn left_near(texel: &mut Texel, at: &At) {
    if at.x < 8 {
        all_near(texel, at);
    }
}

fn where_marked(texel: &mut Texel, at: &At) {
    if texel.stencil == 3 {
        all(texel, at);
    }
}

fn kept_marked(texel: &mut Texel, at: &At) {
    if at.kept {
        all(texel, at);
        texel.stencil = 3;
    }
}

fn left_marked(texel: &mut Texel, at: &At) {
    if at.x < 8 {
        all(texel, at);
        texel.stencil = 3;
    }
}
