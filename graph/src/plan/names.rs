//! How people read a Plan's parts: steps, parts of images, Vulkan's words. Text that came from files is escaped.

use super::{AttachmentKind, BufferId, ImageId, Plan, Resource, StepId};
use crate::vulkan::{Subresources, name_of};
use std::fmt;
use std::fmt::{Display, Formatter, Write};

/// Text from a file, without raw control characters.
pub(crate) struct ShownText<'t>(pub(crate) &'t str);

impl Display for ShownText<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for letter in self.0.chars() {
            match letter {
                '\'' | '"' => f.write_char(letter)?,
                _ => write!(f, "{}", letter.escape_debug())?,
            }
        }
        Ok(())
    }
}

impl Display for Subresources {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let part = |f: &mut Formatter<'_>, name: &str, base: u32, count: u32| match count {
            1 => write!(f, ", {name} {base}"),
            _ => write!(f, ", {name}s {base}–{}", u64::from(base) + u64::from(count.max(1)) - 1),
        };
        f.write_str(&name_of(&self.aspects))?;
        part(f, "mip", self.base_mip, self.mips)?;
        part(f, "layer", self.base_layer, self.layers)
    }
}

impl AttachmentKind {
    /// An attachment of this kind in words: "color 0", "depth". `location`: its number among the attachments of its scope.
    pub(crate) fn words(self, location: usize) -> String {
        match self {
            AttachmentKind::Color => format!("color {location}"),
            AttachmentKind::Depth | AttachmentKind::Stencil => name_of(&self),
        }
    }
}

impl Plan {
    /// The name of a step for people: its passes' names, or its source and target. Escaped; empty if there is no such step.
    pub(crate) fn step_name(&self, step: StepId) -> String {
        const MOST: usize = 3;
        let quoted = |name: &str| format!("`{}`", ShownText(name));
        let Some(work) = self.steps.get(step.0 as usize).map(|step| &step.work) else { return String::new() };
        if let Some(scope) = work.scope() {
            let names: Vec<_> = scope.passes.iter().take(MOST).map(|pass| quoted(&pass.name)).collect();
            return match scope.passes.len() {
                0 => "without passes".to_owned(),
                more if more > MOST => format!("{} and {} more", names.join(", "), more - MOST),
                _ => names.join(", "),
            };
        }
        if let Some(name) = work.name() {
            return quoted(name);
        }
        let sides: Vec<_> = work.sides().map(|side| quoted(self.resource_name(side.resource()))).collect();
        if sides.is_empty() { work.word().to_owned() } else { format!("{} {}", work.word(), sides.join(" to ")) }
    }

    /// The name of an image or buffer, as it stands in the file; empty if there is none.
    #[must_use]
    pub fn resource_name(&self, resource: Resource) -> &str {
        match resource {
            Resource::Image(ImageId(id)) => self.images.get(id as usize).map_or("", |image| &image.name),
            Resource::Buffer(BufferId(id)) => self.buffers.get(id as usize).map_or("", |buffer| &buffer.name),
        }
    }
}
