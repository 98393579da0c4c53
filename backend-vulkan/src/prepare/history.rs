//! History rings: images and buffers that become each other at the end of each frame, and which of them stands for which of
//! the Plan's in a frame.

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
    /// The rings of `plan`.
    pub(crate) fn new(plan: &Plan) -> Result<HistoryRings, Error> {
        let mut rings = Vec::new();
        let images = ring_positions(&plan.images.iter().map(|it| next(&it.role)).collect::<Vec<_>>(), &mut rings)?;
        let buffers = ring_positions(&plan.buffers.iter().map(|it| next(&it.role)).collect::<Vec<_>>(), &mut rings)?;
        Ok(HistoryRings { images, buffers, rings })
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

/// What an image or buffer becomes; `None` is itself.
fn next(role: &Role) -> Option<u32> {
    match role {
        Role::Persistent { becomes, .. } => Some(*becomes),
        Role::Transient(_) | Role::External { .. } => None,
    }
}

/// The position of each in its ring.
fn ring_positions(next: &[Option<u32>], rings: &mut Vec<Vec<u32>>) -> Result<Vec<RingPosition>, Error> {
    let bad = || Error::BadPlan { what: "what images or buffers become is no permutation".to_owned() };
    let mut ring_positions: Vec<Option<RingPosition>> = vec![None; next.len()];
    for (first, _) in (0_u32..).zip(next) {
        if ring_positions[first as usize].is_some() {
            continue;
        }
        let (mut members, mut member) = (Vec::new(), first);
        loop {
            let place = ring_positions.get_mut(member as usize).ok_or_else(bad)?;
            if place.is_some() {
                // Back at the beginning, or in the middle of something.
                if member == first { break } else { return Err(bad()) }
            }
            *place = Some(RingPosition { ring: rings.len(), at: members.len() });
            members.push(member);
            member = next[member as usize].unwrap_or(member);
        }
        rings.push(members);
    }
    ring_positions.into_iter().map(|place| place.ok_or_else(bad)).collect()
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

    /// What was made for frame `frame`.
    pub(crate) fn at(&self, frame: u64) -> Option<&T> {
        self.made.get(self.slot(frame))?.as_ref()
    }

    /// What frame `frame` needs, which is made unless it is there.
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

    fn rings(next: &[Option<u32>]) -> Result<HistoryRings, Error> {
        let mut rings = Vec::new();
        let images = ring_positions(next, &mut rings)?;
        Ok(HistoryRings { images, buffers: Vec::new(), rings })
    }

    #[test]
    fn what_stood_for_an_image_stands_for_what_it_becomes_in_the_next_frame() {
        let next = [Some(2), None, Some(3), Some(0)];
        let rings = rings(&next).expect("a permutation");
        for frame in 0..7 {
            for (image, next) in (0_u32..).zip(next) {
                let now = rings.image(image, frame);
                assert_eq!(rings.image(next.unwrap_or(image), frame + 1), now, "image {image}, frame {frame}");
            }
        }
        assert_eq!([0, 1, 2, 3].map(|image| rings.image(image, 3)), [0, 1, 2, 3]);
    }

    #[test]
    fn two_that_become_the_same_are_refused() {
        assert!(rings(&[Some(1), Some(1)]).is_err());
        assert!(rings(&[Some(2)]).is_err());
    }

    #[test]
    fn periods_are_the_least_that_all_rings_share() {
        assert_eq!(least_common_multiple(4, 6), 12);
        assert_eq!(least_common_multiple(1, 3), 3);
    }
}
