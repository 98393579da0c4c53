//! Migration to another Plan, after a resize or another setting: images and buffers that persist in both keep their contents. Others
//! begin anew, in `initial_contents.rs`.

use super::executor::Executor;
use crate::base::Error;
use crate::commands::{barriers, memory_change, state_change};
use crate::prepare::{cycle, initial_queue};
use ash::vk;
use framewright_graph::plan::{BufferId, FirstContents, ImageId, Plan, Queue, Resource, Role};
use framewright_graph::vulkan::{Layout, State, Subresources};
use std::sync::Arc;

/// One image or buffer that keeps its contents.
struct Migration {
    from: Resource,
    to: Resource,
    /// The queue that has it, in both.
    queue: Queue,
    left: State,
    found: State,
}

impl Executor {
    /// Lets what persists go on from `before`, which executed another Plan on the same device and ends here: the same
    /// pipeline at another size or with other settings. What both Plans know by the same name and in the same form keeps
    /// its contents, history as a whole; everything else begins with its initial value. Frames are counted on. Returns the names of
    /// what went on. What the program imported into `before` is to be imported again, or no frame is drawn. Its
    /// [outside owners](Executor::set_owner) stay: [`Executor::check_owners`] tells before whether they can. What `before` found out about
    /// custom passes and didn't tell yet ([`ExecutorOptions::check_uses`](crate::ExecutorOptions::check_uses)), this executor tells.
    ///
    /// # Errors
    /// [`Error::BadResource`] if this executor has begun already, is of another device, or uses what has an outside owner on several queues;
    /// [`Error::DeviceLost`],
    /// [`Error::Timeout`].
    pub fn migrate_from(&mut self, mut before: Executor) -> Result<Vec<String>, Error> {
        let bad = |what: &str| Err(Error::BadResource { what: format!("nothing can be carried over: {what}") });
        if self.frames.next() > 0 || self.initialised {
            return bad("the executor has begun already");
        }
        if !Arc::ptr_eq(&self.gpu, &before.gpu) {
            return bad("the executors are of different devices");
        }
        before.frames.wait_for_all()?;
        self.first_frame = before.frames();
        self.missing = before.imported();
        self.take_owners(&mut before)?;
        self.frames.take_promises(&mut before.frames);
        self.sets.take_over(&before.sets);
        self.runs.go_on(&before.runs);
        if !before.initialised {
            return Ok(Vec::new());
        }
        let migrated = self.migrations_from(&before);
        for queue in [Queue::Graphics, Queue::Compute, Queue::Transfer] {
            let mut here = migrated.iter().filter(|it| it.queue == queue).peekable();
            if here.peek().is_some() {
                self.gpu.submit_once("carrying contents over", queue, |commands| {
                    here.for_each(|it| before.record_change(commands, it));
                })?;
            }
        }
        let next = before.frames.next();
        for it in &migrated {
            let (from, to) = (&before.prepared.physical, &mut self.prepared.physical);
            match (it.from, it.to) {
                (Resource::Image(old), Resource::Image(new)) => {
                    let extent = from.extent(before.plan.image(old), next);
                    to.migrate_image(new, from.image(old, next).clone(), extent);
                }
                (Resource::Buffer(old), Resource::Buffer(new)) => {
                    to.migrate_buffer(new, from.buffer(old, next).clone())
                }
                (Resource::Image(_), Resource::Buffer(_)) | (Resource::Buffer(_), Resource::Image(_)) => {}
            }
        }
        self.prepared.forget();
        Ok(migrated.iter().map(|it| self.plan.resource_name(it.to).to_owned()).collect())
    }

    /// What would be lost if this executor went on from `before` by [`Executor::migrate_from`]: the names of what persists in both and
    /// doesn't keep its contents, and of what the program imported, which it would have to import again.
    #[must_use]
    pub fn would_lose(&self, before: &Executor) -> Vec<String> {
        let mut lost = before.imported();
        if before.initialised {
            let begins = |to: &Resource| {
                let name = self.plan.resource_name(*to);
                let is_kept = match self.plan.role(*to) {
                    Role::Persistent { before, initial: FirstContents::Value(_), .. } => {
                        matches!(to, Resource::Buffer(_)) || before.layout != Layout::Undefined
                    }
                    Role::Persistent { .. } | Role::Transient(_) | Role::External { .. } => false,
                };
                let was = || persistent(&before.plan).any(|it| before.plan.resource_name(it) == name);
                is_kept && was() && self.goes_on(before, *to).is_none()
            };
            lost.extend(persistent(&self.plan).filter(begins).map(|it| self.plan.resource_name(it).to_owned()));
        }
        lost
    }

    /// Names of the images and buffers of the program's that it has, or that executors before it had. Those that a window shows aren't
    /// among them: presenting imports them.
    fn imported(&self) -> Vec<String> {
        let imported = self.imports.iter().filter(|it| !it.is_own(&self.prepared.physical));
        let names = imported.map(|it| self.plan.resource_name(it.resource));
        let names = names.filter(|name| self.owners.iter().all(|(shown, _)| shown != name));
        names.map(str::to_owned).chain(self.missing.iter().cloned()).collect()
    }

    /// What the frame uses of the program's, and was not imported since the executor before this one had it.
    pub(super) fn not_imported(&self) -> Option<&str> {
        let uses_own = |name: &str| {
            let mut own = self.imports.iter().filter(|it| it.is_own(&self.prepared.physical));
            own.any(|it| self.plan.resource_name(it.resource) == name)
        };
        self.missing.iter().map(String::as_str).find(|name| uses_own(name))
    }

    /// Migrations of the images and buffers whose contents are carried over, cycle by cycle.
    fn migrations_from(&self, before: &Executor) -> Vec<Migration> {
        let mut migrated = Vec::new();
        for first in persistent(&self.plan) {
            let members: Vec<Resource> = members(&self.plan, first);
            if members.iter().min() == Some(&first) {
                let goes_on: Option<Vec<_>> = members.iter().map(|it| self.goes_on(before, *it)).collect();
                migrated.extend(goes_on.into_iter().flatten());
            }
        }
        migrated
    }

    /// How an image or buffer goes on; `None` if it doesn't.
    fn goes_on(&self, before: &Executor, to: Resource) -> Option<Migration> {
        let (name, role) = (self.plan.resource_name(to), self.plan.role(to));
        // Contents from a file were read anew, and may have changed.
        let Role::Persistent { before: found, initial: FirstContents::Value(_), .. } = role else { return None };
        let from = persistent(&before.plan).find(|it| before.plan.resource_name(*it) == name)?;
        let Role::Persistent { before: left, .. } = before.plan.role(from) else { return None };
        let names = |plan: &Plan, first| -> Vec<String> {
            members(plan, first).into_iter().map(|it| plan.resource_name(it).to_owned()).collect()
        };
        let (next, old, new) = (before.frames.next(), &before.prepared.physical, &self.prepared.physical);
        let fits = match (from, to) {
            (Resource::Image(from), Resource::Image(to)) => {
                // Who reads all of an image can't go on with a part of it.
                let parts = [before.plan.image(from), self.plan.image(to)].map(|image| image.allocated.is_some());
                let (old, new) = (old.image(from, next).descriptor, new.image(to, 0).descriptor);
                parts[0] == parts[1]
                    && old.usage.contains(new.usage)
                    && framewright_graph::device::ImageDescriptor { usage: old.usage, ..new } == old
            }
            (Resource::Buffer(from), Resource::Buffer(to)) => {
                let (old, new) = (old.buffer(from, next), new.buffer(to, 0));
                let sharing = |plan: &Plan, id: BufferId| plan.buffers[id.0 as usize].sharing;
                old.usage.contains(new.usage)
                    && old.bytes == new.bytes
                    && sharing(&before.plan, from) == sharing(&self.plan, to)
            }
            (Resource::Image(_), Resource::Buffer(_)) | (Resource::Buffer(_), Resource::Image(_)) => false,
        };
        // An image or buffer that lies between two queues can't be brought into another state.
        let queue = if next == 0 { initial_queue(&before.plan, &before.uses, from) } else { before.owner(from) };
        let queue = queue.filter(|queue| Some(*queue) == initial_queue(&self.plan, &self.uses, to))?;
        let goes_on = fits && names(&before.plan, from) == names(&self.plan, to);
        goes_on.then_some(Migration { from, to, queue, left: *left, found: *found })
    }

    /// Brings it from the state in which its own next frame would find it to that in which the other one's first does.
    fn record_change(&self, commands: vk::CommandBuffer, migrated: &Migration) {
        let (physical, next) = (&self.prepared.physical, self.frames.next());
        match migrated.from {
            Resource::Image(id) => {
                let image = physical.image(id, next);
                let descriptor = image.descriptor;
                let whole = Subresources::all(descriptor.format, descriptor.mips, descriptor.layers);
                barriers(&self.gpu, commands, &[], &[state_change(image.raw, whole, migrated.left, migrated.found)]);
            }
            Resource::Buffer(_) => {
                barriers(&self.gpu, commands, &[memory_change(migrated.left, migrated.found)], &[]);
            }
        }
    }
}

/// All that persists.
fn persistent(plan: &Plan) -> impl Iterator<Item = Resource> {
    let persists = |role: &Role| matches!(role, Role::Persistent { .. });
    let images = plan.images.iter().filter(move |it| persists(&it.role)).map(|it| Resource::Image(it.id));
    images.chain(plan.buffers.iter().filter(move |it| persists(&it.role)).map(|it| Resource::Buffer(it.id)))
}

/// The images or buffers that become each other, from `first` on.
fn members(plan: &Plan, first: Resource) -> Vec<Resource> {
    match first {
        Resource::Image(ImageId(id)) => {
            cycle(id, |id| &plan.images[id as usize].role).map(|id| Resource::Image(ImageId(id))).collect()
        }
        Resource::Buffer(BufferId(id)) => {
            cycle(id, |id| &plan.buffers[id as usize].role).map(|id| Resource::Buffer(BufferId(id))).collect()
        }
    }
}
