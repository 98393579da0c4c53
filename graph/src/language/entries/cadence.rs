//! `run`: in which frames a pass runs.

use crate::base::{Code, Diagnostic};
use crate::fields;
use crate::frame::Cadence;
use crate::language::scope::{Context, FieldValue, combined};
use crate::ron::{FieldTable, Form, Leaf, PlainForm, Word, WordContents, Words};

/// The form of `count`.
const COUNT: Form = Form::Whole(1, Cadence::LONGEST as i64);

fields! {
    /// The fields of `Every`: how often a pass runs.
    struct EveryFields<'src> {
        /// How many frames it is from one run to the next.
        count: Leaf<'src> => COUNT,
        /// In which of them it runs, from 0; 0 if left out.
        at: Option<Leaf<'src>> => Form::Whole(0, Cadence::LONGEST as i64 - 1),
    }
}

/// The form of `run`.
pub(crate) const RUN: Form = Form::Words(&CADENCES);

static CADENCES: Words = Words {
    name: "Run",
    what: "a way to run",
    or: &[],
    all: &[
        Word::alone("Always", "In every frame."),
        Word::alone("Once", "In the first frame."),
        Word::new(
            "Every",
            &[WordContents::Values(&[COUNT]), WordContents::Fields(EveryFields::<'static>::table)],
            &["Every(4)", "Every(count: 6, at: \"face\")"],
            "In the first frame, and in each whose number, divided by `count`, leaves `at`.",
        ),
        Word::new(
            "WhenDirty",
            &[WordContents::Values(&[Form::Plain(PlainForm::Outside)])],
            &["WhenDirty(\"sky\")"],
            "In the first frame, and in the next one after the program said that the name is dirty.",
        ),
    ],
};

impl Context<'_> {
    /// In which frames a pass runs.
    pub(crate) fn cadence(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Cadence>> {
        const FORMS: &str = "Every(4)` or `Every(count: 6, at: 2)";
        let (word, rest) = self.reader.one_of(leaf, &CADENCES)?;
        match word {
            "Always" => self.reader.bare(word, rest).map(|()| FieldValue::Constant(Cadence::Always)),
            "Once" => self.reader.bare(word, rest).map(|()| FieldValue::Constant(Cadence::Once)),
            "Every" => {
                let has_fields = rest.is_some_and(|rest| rest.fields().is_some_and(|mut it| it.next().is_some()));
                let (count, at) = if has_fields {
                    let fields: EveryFields<'_> = self.reader.inside(leaf, rest, FORMS)?;
                    (fields.count, fields.at)
                } else {
                    (self.reader.inside::<[Leaf<'_>; 1]>(leaf, rest, FORMS)?[0], None)
                };
                let (longest, span) = (i64::from(Cadence::LONGEST), leaf.span());
                let count = self.whole(count, "number of frames", 1..=longest);
                let first = Some(FieldValue::Constant(0));
                let at = at.map_or(first, |at| self.whole(at, "number of a frame", 0..=longest - 1));
                combined((count?, at?), |(count, at)| Cadence::every(count, at)).checked(self.reader, move |made, _| {
                    let wrong = |what| Diagnostic::new(Code::CADENCE_UNFIT, span, format!("this runs {what}"));
                    match made.problem() {
                        Some(what) => Err(wrong(what).help("count the frames from 0, below `count`")),
                        None => Ok(made),
                    }
                })
            }
            _ => {
                let [name]: [Leaf<'_>; 1] = self.reader.inside(leaf, rest, "WhenDirty(\"name\")")?;
                let name = self.reader.outside_name(name, "what the program calls dirty")?;
                Some(FieldValue::Constant(Cadence::WhenDirty(name.text)))
            }
        }
    }
}
