//! What a pass does: `draw`, `dispatch`, `copy`, `blit`, `fill` or `custom`, exactly one of them.

use super::bindings::{self, FILTERS};
use super::pass::{Draw, Groups, Part, Work};
use super::passes::PassFields;
use super::scope::Scope;
use super::{casters, parts, values};
use crate::fields;
use crate::frame::DrawList;
use crate::ron::{Described, Form, Leaf, Name, Plain, Reader, Shape, Takes, Word, Words, names};

fields! {
    /// A copy: bits as they are.
    /// ```ron
    /// (from: "image", to: "target")
    /// ```
    struct CopyFields<'src> {
        /// What is copied.
        from: Leaf<'src> => parts::ANY,
        /// To where.
        to: Leaf<'src> => parts::ANY,
    }
}

/// What `copy` takes.
pub(super) const COPY: Form = Form::Fields(CopyFields::<'static>::table);

fields! {
    /// A blit: an image is copied and scaled.
    /// ```ron
    /// (from: (image: "image", mip: 0), to: (image: "image", mip: 1), filter: Linear)
    /// ```
    struct BlitFields<'src> {
        /// What is copied: one mip level.
        from: Leaf<'src> => parts::IMAGE,
        /// To where: one mip level.
        to: Leaf<'src> => parts::IMAGE,
        /// How texels are mixed; `Linear` for colour and else `Nearest` if left out.
        filter: Option<Leaf<'src>> => bindings::FILTER,
    }
}

/// What `blit` takes.
pub(super) const BLIT: Form = Form::Fields(BlitFields::<'static>::table);

fields! {
    /// A fill: an image or buffer is set to a value.
    /// ```ron
    /// (to: "buffer", value: 0)
    /// ```
    struct FillFields<'src> {
        /// What is set.
        to: Leaf<'src> => parts::ANY,
        /// To what: a number for every component or word, depth and stencil, or red, green, blue and alpha.
        value: Leaf<'src> => values::FILL,
    }
}

/// What `fill` takes.
pub(super) const FILL: Form = Form::Fields(FillFields::<'static>::table);

/// What `reads` and `writes` take.
pub(super) const TRANSFERRED: Form = Form::Either(&[parts::WHOLE_RESOURCE, Form::List(&parts::ANY)]);

/// What `draw` takes.
pub(super) const DRAW: Form = Form::Words(&DRAWS);

static DRAWS: Words = Words {
    name: "Draw",
    what: "a draw",
    or: &[],
    all: &[
        Word::new(
            "Objects",
            &[Takes::Values(&[Form::Choice("a draw list", || names(&LISTS))])],
            &["Objects(Opaque)", "Objects(Masked)", "Objects(Transparent)"],
            "The scene's opaque objects, those that alpha cuts holes into, or those that let light through.",
        ),
        Word::new(
            "Casters",
            &[Takes::Fields(casters::fields)],
            &[casters::FORM],
            "What casts the sun's shadow, as the sun sees it: depth for a shadow map.",
        ),
        Word::alone("Sky", "The scene's sky, by the shader `sky` unless `shader` names another."),
        Word::new(
            "FullScreen",
            &[Takes::Values(&[Form::Plain(Plain::Outside)])],
            &["FullScreen(\"shader\")"],
            "Every pixel, by this shader.",
        ),
        Word::new(
            "Vertices",
            &[Takes::Values(&[MANY]), Takes::Values(&[MANY, MANY])],
            &["Vertices(3, 100)"],
            "So many vertices, or indices, of triangles, so many times; once if one number stands there.",
        ),
        Word::new(
            "Indirect",
            &[Takes::Values(&[parts::BUFFER])],
            &["Indirect(\"buffer\")"],
            "As many as a buffer says: a `VkDrawIndirectCommand`, with `index` a `VkDrawIndexedIndirectCommand`.",
        ),
    ],
};

/// Draw lists, by name.
pub(super) const LISTS: [(&str, DrawList); 3] =
    [("Opaque", DrawList::Opaque), ("Masked", DrawList::Masked), ("Transparent", DrawList::Transparent)];

/// Counts of vertices, instances and invocations.
const MANY: Form = Form::Whole(1, u32::MAX as i64);

/// What `groups` takes.
pub(super) const WORKGROUPS: Form = Form::Words(&GROUPS);

static GROUPS: Words = Words {
    name: "Groups",
    what: "a number of workgroups",
    or: &[],
    all: &[
        Word::new(
            "Count",
            &[Takes::Values(&[GROUP]), Takes::Values(&[GROUP, GROUP]), Takes::Values(&[GROUP, GROUP, GROUP])],
            &["Count(8, 8, 1)"],
            "So many in x, y and z; numbers that are left out are 1.",
        ),
        Word::new(
            "Invocations",
            &[Takes::Values(&[MANY]), Takes::Values(&[MANY, MANY]), Takes::Values(&[MANY, MANY, MANY])],
            &["Invocations(1000, 1, 1)"],
            "As many as cover so many invocations in x, y and z, by the shader's own workgroup size.",
        ),
        Word::new(
            "Texels",
            &[Takes::Values(&[parts::IMAGE]), Takes::Fields(parts::part)],
            &["Texels(\"image\")"],
            "As many as cover one invocation for each texel of an image or a part of it, layers or depth in z.",
        ),
        Word::new(
            "Indirect",
            &[
                Takes::Values(&[parts::BUFFER]),
                Takes::Values(&[parts::BUFFER, Form::Whole(0, super::buffers::LARGEST_BUFFER)]),
            ],
            &["Indirect(\"buffer\")"],
            "As many as a buffer says, from this byte on: a `VkDispatchIndirectCommand`.",
        ),
    ],
};

const GROUP: Form = Form::Whole(1, MOST_GROUPS);

/// Fields of a pass that have a meaning beside some kinds of work alone.
pub(super) const GOES_WITH: [(&str, &[&str]); 13] = [
    ("shader", &["draw"]),
    ("groups", &["dispatch"]),
    ("sample", &["draw", "dispatch", "custom"]),
    ("storage", &["draw", "dispatch", "custom"]),
    ("uniform", &["draw", "dispatch", "custom"]),
    ("params", &["draw", "dispatch", "custom"]),
    ("vertex", &["draw"]),
    ("index", &["draw"]),
    ("color", &["draw", "custom"]),
    ("depth", &["draw", "custom"]),
    ("alpha_to_coverage", &["draw"]),
    ("reads", &["custom"]),
    ("writes", &["custom"]),
];

/// Every device allows so many workgroups in x, y and z.
pub(crate) const MOST_GROUPS: i64 = 65535;

/// The one thing that the pass does. `what` names the pass.
pub(super) fn lower<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    fields: &PassFields<'src>,
    what: &str,
) -> Option<Work> {
    let PassFields { draw, dispatch, copy, blit, fill, custom, .. } = fields;
    let named = [
        ("draw", *draw),
        ("dispatch", *dispatch),
        ("copy", *copy),
        ("blit", *blit),
        ("fill", *fill),
        ("custom", *custom),
    ];
    let mut given = named.into_iter().filter_map(|(word, leaf)| Some((word, leaf?)));
    let Some((word, leaf)) = given.next() else {
        let help = "give it one of `draw`, `dispatch`, `copy`, `blit`, `fill` and `custom`";
        reader.wrong(fields.name, format!("{what} does nothing"), help);
        return None;
    };
    if let Some((second, more)) = given.next() {
        let twice = crate::base::Diagnostic::new(more.span(), format!("{what} has both `{word}` and `{second}`"));
        let twice = twice.label(leaf.span(), format!("`{word}` stands here"));
        reader.report(twice.help("a pass does one thing: make it two passes"));
        return None;
    }
    fits(reader, fields, what, word);
    if matches!(word, "copy" | "blit" | "fill") && !matches!(leaf.shape(), Shape::Parentheses) {
        let form = if word == "fill" { "`(to: …, value: …)`" } else { "`(from: …, to: …)`" };
        reader.expected(leaf, form);
        return None;
    }
    match word {
        "draw" => draw_work(reader, scope, fields, leaf, what),
        "dispatch" => dispatch_work(reader, scope, fields, leaf, what),
        "copy" => {
            let fields: CopyFields<'_> = reader.read(leaf, "a copy")?;
            let (from, to) = (parts::any(reader, scope, fields.from), parts::any(reader, scope, fields.to));
            Some(Work::Copy { from: from?, to: to? })
        }
        "blit" => {
            let fields: BlitFields<'_> = reader.read(leaf, "a blit")?;
            let (from, to) = (parts::image(reader, scope, fields.from), parts::image(reader, scope, fields.to));
            let filter = match fields.filter {
                Some(leaf) => {
                    values::choice(reader, leaf, "a filter", &FILTERS).map(|filter| Some(leaf.spanned(filter)))
                }
                None => Some(None),
            };
            Some(Work::Blit { from: Part::Image(from?), to: Part::Image(to?), filter: filter? })
        }
        "fill" => {
            let fields: FillFields<'_> = reader.read(leaf, "a fill")?;
            let to = parts::any(reader, scope, fields.to);
            let value = values::fill(reader, scope, fields.value).map(|value| fields.value.spanned(value));
            Some(Work::Fill { to: to?, value: value? })
        }
        _ => {
            let callback = reader.outside_name(leaf, "what the program records");
            let reads = listed(reader, scope, fields.reads, "`reads`");
            let writes = listed(reader, scope, fields.writes, "`writes`");
            Some(Work::Custom { callback: callback?, reads: reads?, writes: writes? })
        }
    }
}

/// Reports fields that have no meaning beside what the pass does.
fn fits(reader: &mut Reader, fields: &PassFields<'_>, what: &str, word: &str) {
    let reads_something = fields.sample.is_some() || fields.uniform.is_some();
    let values = [
        fields.shader,
        fields.groups,
        fields.sample,
        fields.storage,
        fields.uniform,
        fields.params,
        fields.vertex,
        fields.index,
        fields.color,
        fields.depth,
        fields.alpha_to_coverage,
        fields.reads,
        fields.writes,
    ];
    for ((field, words), leaf) in GOES_WITH.into_iter().zip(values) {
        let Some(leaf) = leaf.filter(|_| !words.contains(&word)) else { continue };
        let fitting: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
        let message = format!("{what} has `{field}`, which means nothing beside `{word}`");
        let help = format!("leave `{field}` out: it goes with {}", fitting.join(", "));
        let diagnostic = crate::base::Diagnostic::new(leaf.span(), message);
        reader.report(diagnostic.help(help));
    }
    let writes =
        fields.storage.is_some() || fields.writes.is_some() || fields.color.is_some() || fields.depth.is_some();
    if matches!(word, "dispatch" | "custom") && !writes && fields.side_effect.is_none() {
        let nothing = crate::base::Diagnostic::new(fields.name.span(), format!("{what} writes nothing"));
        let reads = if reads_something { "what it reads goes nowhere: " } else { "" };
        let field = if word == "dispatch" { "storage: {\"…\": \"…\"}" } else { "writes: [\"…\"]" };
        reader.report(nothing.help(format!("{reads}give it `{field}`, or say `side_effect: true`")));
    }
}

/// What is drawn, by which shader.
fn draw_work<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    fields: &PassFields<'src>,
    leaf: Leaf<'src>,
    what: &str,
) -> Option<Work> {
    let (word, rest) = reader.one_of(leaf, &DRAWS)?;
    if !matches!(word, "Vertices" | "Indirect") {
        for (field, foreign) in [("vertex", fields.vertex), ("index", fields.index)] {
            let Some(foreign) = foreign else { continue };
            let message = format!("{what} has `{field}`, which means nothing beside `{word}`");
            reader.wrong(
                foreign,
                message,
                &format!("leave `{field}` out: buffers of vertices go with `Vertices(…)` and `Indirect(…)`"),
            );
        }
    }
    let (draw, verb) = match word {
        "FullScreen" => {
            let [shader]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "FullScreen(\"shader\")")?;
            if let Some(second) = fields.shader {
                reader.wrong(second, format!("{what} names its shader in `FullScreen(…)` already"), "");
                return None;
            }
            return Some(Work::Draw { draw: Draw::FullScreen, shader: reader.outside_name(shader, "a shader")? });
        }
        "Sky" => {
            reader.bare(word, rest)?;
            if fields.shader.is_none() {
                let shader = Name { text: "sky".into(), span: leaf.span() };
                return Some(Work::Draw { draw: Draw::Sky, shader });
            }
            (Draw::Sky, "draws the sky")
        }
        "Objects" => (Draw::Objects(list(reader, leaf, rest)?), "draws objects"),
        "Casters" => (Draw::Casters(casters::lower(reader, scope, leaf, rest)?), "draws objects"),
        "Vertices" => {
            let one = || Some(1);
            let number = |reader: &mut Reader, leaf, what: &str| {
                values::whole(reader, scope, leaf, what, 1..=i64::from(u32::MAX))
            };
            let form = "Vertices(3)` or `Vertices(3, 100)";
            let (count, instances) = match rest.and_then(Leaf::tuple) {
                Some([count, instances]) => {
                    (number(reader, count, "number of vertices"), number(reader, instances, "number of instances"))
                }
                None => {
                    let [count]: [Leaf<'_>; 1] = reader.inside(leaf, rest, form)?;
                    (number(reader, count, "number of vertices"), one())
                }
            };
            (Draw::Vertices { count: count?, instances: instances? }, "draws vertices")
        }
        _ => {
            let [buffer]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Indirect(\"buffer\")")?;
            (Draw::Indirect(parts::buffer(reader, scope, buffer)?), "draws vertices")
        }
    };
    let Some(shader) = fields.shader else {
        reader.wrong(leaf, format!("{what} {verb} and needs a shader"), "add `shader: \"…\"`");
        return None;
    };
    Some(Work::Draw { draw, shader: reader.outside_name(shader, "a shader")? })
}

/// One of the scene's draw lists.
fn list<'src>(reader: &mut Reader, leaf: Leaf<'src>, rest: Option<Leaf<'src>>) -> Option<DrawList> {
    let [list]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Objects(Opaque)")?;
    values::choice(reader, list, "a draw list", &LISTS)
}

/// A compute shader and how often it runs.
fn dispatch_work<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    fields: &PassFields<'src>,
    leaf: Leaf<'src>,
    what: &str,
) -> Option<Work> {
    let shader = reader.outside_name(leaf, "a shader");
    let Some(leaf) = fields.groups else {
        reader.wrong(
            leaf,
            format!("{what} doesn't say how many workgroups run"),
            "add `groups: Count(8, 8, 1)`, or another number",
        );
        return None;
    };
    let groups = groups(reader, scope, leaf);
    Some(Work::Dispatch { shader: shader?, groups: leaf.spanned(groups?) })
}

fn groups<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Groups> {
    let (word, rest) = reader.one_of(leaf, &GROUPS)?;
    match word {
        "Count" => three(reader, scope, leaf, rest, "number of workgroups", MOST_GROUPS).map(Groups::Count),
        "Invocations" => {
            three(reader, scope, leaf, rest, "number of invocations", i64::from(u32::MAX)).map(Groups::Invocations)
        }
        "Texels" => {
            let image = match rest {
                // `Texels(image: "x", mip: 1)` is the part itself, in the word's own parentheses.
                Some(rest) if rest.tuple::<1>().is_none() => rest,
                _ => reader.inside::<[Leaf<'_>; 1]>(leaf, rest, "Texels(\"image\")")?[0],
            };
            parts::image(reader, scope, image).map(Groups::Texels)
        }
        _ => {
            let (buffer, offset) = match rest.and_then(Leaf::tuple) {
                Some([buffer, offset]) => (buffer, Some(offset)),
                None => (
                    reader.inside::<[Leaf<'_>; 1]>(leaf, rest, "Indirect(\"buffer\")` or `Indirect(\"buffer\", 16)")?
                        [0],
                    None,
                ),
            };
            let buffer = parts::buffer(reader, scope, buffer);
            let offset = match offset {
                Some(leaf) => values::whole(reader, scope, leaf, "offset in bytes", 0..=super::buffers::LARGEST_BUFFER),
                None => Some(0),
            };
            Some(Groups::Indirect { buffer: buffer?, offset: offset? })
        }
    }
}

/// One to three whole numbers; those that are left out are 1.
fn three<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    rest: Option<Leaf<'src>>,
    what: &str,
    most: i64,
) -> Option<[u32; 3]> {
    let probed = rest.and_then(|rest| {
        let one = rest.tuple().map(|[x]| (x, None, None));
        one.or_else(|| rest.tuple().map(|[x, y]| (x, Some(y), None)))
    });
    let (x, y, z) = match probed {
        Some(few) => few,
        None => {
            let [x, y, z]: [Leaf<'_>; 3] = reader.inside(leaf, rest, "Count(8, 8, 1)")?;
            (x, Some(y), Some(z))
        }
    };
    let number = [Some(x), y, z].map(|leaf| match leaf {
        Some(leaf) => values::whole(reader, scope, leaf, what, 1..=most),
        None => Some(1),
    });
    Some([number[0]?, number[1]?, number[2]?])
}

/// Parts of images and buffers in a list.
fn listed<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Option<Leaf<'src>>, field: &str) -> Option<Vec<Part>> {
    let Some(leaf) = leaf else { return Some(Vec::new()) };
    let entries = match leaf.shape() {
        Shape::List => reader.list(leaf, field)?,
        _ => vec![leaf],
    };
    let parts: Vec<Option<Part>> = entries.into_iter().map(|entry| parts::any(reader, scope, entry)).collect();
    parts.into_iter().collect()
}
