//! `draw`: the draw of a raster pass.

use super::casters;
use super::values::MANY;
use super::{indirect, parts, shader};
use crate::base::Code;
use crate::frame::{Draw, DrawList};
use crate::language::model::Work;
use crate::language::scope::{Context, FieldValue, combined};
use crate::ron::{Form, Leaf, Name, Reader, Word, WordContents, Words, names};
use std::fmt::Display;

/// The form of `draw`.
pub(crate) const DRAW: Form = Form::Words(&DRAWS);

static DRAWS: Words = Words {
    name: "Draw",
    what: "a draw",
    or: &[],
    all: &[
        Word::new(
            "Objects",
            &[WordContents::Values(&[Form::Choice("a draw list", || names(&DrawList::NAMED))])],
            &["Objects(Opaque)", "Objects(Masked)", "Objects(Transparent)"],
            "The scene's opaque objects, those that alpha cuts holes into, or those that let light through.",
        ),
        Word::new(
            "Casters",
            &[WordContents::Fields(casters::fields)],
            &[casters::FORM],
            "Objects that cast the sun's shadow, as the sun sees them: depth for a shadow map.",
        ),
        Word::alone("Sky", "The scene's sky, by the shader `sky` unless `shader` names another."),
        Word::new(
            "FullScreen",
            &[WordContents::Values(&[shader::STAGE]), WordContents::Fields(shader::fields)],
            &["FullScreen(\"shader\")"],
            "Every pixel, by this shader.",
        ),
        Word::new(
            "Vertices",
            &[WordContents::Values(&[MANY]), WordContents::Values(&[MANY, MANY])],
            &["Vertices(3, 100)"],
            "This many vertices, or indices, of triangles, in this many instances; one instance if one number stands there.",
        ),
        Word::new(
            "Indirect",
            &[WordContents::Values(&[parts::BUFFER]), WordContents::Fields(indirect::fields)],
            &["Indirect(\"buffer\")", indirect::FORM],
            "As many as a buffer says: a `VkDrawIndirectCommand`, with `index` a `VkDrawIndexedIndirectCommand`; or several draws, each as it \
             says.",
        ),
    ],
};

/// The fields next to `draw` that describe a draw.
#[derive(Clone, Copy)]
pub(crate) struct DrawFields<'src> {
    pub(crate) shader: Option<Leaf<'src>>,
    pub(crate) vertex: Option<Leaf<'src>>,
    pub(crate) index: Option<Leaf<'src>>,
}

impl Context<'_> {
    /// `draw: …`, with the shader.
    pub(crate) fn draw_work(
        &mut self,
        leaf: Leaf<'_>,
        DrawFields { shader, vertex, index }: DrawFields<'_>,
        what: impl Display,
    ) -> Option<FieldValue<Work>> {
        let (word, rest) = self.reader.one_of(leaf, &DRAWS)?;
        if !matches!(word, "Vertices" | "Indirect") {
            for (field, foreign) in [("vertex", vertex), ("index", index)] {
                let Some(foreign) = foreign else { continue };
                let message = format!("{what} has `{field}`, which means nothing beside `{word}`");
                self.reader.wrong(
                    Code::FIELD_UNFIT,
                    foreign,
                    message,
                    &format!("leave `{field}` out: buffers of vertices go with `Vertices(…)` and `Indirect(…)`"),
                );
            }
        }
        let (draw, verb) = match word {
            "FullScreen" => {
                let stages = rest.filter(|rest| rest.fields().is_some_and(|mut fields| fields.next().is_some()));
                let named = match stages {
                    Some(_) => None,
                    None => Some(self.reader.inside::<[Leaf<'_>; 1]>(leaf, rest, "FullScreen(\"shader\")")?[0]),
                };
                if let Some(second) = shader {
                    self.reader.wrong(
                        Code::FIELD_UNFIT,
                        second,
                        format!("{what} names its shader in `FullScreen(…)` already"),
                        "",
                    );
                    return None;
                }
                let shader = match (named, stages) {
                    (Some(named), _) => self.reader.stage(named)?,
                    // `FullScreen(fragment: "post.spv")` has the stages in the word's own parentheses.
                    (None, stages) => self.reader.stages(stages?)?,
                };
                let draw = Draw::FullScreen;
                return Some(FieldValue::Constant(Work::Draw { draw, counts: None, count: None, shader }));
            }
            "Sky" => {
                self.reader.bare(word, rest)?;
                if shader.is_none() {
                    let shader = Name { text: "sky".into(), span: leaf.span() };
                    let draw = Draw::Sky;
                    return Some(FieldValue::Constant(Work::Draw { draw, counts: None, count: None, shader }));
                }
                (FieldValue::Constant((Draw::Sky, None, None)), "draws the sky")
            }
            "Objects" => {
                (FieldValue::Constant((Draw::Objects(list(self.reader, leaf, rest)?), None, None)), "draws objects")
            }
            "Casters" => {
                (self.casters(leaf, rest)?.map(|cascade| (Draw::Casters(cascade), None, None)), "draws objects")
            }
            "Vertices" => {
                let (count, instances) = match rest.and_then(Leaf::tuple) {
                    Some([count, instances]) => (count, Some(instances)),
                    None => {
                        let [count]: [Leaf<'_>; 1] =
                            self.reader.inside(leaf, rest, "Vertices(3)` or `Vertices(3, 100)")?;
                        (count, None)
                    }
                };
                let range = 1..=i64::from(u32::MAX);
                let count = self.whole(count, "number of vertices", range.clone());
                let once = Some(FieldValue::Constant(1));
                let instances = instances.map_or(once, |leaf| self.whole(leaf, "number of instances", range));
                let vertices = (count?, instances?);
                let draw = |(count, instances)| (Draw::Vertices { count, instances }, None, None);
                (combined(vertices, draw), "draws vertices")
            }
            _ => (self.indirect(leaf, rest)?, "draws vertices"),
        };
        let Some(shader) = shader else {
            self.reader.wrong(
                Code::SHADER_UNSAID,
                leaf,
                format!("{what} {verb} and needs a shader"),
                "add `shader: \"…\"`",
            );
            return None;
        };
        let shader = self.reader.shader(shader)?;
        Some(draw.map(move |(draw, counts, count)| Work::Draw { draw, counts, count, shader: shader.clone() }))
    }
}

/// One of the scene's draw lists.
fn list<'src>(reader: &mut Reader, leaf: Leaf<'src>, rest: Option<Leaf<'src>>) -> Option<DrawList> {
    let [list]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Objects(Opaque)")?;
    reader.choice(list, "a draw list", &DrawList::NAMED)
}
