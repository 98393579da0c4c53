//! The images and buffers that a pass names, each with its use. All questions about them are asked of this one walk.

use super::part::{BufferPart, ImagePart, Part};
use super::pass::Pass;
use super::references::ResourceRef;
use crate::ron::Spanned;

/// How a pass uses an image or buffer that it names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Use {
    /// Its shader samples it.
    Sampled,
    /// Its shader would sample it, had a condition not left it out.
    LeftOut,
    /// Its shader reads it by itself.
    StorageRead,
    /// Its shader writes it by itself, or may do so.
    Storage,
    /// Its shader reads it as a uniform block.
    Uniform,
    /// It holds vertex attributes or indices.
    Drawn,
    /// It holds the counts of an indirect draw or dispatch, or the number of draws.
    Counts,
    /// Workgroups are counted by its texels: its size alone matters.
    Measured,
    /// It is a target.
    Target,
    /// It is read by transfer.
    TransferRead,
    /// It is written by transfer.
    TransferWrite,
}

impl Use {
    /// Whether the pass may write it.
    pub(crate) const fn writes(self) -> bool {
        match self {
            Use::Storage | Use::Target | Use::TransferWrite => true,
            Use::Sampled
            | Use::LeftOut
            | Use::StorageRead
            | Use::Uniform
            | Use::Drawn
            | Use::Counts
            | Use::Measured
            | Use::TransferRead => false,
        }
    }

    /// Whether the contents of the image or buffer matter where the pass runs.
    pub(crate) const fn is_access(self) -> bool {
        !matches!(self, Use::LeftOut | Use::Measured)
    }
}

/// A part of an image, or a buffer, where it is named.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PartRef<'p> {
    Image(&'p ImagePart),
    Buffer(&'p BufferPart),
}

impl<'p> PartRef<'p> {
    const fn of(part: &'p Part) -> PartRef<'p> {
        match part {
            Part::Image(part) => PartRef::Image(part),
            Part::Buffer(part) => PartRef::Buffer(part),
        }
    }

    /// The image or buffer, and where it is named.
    pub(crate) fn resource(self) -> ResourceRef {
        match self {
            PartRef::Image(part) => part.image.into(),
            PartRef::Buffer(part) => part.buffer.into(),
        }
    }

    /// How many frames back; `None`: this frame.
    pub(crate) const fn previous(self) -> Option<Spanned<u32>> {
        match self {
            PartRef::Image(part) => part.previous,
            PartRef::Buffer(part) => part.previous,
        }
    }
}

impl Pass {
    /// The parts of images and buffers that it names, each with its use.
    pub(crate) fn parts(&self) -> impl Iterator<Item = (PartRef<'_>, Use)> {
        let sampled = self.sample.iter().map(|sample| (PartRef::Image(&sample.part), Use::Sampled));
        let left_out = self.left_out.iter().filter_map(|left_out| left_out.sample.as_ref());
        let left_out = left_out.map(|sample| (PartRef::Image(&sample.part), Use::LeftOut));
        let storage = self.storage.iter().map(|storage| {
            let writes = storage.access.is_none_or(|access| access.value.writes());
            (PartRef::of(&storage.part), if writes { Use::Storage } else { Use::StorageRead })
        });
        let uniform = self.uniform.iter().map(|uniform| (PartRef::Buffer(&uniform.part), Use::Uniform));
        let drawn = self.vertex.iter().chain(&self.index).map(|part| (PartRef::Buffer(part), Use::Drawn));
        let counts =
            self.work.counts().into_iter().chain(self.work.count()).map(|part| (PartRef::Buffer(part), Use::Counts));
        let measured = self.work.measured().map(|part| (PartRef::Image(part), Use::Measured));
        let targets = self.color.iter().map(|color| &color.part).chain(self.depth.as_ref().map(|depth| &depth.part));
        let targets = targets.map(|part| (PartRef::Image(part), Use::Target));
        let reads = self.work.transfer_reads().iter().map(|part| (PartRef::of(part), Use::TransferRead));
        let writes = self.work.transfer_writes().iter().map(|part| (PartRef::of(part), Use::TransferWrite));
        let of_shader = sampled.chain(left_out).chain(storage).chain(uniform).chain(drawn);
        of_shader.chain(counts).chain(measured).chain(targets).chain(reads).chain(writes)
    }

    /// The parts of images among them.
    pub(crate) fn image_parts(&self) -> impl Iterator<Item = (&ImagePart, Use)> {
        self.parts().filter_map(|(part, of)| match part {
            PartRef::Image(part) => Some((part, of)),
            PartRef::Buffer(_) => None,
        })
    }

    /// The parts of images whose contents it uses or would use, and how it declares their uses, to be changed.
    pub(crate) fn image_parts_mut(&mut self) -> impl Iterator<Item = &mut ImagePart> {
        let Pass { sample, left_out, storage, color, depth, work, uses, .. } = self;
        let left_out = left_out.iter_mut().filter_map(|left_out| left_out.sample.as_mut());
        let sampled = sample.iter_mut().chain(left_out).map(|sample| &mut sample.part);
        let targets = color.iter_mut().map(|color| &mut color.part).chain(depth.as_mut().map(|depth| &mut depth.part));
        let declared = uses.iter_mut().map(|declared| &mut declared.part);
        let others = storage.iter_mut().map(|storage| &mut storage.part).chain(work.transfers_mut()).chain(declared);
        sampled.chain(targets).chain(others.filter_map(|part| match part {
            Part::Image(part) => Some(part),
            Part::Buffer(_) => None,
        }))
    }
}
