//! How people read a Plan's parts: steps, parts of images, Vulkan's words. Text that came from files is escaped.

use super::{BufferId, ImageId, Plan, Resource, Side, StepId, Transfer, Work};
use crate::vulkan::{Subresources, name_of};
use std::fmt;
use std::fmt::{Display, Formatter, Write};

/// Text from a file, without raw control characters.
pub(crate) struct Shown<'t>(pub(crate) &'t str);

impl Display for Shown<'_> {
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

impl Plan {
    /// The name of a step for people: its passes' names, or its source and target. Escaped; empty if there is no such step.
    pub(crate) fn step_name(&self, step: StepId) -> String {
        const MOST: usize = 3;
        let side = |side: &Side| Shown(self.resource_name(side.resource()));
        let transfer = |word: &str, transfer: &Transfer| match &transfer.name {
            Some(name) => format!("`{}`", Shown(name)),
            None => format!("{word} `{}` to `{}`", side(&transfer.source), side(&transfer.target)),
        };
        match self.steps.get(step.0 as usize).map(|step| &step.work) {
            None => String::new(),
            Some(Work::Render(scope)) => {
                let names: Vec<_> =
                    scope.passes.iter().take(MOST).map(|pass| format!("`{}`", Shown(&pass.name))).collect();
                match scope.passes.len() {
                    0 => "without passes".to_owned(),
                    more if more > MOST => format!("{} and {} more", names.join(", "), more - MOST),
                    _ => names.join(", "),
                }
            }
            Some(Work::Dispatch(pass) | Work::Custom(pass)) => format!("`{}`", Shown(&pass.name)),
            Some(Work::Resolve(it)) => transfer("resolve", it),
            Some(Work::Copy(it)) => transfer("copy", it),
            Some(Work::Blit(it)) => transfer("blit", it),
            Some(Work::Fill(fill)) => match &fill.name {
                Some(name) => format!("`{}`", Shown(name)),
                None => format!("fill `{}`", side(&fill.target)),
            },
            Some(Work::Export) => "export".to_owned(),
        }
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
