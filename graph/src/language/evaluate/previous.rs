//! `previous` looks no further back than a lifetime reaches, and only reads.

use crate::base::{Code, Diagnostic};
use crate::frame::Resource;
use crate::language::model::{Buffer, Image, Lifetime, Pass, ResourceRef, Use};
use crate::ron::{Name, Spanned};
use std::sync::Arc;

/// Reports every part of an earlier frame that isn't kept, and every one that a pass would write.
pub(crate) fn check(
    images: &[Option<Arc<Image>>],
    buffers: &[Option<Buffer>],
    passes: &[Option<Arc<Pass>>],
    errors: &mut Vec<Diagnostic>,
) {
    for pass in passes.iter().flatten() {
        for (part, of) in pass.parts().filter(|(_, of)| of.is_access()) {
            let Some(previous) = part.previous() else { continue };
            if of == Use::TransferWrite {
                let message = "what an earlier frame left can't be written";
                errors.push(
                    Diagnostic::new(Code::EARLIER_FRAME, previous.span, message)
                        .help("remove `previous`: it is for reading"),
                );
            } else {
                kept(images, buffers, part.resource(), previous, errors);
            }
        }
    }
}

fn kept(
    images: &[Option<Arc<Image>>],
    buffers: &[Option<Buffer>],
    of: ResourceRef,
    previous: Spanned<u32>,
    errors: &mut Vec<Diagnostic>,
) {
    let Some((name, lifetime)) = declared(images, buffers, of.resource) else { return };
    let mut kept = lifetime;
    // A circle would be longer than everything together; it is reported elsewhere.
    for _ in 0..images.len() + buffers.len() {
        let Lifetime::Like(other) = &kept.value else { break };
        let Some((_, next)) = declared(images, buffers, other.resource) else { return };
        kept = next;
    }
    let (value, text) = (previous.value, &name.text);
    let why = match kept.value {
        Lifetime::History { frames, .. } if value <= frames => return,
        Lifetime::Like(_) => return,
        Lifetime::History { frames, .. } => {
            let left = if frames == 1 { "what 1 frame left".to_owned() } else { format!("what {frames} frames left") };
            format!("`{text}` keeps {left}, not {value}")
        }
        Lifetime::Transient => format!("`{text}` is transient: nothing is left of it after a frame"),
        Lifetime::Persistent { .. } => format!("`{text}` is persistent: it is one image or buffer for all frames"),
        Lifetime::Imported { .. } => format!("`{text}` is imported: only the program knows what it held"),
        Lifetime::File(_) => {
            let wrong = Diagnostic::new(
                Code::NOT_KEPT,
                previous.span,
                format!("`{text}` comes from a file: it is the same in all frames"),
            );
            errors.push(wrong.remark("read here").label(kept.span, "its file").help("leave `previous` out"));
            return;
        }
    };
    let remark = match kept.value {
        Lifetime::Transient => "declared here, without a lifetime that outlives the frame",
        _ => "its lifetime",
    };
    errors.push(
        Diagnostic::new(Code::NOT_KEPT, previous.span, why)
            .remark("read here")
            .label(kept.span, remark)
            .help(format!("let it live longer: `lifetime: History(frames: {value})`")),
    );
}

/// The name and lifetime of an image or buffer, if it could be read.
fn declared<'a>(
    images: &'a [Option<Arc<Image>>],
    buffers: &'a [Option<Buffer>],
    of: Resource,
) -> Option<(&'a Name, &'a Spanned<Lifetime>)> {
    match of {
        Resource::Image(index) => images.get(index.0 as usize)?.as_ref().map(|image| (&image.name, &image.lifetime)),
        Resource::Buffer(index) => {
            buffers.get(index.0 as usize)?.as_ref().map(|buffer| (&buffer.name, &buffer.lifetime))
        }
    }
}
