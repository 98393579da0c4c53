//! What shaders read of the vertices and push constants that a draw source brings along, and what that asks of the device.

use super::{
    Attribute, AttributeMisfit, BroughtLocation, DrawInterface, PushConstants, PushedBlock, VertexBuffer, VertexInput,
    VertexRate,
};
use crate::device::{Limit, Need, NeedKind};

/// Vulkan's name of the feature that several instances in a row with one element need.
const DIVISOR: &str = "vertexAttributeInstanceRateDivisor";

impl DrawInterface {
    /// The attribute that a shader means, if it is brought along: by its name, or else by its location.
    #[must_use]
    pub fn attribute(&self, input: &VertexInput) -> Option<&Attribute> {
        let named = self.attributes.iter().find(|it| it.is_called(input));
        named.or_else(|| self.attributes.iter().find(|it| it.location == Some(input.location)))
    }

    /// Where a shader's attribute is read, location by location.
    ///
    /// # Errors
    /// [`AttributeMisfit`], if what is brought along isn't what the shader declares.
    pub fn locations(
        &self,
        input: &VertexInput,
    ) -> Result<impl Iterator<Item = BroughtLocation> + use<>, AttributeMisfit> {
        let there = self.attribute(input).ok_or(AttributeMisfit::Unknown)?;
        let (count, component) = input.read_as().ok_or(AttributeMisfit::Format(there.format))?;
        let misfit = match () {
            () if input.component != 0 => Some(AttributeMisfit::Component),
            () if component != there.format.component() => Some(AttributeMisfit::Format(there.format)),
            () if count > there.locations => Some(AttributeMisfit::Locations(there.locations)),
            () => None,
        };
        if let Some(misfit) = misfit {
            return Err(misfit);
        }
        let Attribute { format, buffer, offset, .. } = *there;
        let first = input.location;
        Ok((0..count).map(move |number| BroughtLocation {
            location: first.saturating_add(number),
            buffer,
            offset: offset + number * format.bytes(),
            format,
        }))
    }

    /// The byte behind the last push constant.
    #[must_use]
    pub fn pushed_bytes(&self) -> u32 {
        self.push_constants.iter().map(|it| it.offset.saturating_add(it.bytes)).max().unwrap_or(0)
    }

    /// Why a block of push constants doesn't fit what is brought along, in words; `None`: it does.
    #[must_use]
    pub fn pushed_misfit(&self, block: &PushedBlock) -> Option<String> {
        let PushedBlock { name, stages, offset, end } = block;
        let seen = || self.push_constants.iter().filter(|it| it.stages.contains(*stages));
        let holds = |it: &PushConstants| it.offset <= *offset && *end <= it.offset.saturating_add(it.bytes);
        if seen().any(holds) {
            return None;
        }
        let there: Vec<String> = seen().map(|it| format!("{} to {}", it.offset, it.offset + it.bytes - 1)).collect();
        let there = if there.is_empty() { "none".to_owned() } else { format!("bytes {}", there.join(" and ")) };
        Some(format!("push constants `{name}`, bytes {offset} to {}, and the stage is brought {there}", end - 1))
    }
}

/// What reading a shader's attributes out of the buffers of a draw source asks of the device. Attributes that don't fit ask for nothing.
#[must_use]
pub fn vertex_needs(inputs: &[VertexInput], brought: &DrawInterface) -> Vec<Need> {
    let mut needs = Vec::new();
    let mut need = |kind| {
        let need = Need { kind, place: "".into() };
        if !needs.contains(&need) {
            needs.push(need);
        }
    };
    for input in inputs {
        let Ok(locations) = brought.locations(input) else { continue };
        for BroughtLocation { location, buffer, offset, format } in locations {
            if !format.is_on_every_device() {
                need(NeedKind::VertexFormat { format, name: input.name.as_str().into() });
            }
            let Some(VertexBuffer { stride, rate }) = brought.vertex_buffers.get(buffer as usize).copied() else {
                continue;
            };
            let limits = [
                (
                    Limit::VertexAttributes,
                    u64::from(location) + 1,
                    "the locations of its vertex attributes go up to",
                    location,
                ),
                (Limit::VertexBuffers, u64::from(buffer) + 1, "its vertex buffers go up to", buffer),
                (Limit::VertexOffset, u64::from(offset), "the offset of a vertex attribute is", offset),
                (Limit::VertexStride, u64::from(stride), "the bytes from vertex to vertex are", stride),
            ];
            for (limit, value, what, said) in limits {
                if value > limit.least() {
                    need(NeedKind::Limit { limit, value, what: format!("{what} {said}").into() });
                }
            }
            if matches!(rate, VertexRate::Instance { divisor: 2.. }) {
                need(NeedKind::Feature { name: DIVISOR, what: "a vertex attribute that several instances share" });
            }
        }
    }
    needs
}

/// What the push constants of a draw source ask of the device.
#[must_use]
pub fn push_needs(brought: &DrawInterface) -> Option<Need> {
    let value = u64::from(brought.pushed_bytes());
    let what = || format!("{value} bytes of push constants are brought along").into();
    let limit = Limit::PushConstantBytes;
    (value > limit.least()).then(|| Need { kind: NeedKind::Limit { limit, value, what: what() }, place: "".into() })
}
