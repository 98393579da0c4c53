//! `dispatch`: how many workgroups a compute pass runs.

use super::values::{MANY, at};
use super::{buffers, parts};
use crate::base::Code;
use crate::language::model::{Groups, Work};
use crate::language::scope::{Context, FieldValue, all, combined};
use crate::ron::{Form, Leaf, Word, WordContents, Words};
use std::fmt::Display;

/// The form of `groups`: a number of workgroups.
pub(crate) const WORKGROUPS: Form = Form::Words(&GROUPS);

static GROUPS: Words = Words {
    name: "Groups",
    what: "a number of workgroups",
    or: &[],
    all: &[
        Word::new(
            "Count",
            &[
                WordContents::Values(&[GROUP]),
                WordContents::Values(&[GROUP, GROUP]),
                WordContents::Values(&[GROUP, GROUP, GROUP]),
            ],
            &["Count(8, 8, 1)"],
            "This many workgroups in x, y and z; numbers that are left out are 1.",
        ),
        Word::new(
            "Invocations",
            &[
                WordContents::Values(&[MANY]),
                WordContents::Values(&[MANY, MANY]),
                WordContents::Values(&[MANY, MANY, MANY]),
            ],
            &["Invocations(1000, 1, 1)"],
            "Enough workgroups for this many invocations in x, y and z, by the shader's own workgroup size.",
        ),
        Word::new(
            "Texels",
            &[WordContents::Values(&[parts::IMAGE]), WordContents::Fields(parts::part)],
            &["Texels(\"image\")"],
            "Enough workgroups for one invocation for each texel of an image or a part of it, layers or depth in z.",
        ),
        Word::new(
            "Indirect",
            &[
                WordContents::Values(&[parts::BUFFER]),
                WordContents::Values(&[parts::BUFFER, Form::Whole(0, buffers::LARGEST_BUFFER)]),
            ],
            &["Indirect(\"buffer\")"],
            "As many as a buffer says, from this byte on: a `VkDispatchIndirectCommand`.",
        ),
    ],
};

const GROUP: Form = Form::Whole(1, MOST_GROUPS);

/// The most workgroups in x, y and z that every device allows.
pub(crate) const MOST_GROUPS: i64 = 65535;

impl Context<'_> {
    /// A compute shader and how often it runs.
    pub(crate) fn dispatch_work(
        &mut self,
        leaf: Leaf<'_>,
        groups_at: Option<Leaf<'_>>,
        what: impl Display,
    ) -> Option<FieldValue<Work>> {
        let shader = self.reader.stage(leaf);
        let Some(groups_at) = groups_at else {
            self.reader.wrong(Code::GROUPS,
                leaf,
                format!("{what} doesn't say how many workgroups run"),
                "add `groups: Texels(\"image\")` to run it for each texel of an image, or a number: `groups: Count(8, 8, 1)`",
            );
            return None;
        };
        let groups = self.groups(groups_at);
        let shader = shader?;
        Some(at(groups_at, groups?).map(move |groups| Work::Dispatch { shader: shader.clone(), groups }))
    }

    fn groups(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Groups>> {
        let (word, rest) = self.reader.one_of(leaf, &GROUPS)?;
        match word {
            "Count" => self
                .three_numbers(leaf, rest, "number of workgroups", MOST_GROUPS)
                .map(|numbers| combined(numbers, Groups::Count)),
            "Invocations" => self
                .three_numbers(leaf, rest, "number of invocations", i64::from(u32::MAX))
                .map(|numbers| combined(numbers, Groups::Invocations)),
            "Texels" => {
                let image = match rest {
                    // `Texels(image: "x", mip: 1)` is the part itself, in the word's own parentheses.
                    Some(rest) if rest.tuple::<1>().is_none() => rest,
                    _ => self.reader.inside::<[Leaf<'_>; 1]>(leaf, rest, "Texels(\"image\")")?[0],
                };
                Some(self.image_part(image)?.map(Groups::Texels))
            }
            _ => {
                let (buffer, offset) = match rest.and_then(Leaf::tuple) {
                    Some([buffer, offset]) => (buffer, Some(offset)),
                    None => (
                        self.reader.inside::<[Leaf<'_>; 1]>(
                            leaf,
                            rest,
                            "Indirect(\"buffer\")` or `Indirect(\"buffer\", 16)",
                        )?[0],
                        None,
                    ),
                };
                let buffer = self.buffer_part(buffer);
                let offset = offset.map_or(Some(FieldValue::Constant(0)), |leaf| {
                    self.whole(leaf, "offset in bytes", 0..=buffers::LARGEST_BUFFER)
                });
                Some(combined((buffer?, offset?), |(buffer, offset)| Groups::Indirect { buffer, offset }))
            }
        }
    }

    /// One to three whole numbers; those that are left out are 1.
    fn three_numbers(
        &mut self,
        leaf: Leaf<'_>,
        rest: Option<Leaf<'_>>,
        what: &'static str,
        most: i64,
    ) -> Option<[FieldValue<u32>; 3]> {
        let probed = rest.and_then(|rest| {
            let one = rest.tuple().map(|[x]| (x, None, None));
            one.or_else(|| rest.tuple().map(|[x, y]| (x, Some(y), None)))
        });
        let (x, y, z) = match probed {
            Some(few) => few,
            None => {
                let [x, y, z]: [Leaf<'_>; 3] = self.reader.inside(leaf, rest, "Count(8, 8, 1)")?;
                (x, Some(y), Some(z))
            }
        };
        let one = || Some(FieldValue::Constant(1));
        all([Some(x), y, z].map(|leaf| leaf.map_or_else(one, |leaf| self.whole(leaf, what, 1..=most))))
    }
}
