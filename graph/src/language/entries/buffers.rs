//! `buffers`: how many bytes, and how long their contents live.

use super::repeat::REPEAT;
use super::{lifetimes, parts, views};
use crate::base::{Code, Diagnostic};
use crate::fields;
use crate::language::model::{Buffer, Bytes, Decided, Lifetime};
use crate::language::scope::{Context, FieldValue, Parameter, ParameterKind, combined};
use crate::ron::{Form, Leaf, PlainForm, Shape, Spanned, Word, WordContents, Words};
use crate::vulkan::access::StateSubject;

/// Most bytes that a buffer may have: 1 TiB.
pub(crate) const LARGEST_BUFFER: i64 = 1 << 40;

fields! {
    /// A buffer: bytes that passes write and read.
    /// ```ron
    /// (name: "particles", bytes: Times(32, "setting"), lifetime: History)
    /// ```
    pub(crate) struct BufferFields<'src> as "Buffer" {
        /// Its name, unique among images and buffers.
        name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// The view whose values of settings it takes; the first if left out.
        pub(crate) view: Option<Leaf<'src>> => views::NAME,
        /// The name of an index, and how often the entry is repeated.
        pub(crate) repeat: Option<Leaf<'src>> => REPEAT,
        /// How many bytes it has, a multiple of 4.
        bytes: Leaf<'src> => Form::Words(&BYTES),
        /// How long its contents live; `Transient` if left out.
        lifetime: Option<Leaf<'src>> => lifetimes::LIFETIME,
    }
}

static BYTES: Words = Words {
    name: "Bytes",
    what: "a buffer's size",
    or: &[Form::Whole(4, LARGEST_BUFFER)],
    all: &[
        Word::new(
            "Times",
            &[WordContents::Values(&[Form::Whole(1, LARGEST_BUFFER), Form::Whole(1, LARGEST_BUFFER)])],
            &["Times(16, \"setting\")"],
            "The bytes of one element, times the number of elements; rounded up to a multiple of 4.",
        ),
        Word::new(
            "PerTexel",
            &[WordContents::Values(&[Form::Whole(1, LARGEST_BUFFER), parts::WHOLE_IMAGE])],
            &["PerTexel(4, \"image\")"],
            "This many bytes for each texel of an image's first mip level, layers and depth included; rounded up to a \
                    multiple of 4.",
        ),
        Word::new(
            "Like",
            &[WordContents::Values(&[parts::WHOLE_BUFFER])],
            &["Like(\"buffer\")"],
            "As many as another buffer has.",
        ),
    ],
};

impl Context<'_> {
    /// A buffer.
    pub(crate) fn buffer_entry(&mut self, fields: &BufferFields<'_>) -> Option<FieldValue<Buffer>> {
        let name = self.reader.name(fields.name, "a buffer");
        let bytes = self.bytes(fields.bytes);
        let transient = Spanned { value: Lifetime::Transient, span: fields.name.span() };
        let lifetime = fields
            .lifetime
            .map_or(Some(FieldValue::Constant(transient)), |leaf| self.lifetime(leaf, StateSubject::Buffer));
        let (name, bytes) = (name?, bytes?.at(fields.bytes));
        Some(combined((bytes, lifetime?), move |(bytes, lifetime)| Buffer {
            name: name.clone(),
            bytes,
            lifetime,
            instance: None,
        }))
    }

    fn bytes(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<Bytes>>> {
        let (what, span) = ("size of a buffer in bytes", leaf.span());
        match leaf.shape() {
            Shape::Text | Shape::Number => {
                let bytes = self.whole_because(leaf, what, 4..=LARGEST_BUFFER)?;
                if let FieldValue::Constant(Decided { value: bytes, .. }) = &bytes
                    && !u64::is_multiple_of(*bytes, 4)
                {
                    let help = format!("the next is {}", bytes.next_multiple_of(4));
                    self.reader.wrong(
                        Code::BUFFER_SIZE,
                        leaf,
                        format!("a buffer has a multiple of 4 bytes, found {bytes}"),
                        &help,
                    );
                    return None;
                }
                Some(bytes.of(Bytes::Count))
            }
            _ => {
                let (word, rest) = self.reader.one_of(leaf, &BYTES)?;
                if word == "Like" {
                    let [other]: [Leaf<'_>; 1] = self.reader.inside(leaf, rest, "Like(\"buffer\")")?;
                    return Some(self.buffer(other)?.map(move |other| Decided::said(span, Bytes::Like(other))));
                }
                let [each, of]: [Leaf<'_>; 2] = self.reader.inside(leaf, rest, &format!("{word}(16, \"…\")"))?;
                let each = self.whole(each, "number of bytes", 1..=LARGEST_BUFFER);
                if word == "PerTexel" {
                    let image = self.image(of);
                    return Some(combined((each?, image?), move |(each, image)| {
                        Decided::said(span, Bytes::PerTexel(each, image))
                    }));
                }
                let count = self.bytes_times(of)?;
                Some(combined((each?, count), |(each, count)| count.map(|count| Bytes::Times(each, count))))
            }
        }
    }

    /// The number of elements of a buffer.
    fn bytes_times(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<u64>>> {
        if let Some(Parameter { kind: ParameterKind::Value(kind), .. }) = self.setting(leaf)
            && let Some(least) = kind.least().filter(|least| *least < 1.0 && kind.is_whole())
        {
            let message = format!("this setting allows {least}, so that the buffer would be empty");
            self.reader.wrong(Code::SETTING_TOO_WIDE, leaf, message, "let the setting begin at 1");
            return None;
        }
        let count: FieldValue<Decided<i64>> = self.whole_because(leaf, "count", i64::MIN..=i64::MAX)?;
        count.checked(self.reader, move |count, _| match u64::try_from(count.value) {
            Ok(value @ 1..) => Ok(count.map(|_| value)),
            _ => {
                let message = format!("{} of something leave the buffer empty", count.value);
                Err(Diagnostic::new(Code::BUFFER_SIZE, count.span, message).remark(count.remark()))
            }
        })
    }
}
