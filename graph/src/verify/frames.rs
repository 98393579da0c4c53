//! How many frames are walked, and which history image becomes which in the next one.

use super::findings::Findings;
use crate::plan::{Buffer, Image, Plan, Role};

/// The number of frames that are walked, and the images and buffers that become each other between them.
#[derive(Debug)]
pub(super) struct Frames {
    pub(super) count: u32,
    /// Rings of images and buffers: each frame every member takes the next one's place, and the last the first one's.
    pub(super) circles: Vec<Vec<u32>>,
}

/// Most images or buffers that become each other: history is followed as deep as that, less one.
const LONGEST_CIRCLE: usize = 33;

/// Finds the images and buffers that become each other; `None` after a report if this is no permutation of alike ones.
pub(super) fn circles(plan: &Plan, found: &mut Findings) -> Option<Frames> {
    let before = found.violations.len();
    let mut circles = Vec::new();
    let images: Vec<&Role> = plan.images.iter().map(|image| &image.role).collect();
    let buffers: Vec<&Role> = plan.buffers.iter().map(|buffer| &buffer.role).collect();
    for (roles, offset) in [(&images, 0), (&buffers, images.len() as u32)] {
        let next = |index: u32| match roles[index as usize] {
            Role::Persistent { becomes, .. } => Some(*becomes),
            _ => None,
        };
        let mut reached = vec![false; roles.len()];
        for index in 0..roles.len() as u32 {
            let Some(becomes) = next(index) else { continue };
            if std::mem::replace(&mut reached[becomes as usize], true) {
                found.structure(None, Some(offset + becomes), "is what two others become in the next frame");
            }
            if next(becomes).is_none() {
                let what = "is what something persistent becomes in the next frame, and not persistent itself";
                found.structure(None, Some(offset + becomes), what);
            }
        }
        if found.violations.len() > before {
            continue;
        }
        let mut placed = vec![false; roles.len()];
        for index in 0..roles.len() as u32 {
            let mut circle = Vec::new();
            let mut at = Some(index);
            while let Some(member) = at.filter(|member| !placed[*member as usize] && next(*member).is_some()) {
                placed[member as usize] = true;
                circle.push(offset + member);
                at = next(member);
            }
            if circle.len() > LONGEST_CIRCLE {
                let what = format!("is one of {} that become each other, at most {LONGEST_CIRCLE} can", circle.len());
                found.structure(None, Some(offset + index), what);
            }
            if circle.len() > 1 {
                circles.push(circle);
            }
        }
    }
    check_alike(plan, found);
    let longest = circles.iter().map(Vec::len).max().unwrap_or(1);
    (found.violations.len() == before).then_some(Frames { count: longest as u32 + 1, circles })
}

/// An image or buffer must be like the one that it becomes, and leave the frame in the state in which the next finds that one.
fn check_alike(plan: &Plan, found: &mut Findings) {
    for (image, index) in plan.images.iter().zip(0..) {
        if let Role::Persistent { becomes, .. } = image.role {
            let other = &plan.images[becomes as usize];
            let of = |image: &Image| {
                let extent = (
                    image.format,
                    image.shape,
                    (image.extent, image.allocated, image.rotation),
                    image.mips,
                    image.layers,
                    image.samples,
                    image.eyes,
                );
                (extent, image.usage, image.sharing)
            };
            check_pair(found, index, of(image) == of(other), [&image.role, &other.role]);
        }
    }
    for (buffer, index) in plan.buffers.iter().zip(plan.images.len() as u32..) {
        if let Role::Persistent { becomes, .. } = buffer.role {
            let other = &plan.buffers[becomes as usize];
            let of = |buffer: &Buffer| (buffer.bytes, buffer.usage, buffer.sharing);
            check_pair(found, index, of(buffer) == of(other), [&buffer.role, &other.role]);
        }
    }
}

fn check_pair(found: &mut Findings, index: u32, alike: bool, roles: [&Role; 2]) {
    if let [Role::Persistent { initial: one, after, .. }, Role::Persistent { initial: other, before, .. }] = roles {
        if !alike || one != other {
            found.structure(None, Some(index), "becomes something of another kind in the next frame");
        }
        if after != before {
            found.structure(None, Some(index), "is left in another state than the next frame finds what it becomes in");
        }
    }
}
