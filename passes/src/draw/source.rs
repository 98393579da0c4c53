//! Draws a scene.

use super::frame_data::{lights_block, objects_block, view_block};
use super::geometry::Geometry;
use super::interface::{FRAME_SET, LIGHTS_BINDING, MATERIAL_SET, OBJECTS_BINDING, VIEW_BINDING, interface};
use super::lists::draw_order;
use super::textures::Textures;
use crate::scene::Scene;
use framewright_graph::frame::{Draw, DrawList};
use framewright_vulkan::{BindGroup, BufferUsage, CullMode, Device, DrawSource, Error, FrontFace, Recorder, Resource};

/// Every fragment looks at every point light, so their number is kept small.
pub const MOST_POINT_LIGHTS: usize = 64;

/// A scene on a device, ready to be drawn.
///
/// It supplies what [`interface`] lists. Each object is one draw call, whose first instance is the object's index in the
/// scene.
pub struct SceneDrawSource {
    frame: BindGroup,
    geometry: Geometry,
    textures: Textures,
    opaque: Vec<ObjectDraw>,
    masked: Vec<ObjectDraw>,
    transparent: Vec<ObjectDraw>,
}

/// One object, with the state that it wants.
struct ObjectDraw {
    object: u32,
    mesh: usize,
    texture: Option<usize>,
    raster: (CullMode, FrontFace),
}

impl SceneDrawSource {
    /// Uploads a scene. `extent` is the picture's width and height, of which only the ratio counts: passes may draw into
    /// images of other sizes.
    ///
    /// # Errors
    /// More than [`MOST_POINT_LIGHTS`] point lights, a texture or scene larger than the device takes, or no memory.
    pub fn new(device: &Device, scene: &Scene, extent: [u32; 2]) -> Result<SceneDrawSource, Error> {
        let lights = scene.point_lights.len();
        if lights > MOST_POINT_LIGHTS {
            let what = format!("the scene has {lights} point lights, and at most {MOST_POINT_LIGHTS} can be drawn");
            return Err(Error::DrawSource { what });
        }
        let objects = interface(Draw::Objects(DrawList::Opaque));
        let [width, height] = extent.map(|side| f64::from(side.max(1)));
        let view = device.buffer(BufferUsage::Uniform, &view_block(&scene.camera, width / height))?;
        let lights = device.buffer(BufferUsage::Storage, &lights_block(scene))?;
        let by_object = device.buffer(BufferUsage::Storage, &objects_block(scene))?;
        let resources = [
            (VIEW_BINDING, Resource::Buffer(&view)),
            (LIGHTS_BINDING, Resource::Buffer(&lights)),
            (OBJECTS_BINDING, Resource::Buffer(&by_object)),
        ];
        Ok(SceneDrawSource {
            frame: device.bind_group(&objects, FRAME_SET, &resources)?,
            geometry: Geometry::new(device, scene)?,
            textures: Textures::new(device, &objects, &scene.textures)?,
            opaque: draws(scene, DrawList::Opaque),
            masked: draws(scene, DrawList::Masked),
            transparent: draws(scene, DrawList::Transparent),
        })
    }

    /// Records one draw list. State is set only where it differs from the draw before.
    fn record_objects(&self, list: DrawList, recorder: &mut Recorder<'_>) {
        recorder.bind_group(FRAME_SET, &self.frame);
        self.geometry.bind(recorder);
        let (mut texture, mut raster) = (None, None);
        for draw in self.list(list) {
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
    }

    fn list(&self, list: DrawList) -> &[ObjectDraw] {
        match list {
            DrawList::Opaque => &self.opaque,
            DrawList::Masked => &self.masked,
            DrawList::Transparent => &self.transparent,
        }
    }
}

impl DrawSource for SceneDrawSource {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        match draw {
            Draw::Objects(list) => {
                self.record_objects(list, recorder);
                Ok(u32::try_from(self.list(list).len()).unwrap_or(u32::MAX))
            }
            Draw::Sky | Draw::FullScreen => {
                recorder.bind_group(FRAME_SET, &self.frame);
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

/// The draws of a list, in order.
fn draws(scene: &Scene, list: DrawList) -> Vec<ObjectDraw> {
    let draw = |index: u32| {
        let object = &scene.objects[index as usize];
        let material = &scene.materials[object.material];
        let cull = if material.double_sided { CullMode::None } else { CullMode::Back };
        let front = if object.mirrored() { FrontFace::Clockwise } else { FrontFace::CounterClockwise };
        ObjectDraw { object: index, mesh: object.mesh, texture: material.base_color_texture, raster: (cull, front) }
    };
    draw_order(scene, list).into_iter().map(draw).collect()
}
