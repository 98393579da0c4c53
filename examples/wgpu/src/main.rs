//! A program of wgpu's and egui's that shows a pipeline of Framewright: wgpu makes the device, Framewright draws into a texture of wgpu's, and
//! egui draws a panel with the pipeline's settings over it.
//!
//! `cargo run --manifest-path examples/wgpu/Cargo.toml` draws without a window, clicks on a setting in the panel, and writes `out/wgpu.png`
//! before and `out/wgpu_clicked.png` after that.

mod gpu;
mod panel;
mod screen;

use framewright::{Change, Renderer, RendererOptions, Scene, SceneDrawSource, load_scene};
use gpu::Gpu;
use panel::Panel;
use screen::{EXTENT, FORMAT, Screen};
use std::error::Error;

/// The program. What is made from the device is dropped before it, which the screen has.
struct Program {
    renderer: Renderer,
    objects: Option<SceneDrawSource>,
    scene: Scene,
    panel: Panel,
    screen: Screen,
}

impl Program {
    fn open() -> Result<Program, Box<dyn Error>> {
        let screen = Screen::new(Gpu::open()?)?;
        let scene = load_scene("spheres_and_cubes")?;
        let mut renderer = Renderer::open(&screen.gpu.framewright, "forward", RendererOptions::default())?;
        renderer.set_scene(&scene);
        renderer.set_extent(EXTENT)?;
        let panel = Panel::new(&screen.gpu.device, FORMAT, EXTENT);
        Ok(Program { renderer, objects: None, scene, panel, screen })
    }

    /// A frame: the panel is laid out, Framewright draws with what was chosen in it, and egui draws the panel over that.
    fn frame(&mut self, events: Vec<egui::Event>) -> Result<(), Box<dyn Error>> {
        let values = self.renderer.plan().map_or(&[][..], |plan| &plan.settings);
        for (name, value) in self.panel.run(events, &self.renderer.document().settings, values) {
            self.renderer.set(&name, value)?;
        }
        let prepared = self.renderer.prepare()?;
        let objects = match (self.objects.take(), prepared.change) {
            (Some(objects), Change::Nothing) => objects,
            (_, change) => {
                let device = &self.screen.gpu.framewright;
                let objects = SceneDrawSource::for_plan(device, &self.scene, EXTENT, prepared.plan)?;
                if matches!(change, Change::Executor { .. }) {
                    self.screen.import_into(&mut self.renderer)?;
                }
                objects
            }
        };
        self.screen.draw(&mut self.renderer, self.objects.insert(objects))?;

        let mut encoder = self.screen.encoder();
        self.panel.paint(&self.screen.gpu, &mut encoder, &self.screen.view());
        self.screen.submit(encoder)
    }

    /// A frame for each event of a click on the control of a setting.
    fn click(&mut self, setting: &str) -> Result<(), Box<dyn Error>> {
        let control = self.panel.controls.get(setting).ok_or("the panel has no such setting")?;
        let pos = control.left_center() + egui::vec2(8.0, 0.0);
        let (button, modifiers) = (egui::PointerButton::Primary, egui::Modifiers::default());
        let pressed = |pressed| egui::Event::PointerButton { pos, button, pressed, modifiers };
        for event in [egui::Event::PointerMoved(pos), pressed(true), pressed(false), egui::Event::PointerGone] {
            self.frame(vec![event])?;
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut program = Program::open()?;
    // egui knows how large the panel is when it was laid out once.
    for _ in 0..3 {
        program.frame(Vec::new())?;
    }
    program.screen.write("out/wgpu.png")?;
    program.click("tone_mapping")?;
    // The panel shows the new value one frame later.
    program.frame(Vec::new())?;
    program.screen.write("out/wgpu_clicked.png")?;
    let panel = program.panel.rect;
    println!("the panel: {} {} {} {}", panel.left(), panel.top(), panel.right(), panel.bottom());
    Ok(())
}
