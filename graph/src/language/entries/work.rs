//! The work of a pass: `draw`, `dispatch`, `copy`, `blit`, `fill` or `custom`, exactly one of them.

use super::draw::DrawFields;
use super::pass_fields::PassFields;
use crate::base::Code;
use crate::language::model::Work;
use crate::language::scope::{Context, FieldValue, combined};
use crate::ron::{Reader, Shape};
use std::fmt::Display;

/// Fields of a pass that have a meaning beside some kinds of work alone.
pub(crate) const GOES_WITH: [(&str, &[&str]); 19] = [
    ("shader", &["draw"]),
    ("groups", &["dispatch"]),
    ("sample", &["draw", "dispatch", "custom"]),
    ("storage", &["draw", "dispatch", "custom"]),
    ("uniform", &["draw", "dispatch", "custom"]),
    ("params", &["draw", "dispatch", "custom"]),
    ("constants", &["draw", "dispatch"]),
    ("vertex", &["draw"]),
    ("index", &["draw"]),
    ("color", &["draw", "custom"]),
    ("depth", &["draw", "custom"]),
    ("raster", &["draw", "custom"]),
    ("alpha_to_coverage", &["draw"]),
    ("covers", &["draw", "custom"]),
    ("reads", &["custom"]),
    ("writes", &["custom"]),
    ("uses", &["custom"]),
    ("queue", &["custom"]),
    ("both_eyes", &["custom"]),
];

impl Context<'_> {
    /// The work of a pass. `what` names the pass.
    pub(crate) fn work(&mut self, fields: &PassFields<'_>, what: impl Display + Copy) -> Option<FieldValue<Work>> {
        let PassFields { draw, dispatch, copy, blit, fill, custom, .. } = fields;
        let named = [
            ("draw", *draw),
            ("dispatch", *dispatch),
            ("copy", *copy),
            ("blit", *blit),
            ("fill", *fill),
            ("custom", *custom),
        ];
        let mut kinds = named.into_iter().filter_map(|(word, leaf)| Some((word, leaf?)));
        let Some((word, leaf)) = kinds.next() else {
            let help = "give it one of `draw`, `dispatch`, `copy`, `blit`, `fill` and `custom`";
            self.reader.wrong(Code::PASS_DOES_NOTHING, fields.name, format!("{what} does nothing"), help);
            return None;
        };
        if let Some((second, more)) = kinds.next() {
            let twice = crate::base::Diagnostic::new(
                Code::PASS_DOES_TWO_THINGS,
                more.span(),
                format!("{what} has both `{word}` and `{second}`"),
            );
            let twice = twice.label(leaf.span(), format!("`{word}` stands here"));
            self.reader.report(twice.help("a pass does one thing: make it two passes"));
            return None;
        }
        fits(self.reader, fields, what, word);
        if matches!(word, "copy" | "blit" | "fill") && !matches!(leaf.shape(), Shape::Parentheses) {
            let form = if word == "fill" { "`(to: …, value: …)`" } else { "`(from: …, to: …)`" };
            self.reader.expected(leaf, form);
            return None;
        }
        match word {
            "draw" => {
                let beside = DrawFields { shader: fields.shader, vertex: fields.vertex, index: fields.index };
                self.draw_work(leaf, beside, what)
            }
            "dispatch" => self.dispatch_work(leaf, fields.groups, what),
            "copy" => self.copy_work(leaf),
            "blit" => self.blit_work(leaf),
            "fill" => self.fill_work(leaf),
            _ => {
                let callback = self.reader.outside_name(leaf, "what the program records");
                let reads = self.listed_parts(fields.reads, "`reads`");
                let writes = self.listed_parts(fields.writes, "`writes`");
                let callback = callback?;
                Some(combined((reads?, writes?), move |(reads, writes)| Work::Custom {
                    callback: callback.clone(),
                    reads,
                    writes,
                }))
            }
        }
    }
}

/// Reports fields that have no meaning beside the work of the pass.
fn fits(reader: &mut Reader, fields: &PassFields<'_>, what: impl Display, word: &str) {
    let reads_something = fields.sample.is_some() || fields.uniform.is_some();
    let values = [
        fields.shader,
        fields.groups,
        fields.sample,
        fields.storage,
        fields.uniform,
        fields.params,
        fields.constants,
        fields.vertex,
        fields.index,
        fields.color,
        fields.depth,
        fields.raster,
        fields.alpha_to_coverage,
        fields.covers,
        fields.reads,
        fields.writes,
        fields.uses,
        fields.queue,
        fields.both_eyes,
    ];
    for ((field, words), leaf) in GOES_WITH.into_iter().zip(values) {
        let Some(leaf) = leaf.filter(|_| !words.contains(&word)) else { continue };
        let fitting: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
        let message = format!("{what} has `{field}`, which means nothing beside `{word}`");
        let help = format!("leave `{field}` out: it goes with {}", fitting.join(", "));
        let diagnostic = crate::base::Diagnostic::new(Code::FIELD_UNFIT, leaf.span(), message);
        reader.report(diagnostic.help(help));
    }
    let writes =
        fields.storage.is_some() || fields.writes.is_some() || fields.color.is_some() || fields.depth.is_some();
    if matches!(word, "dispatch" | "custom") && !writes && fields.side_effect.is_none() {
        let nothing =
            crate::base::Diagnostic::new(Code::PASS_DOES_NOTHING, fields.name.span(), format!("{what} writes nothing"));
        let reads = if reads_something { "what it reads goes nowhere: " } else { "" };
        let field = if word == "dispatch" { "storage: {\"…\": \"…\"}" } else { "writes: [\"…\"]" };
        reader.report(nothing.help(format!("{reads}give it `{field}`, or say `side_effect: true`")));
    }
}
