//! The program's function that records passes, and how it is called.

use crate::last_error;
use crate::passes::{
    FramewrightDraw, FramewrightEye, FramewrightEyeForm, FramewrightFormats, FramewrightPass, FramewrightResources,
    NO_EYES, PassResources, both, eye, targets,
};
use framewright::graph::frame::ParamValue;
use framewright::vulkan::Error;
use framewright::vulkan::ash::vk;
use framewright::{BindGroup, CustomImage, CustomRecorder, DispatchRecorder, RawSet, Recorder, SecondaryRecorder};
use std::ffi::c_void;
use std::ptr;
use std::sync::{Mutex, MutexGuard, PoisonError};

impl PassResources for CustomRecorder<'_> {
    fn image(&self, name: &str) -> Option<CustomImage> {
        CustomRecorder::image(self, name)
    }

    fn buffer(&self, name: &str) -> Option<vk::Buffer> {
        CustomRecorder::buffer(self, name)
    }

    fn param(&self, name: &str) -> Option<ParamValue> {
        CustomRecorder::param(self, name)
    }

    fn draws(&self, _: &mut dyn FnMut(&mut Recorder<'_>)) -> Result<(), &'static str> {
        Err("the pass stands outside of rendering scopes")
    }
}

impl PassResources for SecondaryRecorder<'_> {
    fn image(&self, name: &str) -> Option<CustomImage> {
        SecondaryRecorder::image(self, name)
    }

    fn buffer(&self, name: &str) -> Option<vk::Buffer> {
        SecondaryRecorder::buffer(self, name)
    }

    fn param(&self, name: &str) -> Option<ParamValue> {
        SecondaryRecorder::param(self, name)
    }

    fn draws(&self, _: &mut dyn FnMut(&mut Recorder<'_>)) -> Result<(), &'static str> {
        Err("the draws of the pass come in secondary command buffers")
    }
}

/// The recorder of a pass, which one thread of the program uses at a time.
struct SharedRecorder<'p, R>(Mutex<&'p mut R>);

impl<'p, R> SharedRecorder<'p, R> {
    fn recorder(&self) -> MutexGuard<'_, &'p mut R> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A pass inside a scope.
impl PassResources for SharedRecorder<'_, Recorder<'_>> {
    fn image(&self, name: &str) -> Option<CustomImage> {
        self.recorder().image(name)
    }

    fn buffer(&self, name: &str) -> Option<vk::Buffer> {
        self.recorder().buffer(name)
    }

    fn param(&self, name: &str) -> Option<ParamValue> {
        self.recorder().param(name)
    }

    fn draws(&self, record: &mut dyn FnMut(&mut Recorder<'_>)) -> Result<(), &'static str> {
        let mut recorder = self.recorder();
        // The program may have set viewport and scissor since.
        let _ = recorder.raw();
        record(&mut recorder);
        Ok(())
    }
}

/// A compute pass, of which images and buffers are the shader's.
impl PassResources for SharedRecorder<'_, DispatchRecorder<'_>> {
    fn image(&self, _: &str) -> Option<CustomImage> {
        None
    }

    fn buffer(&self, _: &str) -> Option<vk::Buffer> {
        None
    }

    fn param(&self, _: &str) -> Option<ParamValue> {
        None
    }

    fn tells(&self) -> bool {
        false
    }

    fn draws(&self, _: &mut dyn FnMut(&mut Recorder<'_>)) -> Result<(), &'static str> {
        Err("the pass is a compute pass: the program only binds, and the dispatch follows by itself")
    }

    fn bind_group(&self, set: u32, group: &BindGroup) -> Result<(), &'static str> {
        self.recorder().bind_group(set, group);
        Ok(())
    }

    fn bind_set(&self, number: u32, set: RawSet, offsets: &[u32]) -> Result<(), &'static str> {
        self.recorder().bind_set(number, set, offsets);
        Ok(())
    }
}

/// The program's callback, and what it is given.
#[derive(Clone, Copy)]
pub(crate) struct Callback {
    pub(crate) record: unsafe extern "C" fn(*mut c_void, *const FramewrightPass<'_>) -> u32,
    pub(crate) context: *mut c_void,
}

impl Callback {
    /// Has the program record what stands inside a rendering scope.
    pub(crate) fn inside(&self, kind: FramewrightDraw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let (name, custom) = (recorder.pass().to_owned(), recorder.shader().to_owned());
        let formats = recorder.formats().clone();
        let formats = FramewrightFormats::of(&formats);
        let [width, height] = recorder.target_extent();
        let (both_eyes, eye_form) = both(recorder.both_eyes());
        let of_scope = FramewrightPass {
            commands: recorder.raw(),
            in_scope: 1,
            width,
            height,
            frame: recorder.frame(),
            queue_family: recorder.queue_family(),
            draw: kind,
            eye: eye(recorder.eye()),
            both_eyes,
            eye_form,
            eye_targets: targets(recorder.eye_targets()),
            formats: &raw const formats,
            rotation: recorder.rotation() as u32,
            ..NONE
        };
        let inside = SharedRecorder(Mutex::new(recorder));
        self.call([&name, &custom], &inside, of_scope).map(|()| 1)
    }

    /// Has the program execute its secondary command buffers inside a rendering scope.
    pub(crate) fn secondary(&self, custom: &str, recorder: &mut SecondaryRecorder<'_>) -> Result<u32, Error> {
        let commands = recorder.raw();
        let formats = FramewrightFormats::of(recorder.formats());
        let inheritance = recorder.inheritance();
        let [width, height] = recorder.target_extent();
        let (both_eyes, eye_form) = both(recorder.both_eyes());
        let of_scope = FramewrightPass {
            commands,
            in_scope: 1,
            width,
            height,
            frame: recorder.frame(),
            queue_family: recorder.queue_family(),
            eye: eye(recorder.eye()),
            both_eyes,
            eye_form,
            eye_targets: targets(recorder.eye_targets()),
            formats: &raw const formats,
            inheritance: &raw const inheritance,
            rotation: recorder.rotation() as u32,
            ..NONE
        };
        self.call([recorder.pass(), custom], &*recorder, of_scope).map(|()| 1)
    }

    /// Has the program record what stands outside of rendering scopes.
    pub(crate) fn outside(&self, custom: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        let commands = recorder.raw();
        let (both_eyes, eye_form) = both(recorder.both_eyes());
        let pass = FramewrightPass {
            commands,
            frame: recorder.frame(),
            queue_family: recorder.queue_family(),
            eye: eye(recorder.view().and_then(|view| view.eye).map(|of| of.eye)),
            both_eyes,
            eye_form,
            ..NONE
        };
        self.call([recorder.pass(), custom], &*recorder, pass)
    }

    /// Has the program bind what a compute pass sees of it.
    pub(crate) fn compute(&self, recorder: &mut DispatchRecorder<'_>) -> Result<(), Error> {
        let (name, shader) = (recorder.pass().to_owned(), recorder.shader().to_owned());
        let pass = FramewrightPass {
            frame: recorder.frame(),
            queue_family: vk::QUEUE_FAMILY_IGNORED,
            draw: FramewrightDraw::Compute,
            eye: eye(recorder.eye()),
            ..NONE
        };
        self.call([&name, &shader], &SharedRecorder(Mutex::new(recorder)), pass)
    }

    /// Calls it for a pass, and puts in the names and what leads to the resources.
    fn call(
        &self,
        [name, custom]: [&str; 2],
        resources: &dyn PassResources,
        pass: FramewrightPass<'_>,
    ) -> Result<(), Error> {
        let (name_of_c, custom_of_c) = (last_error::text(name), last_error::text(custom));
        let resources = FramewrightResources(resources);
        let pass = FramewrightPass {
            name: name_of_c.as_ptr(),
            custom: custom_of_c.as_ptr(),
            resources: &raw const resources,
            ..pass
        };
        // SAFETY: the program's word: it takes a pass and what was given with it.
        match unsafe { (self.record)(self.context, &raw const pass) } {
            0 => Err(Error::DrawSource {
                what: format!("the program doesn't record `{custom}`, which pass `{name}` asks for"),
            }),
            _ => Ok(()),
        }
    }
}

/// A custom pass outside of scopes that isn't for an eye: what others differ from.
const NONE: FramewrightPass<'static> = FramewrightPass {
    name: ptr::null(),
    custom: ptr::null(),
    commands: vk::CommandBuffer::null(),
    in_scope: 0,
    width: 0,
    height: 0,
    frame: 0,
    resources: ptr::null(),
    queue_family: 0,
    draw: FramewrightDraw::Custom,
    eye: FramewrightEye::None,
    both_eyes: 0,
    eye_form: FramewrightEyeForm::None,
    eye_targets: NO_EYES,
    formats: ptr::null(),
    inheritance: ptr::null(),
    rotation: 0,
};
