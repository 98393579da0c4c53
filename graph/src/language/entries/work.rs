//! What a pass does: `draw`, `dispatch`, `copy`, `blit`, `fill` or `custom`, exactly one of them.

use super::dispatch;
use super::draw::{self, Beside};
use super::pass_fields::PassFields;
use super::transfer::{self, listed};
use crate::language::model::Work;
use crate::language::scope::Scope;
use crate::ron::{Reader, Shape};

/// Fields of a pass that have a meaning beside some kinds of work alone.
pub(crate) const GOES_WITH: [(&str, &[&str]); 13] = [
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

/// The one thing that the pass does. `what` names the pass.
pub(crate) fn lower<'src>(
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
        "draw" => {
            let beside = Beside { shader: fields.shader, vertex: fields.vertex, index: fields.index };
            draw::lower(reader, scope, leaf, beside, what)
        }
        "dispatch" => dispatch::lower(reader, scope, leaf, fields.groups, what),
        "copy" => transfer::copy(reader, scope, leaf),
        "blit" => transfer::blit(reader, scope, leaf),
        "fill" => transfer::fill(reader, scope, leaf),
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
