//! `buffers`: how many bytes, and how long their contents live.

use super::leaf::{Leaf, Shape};
use super::names::Scope;
use super::pipeline::{SettingKind, Value};
use super::reader::Reader;
use super::resources::{Buffer, Bytes, Lifetime};
use super::{Spanned, lifetimes, values};
use crate::fields;

/// Most bytes that a buffer may have: 1 TiB.
pub(crate) const LARGEST_BUFFER: i64 = 1 << 40;

fields! {
    pub(super) struct BufferFields<'src> as "Buffer" {
        name: Leaf<'src>,
        bytes: Leaf<'src>,
        lifetime: Option<Leaf<'src>>,
    }
}

const SIZES: &str = "a buffer's size is a number, the name of a setting, `Times(16, \"setting\")`, \
                     `PerTexel(4, \"image\")` or `Like(\"buffer\")`";

/// A buffer, once its fields are told apart.
pub(super) fn lower<'src>(reader: &mut Reader, scope: &Scope<'_>, fields: &BufferFields<'src>) -> Option<Buffer> {
    let name = reader.name(fields.name, "a buffer");
    let bytes = bytes(reader, scope, fields.bytes).map(|bytes| fields.bytes.spanned(bytes));
    let lifetime = match fields.lifetime {
        Some(leaf) => lifetimes::lower(reader, scope, leaf, lifetimes::Of::Buffer),
        None => Some(Spanned { value: Lifetime::Transient, span: fields.name.span() }),
    };
    Some(Buffer { name: name?, bytes: bytes?, lifetime: lifetime? })
}

fn bytes<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Bytes> {
    let what = "size of a buffer in bytes";
    match leaf.shape() {
        Shape::Text | Shape::Number => {
            let bytes: Value<u64> = values::whole(reader, scope, leaf, what, 4..=LARGEST_BUFFER)?;
            if let Value::Constant(bytes) = bytes
                && !bytes.is_multiple_of(4)
            {
                let help = format!("the next is {}", bytes.next_multiple_of(4));
                reader.wrong(leaf, format!("a buffer has a multiple of 4 bytes, found {bytes}"), &help);
                return None;
            }
            Some(Bytes::Count(bytes))
        }
        _ => {
            let (word, rest) = reader.word(leaf, "a buffer's size", &["Times", "PerTexel", "Like"], SIZES)?;
            if word == "Like" {
                let [other]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Like(\"buffer\")")?;
                return scope.buffer(reader, other).map(Bytes::Like);
            }
            let [each, of]: [Leaf<'_>; 2] = reader.inside(leaf, rest, &format!("{word}(16, \"…\")"))?;
            let each = values::constant(reader, each, "number of bytes", 1..=LARGEST_BUFFER);
            if word == "PerTexel" {
                let image = scope.image(reader, of);
                return Some(Bytes::PerTexel(each?, image?));
            }
            let fits = |kind: &SettingKind| matches!(kind, SettingKind::OneOf { .. } | SettingKind::Integer { .. });
            let setting = scope.setting(reader, of, fits, "a whole number")?;
            let least = match scope.kinds.get(setting.index)?.as_ref().map(|setting| &setting.kind)? {
                SettingKind::OneOf { of, .. } => of.iter().min().copied().unwrap_or_default(),
                SettingKind::Integer { min, .. } => *min,
                SettingKind::Bool { .. } | SettingKind::Number { .. } => return None,
            };
            if least < 1 {
                let message = format!("this setting allows {least}, so that the buffer would be empty");
                reader.wrong(of, message, "let the setting begin at 1");
                return None;
            }
            Some(Bytes::Times(each?, setting))
        }
    }
}
