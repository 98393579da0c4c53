//! Draws a scene.

use super::cascades::{self, Map, cascades_block, seen_by_sun};
use super::clusters::Clusters;
use super::frame_data::{lights_block, objects_block, view_block, world_to_clip};
use super::frustum;
use super::geometry::Geometry;
use super::interface::{
    CASCADES_BINDING, CLUSTERS_BINDING, FRAME_SET, LIGHTS_BINDING, MATERIAL_SET, OBJECTS_BINDING, VIEW_BINDING,
    interface,
};
use super::lists::draw_order_from;
use super::textures::Textures;
use crate::scene::{Camera, Scene, limits};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::plan::{Plan, View, ViewId};
use framewright_vulkan::{BindGroup, BufferUsage, CullMode, Device, DrawSource, Error, FrontFace, Recorder, Resource};

/// Point lights that a scene may have to be drawn. Those with a range are looked at where they reach; see
/// [`super::clusters`].
pub const MOST_POINT_LIGHTS: usize = limits::POINT_LIGHTS;

/// A scene on a device, ready to be drawn.
///
/// It supplies what [`interface`] lists. Each object is one draw call, whose first instance is the object's index in the
/// scene.
pub struct SceneDrawSource {
    /// By view, the main one first; at least one.
    views: Vec<Seen>,
    geometry: Geometry,
    textures: Textures,
    opaque: Vec<ObjectDraw>,
    masked: Vec<ObjectDraw>,
    culls: bool,
}

/// What a view's camera decides.
struct Seen {
    frame: BindGroup,
    /// By object, whether it may be seen.
    in_sight: Vec<bool>,
    transparent: Vec<ObjectDraw>,
    /// By cascade, the nearest first.
    cascades: Vec<SeenBySun>,
}

/// What the sun sees of a cascade.
struct SeenBySun {
    frame: BindGroup,
    /// By object, whether it may cast a shadow there.
    casts: Vec<bool>,
}

/// One object, with the state that it wants.
struct ObjectDraw {
    object: u32,
    mesh: usize,
    texture: Option<usize>,
    raster: (CullMode, FrontFace),
}

impl SceneDrawSource {
    /// Uploads a scene, seen by its default camera. `extent` is the picture's width and height, of which only the ratio
    /// counts: passes may draw into images of other sizes.
    ///
    /// # Errors
    /// More than [`MOST_POINT_LIGHTS`] point lights, a texture or scene larger than the device takes, or no memory.
    pub fn new(device: &Device, scene: &Scene, extent: [u32; 2]) -> Result<SceneDrawSource, Error> {
        SceneDrawSource::seen_from(device, scene, &[(scene.camera, extent, Vec::new())])
    }

    /// Uploads a scene for the views of a Plan, each with its camera, and for the sun's shadows in each; a Plan without views
    /// is for the default camera's, of which `extent` is as in [`SceneDrawSource::new`].
    ///
    /// # Errors
    /// Those of [`SceneDrawSource::new`]; [`Error::DrawSource`] if the scene has no camera that a view names.
    pub fn for_plan(device: &Device, scene: &Scene, extent: [u32; 2], plan: &Plan) -> Result<SceneDrawSource, Error> {
        let mut views = Vec::with_capacity(plan.views.len());
        for (number, view) in (0..).map(ViewId).zip(&plan.views) {
            let camera = scene.camera_named(view.camera.as_deref()).ok_or_else(|| no_camera(scene, view))?;
            views.push((*camera, view.extent, cascades::of_plan(plan, Some(number))));
        }
        if views.is_empty() {
            views.push((scene.camera, extent, cascades::of_plan(plan, None)));
        }
        SceneDrawSource::seen_from(device, scene, &views)
    }

    /// Uploads a scene, seen by cameras, each with its picture's size and the cascades of the sun's shadows.
    fn seen_from(
        device: &Device,
        scene: &Scene,
        views: &[(Camera, [u32; 2], Vec<Map>)],
    ) -> Result<SceneDrawSource, Error> {
        let lights = scene.point_lights.len();
        if lights > MOST_POINT_LIGHTS {
            let what = format!("the scene has {lights} point lights, and at most {MOST_POINT_LIGHTS} can be drawn");
            return Err(Error::DrawSource { what });
        }
        let objects = interface(Draw::Objects(DrawList::Opaque));
        let seen = |(camera, extent, maps): &(Camera, [u32; 2], Vec<Map>)| seen(device, scene, camera, *extent, maps);
        Ok(SceneDrawSource {
            views: views.iter().map(seen).collect::<Result<_, _>>()?,
            geometry: Geometry::new(device, scene)?,
            textures: Textures::new(device, &objects, &scene.textures)?,
            opaque: draws(scene, &scene.camera, DrawList::Opaque),
            masked: draws(scene, &scene.camera, DrawList::Masked),
            culls: true,
        })
    }

    /// Whether objects are left out that lie outside of what a pass shows; they are unless this says otherwise. The picture
    /// is the same. Passes whose shaders bring a vertex shader of their own are always given all objects.
    pub fn set_culling(&mut self, on: bool) {
        self.culls = on;
    }

    /// Records those of a draw list that are `wanted`, by object, and returns how many. State is set only where it differs
    /// from the draw before.
    fn record_objects(
        &self,
        list: &[ObjectDraw],
        wanted: &[bool],
        frame: &BindGroup,
        recorder: &mut Recorder<'_>,
    ) -> u32 {
        recorder.bind_group(FRAME_SET, frame);
        self.geometry.bind(recorder);
        let all = !self.culls || !recorder.has_usual_vertices();
        let (mut texture, mut raster) = (None, None);
        let (mut drawn, mut culled) = (0, 0);
        for draw in list {
            if !(all || wanted[draw.object as usize]) {
                culled += 1;
                continue;
            }
            drawn += 1;
            if texture != Some(draw.texture) {
                recorder.bind_group(MATERIAL_SET, self.textures.group(draw.texture));
                texture = Some(draw.texture);
            }
            if raster != Some(draw.raster) {
                recorder.set_cull_mode(draw.raster.0);
                recorder.set_front_face(draw.raster.1);
                raster = Some(draw.raster);
            }
            self.geometry.draw(draw.mesh, draw.object, recorder);
        }
        recorder.count_culled(culled);
        drawn
    }

    fn list<'s>(&'s self, list: DrawList, seen: &'s Seen) -> &'s [ObjectDraw] {
        match list {
            DrawList::Opaque => &self.opaque,
            DrawList::Masked => &self.masked,
            DrawList::Transparent => &seen.transparent,
        }
    }

    /// What the sun sees of a cascade of a pass's view.
    fn seen_by_sun(&self, cascade: u8, recorder: &Recorder<'_>) -> Result<&SeenBySun, Error> {
        self.seen(recorder)?.cascades.get(usize::from(cascade)).ok_or_else(|| {
            let pass = recorder.pass();
            Error::DrawSource { what: format!("pass `{pass}` draws cascade {cascade}, which wasn't prepared") }
        })
    }

    /// What the view of a pass sees.
    fn seen(&self, recorder: &Recorder<'_>) -> Result<&Seen, Error> {
        let view = recorder.view().map_or(0, |view| view.0 as usize);
        self.views.get(view).ok_or_else(|| {
            let (pass, views) = (recorder.pass(), self.views.len());
            Error::DrawSource { what: format!("pass `{pass}` draws for view {view}, and {views} were prepared") }
        })
    }
}

impl DrawSource for SceneDrawSource {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        match draw {
            Draw::Objects(list) => {
                let seen = self.seen(recorder)?;
                Ok(self.record_objects(self.list(list, seen), &seen.in_sight, &seen.frame, recorder))
            }
            Draw::Casters(cascade) => {
                let seen = self.seen_by_sun(cascade.index, recorder)?;
                let list = if cascade.list == DrawList::Masked { &self.masked } else { &self.opaque };
                Ok(self.record_objects(list, &seen.casts, &seen.frame, recorder))
            }
            Draw::Sky | Draw::FullScreen => {
                let seen = self.seen(recorder)?;
                recorder.bind_group(FRAME_SET, &seen.frame);
                recorder.draw(0..3, 0..1);
                Ok(1)
            }
            Draw::Vertices { .. } | Draw::Indirect | Draw::Custom => {
                let what =
                    format!("a scene doesn't draw `{}`, which pass `{}` asks for", recorder.shader(), recorder.pass());
                Err(Error::DrawSource { what })
            }
        }
    }
}

/// What a camera sees, and the sun for it.
fn seen(device: &Device, scene: &Scene, camera: &Camera, extent: [u32; 2], maps: &[Map]) -> Result<Seen, Error> {
    let [width, height] = extent.map(|side| f64::from(side.max(1)));
    let aspect = width / height;
    let by_sun: Vec<_> = maps.iter().map(|map| seen_by_sun(scene, camera, aspect, map.cascade, map.texels)).collect();
    let in_clusters = Clusters::new(scene, camera, aspect);
    let lights = device.buffer(BufferUsage::Storage, &lights_block(scene, camera, &in_clusters))?;
    let clusters = device.buffer(BufferUsage::Storage, &in_clusters.block())?;
    let by_object = device.buffer(BufferUsage::Storage, &objects_block(scene, camera))?;
    let cascades = device.buffer(BufferUsage::Uniform, &cascades_block(&by_sun))?;
    let objects = interface(Draw::Objects(DrawList::Opaque));
    let frame = |world_to_clip| {
        let view = device.buffer(BufferUsage::Uniform, &view_block(camera, world_to_clip))?;
        let resources = [
            (VIEW_BINDING, Resource::Buffer(&view)),
            (LIGHTS_BINDING, Resource::Buffer(&lights)),
            (OBJECTS_BINDING, Resource::Buffer(&by_object)),
            (CASCADES_BINDING, Resource::Buffer(&cascades)),
            (CLUSTERS_BINDING, Resource::Buffer(&clusters)),
        ];
        device.bind_group(&objects, FRAME_SET, &resources)
    };
    let cascade = |seen: &cascades::Seen| {
        let casts = scene.objects.iter().map(|object| cascades::may_cast(scene, camera, seen, object)).collect();
        Ok::<_, Error>(SeenBySun { frame: frame(seen.world_to_clip)?, casts })
    };
    Ok(Seen {
        frame: frame(world_to_clip(camera, aspect))?,
        in_sight: frustum::in_sight(scene, camera, aspect),
        transparent: draws(scene, camera, DrawList::Transparent),
        cascades: by_sun.iter().map(cascade).collect::<Result<_, _>>()?,
    })
}

fn no_camera(scene: &Scene, view: &View) -> Error {
    let wanted = view.camera.as_deref().unwrap_or_default();
    let known: Vec<String> = scene.cameras.iter().map(|it| format!("`{}`", it.name)).collect();
    let known = if known.is_empty() { "none by a name".to_owned() } else { known.join(", ") };
    Error::DrawSource { what: format!("view `{}` asks for the camera `{wanted}`; the scene has {known}", view.name) }
}

/// The draws of a list, in order.
fn draws(scene: &Scene, camera: &Camera, list: DrawList) -> Vec<ObjectDraw> {
    let draw = |index: u32| {
        let object = &scene.objects[index as usize];
        let material = &scene.materials[object.material];
        let cull = if material.double_sided { CullMode::None } else { CullMode::Back };
        let front = if object.mirrored() { FrontFace::Clockwise } else { FrontFace::CounterClockwise };
        ObjectDraw { object: index, mesh: object.mesh, texture: material.base_color_texture, raster: (cull, front) }
    };
    draw_order_from(scene, camera, list).into_iter().map(draw).collect()
}
