//! A tree of boxes around triangles, so that a ray need not try them all.

use super::triangle::Ray;
use glam::DVec3;
use std::ops::Range;

/// Triangles that are tried one by one.
const LEAF: usize = 4;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    fn around(points: impl Iterator<Item = DVec3>) -> Self {
        let nothing = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
        points.fold(nothing, |bounds, point| Self { low: bounds.low.min(point), high: bounds.high.max(point) })
    }

    /// Whether the ray comes through the box before `limit`. Slightly too often rather than too seldom.
    fn is_met(&self, ray: &Ray, limit: f64) -> bool {
        let (mut enter, mut leave) = (0.0_f64, limit);
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            let margin = 1e-9 * (1.0 + self.low[axis].abs().max(self.high[axis].abs()));
            let (low, high) = (self.low[axis] - margin, self.high[axis] + margin);
            if direction == 0.0 {
                if origin < low || origin > high {
                    return false;
                }
            } else {
                let (to_low, to_high) = ((low - origin) / direction, (high - origin) / direction);
                enter = enter.max(to_low.min(to_high));
                leave = leave.min(to_low.max(to_high));
            }
        }
        enter <= leave
    }
}

#[derive(Debug)]
enum Node {
    Leaf(Bounds, Range<usize>),
    Branch(Bounds, Box<[Node; 2]>),
}

/// The tree.
#[derive(Debug)]
pub(super) struct BoundsTree {
    order: Vec<u32>,
    root: Option<Node>,
}

impl BoundsTree {
    /// A tree over `triangles`, known by their place in the slice.
    #[must_use]
    pub(super) fn new(triangles: &[[DVec3; 3]]) -> Self {
        let mut order: Vec<u32> = (0..).take(triangles.len()).collect();
        let root = (!order.is_empty()).then(|| split(triangles, &mut order, 0));
        Self { order, root }
    }

    /// Calls `try_triangle` with every triangle that `ray` may meet before the limit that the last call returned, at first
    /// without limit.
    pub(super) fn walk(&self, ray: &Ray, mut try_triangle: impl FnMut(u32) -> f64) {
        let mut limit = f64::INFINITY;
        let mut waiting: Vec<&Node> = self.root.iter().collect();
        while let Some(node) = waiting.pop() {
            match node {
                Node::Leaf(bounds, range) if bounds.is_met(ray, limit) => {
                    for &triangle in &self.order[range.clone()] {
                        limit = try_triangle(triangle);
                    }
                }
                Node::Branch(bounds, children) if bounds.is_met(ray, limit) => waiting.extend(children.iter()),
                Node::Leaf(..) | Node::Branch(..) => {}
            }
        }
    }
}

/// Halves the triangles of `order` along their longest extent until a leaf's worth is left. `start` is where `order` begins
/// in the whole.
fn split(triangles: &[[DVec3; 3]], order: &mut [u32], start: usize) -> Node {
    let corners = order.iter().flat_map(|&triangle| triangles[triangle as usize]);
    let bounds = Bounds::around(corners);
    if order.len() <= LEAF {
        return Node::Leaf(bounds, start..start + order.len());
    }
    let extent = bounds.high - bounds.low;
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
    let centre = |triangle: u32| triangles[triangle as usize].iter().map(|corner| corner[axis]).sum::<f64>();
    order.sort_by(|&a, &b| centre(a).total_cmp(&centre(b)));
    let middle = order.len() / 2;
    let (low, high) = order.split_at_mut(middle);
    Node::Branch(bounds, Box::new([split(triangles, low, start), split(triangles, high, start + middle)]))
}
