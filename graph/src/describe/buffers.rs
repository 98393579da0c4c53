//! `buffers`: how many bytes, and how long their contents live.

use super::leaf::{Leaf, Shape};
use super::pipeline::SettingKind;
use super::reader::Reader;
use super::resources::{Buffer, Bytes, Lifetime};
use super::scope::{Quoted, Scope};
use super::values::Decided;
use super::{Diagnostic, Spanned, lifetimes, values};
use crate::fields;

/// Most bytes that a buffer may have: 1 TiB.
pub(crate) const LARGEST_BUFFER: i64 = 1 << 40;

fields! {
    pub(super) struct BufferFields<'src> as "Buffer" {
        name: Leaf<'src>,
        pub(super) view: Option<Leaf<'src>>,
        pub(super) repeat: Option<Leaf<'src>>,
        bytes: Leaf<'src>,
        lifetime: Option<Leaf<'src>>,
    }
}

const SIZES: &str = "a buffer's size is a number, an expression in quotes, `Times(16, \"setting\")`, \
                     `PerTexel(4, \"image\")` or `Like(\"buffer\")`";

/// A buffer, once its fields are told apart.
pub(super) fn lower<'src>(reader: &mut Reader, scope: &Scope<'_>, fields: &BufferFields<'src>) -> Option<Buffer> {
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
            let (word, rest) = reader.word(leaf, "a buffer's size", &["Times", "PerTexel", "Like"], SIZES)?;
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
