//! What a view's camera sees of a scene at a frame: the bind groups and lists that its passes are drawn with.

use super::cascades::{self, Map, cascades_block, seen_by_sun};
use super::clusters::Clusters;
use super::eyes::{EyeSight, Eyes};
use super::frame_data::{lights_block, motion_block, objects_block, shifted, view_block, world_to_clip};
use super::frustum;
use super::interface::{
    CASCADES_BINDING, CLUSTERS_BINDING, FRAME_SET, LIGHTS_BINDING, MOTION_BINDING, OBJECTS_BINDING, VIEW_BINDING,
    interface,
};
use super::lists::draw_order_from;
use crate::scene::{Camera, Scene};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::jitter::Jitter;
use framewright_vulkan::{BindGroup, Buffer, BufferUsage, CullMode, Device, Error, FrontFace, Resource};
use glam::{DMat4, DVec3};

/// From where, and how, a view sees the scene.
pub(super) struct Viewpoint {
    /// At frame 0; of an eye the one between both.
    pub(super) camera: Camera,
    /// The eye that sees it, if there are two.
    pub(super) eye: Option<EyeSight>,
    /// Both eyes, of a view that is seen with either or from between them.
    pub(super) eyes: Option<Eyes>,
    /// Width and height of its picture, of which only the ratio counts.
    pub(super) extent: [u32; 2],
    /// The cascades of the sun's shadows in it, the nearest first.
    pub(super) maps: Vec<Map>,
    pub(super) jitter: Option<Jitter>,
}

impl Viewpoint {
    fn aspect(&self) -> f64 {
        let [width, height] = self.extent.map(|side| f64::from(side.max(1)));
        width / height
    }

    /// The camera at a frame that sees all that this view shares with those of other eyes.
    fn around(&self, frame: u64) -> Camera {
        let camera = self.camera.at(frame);
        self.eyes.map_or(camera, |eyes| eyes.around(&camera, self.aspect()))
    }

    /// Where the eye is at a frame, in the shaders' world space.
    fn eye(&self, frame: u64) -> DVec3 {
        self.eye.map_or(DVec3::ZERO, |eye| eye.offset(&self.camera.at(frame)))
    }

    /// From world space to clip space at a frame, not shifted.
    fn straight(&self, frame: u64) -> DMat4 {
        let (camera, aspect) = (self.camera.at(frame), self.aspect());
        let straight = world_to_clip(&camera, aspect);
        self.eye.map_or(straight, |eye| eye.world_to_clip(&camera, aspect, straight))
    }

    /// From world space to clip space at a frame.
    fn world_to_clip(&self, frame: u64) -> DMat4 {
        let shift = self.jitter.as_ref().map(|jitter| jitter.shift(frame));
        let straight = self.straight(frame);
        shift.map_or(straight, |shift| shifted(straight, shift))
    }
}

/// What a view's camera decides.
pub(super) struct Seen {
    pub(super) frame: BindGroup,
    /// By object, whether it may be seen.
    pub(super) in_sight: Vec<bool>,
    pub(super) transparent: Vec<ObjectDraw>,
    /// By cascade, the nearest first.
    pub(super) cascades: Vec<SeenBySun>,
    /// All that `frame` holds, but for what shifts.
    buffers: Buffers,
}

/// What the sun sees of a cascade.
pub(super) struct SeenBySun {
    pub(super) frame: BindGroup,
    /// By object, whether it may cast a shadow there.
    pub(super) casts: Vec<bool>,
}

/// One object, with the state that it wants.
pub(super) struct ObjectDraw {
    pub(super) object: u32,
    pub(super) mesh: usize,
    pub(super) texture: Option<usize>,
    pub(super) raster: (CullMode, FrontFace),
}

/// What shaders read of a scene beside the view.
struct Buffers {
    lights: Buffer,
    objects: Buffer,
    cascades: Buffer,
    clusters: Buffer,
    motion: Buffer,
}

impl Seen {
    /// What `view` sees at a frame of a scene, which is given as it is at frame 0.
    pub(super) fn new(device: &Device, scene: &Scene, view: &Viewpoint, frame: u64) -> Result<Seen, Error> {
        // The first frame comes after itself: nothing has moved.
        let frame_before = frame.saturating_sub(1);
        let (camera, before) = (view.camera.at(frame), view.camera.at(frame_before));
        let (now, then) = (view.straight(frame), (view.straight(frame_before), &before));
        let motion = motion_block(scene, now, then, frame_before);
        let scene = &scene.at(frame);
        // Both eyes look up the same maps.
        let around = view.around(frame);
        let to_around = DMat4::from_translation((camera.position() - around.position()).as_dvec3());
        let by_sun = |map: &Map| {
            let seen = seen_by_sun(scene, &around, view.aspect(), map.cascade, map.texels);
            cascades::Seen { world_to_clip: seen.world_to_clip * to_around, ..seen }
        };
        let by_sun: Vec<_> = view.maps.iter().map(by_sun).collect();
        let clusters = Clusters::new(scene, &camera, view.aspect());
        let buffers = Buffers {
            lights: device.buffer(BufferUsage::Storage, &lights_block(scene, &camera, &clusters))?,
            objects: device.buffer(BufferUsage::Storage, &objects_block(scene, &camera))?,
            cascades: device.buffer(BufferUsage::Uniform, &cascades_block(&by_sun))?,
            clusters: device.buffer(BufferUsage::Storage, &clusters.block())?,
            motion: device.buffer(BufferUsage::Storage, &motion)?,
        };
        let cascade = |seen: &cascades::Seen| {
            let casts = scene.objects.iter().map(|object| cascades::may_cast(scene, &camera, seen, object)).collect();
            Ok::<_, Error>(SeenBySun {
                frame: group(device, &camera, (seen.world_to_clip, DVec3::ZERO), &buffers)?,
                casts,
            })
        };
        let world_to_clip = view.world_to_clip(frame);
        Ok(Seen {
            frame: group(device, &camera, (world_to_clip, view.eye(frame)), &buffers)?,
            in_sight: frustum::within(scene, &camera, world_to_clip),
            transparent: draws(scene, &camera, DrawList::Transparent),
            cascades: by_sun.iter().map(cascade).collect::<Result<_, _>>()?,
            buffers,
        })
    }

    /// Goes over to another frame: what stays the same is kept, and nothing is overwritten, since frames on their way may
    /// still read it.
    pub(super) fn turn_to(
        &mut self,
        device: &Device,
        scene: &Scene,
        view: &Viewpoint,
        frame: u64,
    ) -> Result<(), Error> {
        if scene.moves() {
            *self = Seen::new(device, scene, view, frame)?;
        } else if view.jitter.is_some() {
            self.shift(device, scene, view, frame)?;
        }
        Ok(())
    }

    /// Is shifted as `view` is at the frame that it is for already.
    pub(super) fn shift(&mut self, device: &Device, scene: &Scene, view: &Viewpoint, frame: u64) -> Result<(), Error> {
        let (camera, world_to_clip) = (view.camera.at(frame), view.world_to_clip(frame));
        self.frame = group(device, &camera, (world_to_clip, view.eye(frame)), &self.buffers)?;
        self.in_sight = frustum::within(&scene.at(frame), &camera, world_to_clip);
        Ok(())
    }
}

/// The set of what stays the same for a whole frame.
fn group(
    device: &Device,
    camera: &Camera,
    (world_to_clip, eye): (DMat4, DVec3),
    buffers: &Buffers,
) -> Result<BindGroup, Error> {
    let view = device.buffer(BufferUsage::Uniform, &view_block(camera, world_to_clip, eye))?;
    let Buffers { lights, objects, cascades, clusters, motion } = buffers;
    let resources = [
        (VIEW_BINDING, Resource::Buffer(&view)),
        (LIGHTS_BINDING, Resource::Buffer(lights)),
        (OBJECTS_BINDING, Resource::Buffer(objects)),
        (CASCADES_BINDING, Resource::Buffer(cascades)),
        (CLUSTERS_BINDING, Resource::Buffer(clusters)),
        (MOTION_BINDING, Resource::Buffer(motion)),
    ];
    device.bind_group(&interface(Draw::Objects(DrawList::Opaque)), FRAME_SET, &resources)
}

/// The draws of a list, in order.
pub(super) fn draws(scene: &Scene, camera: &Camera, list: DrawList) -> Vec<ObjectDraw> {
    let draw = |index: u32| {
        let object = &scene.objects[index as usize];
        let material = &scene.materials[object.material];
        let cull = if material.double_sided { CullMode::None } else { CullMode::Back };
        let front = if object.mirrored() { FrontFace::Clockwise } else { FrontFace::CounterClockwise };
        ObjectDraw { object: index, mesh: object.mesh, texture: material.base_color_texture, raster: (cull, front) }
    };
    draw_order_from(scene, camera, list).into_iter().map(draw).collect()
}
