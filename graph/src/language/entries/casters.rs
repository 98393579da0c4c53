//! `draw: Casters(…)`: objects that cast the sun's shadow.

use super::values::optional;
use crate::base::{Code, Diagnostic};
use crate::fields;
use crate::frame::{Cascade, DrawList, Metres, Share};
use crate::language::scope::{Context, FieldValue, FieldValueTuple, combined};
use crate::ron::{FieldTable, Leaf, Spanned, Table, names};

/// The form of `Casters`.
pub(crate) const FORM: &str = "Casters(list: Opaque, cascade: 0, of: 1)";

fields! {
    /// Casters: objects that cast the sun's shadow onto one of several parts of the view, by distance from the camera.
    struct CastersFields<'src> {
        /// Which objects; light goes through transparent ones.
        list: Leaf<'src> => Form::Choice("a list of casters", || names(&DrawList::CASTERS)),
        /// Which part, from 0, the nearest.
        cascade: Leaf<'src> => Form::Whole(0, Cascade::MOST as i64 - 1),
        /// How many parts there are; all have a map of one size.
        of: Leaf<'src> => Form::Whole(1, Cascade::MOST as i64),
        /// How far from the camera shadows reach, in metres; through the whole scene if left out or 0.
        reach: Option<Leaf<'src>> => Form::Number,
        /// How logarithmic the distances are at which parts end, 0 to 1: 0 cuts parts of equal depth, 1 makes each end the same
        /// multiple of the one before, which is sharper near by. 0.85 if left out.
        logarithmic: Option<Leaf<'src>> => Form::Number,
    }
}

/// The fields of `Casters`.
pub(crate) fn fields() -> Table {
    CastersFields::<'static>::table()
}

impl Context<'_> {
    /// The cascade of `Casters(…)`.
    pub(crate) fn casters(&mut self, leaf: Leaf<'_>, rest: Option<Leaf<'_>>) -> Option<FieldValue<Cascade>> {
        let fields: CastersFields<'_> = self.reader.inside(leaf, rest, FORM)?;
        let most = i64::from(Cascade::MOST);
        let list = self.reader.choice(fields.list, "a list of casters", &DrawList::CASTERS);
        let index = self.whole_at(fields.cascade, "cascade", 0..=most - 1);
        let of = self.whole_at(fields.of, "number of cascades", 1..=most);
        let reach = optional(fields.reach, |leaf| self.reach(leaf));
        let logarithmic = optional(fields.logarithmic, |leaf| self.logarithmic(leaf));
        let (list, index) = (list?, index?);
        let said = index.is_constant();
        let numbers = combined((index, of?, reach?, logarithmic?), |numbers| numbers);
        numbers.checked_as(
            self.reader,
            said,
            move |(index, of, reach, logarithmic): (Spanned<u8>, Spanned<u8>, _, _), _| {
                if index.value >= of.value {
                    let beyond = format!("there is no cascade {} of {}", index.value, of.value);
                    let help = format!("write a number from 0 to {}", of.value - 1);
                    return Err(Diagnostic::new(Code::CASCADES, index.span, beyond)
                        .label(of.span, "the number of cascades")
                        .help(help));
                }
                let logarithmic = logarithmic.unwrap_or(Share::OF_CASCADES);
                Ok(Cascade { list, index: index.value, of: of.value, reach: reach.flatten(), logarithmic })
            },
        )
    }

    /// How logarithmic the distances are at which parts end.
    fn logarithmic(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Share>> {
        self.number_because(leaf, "how logarithmic splits are")?.checked(self.reader, move |share, _| {
            #[allow(clippy::cast_possible_truncation, reason = "a number a little above 1 is refused or rounded to 1")]
            Share::try_from(share.value as f32).map_err(|_| {
                let wrong = Diagnostic::new(Code::CASCADES, share.span, "splits can't be that logarithmic");
                wrong.help("write a number from 0 (parts of equal depth) to 1").remark(share.remark())
            })
        })
    }

    /// How far shadows reach; `None`: through the whole scene.
    fn reach(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Option<Metres>>> {
        self.number_because(leaf, "how far shadows reach")?.checked(self.reader, move |metres, _| {
            if metres.value == 0.0 {
                return Ok(None);
            }
            #[allow(clippy::cast_possible_truncation, reason = "what becomes 0 or infinite is refused")]
            Metres::try_from(metres.value as f32).map(Some).map_err(|_| {
                let wrong = Diagnostic::new(Code::CASCADES, metres.span, "shadows can't reach that far");
                let help = "write `0` for the whole scene, or a number of metres above 0 that 32 bits can hold";
                wrong.help(help).remark(metres.remark())
            })
        })
    }
}
