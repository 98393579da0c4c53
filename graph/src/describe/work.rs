//! What a pass does: `draw`, `dispatch`, `copy`, `blit`, `fill` or `custom`, exactly one of them.

use super::bindings::FILTERS;
use super::leaf::{Leaf, Shape};
use super::parts;
use super::pass::{Draw, Groups, Part, Work};
use super::passes::PassFields;
use super::pipeline::Name;
use super::reader::Reader;
use super::scope::Scope;
use super::values;
use crate::fields;
use crate::frame::DrawList;

fields! {
    struct CopyFields<'src> {
        from: Leaf<'src>,
        to: Leaf<'src>,
    }
}

fields! {
    struct BlitFields<'src> {
        from: Leaf<'src>,
        to: Leaf<'src>,
        filter: Option<Leaf<'src>>,
    }
}

fields! {
    struct FillFields<'src> {
        to: Leaf<'src>,
        value: Leaf<'src>,
    }
}

const DRAWS: &str = "a draw is `Objects(Opaque)`, `Objects(Masked)`, `Objects(Transparent)`, `Sky`, \
                     `FullScreen(\"shader\")`, `Vertices(count, instances)` or `Indirect(\"buffer\")`";

const GROUPS: &str =
    "groups are `Count(8, 8, 1)`, `Invocations(1000, 1, 1)`, `Texels(\"image\")` or `Indirect(\"buffer\")`";

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
        let twice = super::Diagnostic::new(more.span(), format!("{what} has both `{word}` and `{second}`"));
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
    let all = [
        ("shader", fields.shader, &["draw"][..]),
        ("groups", fields.groups, &["dispatch"]),
        ("sample", fields.sample, &["draw", "dispatch", "custom"]),
        ("storage", fields.storage, &["draw", "dispatch", "custom"]),
        ("uniform", fields.uniform, &["draw", "dispatch", "custom"]),
        ("params", fields.params, &["draw", "dispatch", "custom"]),
        ("vertex", fields.vertex, &["draw"]),
        ("index", fields.index, &["draw"]),
        ("color", fields.color, &["draw", "custom"]),
        ("depth", fields.depth, &["draw", "custom"]),
        ("reads", fields.reads, &["custom"]),
        ("writes", fields.writes, &["custom"]),
    ];
    for (field, leaf, words) in all {
        let Some(leaf) = leaf.filter(|_| !words.contains(&word)) else { continue };
        let fitting: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
        let message = format!("{what} has `{field}`, which means nothing beside `{word}`");
        let help = format!("`{field}` goes with {}", fitting.join(", "));
        let diagnostic = super::Diagnostic::new(leaf.span(), message);
        reader.report(diagnostic.help(help));
    }
    let writes =
        fields.storage.is_some() || fields.writes.is_some() || fields.color.is_some() || fields.depth.is_some();
    if matches!(word, "dispatch" | "custom") && !writes && fields.side_effect.is_none() {
        let nothing = super::Diagnostic::new(fields.name.span(), format!("{what} writes nothing"));
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
    let words = ["Objects", "Sky", "FullScreen", "Vertices", "Indirect"];
    let (word, rest) = reader.word(leaf, "a draw", &words, DRAWS)?;
    if !matches!(word, "Vertices" | "Indirect") {
        for (field, foreign) in [("vertex", fields.vertex), ("index", fields.index)] {
            let Some(foreign) = foreign else { continue };
            let message = format!("{what} has `{field}`, which means nothing beside `{word}`");
            reader.wrong(foreign, message, "buffers of vertices go with `Vertices(…)` and `Indirect(…)`");
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
    let (list, rest) = reader.word(list, "a draw list", &["Opaque", "Masked", "Transparent"], DRAWS)?;
    reader.bare(list, rest)?;
    Some(match list {
        "Opaque" => DrawList::Opaque,
        "Masked" => DrawList::Masked,
        _ => DrawList::Transparent,
    })
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
        reader.wrong(leaf, format!("{what} doesn't say how many workgroups run"), GROUPS);
        return None;
    };
    let groups = groups(reader, scope, leaf);
    Some(Work::Dispatch { shader: shader?, groups: leaf.spanned(groups?) })
}

fn groups<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Groups> {
    let words = ["Count", "Invocations", "Texels", "Indirect"];
    let (word, rest) = reader.word(leaf, "a number of workgroups", &words, GROUPS)?;
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
