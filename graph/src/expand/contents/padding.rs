//! Padding: buffers have a multiple of four bytes, and texels may have fewer. A copy of such texels leaves the bytes behind them as they
//! were: what an earlier pass wrote there, else zero.

use crate::expand::resources::Resources;
use crate::frame::{Pass, Resource, TransferUse, Work};
use crate::vulkan::{FillValue, Subresources};

/// Has copies of texels keep the bytes that they don't reach. A pass that fills them with zero goes before the first of them.
pub(in crate::expand) fn keep(resources: &Resources<'_>, passes: &mut Vec<Pass>) {
    let mut at = 0;
    while at < passes.len() {
        if let Some(target) = padded(resources, &passes[at]) {
            passes[at].transfers[target].keeps = true;
            let resource = passes[at].transfers[target].resource;
            let writes = |pass: &Pass| pass.accesses().any(|it| it.resource() == resource && it.writes(pass, None));
            let has_contents = resources.lifetime(resource).is_some_and(|lifetime| lifetime.has_contents(resource));
            if !has_contents && !passes[..at].iter().any(writes) {
                let fill = zero(resources, &passes[at], resource);
                passes.insert(at, fill);
                at += 1;
            }
        }
        at += 1;
    }
}

/// The transfer of a copy into a buffer that has more bytes than the texels.
fn padded(resources: &Resources<'_>, pass: &Pass) -> Option<usize> {
    let (true, [source, target]) = (pass.work.is_copy(), &pass.transfers[..]) else { return None };
    let (Resource::Image(image), Resource::Buffer(buffer)) = (source.resource, target.resource) else { return None };
    let (image, buffer) = (&resources.image(image)?.image, resources.buffer(buffer)?);
    let part = image.part(source.range);
    let texels = image.extent_at(part.base_mip).iter().map(|side| u64::from(*side)).product::<u64>();
    let bytes = texels * u64::from(part.layers) * image.format.plane_bytes(part.aspects)?;
    (bytes < buffer.bytes).then_some(1)
}

fn zero(resources: &Resources<'_>, copy: &Pass, resource: Resource) -> Pass {
    let name = &resources.name(resource).text;
    let why = format!("`{}` copies texels into `{name}` that take fewer bytes than it has", copy.name);
    let span = copy.span;
    let transfer = TransferUse { resource, range: Subresources::WHOLE, frames_ago: 0, span, write: true, keeps: false };
    Pass {
        span,
        view: copy.view,
        run: copy.run.clone(),
        inserted: Some(why.into()),
        transfers: vec![transfer],
        ..Pass::new(&format!("{} (padding)", copy.name), Work::Fill { value: FillValue::Bits([0; 4]) })
    }
}
