//! `draw: Indirect(…)`: draws whose counts a buffer holds.

use super::buffers::LARGEST_BUFFER;
use super::parts;
use super::values::{MANY, optional};
use crate::base::Code;
use crate::fields;
use crate::frame::{Draw, IndirectDraws};
use crate::language::model::BufferPart;
use crate::language::scope::{Context, FieldValue, combined};
use crate::ron::{FieldTable, Leaf, Table};

/// The form of several draws.
pub(crate) const FORM: &str = "Indirect(commands: \"buffer\", draws: 100)";

fields! {
    /// Indirect draws: the counts of each stand in a buffer, one behind the other.
    struct IndirectFields<'src> {
        /// The buffer of the counts: `VkDrawIndirectCommand`, with `index` `VkDrawIndexedIndirectCommand`.
        commands: Leaf<'src> => parts::BUFFER,
        /// How many draws there are; with `count` the most.
        draws: Leaf<'src> => MANY,
        /// The byte at which the counts of the first draw stand; 0 if left out.
        offset: Option<Leaf<'src>> => Form::Whole(0, LARGEST_BUFFER),
        /// Bytes from the counts of a draw to those of the next; they stand side by side if left out.
        stride: Option<Leaf<'src>> => Form::Whole(1, LARGEST_STRIDE),
        /// A buffer that holds how many of them are drawn, in 32 bits; all if left out.
        count: Option<Leaf<'src>> => parts::BUFFER,
        /// The byte at which that number stands; 0 if left out. Goes with `count`.
        count_offset: Option<Leaf<'src>> => Form::Whole(0, LARGEST_BUFFER),
    }
}

/// The most bytes from counts to counts.
const LARGEST_STRIDE: i64 = 1 << 30;

/// The fields of `Indirect`.
pub(crate) fn fields() -> Table {
    IndirectFields::<'static>::table()
}

/// A draw, the buffer of its counts, and that of the number of draws.
pub(crate) type IndirectDraw = (Draw, Option<BufferPart>, Option<BufferPart>);

impl Context<'_> {
    /// The draws of `Indirect(…)`.
    pub(crate) fn indirect(&mut self, leaf: Leaf<'_>, rest: Option<Leaf<'_>>) -> Option<FieldValue<IndirectDraw>> {
        if rest.and_then(Leaf::fields).is_none_or(|mut fields| fields.next().is_none()) {
            let [buffer]: [Leaf<'_>; 1] =
                self.reader.inside(leaf, rest, &format!("Indirect(\"buffer\")` or `{FORM}"))?;
            return Some(self.buffer_part(buffer)?.map(|part| (Draw::Indirect, Some(part), None)));
        }
        let fields: IndirectFields<'_> = self.reader.inside(leaf, rest, FORM)?;
        let bytes = 0..=LARGEST_BUFFER;
        let commands = self.buffer_part(fields.commands);
        let draws = self.whole(fields.draws, "number of draws", 1..=i64::from(u32::MAX));
        let offset = optional(fields.offset, |leaf| self.whole(leaf, "offset in bytes", bytes.clone()));
        let stride = optional(fields.stride, |leaf| self.whole(leaf, "stride in bytes", 1..=LARGEST_STRIDE));
        let count = optional(fields.count, |leaf| self.buffer_part(leaf));
        let count_offset = optional(fields.count_offset, |leaf| self.whole(leaf, "offset in bytes", bytes));
        if let (None, Some(stray)) = (fields.count, fields.count_offset) {
            let message = "`count_offset` means nothing without `count`";
            self.reader.wrong(Code::FIELD_UNFIT, stray, message, "add `count: \"buffer\"`, or leave it out");
            return None;
        }
        let values = (commands?, draws?, offset?, stride?, count?, count_offset?);
        Some(combined(values, |(commands, draws, offset, stride, count, count_offset): Values| {
            let count_offset = count.is_some().then(|| count_offset.unwrap_or(0));
            let draws = IndirectDraws { draws, offset: offset.unwrap_or(0), stride, count: count_offset };
            (Draw::Indirects(draws), Some(commands), count)
        }))
    }
}

/// The values of the fields.
type Values = (BufferPart, u32, Option<u64>, Option<u32>, Option<BufferPart>, Option<u64>);
