//! `framewright window`: a scene through a pipeline, in a window that follows files, mouse and keys.

mod choices;
mod chosen_setting;
mod followed_files;
mod libraries;
mod list;
mod opening;
mod orbit;
mod pace;
mod pictures;
mod problems;
mod session;
mod view;

use crate::command_line::windows::WindowArguments;
use crate::error::Error;
use crate::files::{inputs, outputs};
use crate::planning::{device, helper, layer};
use crate::system::{Exit, interrupt, text};
use framewright_graph::base::ReadFiles;
use framewright_vulkan::raw_window_handle::HasDisplayHandle;
use framewright_vulkan::{Canary, Device, DeviceOptions, Messages};
use session::{FrameOutcome, Session};
use std::panic;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

/// How often the command looks whether it shall end, while nothing is drawn, as in a window that nobody sees.
const ASLEEP: Duration = Duration::from_millis(50);
/// A step of a wheel, in the pixels that touch pads tell.
const WHEEL_STEP: f64 = 40.0;

const KEYS: &str = "keys: up, down: choose a setting; left, right: change it; E: one eye or two; T: rotate the screen; R: the scene's own camera; \
                    L: the list of settings and times; \
                    P: write a picture; Esc: end. The mouse turns the camera, with the right button it shifts it, the wheel \
                    goes nearer";

/// Shows the window until it is closed.
///
/// # Errors
/// If a file is wrong, no window can be opened, or the device is missing or lost.
pub(crate) fn window(arguments: &WindowArguments) -> Result<Exit, Error> {
    inputs::are_there(&arguments.pipeline.file, &arguments.drawn.scene)?;
    if arguments.validate {
        layer::under_the_current_one()?;
    }
    outputs::prepare(arguments.output.iter().map(|path| &**path), &ReadFiles::default())?;
    interrupt::watch();
    let events = event_loop()?;
    events.set_control_flow(ControlFlow::Poll);
    let mut app = App { arguments, open: None, ended: None };
    events.run_app(&mut app).map_err(no_window)?;
    if let Some(Err(error)) = app.ended {
        return Err(error);
    }
    let Some(OpenWindow { session, messages, canary, device, .. }) = app.open else { return Ok(Exit::Fine) };
    // The layer may have something to say about the device's end too.
    drop((session, device));
    Ok(if canary.is_some() && report(&messages) { Exit::Found } else { Exit::Fine })
}

/// The connection to the window system. `winit` panics where a library is missing that it opens late, or the server has no
/// keyboards or pointers; nothing of this program's own runs meanwhile.
fn event_loop() -> Result<EventLoop<()>, Error> {
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let opened = panic::catch_unwind(EventLoop::new);
    panic::set_hook(hook);
    match opened {
        Ok(opened) => opened.map_err(no_window),
        Err(panicked) => {
            let words = panicked.downcast_ref::<&str>().map(|words| (*words).to_owned());
            let words = words.or_else(|| panicked.downcast_ref::<String>().cloned());
            Err(no_window(words.unwrap_or_default()))
        }
    }
}

/// The error of a window system that opens no window.
fn no_window(error: impl std::fmt::Display) -> Error {
    let reason = error.to_string();
    if let Some(packages) = libraries::missing(&reason) {
        return Error::NoWindowLibrary { packages };
    }
    // `winit` begins with the place in its own code.
    let reason =
        reason.rsplit_once(".rs:").and_then(|(_, after)| after.split_once(": ")).map(|(_, said)| said.to_owned());
    Error::NoWindow { reason: reason.unwrap_or_else(|| error.to_string()) }
}

/// Says what the validation layer found. Returns whether there was anything.
fn report(messages: &Messages) -> bool {
    let messages = messages.distinct();
    let findings: Vec<_> = messages.iter().map(|(message, _)| message).filter(|message| message.is_finding()).collect();
    for finding in &findings {
        text::say(&format!("finding: {}: {}", text::escape(&finding.id), text::escape(&finding.located())));
    }
    text::say(&format!("validation: {}", text::count(findings.len(), "finding", "findings")));
    !findings.is_empty()
}

/// The window and what happens to it.
struct App<'a> {
    arguments: &'a WindowArguments,
    open: Option<OpenWindow<'a>>,
    /// How it ended.
    ended: Option<Result<(), Error>>,
}

/// An open window.
struct OpenWindow<'a> {
    session: Session<'a>,
    device: Device,
    messages: Messages,
    canary: Option<Canary>,
    /// Whether the system was asked to say when the next frame is to be drawn. On Wayland it doesn't while nobody sees the window: there a
    /// frame that is shown all the same would wait for that.
    asked: bool,
    /// The button that is held, of those that move the camera.
    held: Option<MouseButton>,
    cursor: [f64; 2],
    window: Arc<Window>,
}

impl<'a> App<'a> {
    /// Opens the window.
    fn open(&mut self, events: &ActiveEventLoop) -> Result<OpenWindow<'a>, Error> {
        let arguments = self.arguments;
        let size = PhysicalSize::new(arguments.size.width, arguments.size.height);
        let attributes = Window::default_attributes().with_title("framewright").with_inner_size(size);
        let window = Arc::new(events.create_window(attributes).map_err(no_window)?);
        let display = events.display_handle().map_err(no_window)?.as_raw();
        let helper = helper::of(&arguments.pipeline)?;
        let device = Device::open(&DeviceOptions {
            choice: device::to_draw_on(arguments.device.name.as_deref())?,
            validation: arguments.validate,
            helper: Some(helper.clone()),
            display: Some(display),
            ..DeviceOptions::default()
        })?;
        device.cancel_when(interrupt::asked);
        let canary = if arguments.validate { Some(device.canary()?) } else { None };
        let surface = device.surface(window.clone())?;
        let PhysicalSize { width, height } = window.inner_size();
        let mut session = Session::new(arguments, &device, helper, &surface, [width, height])?;
        session.rescaled(window.scale_factor());
        text::say(KEYS);
        let messages = device.messages();
        Ok(OpenWindow { session, device, messages, canary, asked: false, held: None, cursor: [0.0; 2], window })
    }

    fn end(&mut self, events: &ActiveEventLoop, how: Result<(), Error>) {
        if self.ended.is_none() {
            // Work that Ctrl-C gave up is no error.
            self.ended = Some(how.or_else(|error| if interrupt::asked() { Ok(()) } else { Err(error) }));
        }
        events.exit();
    }

    /// Draws a frame, or waits where there is nothing to draw into.
    fn draw(&mut self, events: &ActiveEventLoop) -> Result<(), Error> {
        let Some(open) = self.open.as_mut().filter(|_| self.ended.is_none()) else { return Ok(()) };
        let drawn = open.session.frame(|| open.window.pre_present_notify())?;
        open.asked = drawn == FrameOutcome::Shown;
        if open.asked {
            open.window.request_redraw();
        }
        events.set_control_flow(match drawn {
            FrameOutcome::Shown | FrameOutcome::Nothing => ControlFlow::WaitUntil(Instant::now() + ASLEEP),
            FrameOutcome::OutOfDate => ControlFlow::Poll,
        });
        if let Some(title) = open.session.title() {
            open.window.set_title(&title);
        }
        if self.arguments.frames.is_some_and(|most| open.session.shown() >= most) {
            self.close(events);
        }
        Ok(())
    }

    /// Closes the window, and writes the last picture if the command line asks for it.
    fn close(&mut self, events: &ActiveEventLoop) {
        let written = match (&mut self.open, &self.arguments.output) {
            (Some(open), Some(path)) if self.ended.is_none() => open.session.write(path),
            _ => Ok(()),
        };
        self.end(events, written);
    }

    fn happens(&mut self, events: &ActiveEventLoop, event: WindowEvent) -> Result<(), Error> {
        let Some(OpenWindow { session, held, cursor, window, .. }) = &mut self.open else { return Ok(()) };
        match event {
            WindowEvent::CloseRequested => self.close(events),
            WindowEvent::RedrawRequested => return self.draw(events),
            WindowEvent::Resized(PhysicalSize { width, height }) => session.resized([width, height]),
            WindowEvent::ScaleFactorChanged { scale_factor, .. } => session.rescaled(scale_factor),
            WindowEvent::CursorMoved { position, .. } => {
                let moved = [position.x - cursor[0], position.y - cursor[1]];
                *cursor = [position.x, position.y];
                match held {
                    Some(MouseButton::Left) => session.orbit().turn(moved),
                    Some(_) => {
                        let height = f64::from(window.inner_size().height.max(1));
                        session.orbit().shift(moved.map(|side| side / height));
                    }
                    None => {}
                }
            }
            WindowEvent::MouseInput { state: ElementState::Pressed, button, .. }
                if matches!(button, MouseButton::Left | MouseButton::Right | MouseButton::Middle) =>
            {
                *held = Some(button);
            }
            WindowEvent::MouseInput { state: ElementState::Released, button, .. } if *held == Some(button) => {
                *held = None;
            }
            WindowEvent::MouseWheel { delta, .. } => session.orbit().approach(match delta {
                MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
                MouseScrollDelta::PixelDelta(pixels) => pixels.y / WHEEL_STEP,
            }),
            // A key that is held while the window comes into focus is told twice, once as synthetic.
            WindowEvent::KeyboardInput {
                event: KeyEvent { logical_key, state: ElementState::Pressed, repeat, .. },
                is_synthetic: false,
                ..
            } if !repeat || matches!(logical_key, Key::Named(_)) => return self.pressed(events, &logical_key),
            _ => {}
        }
        Ok(())
    }

    fn pressed(&mut self, events: &ActiveEventLoop, key: &Key) -> Result<(), Error> {
        let Some(OpenWindow { session, .. }) = &mut self.open else { return Ok(()) };
        match key {
            Key::Named(NamedKey::Escape) => return self.happens(events, WindowEvent::CloseRequested),
            Key::Named(NamedKey::ArrowUp) => session.choose_setting(false),
            Key::Named(NamedKey::ArrowDown) => session.choose_setting(true),
            Key::Named(NamedKey::ArrowLeft) => session.turn_setting(false)?,
            Key::Named(NamedKey::ArrowRight) => session.turn_setting(true)?,
            Key::Character(letter) => match letter.to_lowercase().as_str() {
                "e" => session.turn_eyes()?,
                "t" => session.turn_screen()?,
                "r" => session.orbit().reset(),
                "l" => session.turn_list(),
                "p" => session.take_picture(),
                _ => {}
            },
            _ => {}
        }
        Ok(())
    }
}

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_none() {
            match self.open(events) {
                Ok(open) => self.open = Some(open),
                Err(error) => self.end(events, Err(error)),
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Err(error) = self.happens(events, event) {
            self.end(events, Err(error));
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if interrupt::asked() {
            return self.close(events);
        }
        if self.open.as_ref().is_some_and(|open| open.asked) {
            return events.set_control_flow(ControlFlow::WaitUntil(Instant::now() + ASLEEP));
        }
        if let Err(error) = self.draw(events) {
            self.end(events, Err(error));
        }
    }
}
