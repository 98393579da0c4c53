//! Draws a scene.

use super::cascades;
use super::eyes::Eyes;
use super::geometry::Geometry;
use super::interface::{FRAME_SET, MATERIAL_SET, interface};
use super::textures::Textures;
use super::view_draws::{CascadeDraws, ObjectDraw, ViewDraws, Viewpoint, draws};
use crate::scene::{Camera, Scene, limits};
use framewright_graph::frame::{Draw, DrawList, Eye, Jitter};
use framewright_graph::plan::{Plan, Step, View, ViewId};
use framewright_vulkan::{BindGroup, Device, DispatchRecorder, DrawSource, Error, Recorder};
use std::collections::BTreeMap;

/// Point lights that a scene may have to be drawn. Those with a range are looked at where they reach; see
/// [`super::clusters`].
pub const MOST_POINT_LIGHTS: usize = limits::POINT_LIGHTS;

/// A scene on a device, ready to be drawn.
///
/// It binds everything that [`interface`] lists. Each object is one draw call, whose first instance is the object's index in
/// the scene. Objects and cameras move with the frames, and a view is jittered as the Plan says.
pub struct SceneDrawSource {
    /// The scene at frame 0, without vertices and texels.
    outline: Scene,
    /// The frame that `views` are for.
    frame: u64,
    /// Whether any of it was drawn.
    drawn: bool,
    /// Views without those of single eyes, the main one first; at least one.
    views: Vec<(Viewpoint, ViewDraws)>,
    /// For each view of the Plan its place in `views`, and its eye.
    by_view: Vec<(usize, Option<Eye>)>,
    geometry: Geometry,
    textures: Textures,
    opaque: Vec<ObjectDraw>,
    masked: Vec<ObjectDraw>,
    culls: bool,
    culls_once: bool,
}

impl SceneDrawSource {
    /// Uploads a scene, seen by its default camera. `extent` is the picture's width and height, of which only the ratio
    /// counts: passes may draw into images of other sizes.
    ///
    /// # Errors
    /// More than [`MOST_POINT_LIGHTS`] point lights, a texture or scene larger than the device takes, or no memory.
    pub fn new(device: &Device, scene: &Scene, extent: [u32; 2]) -> Result<SceneDrawSource, Error> {
        let view = Viewpoint::of_one(scene.camera, extent, Vec::new());
        SceneDrawSource::with_views(device, scene, vec![view], Vec::new())
    }

    /// Uploads a scene for the views of a Plan, each with its camera, and for the sun's shadows in each; a Plan without views
    /// is for the default camera's, of which `extent` is as in [`SceneDrawSource::new`]. Where it is for two eyes, those are
    /// usual ones.
    ///
    /// # Errors
    /// Those of [`SceneDrawSource::new`]; [`Error::DrawSource`] if the scene has no camera that a view names.
    pub fn for_plan(device: &Device, scene: &Scene, extent: [u32; 2], plan: &Plan) -> Result<SceneDrawSource, Error> {
        SceneDrawSource::for_eyes(device, scene, extent, plan, &Eyes::default())
    }

    /// Like [`SceneDrawSource::for_plan`], for given eyes.
    ///
    /// # Errors
    /// Those of [`SceneDrawSource::for_plan`].
    pub fn for_eyes(
        device: &Device,
        scene: &Scene,
        extent: [u32; 2],
        plan: &Plan,
        eyes: &Eyes,
    ) -> Result<SceneDrawSource, Error> {
        let mut views = Vec::with_capacity(plan.views.len());
        let mut places = BTreeMap::new();
        for (number, view) in (0..).map(ViewId).zip(&plan.views).filter(|(_, view)| view.eye.is_none()) {
            let camera = scene.camera_named(view.camera.as_deref()).ok_or_else(|| no_camera(scene, view))?;
            let two = plan.views.iter().any(|view| view.eye.is_some_and(|eye| eye.of == number));
            places.insert(number, views.len());
            views.push(Viewpoint {
                camera: *camera,
                moved_from: None,
                moved: false,
                eyes: two.then_some(*eyes),
                at_once: draws_at_once(plan, number),
                one_by_one: is_seen_by_one(plan, number),
                culls_by_eye: draws_for_one(plan, number),
                extent: view.extent,
                maps: cascades::of_plan(plan, Some(number)),
                jitter: view.jitter.clone(),
            });
        }
        if views.is_empty() {
            views.push(Viewpoint::of_one(scene.camera, extent, cascades::of_plan(plan, None)));
        }
        let of_view = |(number, view): (ViewId, &View)| {
            let of = view.eye.map_or(number, |eye| eye.of);
            (places.get(&of).copied().unwrap_or(0), view.eye.map(|eye| eye.eye))
        };
        let by_view = (0..).map(ViewId).zip(&plan.views).map(of_view).collect();
        SceneDrawSource::with_views(device, scene, views, by_view)
    }

    fn with_views(
        device: &Device,
        scene: &Scene,
        views: Vec<Viewpoint>,
        by_view: Vec<(usize, Option<Eye>)>,
    ) -> Result<SceneDrawSource, Error> {
        let lights = scene.point_lights.len();
        if lights > MOST_POINT_LIGHTS {
            let what = format!("the scene has {lights} point lights, and at most {MOST_POINT_LIGHTS} can be drawn");
            return Err(Error::DrawSource { what });
        }
        let objects = interface(Draw::Objects(DrawList::Opaque));
        let outline = scene.outline();
        let views = views.into_iter().map(|view| {
            let seen = ViewDraws::new(device, &outline, &view, 0)?;
            Ok::<_, Error>((view, seen))
        });
        Ok(SceneDrawSource {
            frame: 0,
            drawn: false,
            views: views.collect::<Result<_, _>>()?,
            by_view,
            outline,
            geometry: Geometry::new(device, scene)?,
            textures: Textures::new(device, &objects, &scene.textures)?,
            opaque: draws(scene, &scene.camera, DrawList::Opaque),
            masked: draws(scene, &scene.camera, DrawList::Masked),
            culls: true,
            culls_once: false,
        })
    }

    /// Goes over to a Plan that differs in values alone, together with [`framewright_vulkan::Executor::change`]: its views get
    /// that Plan's jitter. Frames in flight keep what they are drawn from.
    ///
    /// # Errors
    /// [`Error::DrawSource`] if it has not as many views as the Plan before; no memory.
    pub fn change(&mut self, plan: &Plan) -> Result<(), Error> {
        let jitters: Vec<_> = if plan.views.is_empty() {
            vec![None]
        } else {
            plan.views.iter().filter(|view| view.eye.is_none()).map(|view| view.jitter.clone()).collect()
        };
        if jitters.len() != self.views.len() {
            let what = format!("the Plan has {} views, and {} were prepared", plan.views.len(), self.views.len());
            return Err(Error::DrawSource { what });
        }
        for ((view, seen), jitter) in self.views.iter_mut().zip(jitters) {
            if view.jitter != jitter {
                view.jitter = jitter;
                seen.shift(&self.outline, view, self.frame)?;
            }
        }
        Ok(())
    }

    /// Has the pictures of all views shifted so, instead of as the Plan says. Frames in flight keep what they are drawn from.
    ///
    /// # Errors
    /// No memory.
    pub fn set_jitter(&mut self, jitter: &Jitter) -> Result<(), Error> {
        for (view, seen) in &mut self.views {
            view.jitter = Some(jitter.clone());
            seen.shift(&self.outline, view, self.frame)?;
        }
        Ok(())
    }

    /// Has the main view seen by another camera from the next frame on, as one that the user moves. Passes that follow motion see how it
    /// moved. Frames in flight keep what they are drawn from.
    ///
    /// # Errors
    /// No memory.
    pub fn set_camera(&mut self, camera: Camera) -> Result<(), Error> {
        let Some((view, seen)) = self.views.first_mut() else { return Ok(()) };
        if view.camera != camera {
            let before = std::mem::replace(&mut view.camera, camera);
            if self.drawn {
                view.moved_from.get_or_insert(before);
            } else {
                seen.renew(&self.outline, view, self.frame).inspect_err(|_| view.camera = before)?;
            }
        }
        Ok(())
    }

    /// Prepares the views for a frame. Frames in flight keep theirs.
    fn advance_to(&mut self, frame: u64) -> Result<(), Error> {
        if self.frame != frame {
            for (view, seen) in &mut self.views {
                seen.advance_to(&self.outline, view, frame)?;
                view.moved = view.moved_from.take().is_some();
            }
            self.frame = frame;
        }
        self.drawn = true;
        Ok(())
    }

    /// Whether objects are left out that lie outside of what a pass shows; they are unless this says otherwise. The picture
    /// is the same. Passes whose shaders bring a vertex shader of their own are always given all objects.
    pub fn set_culling(&mut self, on: bool) {
        self.culls = on;
    }

    /// Whether passes that draw for one eye are given what either may see, as those are that draw for both at once; else what
    /// their own may see. The picture is the same. To be called before the first frame.
    pub fn set_shared_culling(&mut self, on: bool) {
        self.culls_once = on;
        self.views.iter_mut().for_each(|(view, _)| view.culls_by_eye = !on);
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

    fn list<'s>(&'s self, list: DrawList, seen: &'s ViewDraws) -> &'s [ObjectDraw] {
        match list {
            DrawList::Opaque => &self.opaque,
            DrawList::Masked => &self.masked,
            DrawList::Transparent => &seen.transparent,
        }
    }

    /// The draws of a cascade of a pass's view.
    fn cascade_draws(&self, cascade: u8, recorder: &Recorder<'_>) -> Result<&CascadeDraws, Error> {
        self.view_draws(recorder)?.cascades.get(usize::from(cascade)).ok_or_else(|| {
            let pass = recorder.pass();
            Error::DrawSource { what: format!("pass `{pass}` draws cascade {cascade}, which wasn't prepared") }
        })
    }

    /// The draws of the view of a pass, and the eye for which it draws or computes.
    fn view_draws_and_eye(&self, pass: &str, view: Option<ViewId>) -> Result<(&ViewDraws, Option<Eye>), Error> {
        let view = view.map_or(0, |view| view.0 as usize);
        let (place, eye) = self.by_view.get(view).copied().unwrap_or((view, None));
        self.views.get(place).map(|(_, seen)| (seen, eye)).ok_or_else(|| {
            let views = self.views.len();
            Error::DrawSource { what: format!("pass `{pass}` draws for view {view}, and {views} were prepared") }
        })
    }

    /// The draws of a pass's view.
    fn view_draws(&self, recorder: &Recorder<'_>) -> Result<&ViewDraws, Error> {
        self.view_draws_and_eye(recorder.pass(), recorder.view()).map(|(seen, _)| seen)
    }

    /// The bind group of a pass that draws, and by object whether it may be visible.
    fn group_and_visible(&self, recorder: &Recorder<'_>) -> Result<(&BindGroup, &[bool]), Error> {
        let at_once = recorder.both_eyes().is_some();
        Ok(self.seen_by(self.view_draws_and_eye(recorder.pass(), recorder.view())?, at_once))
    }

    /// The bind group of an eye, of both at once, or of one between them; and by object whether it may be visible.
    fn seen_by<'s>(&'s self, (seen, eye): (&'s ViewDraws, Option<Eye>), at_once: bool) -> (&'s BindGroup, &'s [bool]) {
        let seen = &seen.jittered;
        let both = seen.by_eye.as_ref().and_then(|by_eye| by_eye.both.as_ref());
        let each = seen.by_eye.as_ref().and_then(|by_eye| by_eye.each.as_ref());
        match (both, each.zip(eye)) {
            (Some(group), _) if at_once => (group, &seen.visible),
            (_, Some((each, eye))) => {
                let (group, own) = &each[eye as usize];
                (group, own.as_ref().filter(|_| !self.culls_once).unwrap_or(&seen.visible))
            }
            _ => (&seen.frame, &seen.visible),
        }
    }
}

impl DrawSource for SceneDrawSource {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        self.advance_to(recorder.frame())?;
        match draw {
            Draw::Objects(list) => {
                let (group, visible) = self.group_and_visible(recorder)?;
                Ok(self.record_objects(self.list(list, self.view_draws(recorder)?), visible, group, recorder))
            }
            Draw::Casters(cascade) => {
                let seen = self.cascade_draws(cascade.index, recorder)?;
                let list = if cascade.list == DrawList::Masked { &self.masked } else { &self.opaque };
                Ok(self.record_objects(list, &seen.casts, &seen.frame, recorder))
            }
            Draw::Sky | Draw::FullScreen => {
                recorder.bind_group(FRAME_SET, self.group_and_visible(recorder)?.0);
                recorder.draw(0..3, 0..1);
                Ok(1)
            }
            // The draw of the pass's own vertices follows.
            Draw::Vertices { .. } | Draw::Indirect | Draw::Indirects(_) => {
                recorder.bind_group(FRAME_SET, self.group_and_visible(recorder)?.0);
                Ok(1)
            }
            Draw::Custom => {
                let what =
                    format!("a scene doesn't draw `{}`, which pass `{}` asks for", recorder.shader(), recorder.pass());
                Err(Error::DrawSource { what })
            }
        }
    }

    fn dispatch(&mut self, recorder: &mut DispatchRecorder<'_>) -> Result<(), Error> {
        self.advance_to(recorder.frame())?;
        let seen = self.view_draws_and_eye(recorder.pass(), recorder.view())?;
        recorder.bind_group(FRAME_SET, self.seen_by(seen, false).0);
        Ok(())
    }
}

fn no_camera(scene: &Scene, view: &View) -> Error {
    let wanted = view.camera.as_deref().unwrap_or_default();
    let known: Vec<String> = scene.cameras.iter().map(|it| format!("`{}`", it.name)).collect();
    let known = if known.is_empty() { "none by a name".to_owned() } else { known.join(", ") };
    Error::DrawSource { what: format!("view `{}` asks for the camera `{wanted}`; the scene has {known}", view.name) }
}

/// The views of passes that draw, with whether they draw for both eyes at once.
fn views_of_draws(plan: &Plan) -> impl Iterator<Item = (Option<ViewId>, bool)> {
    let scopes = plan.steps.iter().filter_map(|step| step.work.scope());
    scopes.flat_map(|scope| {
        let at_once = plan.eyes(scope).is_some();
        scope.passes.iter().map(move |pass| (pass.view, at_once))
    })
}

fn draws_at_once(plan: &Plan, view: ViewId) -> bool {
    views_of_draws(plan).any(|(of, at_once)| at_once && of == Some(view))
}

/// Whether passes draw for one eye of a view.
fn draws_for_one(plan: &Plan, view: ViewId) -> bool {
    views_of_draws(plan).any(|(of, _)| is_eye_of(plan, of, view))
}

/// Whether passes draw or compute for one eye of a view.
fn is_seen_by_one(plan: &Plan, view: ViewId) -> bool {
    let computes =
        |step: &Step| step.work.is_dispatch() && step.work.passes().iter().any(|pass| is_eye_of(plan, pass.view, view));
    draws_for_one(plan, view) || plan.steps.iter().any(computes)
}

/// Whether `eye` is the view of one eye of another view.
fn is_eye_of(plan: &Plan, eye: Option<ViewId>, view: ViewId) -> bool {
    let eye = eye.and_then(|eye| plan.views.get(eye.0 as usize)).and_then(|eye| eye.eye);
    eye.is_some_and(|eye| eye.of == view)
}
