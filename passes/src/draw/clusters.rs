//! Clustered shading: lists of the point lights that reach each part of a camera's frustum (O. Olsson, M. Billeter, U. Assarsson,
//! "Clustered Deferred and Forward Shading", High Performance Graphics 2012).
//!
//! The frustum is cut into tiles of the picture and into slices by distance, each a fixed factor longer than the one before.
//! A fragment finds its cluster by its place in the world, so the size of the image doesn't matter, and reads the lights of
//! that list alone. The formula gives exactly 0 at a light's range, so the sum is that of all lights, bit by bit. Lights
//! without a range, and those that reach a great part of all clusters, come before the others and are read by all.
//!
//! Clusters at the borders of the picture reach on without end, as do the nearest and the farthest: every place lies in one.
//!
//! Two eyes share the clusters of the camera between them. An eye that stands farther back than that sees places that the
//! camera doesn't: before its near plane, and behind it. They lie in the nearest slice, those behind in the four tiles at its
//! corners, by whether they are left or right of the camera, and above or below.

use super::block::Block;
use crate::scene::{Camera, PointLight, Scene};
use glam::{DMat3, DMat4, DVec3};

/// Clusters across, down and away from the camera.
const GRID: [usize; 3] = [16, 9, 32];
/// Lights that reach more than this share of the clusters are read by all: their lists would only cost memory.
const MOST_CLUSTERS: f64 = 0.25;
/// The largest ratio of the distances at which the farthest slice begins and the nearest ends.
const DEPTH_RATIO: f64 = 64.0;
/// Shares of a tile or slice by which clusters overlap, to cover the rounding to 32 bits in the shader's look-up.
const OVERLAP: f64 = 1.0 / 256.0;
/// The largest rounding error of a range and its reciprocal.
const RANGE_ROUNDING: f64 = 1e-5;

/// The lists of lights of a camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Clusters {
    /// The scene's lights by their number there. Those that all clusters read come first.
    pub order: Vec<u32>,
    /// The number of lights that all clusters read.
    pub everywhere: u32,
    /// The lights that reach each cluster, as places in `order`, rising; by tile along a row, row and slice.
    lists: Vec<Vec<u32>>,
    to_cluster: DMat4,
    grid: [usize; 3],
    nearest: f64,
    slices_per_doubling: f64,
}

/// The camera's space: x to the right, y down, z ahead.
struct CameraSpace {
    from_world: DMat3,
    /// Distance of the picture in whose units it is 2 wide and 2 high.
    focal: [f64; 2],
}

/// The sphere that a light reaches, in the camera's space.
#[derive(Debug, Clone, Copy)]
struct Ball {
    centre: DVec3,
    squared_radius: f64,
}

impl Ball {
    /// A ball around what of this one lies on the positive side of a plane, given by its unit normal and its distance from
    /// the origin along that; `None` if nothing does.
    fn cut(self, normal: DVec3, distance: f64) -> Option<Ball> {
        let beyond = distance - normal.dot(self.centre);
        if beyond <= 0.0 {
            return Some(self);
        }
        let squared_radius = self.squared_radius - beyond * beyond;
        (squared_radius >= 0.0).then_some(Ball { centre: self.centre + normal * beyond, squared_radius })
    }
}

impl Clusters {
    /// The lists for a camera's picture, of which `aspect` is width over height.
    #[must_use]
    pub fn new(scene: &Scene, camera: &Camera, aspect: f64) -> Clusters {
        let focal = 1.0 / (f64::from(camera.vertical_fov) * 0.5).tan();
        let from_world = DMat3::from_mat4(camera.transform).inverse();
        let from_world = DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)) * from_world;
        let space = CameraSpace { from_world, focal: [focal / aspect, focal] };
        let ranged = scene.point_lights.iter().any(|light| light.range.is_some());
        let grid = if ranged { GRID } else { [1; 3] };
        let farthest = farthest(scene, camera).max(f64::from(camera.near) * 2.0);
        let nearest = f64::from(camera.near).max(farthest / DEPTH_RATIO);
        let mut clusters = Clusters {
            order: Vec::with_capacity(scene.point_lights.len()),
            everywhere: 0,
            lists: vec![Vec::new(); grid.iter().product()],
            to_cluster: space.to_cluster(grid),
            grid,
            nearest,
            slices_per_doubling: grid[2] as f64 / (farthest / nearest).log2(),
        };
        clusters.fill(scene, camera, &space);
        clusters
    }

    /// Puts each light where it belongs.
    fn fill(&mut self, scene: &Scene, camera: &Camera, space: &CameraSpace) {
        let most = (self.lists.len() as f64 * MOST_CLUSTERS) as usize;
        let mut near = Vec::new();
        for (number, light) in (0..).zip(&scene.point_lights) {
            let reached = ball(light, camera, space).map(|ball| self.reached(ball, space));
            match reached {
                Some(reached) if reached.len() <= most => near.push((number, reached)),
                _ => self.order.push(number),
            }
        }
        self.everywhere = self.order.len() as u32;
        for (number, reached) in near {
            let place = self.order.len() as u32;
            self.order.push(number);
            reached.into_iter().for_each(|cluster| self.lists[cluster].push(place));
        }
    }

    /// The clusters that a ball may reach into.
    fn reached(&self, ball: Ball, space: &CameraSpace) -> Vec<usize> {
        let [across, down, slices] = self.grid;
        let mut reached = Vec::new();
        for slice in 0..slices {
            let Some(ball) = self.in_slice(ball, slice) else { continue };
            for row in 0..down {
                let Some(ball) = space.in_tile(ball, 1, row, down) else { continue };
                let columns = (0..across).filter(|column| space.in_tile(ball, 0, *column, across).is_some());
                reached.extend(columns.map(|column| (slice * down + row) * across + column));
            }
        }
        reached
    }

    /// The part of a ball in a slice.
    fn in_slice(&self, ball: Ball, slice: usize) -> Option<Ball> {
        let border = |number: f64| self.nearest * (number / self.slices_per_doubling).exp2();
        let ball = if slice == 0 { Some(ball) } else { ball.cut(DVec3::Z, border(slice as f64 - OVERLAP)) };
        match slice + 1 == self.grid[2] {
            true => ball,
            false => ball?.cut(DVec3::NEG_Z, -border((slice + 1) as f64 + OVERLAP)),
        }
    }

    /// The list that a shader finds for a place, which is given relative to the camera, along the scene's axes. It holds all
    /// lights that reach the place, but for those that all clusters read, and may hold others. Places in `order`.
    #[must_use]
    pub fn at(&self, from_camera: DVec3) -> &[u32] {
        let place = self.to_cluster * from_camera.extend(1.0);
        let [across, down, slices] = self.grid;
        let number = |at: f64, of: usize| at.clamp(0.0, of as f64 - 1.0) as usize;
        let [column, row] = [(place.x, across), (place.y, down)].map(|(at, of)| match place.w > 0.0 {
            true => number(at / place.w, of),
            false => number(if at < 0.5 * of as f64 * place.w { 0.0 } else { of as f64 }, of),
        });
        let slice = number((place.w.max(0.0) / self.nearest).log2() * self.slices_per_doubling, slices);
        &self.lists[(slice * down + row) * across + column]
    }

    /// The block `clusters` of `shaders/include/scene.glsl`.
    pub(super) fn block(&self) -> Vec<u8> {
        let mut block = Block::default();
        block.mat4(self.to_cluster.as_mat4());
        self.grid.into_iter().for_each(|count| block.uint(count as u32));
        block.float(self.nearest.recip() as f32);
        block.float(self.slices_per_doubling as f32);
        let mut first = self.lists.len() as u32 + 1;
        for list in &self.lists {
            block.uint(first);
            first += list.len() as u32;
        }
        block.uint(first);
        self.lists.iter().flatten().for_each(|place| block.uint(*place));
        block.bytes()
    }
}

impl CameraSpace {
    /// From the shaders' world space to tiles, times the distance along the camera's axis, which is w.
    fn to_cluster(&self, grid: [usize; 3]) -> DMat4 {
        let rows = self.from_world.transpose();
        let tile = |row: DVec3, axis: usize| (row * self.focal[axis] + rows.z_axis) * (0.5 * grid[axis] as f64);
        let rows = [tile(rows.x_axis, 0), tile(rows.y_axis, 1), DVec3::ZERO, rows.z_axis].map(|row| row.extend(0.0));
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    }

    /// The part of a ball in a column (`axis` 0) or row (1) of tiles, of which there are `of`.
    fn in_tile(&self, ball: Ball, axis: usize, tile: usize, of: usize) -> Option<Ball> {
        // A plane through the camera and a place of the picture, from −1 to 1.
        let plane = |number: f64| {
            let mut normal = DVec3::ZERO;
            (normal[axis], normal.z) = (self.focal[axis], 1.0 - 2.0 * number / of as f64);
            normal.normalize()
        };
        let ball = if tile == 0 { Some(ball) } else { ball.cut(plane(tile as f64 - OVERLAP), 0.0) };
        if tile + 1 == of { ball } else { ball?.cut(-plane((tile + 1) as f64 + OVERLAP), 0.0) }
    }
}

/// The sphere that a light reaches; `None` if it reaches everywhere.
fn ball(light: &PointLight, camera: &Camera, space: &CameraSpace) -> Option<Ball> {
    let radius = f64::from(light.range?) * (1.0 + RANGE_ROUNDING);
    // Rounded as the shaders receive it.
    let from_camera = (DVec3::from(light.position) - camera.position()).as_vec3().as_dvec3();
    Some(Ball { centre: space.from_world * from_camera, squared_radius: radius * radius })
}

/// How far from a camera what it sees of the scene reaches, metres.
fn farthest(scene: &Scene, camera: &Camera) -> f64 {
    let eye = camera.position();
    let reach = scene.bounds().map_or(1.0, |bounds| bounds.center().distance(eye) + bounds.radius());
    camera.far.map_or(reach, |far| reach.min(far.into()))
}
