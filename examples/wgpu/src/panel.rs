//! The program's own UI: a panel with the settings of a pipeline, drawn by egui.

use crate::gpu::Gpu;
use crate::screen::pass;
use egui_wgpu::{RendererOptions, ScreenDescriptor};
use framewright::graph::language::{Setting, SettingKind};
use framewright::graph::plan::SettingUsed;
use std::collections::BTreeMap;

/// The panel.
pub(crate) struct Panel {
    context: egui::Context,
    painter: egui_wgpu::Renderer,
    screen: ScreenDescriptor,
    output: egui::FullOutput,
    /// Where it stands.
    pub(crate) rect: egui::Rect,
    /// Where the control of each setting stands.
    pub(crate) controls: BTreeMap<String, egui::Rect>,
}

impl Panel {
    pub(crate) fn new(device: &wgpu::Device, format: wgpu::TextureFormat, size: [u32; 2]) -> Panel {
        let context = egui::Context::default();
        context.global_style_mut(|style| {
            // Nothing is drawn outside of the panel, and it is there at once.
            style.visuals.window_shadow = egui::Shadow::NONE;
            style.animation_time = 0.0;
        });
        Panel {
            context,
            painter: egui_wgpu::Renderer::new(device, format, RendererOptions::PREDICTABLE),
            screen: ScreenDescriptor { size_in_pixels: size, pixels_per_point: 1.0 },
            output: egui::FullOutput::default(),
            rect: egui::Rect::NOTHING,
            controls: BTreeMap::new(),
        }
    }

    /// Lays the panel out, and returns the values that the user chose.
    pub(crate) fn run(
        &mut self,
        events: Vec<egui::Event>,
        settings: &[Setting],
        values: &[SettingUsed],
    ) -> Vec<(String, String)> {
        let [width, height] = self.screen.size_in_pixels.map(|side| side as f32);
        let screen_rect = Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(width, height)));
        let input = egui::RawInput { screen_rect, events, ..Default::default() };
        let (mut chosen, mut controls, mut rect) = (Vec::new(), BTreeMap::new(), egui::Rect::NOTHING);
        self.output = self.context.run_ui(input, |ui| {
            let window = egui::Window::new("forward").fixed_pos([12.0, 12.0]).resizable(false).collapsible(false);
            let shown = window.show(ui.ctx(), |ui| {
                for setting in settings {
                    let name = &*setting.name.text;
                    let Some(used) = values.iter().find(|used| *used.name == *name) else { continue };
                    let (control, value) = control(ui, setting, &used.value);
                    controls.insert(name.to_owned(), control);
                    chosen.extend(value.map(|value| (name.to_owned(), value)));
                }
            });
            rect = shown.map_or(egui::Rect::NOTHING, |shown| shown.response.rect);
        });
        (self.controls, self.rect) = (controls, rect);
        chosen
    }

    /// Draws the panel over a picture.
    pub(crate) fn paint(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView) {
        let mut output = std::mem::take(&mut self.output);
        for (id, changes) in output.textures_delta.set.drain() {
            for change in changes {
                self.painter.update_texture(&gpu.device, &gpu.queue, id, &change);
            }
        }
        let shapes = self.context.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point);
        self.painter.update_buffers(&gpu.device, &gpu.queue, encoder, &shapes, &self.screen);
        self.painter.render(&mut pass(encoder, view, wgpu::LoadOp::Load), &shapes, &self.screen);
        for id in output.textures_delta.free.drain() {
            self.painter.free_texture(&id);
        }
    }
}

/// Shows the control of a setting, and returns where, with the value that the user chose.
fn control(ui: &mut egui::Ui, setting: &Setting, value: &str) -> (egui::Rect, Option<String>) {
    let name = &*setting.name.text;
    match &setting.kind {
        SettingKind::Bool { .. } => {
            let mut on = value == "true";
            let shown = ui.checkbox(&mut on, name);
            (shown.rect, shown.changed().then(|| on.to_string()))
        }
        SettingKind::OneOf { of, .. } => {
            let buttons = |ui: &mut egui::Ui| {
                ui.label(name);
                let clicked = |one: &&i64| ui.selectable_label(value == one.to_string(), one.to_string()).clicked();
                of.iter().filter(clicked).last().map(i64::to_string)
            };
            let shown = ui.horizontal(buttons);
            (shown.response.rect, shown.inner)
        }
        SettingKind::Number { min, max, .. } => {
            let mut number = value.parse().unwrap_or(*min);
            let shown = ui.add(egui::Slider::new(&mut number, *min..=*max).text(name));
            (shown.rect, shown.changed().then(|| number.to_string()))
        }
        _ => (ui.label(format!("{name} = {value}")).rect, None),
    }
}
