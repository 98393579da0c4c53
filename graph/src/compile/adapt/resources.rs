//! Physical images and buffers: made at their first use, replaced when a version needs another one.

use super::adapter::{Adapter, Version};
use super::demote::copies_samples;
use crate::compile::model::{Kind, MemorySource, PhysicalIndex, PhysicalResource, Use};
use crate::device::{BufferDescriptor, ImageDescriptor};
use crate::frame::tracked_parts::Grid;
use crate::frame::{BufferIndex, Frame, ImageIndex, Lifetime, Output, Pass, Resource, TransferUse};
use crate::plan::InsertionCause;
use crate::vulkan::{BufferUsage, FillValue, Format, Rotation, Sharing, Usage};
use std::collections::HashMap;
use std::sync::Arc;

/// Numbers physical images of one name, as an image gets that others are forwarded to; the last one keeps the name.
pub(super) fn distinct_names(frame: &Frame, resources: &mut [PhysicalResource]) {
    let mut used: HashMap<Arc<str>, u32> = HashMap::with_capacity(resources.len());
    for resource in resources.iter_mut().rev() {
        let name = resource.renamed.as_ref().unwrap_or(frame.name(resource.of)).clone();
        let mut shown = name.clone();
        while let Some(number) = used.get_mut(&shown) {
            // Counting goes on where it stopped: many images may have one name.
            *number += 1;
            shown = format!("{name} ({number})").into();
            resource.renamed = Some(shown.clone());
        }
        used.insert(shown, 1);
    }
}

impl Adapter<'_> {
    /// The physical image with the current version; there is one, since `link` saw a version.
    #[inline]
    pub(super) fn current(&mut self, image: ImageIndex) -> PhysicalIndex {
        match self.resource_of[image.0 as usize] {
            Some(resource) => resource,
            None => self.first_resource(image),
        }
    }

    /// The samples of an image's current version.
    pub(super) fn current_samples(&mut self, image: ImageIndex) -> u32 {
        let resource = self.current(image);
        self.samples(resource)
    }

    /// The samples of a physical image.
    pub(super) fn samples(&self, resource: PhysicalIndex) -> u32 {
        self.versions[resource as usize].samples
    }

    /// By how much what a physical image holds is turned.
    pub(super) fn rotation(&self, resource: PhysicalIndex) -> Rotation {
        match self.adapted.resources[resource as usize].of {
            Resource::Image(image) => self.input.frame.images[image.0 as usize].rotation,
            Resource::Buffer(_) => Rotation::Identity,
        }
    }

    /// The physical image that takes the next version: another one if nothing is kept and the last draws moved to fewer
    /// samples.
    #[inline]
    pub(super) fn written(&mut self, image: ImageIndex, keeps: bool) -> PhysicalIndex {
        let Some(resource) = self.resource_of[image.0 as usize] else { return self.first_resource(image) };
        let wanted = self.input.negotiated.samples(image);
        match !keeps && self.samples(resource) != wanted {
            true => self.written_anew(image, wanted),
            false => self.continued(image),
        }
    }

    fn written_anew(&mut self, image: ImageIndex, wanted: u32) -> PhysicalIndex {
        let declared = &self.input.frame.images[image.0 as usize];
        let because = format!("`{}` is written anew, with {wanted} samples", declared.name);
        let why = self.reason(because, declared.span);
        self.replace(image, "again", why, wanted)
    }

    /// The physical image with the current version, which is about to change.
    pub(super) fn continued(&mut self, image: ImageIndex) -> PhysicalIndex {
        let resource = self.current(image);
        let version = &mut self.versions[resource as usize];
        (version.resolved, version.redrawn) = (None, None);
        resource
    }

    fn first_resource(&mut self, image: ImageIndex) -> PhysicalIndex {
        let declared = &self.input.frame.images[image.0 as usize];
        let samples = self.input.negotiated.samples(image);
        let (name, lifetime) = (&declared.name, &declared.lifetime);
        let first = self.add_image(image, samples);
        if !matches!(lifetime, Lifetime::Transient) {
            self.add_lives(first, name, lifetime, |adapter| adapter.add_image(image, samples));
        }
        self.resource_of[image.0 as usize] = Some(first);
        first
    }

    /// The physical buffer that holds what a buffer held some frames ago.
    pub(super) fn buffer(&mut self, buffer: BufferIndex, frames_ago: u32) -> PhysicalIndex {
        let first = match self.buffer_resource_of[buffer.0 as usize] {
            Some(resource) => resource,
            None => {
                let declared = &self.input.frame.buffers[buffer.0 as usize];
                let (name, lifetime) = (&declared.name, &declared.lifetime);
                let first = self.add_buffer(buffer);
                self.add_lives(first, name, lifetime, |adapter| adapter.add_buffer(buffer));
                first
            }
        };
        self.buffer_resource_of[buffer.0 as usize] = Some(first);
        first + frames_ago
    }

    /// Gives a resource the memory that its lifetime takes; with history, adds one for each earlier frame, the newest first.
    fn add_lives(
        &mut self,
        first: PhysicalIndex,
        name: &Arc<str>,
        lifetime: &Lifetime,
        mut add: impl FnMut(&mut Self) -> PhysicalIndex,
    ) {
        let persistent =
            |initial: FillValue, becomes: PhysicalIndex| MemorySource::Persistent { becomes, initial: Some(initial) };
        match *lifetime {
            Lifetime::Transient => {}
            Lifetime::Persistent { initial } => {
                self.adapted.resources[first as usize].memory = persistent(initial, first)
            }
            Lifetime::History { frames, initial } => {
                for ago in 1..=frames {
                    let older = add(self);
                    let words = if ago == 1 { "1 frame ago".to_owned() } else { format!("{ago} frames ago") };
                    self.adapted.resources[older as usize].renamed = Some(format!("{name} ({words})").into());
                    self.renamed = true;
                }
                for resource in first..=first + frames {
                    let becomes = if resource == first + frames { first } else { resource + 1 };
                    self.adapted.resources[resource as usize].memory = persistent(initial, becomes);
                }
            }
            Lifetime::File(_) => {
                self.adapted.resources[first as usize].memory =
                    MemorySource::Persistent { becomes: first, initial: None };
            }
            Lifetime::Imported { before, after, .. } => {
                let resource = &mut self.adapted.resources[first as usize];
                (resource.memory, resource.after) = (MemorySource::Imported { before }, after);
            }
        }
    }

    /// A further physical image for `image`, which holds no version yet.
    pub(super) fn second(
        &mut self,
        image: ImageIndex,
        what: &str,
        why: Box<InsertionCause>,
        samples: u32,
    ) -> PhysicalIndex {
        let count = self.inserted_for.entry(image).or_insert(0);
        *count += 1;
        let name = &self.input.frame.images[image.0 as usize].name;
        let name = if *count == 1 { format!("{name} ({what})") } else { format!("{name} ({what} {count})") };
        self.renamed = true;
        let resource = self.add_image(image, samples);
        let made = &mut self.adapted.resources[resource as usize];
        (made.renamed, made.inserted) = (Some(name.into()), Some(why));
        resource
    }

    /// A further physical image for `image`, which takes its next version.
    pub(super) fn replace(
        &mut self,
        image: ImageIndex,
        what: &str,
        why: Box<InsertionCause>,
        samples: u32,
    ) -> PhysicalIndex {
        let resource = self.second(image, what, why, samples);
        self.resource_of[image.0 as usize] = Some(resource);
        resource
    }

    fn add_image(&mut self, image: ImageIndex, samples: u32) -> PhysicalIndex {
        let declared = &self.input.frame.images[image.0 as usize];
        let descriptor = ImageDescriptor {
            format: declared.format,
            shape: declared.shape,
            extent: declared.extent,
            mips: declared.mips,
            layers: declared.layers,
            samples,
            usage: Usage::empty(),
            sharing: Sharing::Exclusive,
        };
        self.images += 1;
        let usual = declared.chosen.as_ref().map(|chosen| chosen.usual);
        let (kind, grid) = (Kind::Image(descriptor), self.input.grids.of(image).cloned());
        let resource = self.add(Resource::Image(image), self.images - 1, kind, usual, grid);
        if let Some(allocated) = declared.allocated {
            self.adapted.allocated.insert(resource, allocated);
        }
        if let Some(form) = declared.eyes {
            self.adapted.eyes.insert(resource, (form, declared.rotation));
        }
        resource
    }

    fn add_buffer(&mut self, buffer: BufferIndex) -> PhysicalIndex {
        let bytes = self.input.frame.buffers[buffer.0 as usize].bytes;
        let descriptor = BufferDescriptor { bytes, usage: BufferUsage::empty(), sharing: Sharing::Exclusive };
        self.adapted.buffers += 1;
        self.add(Resource::Buffer(buffer), self.adapted.buffers - 1, Kind::Buffer(descriptor), None, None)
    }

    fn add(
        &mut self,
        of: Resource,
        id: u32,
        kind: Kind,
        usual: Option<Format>,
        grid: Option<Arc<Grid>>,
    ) -> PhysicalIndex {
        let (subresource, subresources) = match &grid {
            None => (self.adapted.subresources, 1),
            Some(grid) => (Use::SEVERAL, grid.len()),
        };
        let samples = if let Kind::Image(image) = &kind { image.samples } else { 1 };
        self.versions.push(Version { samples, subresource, resolved: None, redrawn: None, drawn: false });
        self.adapted.resources.push(PhysicalResource {
            id,
            of,
            renamed: None,
            inserted: None,
            kind,
            usual,
            memory: MemorySource::Transient,
            after: None,
            grid,
            first_subresource: self.adapted.subresources,
        });
        self.adapted.subresources += subresources;
        self.adapted.resources.len() as PhysicalIndex - 1
    }

    /// The resource that a pass transfers, and which part of it; a multisampled source is resolved first.
    pub(super) fn transferred(&mut self, pass: &Pass, used: &TransferUse) -> Option<(PhysicalIndex, u32)> {
        let image = match used.resource {
            Resource::Buffer(buffer) => return Some((self.buffer(buffer, used.frames_ago), Use::ALL)),
            Resource::Image(image) => image,
        };
        let range = self.range(image, used.range);
        if used.frames_ago > 0 {
            return Some((self.current(image) + used.frames_ago, range));
        }
        let declared = &self.input.frame.images[image.0 as usize];
        if used.write {
            let reads = |it: &TransferUse| !it.write && (it.resource, it.frames_ago) == (used.resource, 0);
            let keeps = range != Use::ALL || pass.is_custom() && pass.transfers.iter().any(reads);
            return Some((self.written(image, keeps), range));
        }
        let count = self.current_samples(image);
        if count == 1 || copies_samples(self.input.frame, pass) {
            return Some((self.current(image), range));
        }
        let because = format!("`{}` transfers from `{}` and it has {count} samples", pass.name, declared.name);
        let planes = declared.part(used.range).aspects;
        Some((self.resolved_as_it_is((image, planes), because, used.span)?, range))
    }

    pub(super) fn output(&mut self, output: &Output) {
        let image = match output.resource {
            Resource::Buffer(buffer) => {
                let resource = self.buffer(buffer, 0);
                return self.leaves(resource, output);
            }
            Resource::Image(image) => image,
        };
        let declared = &self.input.frame.images[image.0 as usize];
        let count = self.current_samples(image);
        let resource = if count == 1 {
            self.current(image)
        } else {
            let because = format!("`{}` is an output and has {count} samples", declared.name);
            match self.resolved_as_it_is((image, declared.format.aspects()), because, output.span) {
                Some(resolved) => resolved,
                None => return,
            }
        };
        self.leaves(resource, output);
    }

    fn leaves(&mut self, resource: PhysicalIndex, output: &Output) {
        let leaving = &mut self.adapted.resources[resource as usize];
        if leaving.is_transient() {
            leaving.memory = MemorySource::Output;
        }
        leaving.after = output.after.or(leaving.after);
        self.adapted.outputs.push(resource);
    }
}
