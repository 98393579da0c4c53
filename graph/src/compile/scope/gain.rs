//! The gain of passes that share a rendering scope. The sentence is made when it is printed: sizes may have changed by then.

use super::step::{Scope, Target, op_name, resource_name};
use crate::compile::model::{Adapted, Use};
use crate::frame::Frame;

/// The gain of a pass by joining the scope before it.
#[derive(Debug, Clone)]
pub(super) enum Gain {
    /// It draws into attachments that the scope has already.
    Shared {
        /// The last operation of the scope so far.
        before: Option<u32>,
        attachments: Vec<Target>,
    },
    /// It reads at its own position what the scope drew.
    ReadLocally(Target),
}

impl Gain {
    /// Of an operation with these uses that joins `scope`.
    pub(super) fn shared(adapted: &Adapted, scope: &Scope, uses: &[Use]) -> Gain {
        let attached = |used: &&Use| used.role.is_attachment() && scope.attaches(adapted, used);
        let attachments = uses.iter().filter(attached).map(|used| Target::of(adapted, used)).collect();
        Gain::Shared { before: scope.ops.last().copied(), attachments }
    }

    pub(super) fn read_locally(adapted: &Adapted, used: &Use) -> Gain {
        Gain::ReadLocally(Target::of(adapted, used))
    }

    pub(super) fn words(&self, frame: &Frame, adapted: &Adapted) -> String {
        let mebibytes = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        let name = |target: &Target| resource_name(frame, adapted, target.resource);
        match self {
            Gain::Shared { before, attachments } => {
                let bytes = attachments.iter().map(|target| bytes(adapted, target)).fold(0, u64::saturating_add);
                let names: Vec<String> = attachments.iter().map(|target| format!("`{}`", name(target))).collect();
                let before = before.and_then(|op| op_name(frame, adapted, op)).map_or("", |name| name);
                format!(
                    "draws into {} like `{before}`: {:.1} MiB need neither be stored nor loaded",
                    names.join(" and "),
                    mebibytes(bytes)
                )
            }
            Gain::ReadLocally(target) => format!(
                "reads `{}` at its own position: {:.1} MiB need not be read from memory",
                name(target),
                mebibytes(bytes(adapted, target))
            ),
        }
    }
}

/// Bytes of a part of an image.
fn bytes(adapted: &Adapted, target: &Target) -> u64 {
    let Some(image) = adapted.resources[target.resource as usize].image() else { return 0 };
    let sides = image.extent_at(target.range.base_mip).map(u64::from);
    let texels = sides.into_iter().fold(u64::from(target.range.layers), u64::saturating_mul);
    texels.saturating_mul(image.format.texel_bytes()).saturating_mul(u64::from(image.samples))
}
