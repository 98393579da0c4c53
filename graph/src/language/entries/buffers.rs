//! `buffers`: how many bytes, and how long their contents live.

use super::repeat::REPEAT;
use super::values::{self, Decided};
use super::{lifetimes, parts, views};
use crate::base::Diagnostic;
use crate::fields;
use crate::language::model::{Buffer, Bytes, Lifetime, SettingKind};
use crate::language::scope::{Quoted, Scope};
use crate::ron::{Form, Leaf, Plain, Reader, Shape, Spanned, Takes, Word, Words};

/// Most bytes that a buffer may have: 1 TiB.
pub(crate) const LARGEST_BUFFER: i64 = 1 << 40;

fields! {
    /// A buffer: bytes that passes write and read.
    /// ```ron
    /// (name: "particles", bytes: Times(32, "setting"), lifetime: History)
    /// ```
    pub(crate) struct BufferFields<'src> as "Buffer" {
        /// Its name, unique among images and buffers.
        name: Leaf<'src> => Form::Plain(Plain::Name),
        /// The view whose values of settings it takes; the first if left out.
        pub(crate) view: Option<Leaf<'src>> => views::NAME,
        /// How often it stands there.
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
            &[Takes::Values(&[Form::Whole(1, LARGEST_BUFFER), Form::Whole(1, LARGEST_BUFFER)])],
            &["Times(16, \"setting\")"],
            "So many bytes for each of so many things; rounded up to a multiple of 4.",
        ),
        Word::new(
            "PerTexel",
            &[Takes::Values(&[Form::Whole(1, LARGEST_BUFFER), parts::WHOLE_IMAGE])],
            &["PerTexel(4, \"image\")"],
            "So many bytes for each texel of an image's first mip level, layers and depth included; rounded up to a \
                    multiple of 4.",
        ),
        Word::new(
            "Like",
            &[Takes::Values(&[parts::WHOLE_BUFFER])],
            &["Like(\"buffer\")"],
            "As many as another buffer has.",
        ),
    ],
};

/// A buffer, once its fields are told apart.
pub(crate) fn lower<'src>(reader: &mut Reader, scope: &Scope<'_>, fields: &BufferFields<'src>) -> Option<Buffer> {
    let name = reader.name(fields.name, "a buffer");
    let bytes = bytes(reader, scope, fields.bytes);
    let lifetime = match fields.lifetime {
        Some(leaf) => lifetimes::lower(reader, scope, leaf, lifetimes::Of::Buffer),
        None => Some(Spanned { value: Lifetime::Transient, span: fields.name.span() }),
    };
    let (bytes, bytes_because) = bytes?;
    let bytes = fields.bytes.spanned(bytes);
    Some(Buffer { name: name?, bytes, bytes_because, lifetime: lifetime?, instance: None })
}

fn bytes<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Decided<Bytes>> {
    let what = "size of a buffer in bytes";
    match leaf.shape() {
        Shape::Text | Shape::Number => {
            let (bytes, because): Decided<u64> = values::whole_because(reader, scope, leaf, what, 4..=LARGEST_BUFFER)?;
            if matches!(leaf.shape(), Shape::Number) && !bytes.is_multiple_of(4) {
                let help = format!("the next is {}", bytes.next_multiple_of(4));
                reader.wrong(leaf, format!("a buffer has a multiple of 4 bytes, found {bytes}"), &help);
                return None;
            }
            Some((Bytes::Count(bytes), because))
        }
        _ => {
            let (word, rest) = reader.one_of(leaf, &BYTES)?;
            if word == "Like" {
                let [other]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Like(\"buffer\")")?;
                return scope.buffer(reader, other).map(|other| (Bytes::Like(other), None));
            }
            let [each, of]: [Leaf<'_>; 2] = reader.inside(leaf, rest, &format!("{word}(16, \"…\")"))?;
            let each = values::whole(reader, scope, each, "number of bytes", 1..=LARGEST_BUFFER);
            if word == "PerTexel" {
                let image = scope.image(reader, of);
                return Some((Bytes::PerTexel(each?, image?), None));
            }
            let (count, because) = times(reader, scope, of)?;
            Some((Bytes::Times(each?, count), because))
        }
    }
}

/// How many things a buffer is for.
fn times<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Decided<u64>> {
    if let Shape::Text = leaf.shape()
        && scope.known.settings
        && let Quoted::Given(parameter, _) = scope.quoted(reader, leaf, SettingKind::is_whole, "a whole number")?
        && let Some(least) = parameter.least().filter(|least| *least < 1.0)
    {
        let message = format!("this setting allows {least}, so that the buffer would be empty");
        reader.wrong(leaf, message, "let the setting begin at 1");
        return None;
    }
    let (count, because): Decided<i64> = values::whole_because(reader, scope, leaf, "count", i64::MIN..=i64::MAX)?;
    match u64::try_from(count) {
        Ok(count @ 1..) => Some((count, because)),
        _ => {
            let empty = Diagnostic::new(leaf.span(), format!("{count} of something leave the buffer empty"));
            scope.fault(reader, leaf, empty.remark(because.as_deref().unwrap_or_default()));
            None
        }
    }
}
