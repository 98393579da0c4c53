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
    /// Whether the next frame waits for the system to want it, or for a window with an area.
    waits: bool,
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
        Ok(Shown { window, swapchain, renderer, scene, objects: None, refit: true, waits: false, frames: 0 })
    }

    /// Draws a frame, and has it shown if the images fit the window.
    fn draw(&mut self) -> Result<Presentation, Box<dyn Error>> {
        if self.refit {
            let size = self.window.inner_size();
            if !self.swapchain.resize(size.into())? {
                return Ok(Presentation::NoArea);
            }
            self.renderer.fit(&self.swapchain)?;
        }
        let device = self.renderer.device().clone();
        let prepared = self.renderer.prepare()?;
        let objects = match (self.objects.take(), prepared.change) {
            (Some(objects), Change::Nothing) => objects,
            _ => SceneDrawSource::for_plan(&device, &self.scene, prepared.plan.extent, prepared.plan)?,
        };
        let objects = self.objects.insert(objects);
        // The system then says when it wants another frame: on Wayland not while nobody sees the window.
        self.window.pre_present_notify();
        let shown = self.renderer.present(objects, &mut self.swapchain)?;
        self.refit = !matches!(shown, Presentation::Shown(_));
        Ok(shown)
    }
}

/// The program: how many frames it shows, its window, and what went wrong.
struct Program {
    most: u64,
    shown: Option<Shown>,
    problem: Option<Box<dyn Error>>,
}

impl Program {
    fn draw(&mut self, events: &ActiveEventLoop) {
        let Some(shown) = self.shown.as_mut().filter(|_| !events.exiting()) else { return };
        let drawn = shown.draw();
        shown.waits = true;
        match drawn {
            Ok(Presentation::Shown(_) | Presentation::Suboptimal(_)) => {
                shown.frames += 1;
                shown.window.request_redraw();
            }
            Ok(Presentation::NoArea) => {}
            // The window has another size by now.
            Ok(_) => shown.waits = false,
            Err(problem) => self.problem = Some(problem),
        }
        events.set_control_flow(if shown.waits { ControlFlow::Wait } else { ControlFlow::Poll });
        if self.problem.is_some() || shown.frames >= self.most {
            events.exit();
        }
    }
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
            (WindowEvent::Resized(_), Some(shown)) => (shown.refit, shown.waits) = (true, false),
            (WindowEvent::RedrawRequested, _) => self.draw(events),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if self.shown.as_ref().is_some_and(|shown| !shown.waits) {
            self.draw(events);
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
