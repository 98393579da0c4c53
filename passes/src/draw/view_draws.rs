//! The bind groups and draw lists of a view at a frame.

use super::cascades::{self, CascadeMap, cascades_block, sun_view};
use super::clusters::Clusters;
use super::eyes::Eyes;
use super::frame_data::{ViewTransform, lights_block, motion_block, objects_block, shifted, world_to_clip};
use super::frustum;
use super::lists::draw_order_from;
use super::view_buffers::{Blocks, Sight, ViewBuffers};
use crate::scene::{Camera, Scene};
use framewright_graph::frame::{DrawList, Eye, Jitter};
use framewright_vulkan::{BindGroup, CullMode, Device, Error, FrontFace};
use glam::{DMat4, DVec3};

/// The camera of a view, its eyes, and how its picture is drawn.
pub(super) struct Viewpoint {
    /// At frame 0; of two eyes the one between both.
    pub(super) camera: Camera,
    /// The camera of the frame before, if the program has moved it since.
    pub(super) moved_from: Option<Camera>,
    /// Whether it had moved it before that frame.
    pub(super) moved: bool,
    /// The eyes that see it, if there are two.
    pub(super) eyes: Option<Eyes>,
    /// Whether passes draw for both eyes at once.
    pub(super) at_once: bool,
    /// Whether passes draw or compute for one eye.
    pub(super) one_by_one: bool,
    /// Whether passes that draw for one eye are given the objects that it may see itself.
    pub(super) culls_by_eye: bool,
    /// Width and height of its picture, of which only the ratio counts.
    pub(super) extent: [u32; 2],
    /// The cascades of the sun's shadows in it, the nearest first.
    pub(super) maps: Vec<CascadeMap>,
    pub(super) jitter: Option<Jitter>,
}

impl Viewpoint {
    /// The viewpoint of one eye, without jitter.
    pub(super) fn of_one(camera: Camera, extent: [u32; 2], maps: Vec<CascadeMap>) -> Viewpoint {
        let (at_once, one_by_one, culls_by_eye) = (false, false, true);
        Viewpoint {
            camera,
            moved_from: None,
            moved: false,
            eyes: None,
            at_once,
            one_by_one,
            culls_by_eye,
            extent,
            maps,
            jitter: None,
        }
    }

    fn aspect(&self) -> f64 {
        let [width, height] = self.extent.map(|side| f64::from(side.max(1)));
        width / height
    }

    /// The camera at a frame that sees all that both eyes see.
    fn around(&self, frame: u64) -> Camera {
        let camera = self.camera.at(frame);
        self.eyes.map_or(camera, |eyes| eyes.around(&camera, self.aspect()))
    }

    /// By how much the picture is shifted at a frame, in shares of its width and height.
    fn shift(&self, frame: u64) -> [f64; 2] {
        self.jitter.as_ref().map_or([0.0; 2], |jitter| jitter.shift(frame))
    }

    /// The transform of a camera from between the eyes, without jitter.
    fn straight(&self, camera: &Camera) -> ViewTransform {
        ViewTransform { world_to_clip: world_to_clip(camera, self.aspect()), eye: DVec3::ZERO }
    }

    /// The transform of a camera for each eye, without jitter; the same twice if there is one.
    fn straight_by_eye(&self, camera: &Camera) -> [ViewTransform; 2] {
        let straight = self.straight(camera);
        Eye::BOTH.map(|eye| {
            let Some(eye) = self.eyes.map(|eyes| eyes.of(eye)) else { return straight };
            let world_to_clip = eye.world_to_clip(camera, self.aspect(), straight.world_to_clip);
            ViewTransform { world_to_clip, eye: eye.offset(camera) }
        })
    }

    /// A transform with the jitter of the frame.
    fn shifted(&self, sight: ViewTransform, frame: u64) -> ViewTransform {
        ViewTransform { world_to_clip: shifted(sight.world_to_clip, self.shift(frame)), ..sight }
    }
}

/// The bind groups and draw lists of a view.
pub(super) struct ViewDraws {
    pub(super) jittered: JitteredDraws,
    pub(super) transparent: Vec<ObjectDraw>,
    /// By cascade, the nearest first.
    pub(super) cascades: Vec<CascadeDraws>,
    pub(super) buffers: ViewBuffers,
}

/// The bind groups of two eyes.
pub(super) struct EyeDraws {
    /// For passes that draw for both at once, with the view's own list.
    pub(super) both: Option<BindGroup>,
    /// For passes that draw for one eye, with the objects that this eye may see; `None`: the view's own list.
    pub(super) each: Option<[(BindGroup, Option<Vec<bool>>); 2]>,
}

/// The bind group and objects of a cascade.
pub(super) struct CascadeDraws {
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

impl ViewDraws {
    /// Prepares `view` at a frame. `scene` is as it is at frame 0.
    pub(super) fn new(device: &Device, scene: &Scene, view: &Viewpoint, frame: u64) -> Result<ViewDraws, Error> {
        let mut buffers = ViewBuffers::new(device);
        let (jittered, transparent, cascades) = ViewDraws::parts(&mut buffers, scene, view, frame)?;
        Ok(ViewDraws { jittered, transparent, cascades, buffers })
    }

    /// The bind groups and draw lists of `view` at a frame, whose buffers are written.
    fn parts(
        buffers: &mut ViewBuffers,
        scene: &Scene,
        view: &Viewpoint,
        frame: u64,
    ) -> Result<(JitteredDraws, Vec<ObjectDraw>, Vec<CascadeDraws>), Error> {
        // The first frame comes after itself: nothing has moved.
        let frame_before = frame.saturating_sub(1);
        let (camera, before) = (view.camera.at(frame), view.moved_from.unwrap_or(view.camera).at(frame_before));
        let straight = |camera| view.straight_by_eye(camera).map(|sight| sight.world_to_clip);
        let motion = motion_block(scene, straight(&camera), (straight(&before), &before), frame_before);
        let scene = &scene.at(frame);
        // Both eyes look up the same maps.
        let around = view.around(frame);
        let to_around = DMat4::from_translation(camera.position() - around.position());
        let by_sun = |map: &CascadeMap| {
            let sun = sun_view(scene, &around, view.aspect(), map.cascade, map.texels);
            cascades::SunView { world_to_clip: sun.world_to_clip * to_around, ..sun }
        };
        let by_sun: Vec<_> = view.maps.iter().map(by_sun).collect();
        let clusters = Clusters::new(scene, &camera, view.aspect());
        buffers.write(&Blocks {
            lights: lights_block(scene, &camera, &clusters),
            objects: objects_block(scene, &camera),
            cascades: cascades_block(&by_sun),
            clusters: clusters.block(),
            motion,
        })?;
        let mut cascades = Vec::with_capacity(by_sun.len());
        for (number, sun) in by_sun.iter().enumerate() {
            let casts = scene.objects.iter().map(|object| cascades::may_cast(scene, &camera, sun, object)).collect();
            let transform = ViewTransform { world_to_clip: sun.world_to_clip, eye: DVec3::ZERO };
            let frame = buffers.group(Sight::OfSun(number), &camera, [transform; 2])?;
            cascades.push(CascadeDraws { frame, casts });
        }
        Ok((JitteredDraws::new(buffers, scene, view, frame)?, draws(scene, &camera, DrawList::Transparent), cascades))
    }

    /// Prepares another frame.
    pub(super) fn advance_to(&mut self, scene: &Scene, view: &Viewpoint, frame: u64) -> Result<(), Error> {
        if scene.moves() || view.moved || view.moved_from.is_some() {
            self.renew(scene, view, frame)?;
        } else if view.jitter.is_some() {
            self.shift(scene, view, frame)?;
        }
        Ok(())
    }

    /// Prepares `view` anew.
    pub(super) fn renew(&mut self, scene: &Scene, view: &Viewpoint, frame: u64) -> Result<(), Error> {
        (self.jittered, self.transparent, self.cascades) = ViewDraws::parts(&mut self.buffers, scene, view, frame)?;
        Ok(())
    }

    /// Prepares the jitter of `view` at the frame that it is for already.
    pub(super) fn shift(&mut self, scene: &Scene, view: &Viewpoint, frame: u64) -> Result<(), Error> {
        self.jittered = JitteredDraws::new(&mut self.buffers, &scene.at(frame), view, frame)?;
        Ok(())
    }
}

/// The parts that jitter changes.
pub(super) struct JitteredDraws {
    pub(super) frame: BindGroup,
    /// By object, whether it may be seen.
    pub(super) visible: Vec<bool>,
    pub(super) by_eye: Option<EyeDraws>,
}

impl JitteredDraws {
    /// Prepares them. `scene` is as it is at the frame.
    fn new(buffers: &mut ViewBuffers, scene: &Scene, view: &Viewpoint, frame: u64) -> Result<JitteredDraws, Error> {
        let camera = view.camera.at(frame);
        let own = view.shifted(view.straight(&camera), frame);
        let between = buffers.group(Sight::Between, &camera, [own; 2])?;
        if view.eyes.is_none() {
            let visible = frustum::within(scene, &camera, own.world_to_clip);
            return Ok(JitteredDraws { frame: between, visible, by_eye: None });
        }
        // Jitter moves the picture by at most this share: the frustum around both eyes is widened by it on each side.
        let around = view.around(frame);
        let share = view.shift(frame).into_iter().fold(0.0, |most: f64, side| most.max(side.abs()));
        let narrower = DVec3::new((1.0 + 2.0 * share).recip(), (1.0 + 2.0 * share).recip(), 1.0);
        let all = DMat4::from_scale(narrower) * world_to_clip(&around, view.aspect());
        let eyes = view.straight_by_eye(&camera).map(|sight| view.shifted(sight, frame));
        let both = view.at_once.then(|| buffers.group(Sight::OfBoth, &camera, eyes)).transpose()?;
        let mut each = |eye: Eye| {
            let sight = eyes[eye as usize];
            let own = || frustum::within(scene, &camera, sight.world_to_clip);
            Ok::<_, Error>((buffers.group(Sight::Of(eye), &camera, [sight; 2])?, view.culls_by_eye.then(own)))
        };
        let each = if view.one_by_one { Some([each(Eye::Left)?, each(Eye::Right)?]) } else { None };
        let by_eye = EyeDraws { both, each };
        let visible = frustum::within(scene, &around, all);
        Ok(JitteredDraws { frame: between, visible, by_eye: Some(by_eye) })
    }
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
