//! `otherwise`: stand-ins, which fill the targets of a pass that is off.

use super::parts;
use super::values::{self, optional};
use crate::base::{Code, Diagnostic, Span};
use crate::fields;
use crate::language::model::{Forward, Pass, StandIn};
use crate::language::scope::{Context, FieldValue, combined};
use crate::ron::{FieldTable, Form, Leaf, Reader, Shape, Word, WordContents, Words};
use std::collections::HashMap;

/// The form of `otherwise`: one stand-in or a list of them.
pub(crate) const OTHERWISE: Form = Form::Either(&[Form::Words(&STAND_INS), Form::List(&Form::Words(&STAND_INS))]);

/// The kinds of stand-in.
static STAND_INS: Words = Words {
    name: "StandIn",
    what: "a stand-in",
    or: &[],
    all: &[
        Word::new(
            "Forward",
            &[WordContents::Fields(ForwardFields::<'static>::table)],
            &["Forward(from: \"image\", to: \"image\")"],
            "One image gets what another holds.",
        ),
        Word::new(
            "Clear",
            &[WordContents::Fields(ClearFields::<'static>::table)],
            &["Clear(image: \"image\", value: 0)"],
            "An image gets a value.",
        ),
    ],
};

fields! {
    /// An image that stands for another.
    struct ForwardFields<'src> {
        /// The image that is taken.
        from: Leaf<'src> => parts::WHOLE_IMAGE,
        /// The image that gets it, which the pass would write.
        to: Leaf<'src> => parts::WHOLE_IMAGE,
    }
}

fields! {
    /// A value that stands for an image.
    struct ClearFields<'src> {
        /// The image, which the pass would write.
        image: Leaf<'src> => parts::WHOLE_IMAGE,
        /// The value, as in [a fill](#fills).
        value: Leaf<'src> => values::FILL,
    }
}

/// The stand-ins of a pass or use, as a file says them.
pub(crate) struct StandInList {
    pub(crate) span: Span,
    pub(crate) stand_ins: Vec<FieldValue<StandIn>>,
    /// Whether the pass or use can be off.
    pub(crate) conditional: bool,
}

impl Context<'_> {
    /// The stand-ins of a pass or use: one or several.
    pub(crate) fn otherwise(&mut self, leaf: Option<Leaf<'_>>, when: Option<Leaf<'_>>) -> Option<Option<StandInList>> {
        optional(leaf, |leaf| {
            let entries = match leaf.shape() {
                Shape::List => self.reader.list(leaf, "`otherwise`")?,
                _ => vec![leaf],
            };
            let all: Vec<Option<FieldValue<StandIn>>> = entries.into_iter().map(|entry| self.stand_in(entry)).collect();
            let stand_ins = all.into_iter().collect::<Option<_>>()?;
            Some(StandInList { span: leaf.span(), stand_ins, conditional: when.is_some() })
        })
    }

    fn stand_in(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<StandIn>> {
        let (word, rest) = self.reader.one_of(leaf, &STAND_INS)?;
        if word == "Clear" {
            let fields: ClearFields<'_> = self.reader.inside(leaf, rest, "Clear(image: \"image\", value: 0)")?;
            let (to, value) = (self.image(fields.image), self.fill(fields.value));
            return Some(combined((to?, value?), |(to, value)| StandIn::Clear { to, value }));
        }
        let fields: ForwardFields<'_> = self.reader.inside(leaf, rest, "Forward(from: \"image\", to: \"image\")")?;
        let (from, to) = (self.image(fields.from), self.image(fields.to));
        Some(combined((from?, to?), |(from, to)| StandIn::Forward(Forward { from, to })))
    }
}

/// The kind of entry that `otherwise` belongs to.
#[derive(Clone, Copy)]
pub(crate) enum OtherwiseOwner {
    Pass,
    Use,
}

impl OtherwiseOwner {
    /// The message and the help for a stand-in of an image that is not written.
    const fn foreign(self) -> (&'static str, &'static str) {
        match self {
            OtherwiseOwner::Pass => (
                "`otherwise` fills an image that this pass doesn't write",
                "it is one of the images that the pass draws into or writes",
            ),
            OtherwiseOwner::Use => (
                "`otherwise` fills an image that no pass of this use would write",
                "it is an image in `with` that a pass of the fragment writes; what is repeated 0 times writes nothing, on or \
                 off",
            ),
        }
    }
}

/// Reports stand-ins that don't fill images of the pass's own, each once, from other images.
pub(crate) fn stand_ins_make_sense(reader: &mut Reader, otherwise: &StandInList, of: OtherwiseOwner, pass: &Pass) {
    if !otherwise.conditional {
        let idle = Diagnostic::new(
            Code::STAND_IN_UNFIT,
            otherwise.span,
            "`otherwise` never comes to pass: there is no `when`",
        );
        reader.report(idle.help("add `when: …`, or remove `otherwise`"));
    }
    let mut first = HashMap::new();
    for stand_in in &pass.otherwise {
        let to = stand_in.target();
        if let StandIn::Forward(forward) = stand_in
            && forward.from.index == forward.to.index
        {
            let same = Diagnostic::new(Code::STAND_IN_UNFIT, to.span, "an image can't be forwarded to itself");
            reader.report(same.label(forward.from.span, "the same image"));
            continue;
        }
        if !pass.image_parts().any(|(part, of)| of.writes() && part.image.index == to.index) {
            let (message, help) = of.foreign();
            reader.report(Diagnostic::new(Code::STAND_IN_UNFIT, to.span, message).help(help));
        } else if let Some(first) = first.insert(to.index, to.span) {
            let twice = Diagnostic::new(Code::LISTED_TWICE, to.span, "`otherwise` fills this image twice");
            reader.report(twice.remark("again here").label(first, "first here"));
        }
    }
}
