//! History rings: images and buffers that become each other at the end of each frame, and which of them stands for which of
//! the Plan's in a frame.

use super::descriptions::cycle;
use crate::base::Error;
use framewright_graph::plan::{Plan, Resource, Role};

/// The history rings of a Plan. An image or buffer without history is a ring of its own.
pub(crate) struct HistoryRings {
    images: Vec<RingPosition>,
    buffers: Vec<RingPosition>,
    rings: Vec<Vec<u32>>,
}

/// A position in a ring.
#[derive(Clone, Copy)]
struct RingPosition {
    ring: usize,
    at: usize,
}

impl HistoryRings {
    /// The rings of `plan`. What its images and buffers become must be a permutation, as the checker says.
    pub(crate) fn new(plan: &Plan) -> HistoryRings {
        let mut rings = Vec::new();
        let images = ring_positions(plan.images.len(), |id| &plan.images[id as usize].role, &mut rings);
        let buffers = ring_positions(plan.buffers.len(), |id| &plan.buffers[id as usize].role, &mut rings);
        HistoryRings { images, buffers, rings }
    }

    /// The number of the image that stands for the Plan's image `image` in frame `frame`.
    pub(crate) fn image(&self, image: u32, frame: u64) -> usize {
        self.member(self.images[image as usize], frame)
    }

    /// The number of the buffer that stands for the Plan's buffer `buffer` in frame `frame`.
    pub(crate) fn buffer(&self, buffer: u32, frame: u64) -> usize {
        self.member(self.buffers[buffer as usize], frame)
    }

    /// After how many frames the same images and buffers stand for all of these again.
    pub(crate) fn period(&self, resources: impl IntoIterator<Item = Resource>) -> u64 {
        resources.into_iter().fold(1, |period, resource| {
            let place = match resource {
                Resource::Image(image) => self.images[image.0 as usize],
                Resource::Buffer(buffer) => self.buffers[buffer.0 as usize],
            };
            least_common_multiple(period, self.rings[place.ring].len() as u64)
        })
    }

    /// At the end of each frame the members of a ring move one position on.
    fn member(&self, RingPosition { ring, at }: RingPosition, frame: u64) -> usize {
        let members = &self.rings[ring];
        let moved = usize::try_from(frame % members.len() as u64).unwrap_or(0);
        members[(at + members.len() - moved) % members.len()] as usize
    }
}

/// The position of each in its ring.
fn ring_positions<'p>(
    count: usize,
    role: impl Fn(u32) -> &'p Role + Copy,
    rings: &mut Vec<Vec<u32>>,
) -> Vec<RingPosition> {
    let mut positions = vec![None; count];
    for (first, _) in (0_u32..).zip(0..count) {
        if positions[first as usize].is_none() {
            let members: Vec<u32> = cycle(first, role).collect();
            for (at, member) in members.iter().enumerate() {
                positions[*member as usize] = Some(RingPosition { ring: rings.len(), at });
            }
            rings.push(members);
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

/// Objects that are made for the images and buffers of one frame, and used again whenever the same stand for the same.
pub(crate) struct RingCache<T> {
    period: u64,
    made: Vec<Option<T>>,
}

impl<T> RingCache<T> {
    /// Nothing made yet.
    pub(crate) fn new(period: u64) -> RingCache<T> {
        RingCache { period: period.max(1), made: Vec::new() }
    }

    /// The objects for frame `frame`, if they are made.
    pub(crate) fn at(&self, frame: u64) -> Option<&T> {
        self.made.get(self.slot(frame))?.as_ref()
    }

    /// The objects for frame `frame`, which are made unless they are there.
    pub(crate) fn prepare(&mut self, frame: u64, make: impl FnOnce() -> Result<T, Error>) -> Result<&T, Error> {
        let slot = self.slot(frame);
        if self.made.len() <= slot {
            self.made.resize_with(slot + 1, || None);
        }
        let made = &mut self.made[slot];
        Ok(match made {
            Some(made) => made,
            None => made.insert(make()?),
        })
    }

    /// Forgets everything: other images or buffers stand for the Plan's now. Nothing of it may be in use.
    pub(crate) fn forget(&mut self) {
        self.made.clear();
    }

    fn slot(&self, frame: u64) -> usize {
        usize::try_from(frame % self.period).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::plan::Initial;
    use framewright_graph::vulkan::{Accesses, FillValue, Layout, Stages, State};

    fn rings(next: &[Option<u32>]) -> HistoryRings {
        let state = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::General };
        let initial = Initial::Value(FillValue::Bits([0; 4]));
        let role = |(next, own): (&Option<u32>, u32)| Role::Persistent {
            becomes: next.unwrap_or(own),
            initial: initial.clone(),
            before: state,
            after: state,
        };
        let roles: Vec<Role> = next.iter().zip(0..).map(role).collect();
        let mut rings = Vec::new();
        let images = ring_positions(roles.len(), |id| &roles[id as usize], &mut rings);
        HistoryRings { images, buffers: Vec::new(), rings }
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
    fn periods_are_the_least_that_all_rings_share() {
        assert_eq!(least_common_multiple(4, 6), 12);
        assert_eq!(least_common_multiple(1, 3), 3);
    }
}
