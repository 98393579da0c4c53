//! What tells whether custom passes keep to what they declare: for each step that a program records, the parts of images and the buffers
//! that it must leave as they are, or set.

use super::descriptions::part;
use super::uses::ResourceUses;
use crate::base::Error;
use framewright_graph::base::Place;
use framewright_graph::frame::{Cadence, Draw};
use framewright_graph::plan::{
    Access, BufferAccess, FirstContents, Image, ImageId, Pass, Plan, Queue, Resource, Role, Step, StepId,
};
use framewright_graph::vulkan::{
    Accesses, Aspects, BufferUsage, Format, Layout, Sharing, Subresources, Usage, name_of,
};
use std::collections::HashMap;
use std::sync::atomic::AtomicU32;

/// A step with passes that the program records, and what tells whether they keep to what they declare.
pub(crate) struct WatchedStep {
    pub(crate) step: usize,
    /// Whether it runs in the first frame alone.
    pub(crate) once: bool,
    /// How often it was recorded.
    pub(crate) recorded: AtomicU32,
    /// The passes that the program records, and where the pipeline says so.
    pub(crate) passes: Vec<(String, Option<Place>)>,
    pub(crate) parts: Vec<WatchedPart>,
}

/// A part of an image, or a buffer, whose contents say whether the passes of a step keep to what they declare.
pub(crate) struct WatchedPart {
    pub(crate) resource: Resource,
    /// Of an image: one mip level and one plane of one layer, or of both eyes' layers.
    pub(crate) range: Subresources,
    /// The layout that it is in during the step.
    pub(crate) layout: Layout,
    pub(crate) name: String,
    /// The format of an image.
    pub(crate) format: Option<Format>,
    /// What the step's passes say of it; `None`: they don't name it.
    pub(crate) said: Option<String>,
    pub(crate) promise: PartPromise,
}

/// What the passes of a step promise of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PartPromise {
    /// They don't name it: it is the same after them, and holds garbage meanwhile.
    Unnamed,
    /// They read it: it is the same after them.
    Read,
    /// They set all of it. What it held before is given up.
    Replaced,
}

/// A use that a custom pass declares.
pub(crate) struct DeclaredUse {
    pub(crate) step: usize,
    pub(crate) pass: String,
    pub(crate) at: Option<Place>,
    pub(crate) name: String,
    pub(crate) said: String,
}

/// The uses that custom passes of a Plan declare.
pub(crate) fn declared_uses(plan: &Plan) -> Vec<DeclaredUse> {
    let of_pass = |step: usize, pass: &Pass| {
        let image = |it: &Access| it.declared.then(|| (plan.image(it.image).name.to_string(), of_image(it)));
        let buffer = |it: &BufferAccess| {
            it.declared.then(|| (plan.buffers[it.buffer.0 as usize].name.to_string(), of_buffer(it)))
        };
        let all = pass.accesses.iter().filter_map(image).chain(pass.buffers.iter().filter_map(buffer));
        let declared = |(name, said)| {
            let (pass, at) = (pass.name.to_string(), pass.cause.at().cloned());
            DeclaredUse { step, pass, at, name, said }
        };
        all.map(declared).collect::<Vec<_>>()
    };
    let steps = plan.steps.iter().enumerate();
    steps.flat_map(|(number, step)| step.work.passes().iter().flat_map(move |pass| of_pass(number, pass))).collect()
}

fn of_image(access: &Access) -> String {
    format!("{}, {}, {}", name_of(&access.stages), name_of(&access.accesses), name_of(&access.layout))
}

fn of_buffer(access: &BufferAccess) -> String {
    format!("{}, {}", name_of(&access.stages), name_of(&access.accesses))
}

/// Every step of a Plan that a program records. `family`: the number of a queue's family, which has one queue.
///
/// # Errors
/// [`Error::BadPlan`] if something that lives within the frame can't be copied.
pub(crate) fn watch_list(plan: &Plan, family: &dyn Fn(Queue) -> u32) -> Result<Vec<WatchedStep>, Error> {
    let uses = Uses { spans: ResourceUses::new(plan), families: users(plan, family), family };
    let mut states = Contents::new(plan);
    let mut list = Vec::new();
    for (number, step) in plan.steps.iter().enumerate() {
        states.begin(plan, step);
        let is_custom = |pass: &&Pass| step.work.is_custom() || pass.draw.is_some_and(Draw::is_custom);
        let passes = step.work.passes().iter().filter(is_custom);
        let passes: Vec<_> = passes.map(|pass| (pass.name.to_string(), pass.cause.at().cloned())).collect();
        if !passes.is_empty() {
            let parts = watched_parts(plan, &uses, &states, (number, step));
            let (once, recorded) = (step.run == Cadence::Once, AtomicU32::new(0));
            list.push(WatchedStep { step: number, once, recorded, passes, parts });
        }
        states.end(step);
    }
    let unreadable = list.iter().flat_map(|step| &step.parts).find(|part| !is_readable(plan, part.resource));
    match unreadable {
        None => Ok(list),
        Some(part) => {
            Err(Error::BadPlan { what: format!("`{}` can't be watched: compile the Plan with `readable`", part.name) })
        }
    }
}

/// The uses of a Plan's images and buffers.
struct Uses<'f> {
    spans: ResourceUses,
    /// The queue families that use each.
    families: HashMap<Resource, Vec<u32>>,
    family: &'f dyn Fn(Queue) -> u32,
}

impl Uses<'_> {
    /// Whether no other queue than a step's own uses it in any frame: such a step may change it for a while.
    fn is_alone(&self, resource: Resource, step: &Step) -> bool {
        let own = (self.family)(step.queue);
        self.families.get(&resource).is_none_or(|families| families.iter().all(|family| *family == own))
    }
}

fn users(plan: &Plan, family: &dyn Fn(Queue) -> u32) -> HashMap<Resource, Vec<u32>> {
    let mut users: HashMap<Resource, Vec<u32>> = HashMap::new();
    for step in &plan.steps {
        for resource in step.touched() {
            let families = users.entry(resource).or_default();
            if !families.contains(&family(step.queue)) {
                families.push(family(step.queue));
            }
        }
    }
    users
}

/// Whether an image or buffer can be copied from. What outlives the frame always can.
fn is_readable(plan: &Plan, resource: Resource) -> bool {
    let readable = match resource {
        Resource::Image(image) => plan.image(image).usage.contains(Usage::TRANSFER_SRC),
        Resource::Buffer(buffer) => plan.buffers[buffer.0 as usize].usage.contains(BufferUsage::TRANSFER_SRC),
    };
    readable || plan.role(resource).placement().is_none()
}

/// Where the Plan's images are, while its steps are walked.
struct Contents {
    /// By image, then by part: its layout.
    layouts: Vec<HashMap<PartKey, Layout>>,
    /// By image: the queue that has it, if that is known.
    owners: Vec<Option<Queue>>,
}

/// Plane, mip level and layer.
type PartKey = (Aspects, u32, u32);

/// The parts of an image, one by one, that a range has.
fn parts_of(image: &Image, range: Subresources) -> impl Iterator<Item = (PartKey, Subresources)> {
    let range = part(image, range);
    let planes = [Aspects::COLOR, Aspects::DEPTH, Aspects::STENCIL];
    let aspects = if range.aspects.is_empty() { image.format.aspects() } else { range.aspects };
    // Both eyes' layers are one part.
    let (count, layers) = if image.eyes.is_some() { (1, range.layers) } else { (range.layers, 1) };
    planes.into_iter().filter(move |plane| aspects.contains(*plane)).flat_map(move |plane| {
        (range.base_mip..range.base_mip + range.mips).flat_map(move |mip| {
            (range.base_layer..range.base_layer + count).map(move |layer| {
                let one = Subresources { aspects: plane, base_mip: mip, mips: 1, base_layer: layer, layers };
                ((plane, mip, layer), one)
            })
        })
    })
}

impl Contents {
    fn new(plan: &Plan) -> Contents {
        let before = |image: &Image| image.role.states().map_or(Layout::Undefined, |[before, _]| before.layout);
        let layouts = plan.images.iter().map(|image| {
            parts_of(image, Subresources::WHOLE).map(|(key, _)| (key, before(image))).collect::<HashMap<_, _>>()
        });
        Contents { layouts: layouts.collect(), owners: vec![None; plan.images.len()] }
    }

    /// Goes on to where a step's barriers are done.
    fn begin(&mut self, plan: &Plan, step: &Step) {
        for barrier in &step.image_barriers {
            let image = barrier.image.0 as usize;
            for (key, _) in parts_of(plan.image(barrier.image), barrier.range) {
                self.layouts[image].insert(key, barrier.new_layout);
            }
            self.owners[image] = Some(step.queue);
        }
        for (resource, _) in step.work.used() {
            if let Resource::Image(ImageId(image)) = resource {
                self.owners[image as usize] = Some(step.queue);
            }
        }
    }

    /// Goes on to where a step's images are handed over.
    fn end(&mut self, step: &Step) {
        step.releases.iter().for_each(|barrier| self.owners[barrier.image.0 as usize] = None);
    }
}

/// What tells whether the passes of a step keep to what they declare, of all that can be copied. To look at an image changes its layout,
/// and to look for what isn't named fills it with garbage: neither may be where another queue may use it meanwhile.
fn watched_parts(plan: &Plan, uses: &Uses<'_>, states: &Contents, (number, step): (usize, &Step)) -> Vec<WatchedPart> {
    let mut parts = Vec::new();
    for image in &plan.images {
        let resource = Resource::Image(image.id);
        let owns =
            states.owners[image.id.0 as usize].is_some_and(|queue| (uses.family)(queue) == (uses.family)(step.queue));
        let here = uses.is_alone(resource, step) || image.sharing == Sharing::Exclusive && owns;
        // What a pass sets all of no other queue uses meanwhile.
        let may_look = |promise: &PartPromise| here || *promise == PartPromise::Replaced;
        let copied = image.samples == 1 && !image.usage.contains(Usage::TRANSIENT_ATTACHMENT);
        if !copied {
            continue;
        }
        let accesses = || step.work.passes().iter().flat_map(|pass| &pass.accesses).filter(|it| it.image == image.id);
        let is_in = |key: PartKey, range| parts_of(image, range).any(|(part, _)| part == key);
        for (key, range) in parts_of(image, Subresources::WHOLE) {
            let layout = states.layouts[image.id.0 as usize].get(&key).copied().unwrap_or(Layout::Undefined);
            // The scope's attachments are the scope's own: what it doesn't store is lost.
            let mut attached = step.work.attachments().flat_map(|it| {
                let resolved = it.resolve.as_ref().map(|resolve| (resolve.image, resolve.range));
                std::iter::once((it.image, it.range)).chain(resolved)
            });
            if layout == Layout::Undefined || attached.any(|(of, range)| of == image.id && is_in(key, range)) {
                continue;
            }
            let named = accesses().filter(|it| is_in(key, it.range));
            let named: Vec<_> = named.map(|access| (access.accesses, of_image(access))).collect();
            let mut given_up = step.image_barriers.iter().filter(|it| it.image == image.id);
            let gives_up = given_up.any(|it| it.old_layout == Layout::Undefined && is_in(key, it.range))
                || begins(plan, resource, number);
            let lives = lives(plan, &uses.spans, resource, number) && !(named.is_empty() && is_file(&image.role));
            if let Some(promise) = promise(&named, gives_up, lives).filter(may_look) {
                let (name, said) = (image.name.to_string(), said(named));
                parts.push(WatchedPart { resource, range, layout, name, format: Some(image.format), said, promise });
            }
        }
    }
    for buffer in &plan.buffers {
        let (resource, name) = (Resource::Buffer(buffer.id), buffer.name.to_string());
        let accesses = step.work.passes().iter().flat_map(|pass| &pass.buffers).filter(|it| it.buffer == buffer.id);
        let named: Vec<_> = accesses.map(|access| (access.accesses, of_buffer(access))).collect();
        let (range, layout) = (Subresources::WHOLE, Layout::Undefined);
        let gives_up = begins(plan, resource, number);
        let lives = lives(plan, &uses.spans, resource, number) && (!named.is_empty() || uses.is_alone(resource, step));
        if let Some(promise) = promise(&named, gives_up, lives) {
            let said = said(named);
            parts.push(WatchedPart { resource, range, layout, name, format: None, said, promise });
        }
    }
    parts
}

/// What passes promise that access a part so, each with its words. `gives_up`: whether what it held before isn't there any more; `lives`:
/// whether it holds something.
fn promise(named: &[(Accesses, String)], gives_up: bool, lives: bool) -> Option<PartPromise> {
    let writes = named.iter().any(|(accesses, _)| !accesses.writes().is_empty());
    let reads = named.iter().any(|(accesses, _)| *accesses != accesses.writes());
    match (named.is_empty(), writes) {
        (true, _) => lives.then_some(PartPromise::Unnamed),
        (false, false) => lives.then_some(PartPromise::Read),
        (false, true) => (gives_up && !reads).then_some(PartPromise::Replaced),
    }
}

fn said(named: Vec<(Accesses, String)>) -> Option<String> {
    let said: Vec<_> = named.into_iter().map(|(_, said)| said).collect();
    (!said.is_empty()).then(|| said.join("; "))
}

/// Whether what lives within the frame is first used by a step.
fn begins(plan: &Plan, resource: Resource, step: usize) -> bool {
    plan.role(resource).placement().is_some_and(|place| place.lifetime[0].0 as usize == step)
}

/// Whether its contents come from a file: there are many of those, and no step writes them.
fn is_file(role: &Role) -> bool {
    matches!(role, Role::Persistent { initial: FirstContents::File(_), .. })
}

/// Whether an image or buffer holds something before a step that may be asked for after it.
fn lives(plan: &Plan, uses: &ResourceUses, resource: Resource, step: usize) -> bool {
    let after = |id: StepId| (id.0 as usize) < step;
    match plan.role(resource) {
        Role::Transient(place) => after(place.lifetime[0]) && place.lifetime[1].0 as usize >= step,
        Role::Persistent { .. } => true,
        // Outside of these steps it may belong to somebody else.
        Role::External { .. } => {
            uses.of(resource).is_some_and(|span| span.first.0 as usize <= step && span.last.0 as usize >= step)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::base::Span;
    use framewright_graph::compile::{Options, Order, compile};
    use framewright_graph::device::{MemoryEstimate, Profile, Queues};
    use framewright_graph::frame::{
        Blend, Buffer, BufferIndex, DeclaredUse, Frame, Lifetime, Resource as Described, TransferUse, Work,
    };
    use framewright_graph::vulkan::{FillValue, Stages, State};
    use framewright_tests::frames::{Builder, device};

    /// A pass `own`, which any queue may run, copies `seed` to `list`. Meanwhile the image `large` and the buffer `other` live, which no pass
    /// on another queue than that for graphics uses.
    fn frame() -> Frame {
        let mut builder = Builder::default();
        let [large, shown] = ["large", "shown"].map(|name| builder.image(name, Format::R8G8B8A8_UNORM, 64, 1));
        let names = ["seed", "list", "other", "last", "more"];
        builder.0.buffers = names
            .map(|name| Buffer { name: name.into(), span: Span::NONE, bytes: 32, lifetime: Lifetime::Transient })
            .into();
        let side = |buffer: u32, write| TransferUse {
            resource: Described::Buffer(BufferIndex(buffer)),
            range: Subresources::WHOLE,
            frames_ago: 0,
            span: Span::NONE,
            write,
            keeps: false,
        };
        let fill = || Work::Fill { value: FillValue::Bits([4, 0, 0, 0]) };
        builder.pass("first", fill()).0.transfers = vec![side(0, true)];
        builder.pass("second", fill()).0.transfers = vec![side(2, true)];
        builder.full_screen("draw").clear(large);
        let own = builder.pass("own", Work::Custom { callback: "own".into() }).0;
        own.transfers = vec![side(0, false), side(1, true)];
        let use_of = |buffer: u32, accesses| {
            let state = State { stages: Stages::COPY, accesses, layout: Layout::Undefined };
            DeclaredUse::new(Described::Buffer(BufferIndex(buffer)), state)
        };
        own.uses = vec![use_of(0, Accesses::TRANSFER_READ), use_of(1, Accesses::TRANSFER_WRITE)];
        own.any_queue = true;
        builder.full_screen("show").sample(large).color(shown, Blend::Replace);
        builder.pass("take", Work::Copy).0.transfers = vec![side(1, false), side(3, true)];
        builder.pass("take more", Work::Copy).0.transfers = vec![side(2, false), side(4, true)];
        let mut frame = builder.outputs(&[shown]);
        frame.outputs.extend([3, 4].map(|buffer| Described::Buffer(BufferIndex(buffer)).into()));
        frame
    }

    /// DO-8: what a queue may use meanwhile no other one fills with garbage, nor changes its layout.
    #[test]
    fn do_8_what_another_queue_uses_is_left_alone() {
        for sharing in [Sharing::Concurrent, Sharing::Exclusive] {
            let queues = Queues { compute: true, transfer: false, sharing, wait_bytes: 0 };
            let device = Profile { queues, ..device() };
            let options = Options { readable: true, order: Order::File, ..Options::default() };
            let plan = compile(&frame(), &device, &mut MemoryEstimate(&device), &options);
            let plan = plan.unwrap_or_else(|errors| panic!("{errors:?}"));
            let watched = |family: &dyn Fn(Queue) -> u32| {
                let list = watch_list(&plan, family).expect("it can be read");
                assert_eq!(list.len(), 1, "{}", plan.tree());
                assert_eq!(plan.steps[list[0].step].queue, Queue::Compute, "{}", plan.tree());
                let parts = list[0].parts.iter().map(|part| (part.name.clone(), part.promise));
                parts.collect::<Vec<_>>()
            };
            let named = [("seed".to_owned(), PartPromise::Read), ("list".to_owned(), PartPromise::Replaced)];
            assert_eq!(watched(&|queue| queue as u32), named, "{sharing:?}");
            let of_one = watched(&|_| 0);
            for name in ["large", "other"] {
                assert!(of_one.contains(&(name.to_owned(), PartPromise::Unnamed)), "{sharing:?}: {of_one:?}");
            }
        }
    }
}
