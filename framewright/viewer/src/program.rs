//! The page of a running program: its own Plan with its own draws.

use crate::page::{Page, ShownPlan, page_data};
use crate::server::{Choice, Controls, LiveState, Output, PublishedState, Server};
use crate::times::{LastFrames, Times};
use framewright::{Error, Renderer};
use framewright_graph::plan::{Detail, Resource};
use framewright_lab::outputs;
use framewright_lab::picture::FileFormat;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::hash::{BuildHasher, RandomState};
use std::io;
use std::net::{SocketAddr, ToSocketAddrs};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The page is told of times and pictures this often.
const EVERY: Duration = Duration::from_millis(500);

/// A page that shows a running program, as long as this lives.
///
/// Nothing is looked at, copied or allocated while no page is open: a frame costs one atomic load then.
///
/// ```no_run
/// # fn frames(renderer: &mut framewright::Renderer) -> Result<(), Box<dyn std::error::Error>> {
/// let mut viewer = framewright_viewer::Viewer::serve("127.0.0.1:7117")?;
/// println!("{}", viewer.url());
/// loop {
///     // … the program draws a frame with `renderer` …
///     viewer.frame(renderer)?;
/// }
/// # }
/// ```
#[derive(Debug)]
pub struct Viewer {
    server: Server,
    /// What tells it from earlier ones of the same address.
    id: Arc<str>,
    version: u64,
    shown: ShownPlanState,
    last: LastFrames,
    told: Option<Instant>,
    /// What the last choice did, if it was refused.
    mistakes: Vec<Value>,
    chosen: BTreeMap<String, String>,
}

/// The Plan that is shown.
#[derive(Debug, Default)]
struct ShownPlanState {
    /// The renderer's number of it.
    plan: Option<u64>,
    /// The state that had it first.
    version: u64,
    page: String,
    controls: Controls,
    outputs: Vec<Output>,
    pictures: Arc<BTreeMap<String, Arc<[u8]>>>,
    /// The last frame whose times were taken.
    frame: Option<u64>,
}

impl Viewer {
    /// Serves a page at `address`, such as `127.0.0.1:7117`; with port 0 at one that is free. The page is for those alone who know its
    /// [address](Viewer::url), of which a part is secret. An address that other machines reach shows the program's files to them.
    ///
    /// # Errors
    /// If there is no such address, or it can't be had.
    pub fn serve(address: impl ToSocketAddrs) -> io::Result<Viewer> {
        let none = || io::Error::new(io::ErrorKind::InvalidInput, "there is no such address");
        let address: SocketAddr = address.to_socket_addrs()?.next().ok_or_else(none)?;
        let token = format!("{:016x}{:016x}", secret(), secret());
        Ok(Viewer {
            server: Server::start(address, Some(&token))?,
            id: format!("{:016x}", secret()).into(),
            version: 0,
            shown: ShownPlanState::default(),
            last: LastFrames::default(),
            told: None,
            mistakes: Vec::new(),
            chosen: BTreeMap::new(),
        })
    }

    /// Where the page is.
    #[must_use]
    pub fn url(&self) -> String {
        self.server.url()
    }

    /// Shows the frame that `renderer` drew last, and has it take the settings that were chosen in the page: the next frame has them. Times
    /// are shown if the executor's options have [`timestamps`](framewright_vulkan::ExecutorOptions::timestamps) set.
    ///
    /// # Errors
    /// Those of reading what the device left, such as a lost device. A setting that is refused is told in the page.
    pub fn frame(&mut self, renderer: &mut Renderer) -> Result<(), Error> {
        if !self.server.is_watched() {
            return Ok(());
        }
        let chose = self.take_choices(renderer);
        let anew = renderer.plan().is_some() && self.shown.plan != Some(renderer.plans());
        if anew {
            self.show_plan(renderer)?;
        }
        self.take_times(renderer)?;
        if !anew && !chose && self.told.is_some_and(|told| told.elapsed() < EVERY) {
            return Ok(());
        }
        self.take_pictures(renderer)?;
        self.publish()
    }

    /// Gives the renderer what was chosen. Whether there was anything.
    fn take_choices(&mut self, renderer: &mut Renderer) -> bool {
        let choices: Vec<Choice> = self.server.choices().try_iter().collect();
        for choice in &choices {
            let mut refused = Vec::new();
            match choice {
                Choice::Set(values) => {
                    for (name, value) in values {
                        refused.extend(self.set(renderer, name, value).err());
                    }
                }
                Choice::Preset(preset) => refused.extend(self.take_back(renderer, preset.as_deref()).err()),
                Choice::Exactly { preset, set } => {
                    refused.extend(self.take_back(renderer, preset.as_deref()).err());
                    for (name, value) in set {
                        refused.extend(self.set(renderer, name, value).err());
                    }
                }
            }
            self.mistakes = refused.iter().map(mistake).collect();
        }
        !choices.is_empty()
    }

    fn set(&mut self, renderer: &mut Renderer, name: &str, value: &str) -> Result<(), Error> {
        renderer.set(name, value)?;
        self.chosen.insert(name.to_owned(), value.to_owned());
        Ok(())
    }

    /// Takes back all that was chosen, and chooses a preset.
    fn take_back(&mut self, renderer: &mut Renderer, preset: Option<&str>) -> Result<(), Error> {
        std::mem::take(&mut self.chosen).keys().for_each(|name| renderer.unset(name));
        renderer.preset(preset)
    }

    fn show_plan(&mut self, renderer: &Renderer) -> Result<(), Error> {
        let Some(plan) = renderer.plan() else { return Ok(()) };
        let shown = ShownPlan {
            name: renderer.name(),
            plan,
            detail: Detail { objects: None, verbose: true },
            sources: Some(renderer.sources()),
            times: None,
        };
        let page = Page { plans: vec![shown], differences: None, devices: &[], captures: &[] };
        self.shown = ShownPlanState {
            plan: Some(renderer.plans()),
            version: self.version + 1,
            page: page_data(&page).map_err(no_json)?,
            controls: Controls::of(renderer.document(), plan),
            outputs: Vec::new(),
            pictures: Arc::default(),
            frame: None,
        };
        self.last = LastFrames::on(renderer.device());
        Ok(())
    }

    /// Takes the times of the newest frame that the device is done with, or of the one that the next frame waits for anyway.
    fn take_times(&mut self, renderer: &mut Renderer) -> Result<(), Error> {
        let Some(executor) = renderer.current_executor_mut() else { return Ok(()) };
        let Some(oldest) = executor.oldest_frame().filter(|frame| self.shown.frame.is_none_or(|last| *frame > last))
        else {
            return Ok(());
        };
        self.shown.frame = Some(oldest);
        self.last.add(executor.report(oldest)?);
        Ok(())
    }

    /// Reads the outputs of the last frame.
    fn take_pictures(&mut self, renderer: &mut Renderer) -> Result<(), Error> {
        let Some(executor) = renderer.current_executor_mut() else { return Ok(()) };
        let images = |(at, output): (usize, &framewright_graph::plan::Output)| match output.resource {
            Resource::Image(_) => Some((at, output.name.to_string())),
            Resource::Buffer(_) => None,
        };
        let named: Vec<(usize, String)> = executor.plan().outputs.iter().enumerate().filter_map(images).collect();
        let mut pictures = BTreeMap::new();
        self.shown.outputs.clear();
        for (at, name) in named {
            let texels = executor.read(at)?;
            let plan = executor.plan();
            // What has no picture is left out.
            let Ok(png) = outputs::encoded(FileFormat::Png, (plan, &plan.outputs[at]), vec![texels], &|_| ()) else {
                continue;
            };
            let address = format!("{}/{at}.png", self.version);
            self.shown.outputs.push(Output { name, picture: format!("picture/{address}") });
            pictures.insert(address, png.into());
        }
        self.shown.pictures = Arc::new(pictures);
        Ok(())
    }

    fn publish(&mut self) -> Result<(), Error> {
        self.version += 1;
        self.told = Some(Instant::now());
        let times = self.last.times();
        let message = self.mistakes.iter().filter_map(|one| one["message"].as_str()).collect::<Vec<_>>().join("\n");
        let live = LiveState {
            format_version: 1,
            server: &self.id,
            version: self.version,
            frame: self.shown.version,
            busy: false,
            mistakes: &Value::from(self.mistakes.clone()),
            message: &message,
            sources: &[],
            controls: &self.shown.controls,
            chosen: &self.chosen,
            preset: None,
            outputs: &self.shown.outputs,
            took: &took(times.as_ref()),
            times: times.as_ref(),
        };
        let live = serde_json::to_string(&live).map_err(no_json)?;
        self.server.publish(PublishedState {
            version: self.version,
            server: Arc::clone(&self.id),
            json: format!("{{\"live\":{live},\"page\":{}}}", self.shown.page).into(),
            pictures: Arc::clone(&self.shown.pictures),
            history: Arc::default(),
        });
        Ok(())
    }
}

/// A number that nobody guesses: the keys of each are random.
fn secret() -> u64 {
    RandomState::new().hash_one(Instant::now())
}

fn mistake(error: &Error) -> Value {
    json!({ "message": error.to_string(), "help": null, "labels": [] })
}

/// What the frames took, in words.
fn took(times: Option<&Times>) -> String {
    times.map_or_else(String::new, |times| {
        format!(
            "a frame takes {:.2} ms of the device, and {:.2} ms to record",
            times.frame.median, times.recording.median
        )
    })
}

fn no_json(error: serde_json::Error) -> Error {
    framewright_vulkan::Error::BadPlan { what: format!("it has no JSON form: {error}") }.into()
}
