//! Surfaces: what a window system shows pictures in.

use crate::base::Error;
use crate::gpu::{Device, Gpu};
use ash::{khr, vk};
use raw_window_handle::{HasDisplayHandle, HasWindowHandle, RawDisplayHandle, RawWindowHandle};
use std::any::Any;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The surface of a window. Clones share it; it is destroyed when the last clone and the last
/// swapchain made for it are gone.
#[derive(Clone)]
pub struct Surface {
    pub(super) handle: Arc<SurfaceHandle>,
}

/// Vulkan's surface.
pub(super) struct SurfaceHandle {
    pub(super) gpu: Arc<Gpu>,
    pub(super) functions: khr::surface::Instance,
    pub(super) raw: vk::SurfaceKHR,
    /// For one thread at a time.
    alone: Mutex<()>,
    /// The loader that its functions are of.
    _entry: ash::Entry,
    /// Outlives the surface.
    _window: Option<Arc<dyn Any + Send + Sync>>,
}

impl Device {
    /// The surface of a window, which is kept as long as the surface (`winit` and others have such windows). The device must have been
    /// opened for its display ([`DeviceOptions::display`](crate::DeviceOptions::display)).
    ///
    /// # Errors
    /// [`Error::CantPresent`] if driver or device can't show anything in such a window, or the window is gone.
    pub fn surface<W>(&self, window: Arc<W>) -> Result<Surface, Error>
    where
        W: HasDisplayHandle + HasWindowHandle + Send + Sync + 'static,
    {
        let gone = |_| self.cant_present("the window has no handles any more");
        let display = window.display_handle().map_err(gone)?.as_raw();
        let handle = window.window_handle().map_err(gone)?.as_raw();
        // SAFETY: the handles are valid as long as the window, which the surface keeps.
        unsafe { self.surface_of(display, handle, Some(window.clone())) }
    }

    /// The surface of a window, by the handles of the window system.
    ///
    /// # Errors
    /// Those of [`Device::surface`].
    ///
    /// # Safety
    /// The handles must be valid, and window and display outlive the surface.
    pub unsafe fn surface_from_raw(
        &self,
        display: RawDisplayHandle,
        window: RawWindowHandle,
    ) -> Result<Surface, Error> {
        // SAFETY: the caller's promise.
        unsafe { self.surface_of(display, window, None) }
    }

    /// # Safety
    /// The handles must be valid as long as `owner` lives, or the surface.
    unsafe fn surface_of(
        &self,
        display: RawDisplayHandle,
        window: RawWindowHandle,
        owner: Option<Arc<dyn Any + Send + Sync>>,
    ) -> Result<Surface, Error> {
        if !self.gpu.instance.has_surfaces_of(display) {
            return Err(self.cant_present("the device was opened for another display, or for none"));
        }
        self.surface_by(owner, |entry, instance| {
            // SAFETY: the caller's promise. The extensions for the display are on.
            unsafe { ash_window::create_surface(entry, instance, display, window, None) }
        })
    }

    /// A surface that the program made itself, from this device's instance. It is destroyed here.
    ///
    /// # Errors
    /// Those of [`Device::surface`]. The surface is destroyed all the same, unless the device can't present at all.
    ///
    /// # Safety
    /// The surface must be of the same instance as the device, live, and be used by nobody else. Its window outlives it.
    pub unsafe fn adopt_surface(&self, surface: vk::SurfaceKHR) -> Result<Surface, Error> {
        self.surface_by(None, |_, _| Ok(surface))
    }

    fn surface_by(
        &self,
        owner: Option<Arc<dyn Any + Send + Sync>>,
        create: impl FnOnce(&ash::Entry, &ash::Instance) -> Result<vk::SurfaceKHR, vk::Result>,
    ) -> Result<Surface, Error> {
        let gpu = &self.gpu;
        if !gpu.presents {
            return Err(self.cant_present("it has no VK_KHR_swapchain, or the instance no VK_KHR_surface"));
        }
        let entry = gpu.instance.entry()?;
        let raw = create(&entry, &gpu.instance.raw).map_err(|result| match result {
            vk::Result::ERROR_EXTENSION_NOT_PRESENT => self.cant_present("it knows no surfaces of this window system"),
            result => Error::Vulkan { doing: "making a surface", result },
        })?;
        let functions = khr::surface::Instance::new(&entry, &gpu.instance.raw);
        let (gpu, alone) = (gpu.clone(), Mutex::new(()));
        let handle = SurfaceHandle { gpu, functions, raw, alone, _entry: entry, _window: owner };
        let surface = Surface { handle: Arc::new(handle) };
        let gpu = &self.gpu;
        let family = gpu.queues.families.graphics.index;
        // SAFETY: the surface is of the same instance as the device, which has the queue family.
        let supported =
            unsafe { surface.handle.functions.get_physical_device_surface_support(gpu.physical, family, raw) };
        match supported {
            Ok(true) => Ok(surface),
            _ => Err(self.cant_present("its graphics queue can't present to this surface")),
        }
    }

    fn cant_present(&self, why: &'static str) -> Error {
        Error::CantPresent { device: self.summary().name.clone(), why }
    }
}

impl SurfaceHandle {
    /// The surface for one thread at a time, which makes a swapchain for it.
    pub(super) fn alone(&self) -> MutexGuard<'_, ()> {
        self.alone.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What swapchains for it can be.
    pub(super) fn capabilities(&self) -> Result<vk::SurfaceCapabilitiesKHR, Error> {
        // SAFETY: the surface lives, and is of the same instance as the device.
        unsafe { self.functions.get_physical_device_surface_capabilities(self.gpu.physical, self.raw) }
            .map_err(presenting("asking for the surface's size"))
    }

    /// Its formats.
    pub(super) fn formats(&self) -> Result<Vec<vk::SurfaceFormatKHR>, Error> {
        // SAFETY: as above.
        unsafe { self.functions.get_physical_device_surface_formats(self.gpu.physical, self.raw) }
            .map_err(presenting("asking for the surface's formats"))
    }

    /// Its present modes.
    pub(super) fn present_modes(&self) -> Result<Vec<vk::PresentModeKHR>, Error> {
        // SAFETY: as above.
        unsafe { self.functions.get_physical_device_surface_present_modes(self.gpu.physical, self.raw) }
            .map_err(presenting("asking for the surface's present modes"))
    }
}

impl Drop for SurfaceHandle {
    fn drop(&mut self) {
        if !self.gpu.is_abandoned() {
            // SAFETY: swapchains for it hold on to it, and are gone.
            unsafe { self.functions.destroy_surface(self.raw, None) };
        }
    }
}

/// A failed call of a surface or swapchain, for `map_err`.
pub(super) fn presenting(doing: &'static str) -> impl FnOnce(vk::Result) -> Error {
    move |result| match result {
        vk::Result::ERROR_SURFACE_LOST_KHR => Error::SurfaceLost { doing },
        result => Error::vulkan(doing)(result),
    }
}
