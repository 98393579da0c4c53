//! Rings: the images and buffers that stand for one of the Plan's, one in each frame.
//!
//! History moves round from frame to frame. If the program handed in several images for one, it chooses among them. What a ring holds
//! at the start of a frame stands in `docs/architecture.md`.

use super::descriptions::cycle;
use crate::base::Error;
use framewright_graph::plan::{Plan, Resource, Role};

/// The rings of a Plan's images and buffers. What neither has history nor is handed in is a ring of its own.
#[derive(Default)]
pub(crate) struct ResourceRings {
    images: Vec<RingPosition>,
    buffers: Vec<RingPosition>,
    rings: Vec<Ring>,
}

/// A position in a ring.
#[derive(Clone, Copy)]
struct RingPosition {
    ring: usize,
    at: usize,
}

/// Images or buffers by their numbers. One of them stands for the Plan's.
struct Ring {
    members: Vec<usize>,
    turns: RingKind,
}

/// How a ring turns.
#[derive(Clone, Copy)]
enum RingKind {
    /// By one position after each frame.
    EachFrame,
    /// The program chooses `now` among the first `count` members; those after them are left from when it handed in more.
    Chosen { now: usize, count: usize },
}

/// A frame, and what stands for the Plan's images and buffers in it.
#[derive(Clone, Copy)]
pub(crate) struct Turn<'r> {
    frame: u64,
    rings: &'r ResourceRings,
}

/// When the same images and buffers stand for some of the Plan's again.
#[derive(Clone)]
pub(crate) struct Period {
    /// After how many frames, at least one.
    frames: u64,
    /// If the program also chooses the same in these rings.
    chosen: Vec<usize>,
}

impl ResourceRings {
    /// The rings of `plan`. What its images and buffers become must be a permutation, as the checker says.
    pub(crate) fn new(plan: &Plan) -> ResourceRings {
        let mut rings = Vec::new();
        let images = ring_positions(plan.images.len(), |id| &plan.images[id as usize].role, &mut rings);
        let buffers = ring_positions(plan.buffers.len(), |id| &plan.buffers[id as usize].role, &mut rings);
        ResourceRings { images, buffers, rings }
    }

    /// The number of the image that stands for the Plan's image `image` in frame `frame`.
    pub(crate) fn image(&self, image: u32, frame: u64) -> usize {
        self.member(self.images[image as usize], frame)
    }

    /// The number of the buffer that stands for the Plan's buffer `buffer` in frame `frame`.
    pub(crate) fn buffer(&self, buffer: u32, frame: u64) -> usize {
        self.member(self.buffers[buffer as usize], frame)
    }

    /// Frame `frame` as the rings stand now.
    pub(crate) fn turn(&self, frame: u64) -> Turn<'_> {
        Turn { frame, rings: self }
    }

    /// When the same images and buffers stand for all of these again.
    pub(crate) fn period(&self, resources: impl IntoIterator<Item = Resource>) -> Period {
        let mut period = Period::every(1);
        for number in resources.into_iter().map(|resource| self.position(resource).ring) {
            let ring = &self.rings[number];
            match ring.turns {
                RingKind::EachFrame => {
                    period.frames = least_common_multiple(period.frames, ring.members.len() as u64);
                }
                RingKind::Chosen { .. } if !period.chosen.contains(&number) => period.chosen.push(number),
                RingKind::Chosen { .. } => {}
            }
        }
        period
    }

    /// The numbers of all images or buffers that can stand for an external one.
    pub(crate) fn members(&self, resource: Resource) -> &[usize] {
        &self.rings[self.position(resource).ring].members
    }

    /// Lets the first `count` of these stand for an external image or buffer, at least one. The first is chosen. All that was made
    /// for others must be forgotten.
    pub(crate) fn set_members(&mut self, resource: Resource, members: Vec<usize>, count: usize) {
        let ring = self.position(resource).ring;
        self.rings[ring] = Ring { members, turns: RingKind::Chosen { now: 0, count } };
    }

    /// Whether an external image or buffer has a member of this number to choose.
    pub(crate) fn has_choice(&self, resource: Resource, choice: usize) -> bool {
        let ring = self.position(resource).ring;
        matches!(self.rings[ring].turns, RingKind::Chosen { count, .. } if choice < count)
    }

    /// Chooses the member of this number for an external image or buffer, if it has one.
    pub(crate) fn choose(&mut self, resource: Resource, choice: usize) {
        let ring = self.position(resource).ring;
        match &mut self.rings[ring].turns {
            RingKind::Chosen { now, count } if choice < *count => *now = choice,
            _ => {}
        }
    }

    /// The number that is chosen for an external image or buffer.
    pub(crate) fn choice(&self, resource: Resource) -> usize {
        match self.rings[self.position(resource).ring].turns {
            RingKind::Chosen { now, .. } => now,
            RingKind::EachFrame => 0,
        }
    }

    fn position(&self, resource: Resource) -> RingPosition {
        match resource {
            Resource::Image(image) => self.images[image.0 as usize],
            Resource::Buffer(buffer) => self.buffers[buffer.0 as usize],
        }
    }

    fn member(&self, RingPosition { ring, at }: RingPosition, frame: u64) -> usize {
        let Ring { members, turns } = &self.rings[ring];
        match turns {
            RingKind::EachFrame => {
                let moved = usize::try_from(frame % members.len() as u64).unwrap_or(0);
                members[(at + members.len() - moved) % members.len()]
            }
            RingKind::Chosen { now, .. } => members[*now],
        }
    }
}

/// The position of each in its ring.
fn ring_positions<'p>(count: usize, role: impl Fn(u32) -> &'p Role + Copy, rings: &mut Vec<Ring>) -> Vec<RingPosition> {
    let mut positions = vec![None; count];
    for (first, _) in (0_u32..).zip(0..count) {
        if positions[first as usize].is_none() {
            let members: Vec<usize> = cycle(first, role).map(|member| member as usize).collect();
            for (at, member) in members.iter().enumerate() {
                positions[*member] = Some(RingPosition { ring: rings.len(), at });
            }
            let external = matches!(role(first), Role::External { .. });
            rings.push(Ring {
                members,
                turns: if external { RingKind::Chosen { now: 0, count: 1 } } else { RingKind::EachFrame },
            });
        }
    }
    positions.into_iter().flatten().collect()
}

fn least_common_multiple(a: u64, b: u64) -> u64 {
    let (mut divisor, mut rest) = (a.max(1), b.max(1));
    while rest != 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    (a / divisor).saturating_mul(b)
}

impl Period {
    /// After so many frames.
    pub(super) fn every(frames: u64) -> Period {
        Period { frames, chosen: Vec::new() }
    }

    /// When, beside what it says, this many frames have passed as well.
    pub(super) fn and_every(self, frames: u64) -> Period {
        Period { frames: least_common_multiple(self.frames, frames), ..self }
    }

    /// After how many frames, at least one.
    pub(crate) fn frames(&self) -> u64 {
        self.frames
    }

    /// Whether it depends on a choice of the program's.
    pub(crate) fn is_chosen(&self) -> bool {
        !self.chosen.is_empty()
    }

    /// The place of a turn's frame in the period.
    fn place(&self, turn: Turn<'_>) -> usize {
        usize::try_from(turn.frame % self.frames()).unwrap_or(0)
    }

    /// What the program chooses in a turn, ring by ring.
    fn choices<'t>(&'t self, turn: Turn<'t>) -> impl Iterator<Item = usize> + 't {
        self.chosen.iter().map(move |ring| match turn.rings.rings[*ring].turns {
            RingKind::Chosen { now, .. } => now,
            RingKind::EachFrame => 0,
        })
    }
}

/// Objects that are made for the images and buffers of one frame, and used again whenever the same stand for the same.
pub(crate) struct RingCache<T> {
    period: Period,
    /// By the place in the period: the choices that there were, and what is made for each.
    made: Vec<Vec<(Box<[usize]>, T)>>,
}

impl<T> RingCache<T> {
    /// Nothing made yet.
    pub(crate) fn new(period: Period) -> RingCache<T> {
        RingCache { period, made: Vec::new() }
    }

    /// The objects for a turn, if they are made.
    pub(crate) fn at(&self, turn: Turn<'_>) -> Option<&T> {
        let made = self.made.get(self.period.place(turn))?;
        // Recording asks for each step, and nearly no step depends on a choice.
        if !self.period.is_chosen() {
            return made.first().map(|(_, made)| made);
        }
        made.iter().find(|(choices, _)| self.is_of(choices, turn)).map(|(_, made)| made)
    }

    /// The objects for a turn, which are made unless they are there.
    pub(crate) fn prepare(&mut self, turn: Turn<'_>, make: impl FnOnce() -> Result<T, Error>) -> Result<&T, Error> {
        let place = self.period.place(turn);
        if self.made.len() <= place {
            self.made.resize_with(place + 1, Vec::new);
        }
        let found = self.made[place].iter().position(|(choices, _)| self.is_of(choices, turn));
        let at = found.unwrap_or(self.made[place].len());
        if found.is_none() {
            let made = make()?;
            self.made[place].push((self.period.choices(turn).collect(), made));
        }
        Ok(&self.made[place][at].1)
    }

    /// Whether the program chooses so in this turn.
    fn is_of(&self, choices: &[usize], turn: Turn<'_>) -> bool {
        self.period.choices(turn).eq(choices.iter().copied())
    }

    /// Forgets everything: other images or buffers stand for the Plan's now. Nothing of it may be in use.
    pub(crate) fn forget(&mut self) {
        self.made.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::plan::{FirstContents, ImageId};
    use framewright_graph::vulkan::{Accesses, FillValue, Layout, Stages, State};

    fn rings(next: &[Option<u32>]) -> ResourceRings {
        let state = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::General };
        let initial = FirstContents::Value(FillValue::Bits([0; 4]));
        let role = |(next, own): (&Option<u32>, u32)| Role::Persistent {
            becomes: next.unwrap_or(own),
            initial: initial.clone(),
            before: state,
            after: state,
        };
        let roles: Vec<Role> = next.iter().zip(0..).map(role).collect();
        let mut rings = Vec::new();
        let images = ring_positions(roles.len(), |id| &roles[id as usize], &mut rings);
        ResourceRings { images, buffers: Vec::new(), rings }
    }

    #[test]
    fn what_stood_for_an_image_stands_for_what_it_becomes_in_the_next_frame() {
        let next = [Some(2), None, Some(3), Some(0)];
        let rings = rings(&next);
        for frame in 0..7 {
            for (image, next) in (0_u32..).zip(next) {
                let now = rings.image(image, frame);
                assert_eq!(rings.image(next.unwrap_or(image), frame + 1), now, "image {image}, frame {frame}");
            }
        }
        assert_eq!([0, 1, 2, 3].map(|image| rings.image(image, 3)), [0, 1, 2, 3]);
    }

    #[test]
    fn of_several_that_were_handed_in_the_chosen_one_stands_and_objects_are_kept_for_each() {
        let mut rings = rings(&[Some(1), Some(0), None]);
        let handed_in = Resource::Image(ImageId(2));
        rings.set_members(handed_in, vec![2, 3, 4, 5], 3);
        let mut cache = RingCache::new(rings.period([0, 2, 2].map(|image| Resource::Image(ImageId(image)))));
        let mut made = 0;
        for frame in 0..12 {
            let choice = [1, 0, 2, 2, 1, 0, 0, 1, 2, 1, 0, 2][frame];
            assert!(rings.has_choice(handed_in, choice));
            rings.choose(handed_in, choice);
            assert_eq!(rings.image(2, frame as u64), 2 + choice);
            let turn = rings.turn(frame as u64);
            let make = || {
                made += 1;
                Ok((frame % 2, choice))
            };
            assert_eq!(*cache.prepare(turn, make).expect("nothing fails"), (frame % 2, choice), "frame {frame}");
        }
        assert_eq!(made, 6, "two of history, each with three choices");
        assert!(!rings.has_choice(handed_in, 3) && !rings.has_choice(Resource::Image(ImageId(0)), 0));
    }

    /// A table of all combinations would have 3^20 places.
    #[test]
    fn do_11_objects_are_kept_for_the_choices_that_there_were_alone() {
        let mut rings = rings(&[None; 20]);
        let all: Vec<_> = (0..20).map(|image| Resource::Image(ImageId(image))).collect();
        for (number, resource) in all.iter().enumerate() {
            rings.set_members(*resource, (3 * number..3 * number + 3).collect(), 3);
        }
        let mut cache = RingCache::new(rings.period(all.iter().copied()));
        let mut made = 0;
        for frame in 0..9 {
            all.iter().for_each(|resource| rings.choose(*resource, frame % 3));
            let turn = rings.turn(frame as u64);
            let make = || {
                made += 1;
                Ok(frame % 3)
            };
            assert_eq!(*cache.prepare(turn, make).expect("nothing fails"), frame % 3);
        }
        rings.choose(all[7], 0);
        assert!(cache.at(rings.turn(9)).is_none(), "all but one are as they were in turn 2");
        assert_eq!(made, 3);
    }

    #[test]
    fn periods_are_the_least_that_all_rings_share() {
        assert_eq!(least_common_multiple(4, 6), 12);
        assert_eq!(least_common_multiple(1, 3), 3);
    }
}
