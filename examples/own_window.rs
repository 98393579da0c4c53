//! A pipeline in a window of the program's own, which may be resized while it is shown.
//!
//! `cargo run --package framewright --example own_window`; a number behind it ends the program after so many frames.

use framewright::{
    Change, Device, DeviceOptions, Presentation, Renderer, RendererOptions, Scene, SceneDrawSource, Swapchain,
    SwapchainOptions, load_scene,
};
use std::error::Error;
use std::sync::Arc;
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::raw_window_handle::HasDisplayHandle;
use winit::window::{Window, WindowId};

/// A window, and what is drawn in it.
struct Shown {
    window: Arc<Window>,
    swapchain: Swapchain,
    renderer: Renderer,
    scene: Scene,
    objects: Option<SceneDrawSource>,
    /// Whether the images of the swapchain no longer fit the window.
    refit: bool,
    frames: u64,
}

impl Shown {
    fn open(events: &ActiveEventLoop) -> Result<Shown, Box<dyn Error>> {
        let window = Arc::new(events.create_window(Window::default_attributes().with_title("own window"))?);
        // The device is opened for the display, the surface made for the window, which it keeps.
        let display = Some(events.display_handle()?.as_raw());
        let device = Device::open(&DeviceOptions { display, ..DeviceOptions::default() })?;
        let surface = device.surface(window.clone())?;
        let swapchain = Swapchain::new(&surface, &SwapchainOptions::default())?;
        let scene = load_scene("spheres_and_cubes")?;
        let mut options = RendererOptions::default();
        options.executor.frames_in_flight = 2;
        let mut renderer = Renderer::open(&device, "forward", options)?;
        renderer.set_scene(&scene);
        Ok(Shown { window, swapchain, renderer, scene, objects: None, refit: true, frames: 0 })
    }

    /// Draws a frame and has it shown. Returns whether the window has an area.
    fn draw(&mut self) -> Result<bool, Box<dyn Error>> {
        if self.refit {
            let size = self.window.inner_size();
            if !self.swapchain.resize(size.into())? {
                return Ok(false);
            }
            self.renderer.fit(&self.swapchain)?;
            self.refit = false;
        }
        let device = self.renderer.device().clone();
        let prepared = self.renderer.prepare()?;
        let objects = match (self.objects.take(), prepared.change) {
            (Some(objects), Change::Nothing) => objects,
            _ => SceneDrawSource::for_plan(&device, &self.scene, prepared.plan.extent, prepared.plan)?,
        };
        let objects = self.objects.insert(objects);
        match self.renderer.present(objects, &mut self.swapchain)? {
            Presentation::Shown(_) => {}
            // The window has another size by now, or none.
            _ => self.refit = true,
        }
        self.frames += 1;
        Ok(true)
    }
}

/// The program: how many frames it shows, its window, and what went wrong.
struct Program {
    most: u64,
    shown: Option<Shown>,
    problem: Option<Box<dyn Error>>,
}

impl ApplicationHandler for Program {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Shown::open(events) {
            Ok(shown) => self.shown = Some(shown),
            Err(problem) => {
                self.problem = Some(problem);
                events.exit();
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match (event, &mut self.shown) {
            (WindowEvent::CloseRequested, _) => events.exit(),
            (WindowEvent::Resized(_), Some(shown)) => shown.refit = true,
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(shown) = &mut self.shown else { return };
        match shown.draw() {
            Ok(true) => events.set_control_flow(ControlFlow::Poll),
            // A minimised window: wait until something happens to it.
            Ok(false) => events.set_control_flow(ControlFlow::Wait),
            Err(problem) => self.problem = Some(problem),
        }
        if self.problem.is_some() || shown.frames >= self.most {
            events.exit();
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let most = std::env::args().nth(1).map_or(Ok(u64::MAX), |frames| frames.parse())?;
    let mut program = Program { most, shown: None, problem: None };
    EventLoop::new()?.run_app(&mut program)?;
    match program.problem {
        Some(problem) => Err(problem),
        None => {
            println!("{} frames were shown", program.shown.map_or(0, |shown| shown.frames));
            Ok(())
        }
    }
}
