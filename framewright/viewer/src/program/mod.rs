//! The page of a running program: its own Plans with its own draws.

mod files;
mod renderers;
mod save_error;
mod shown_frame;

pub use save_error::SaveError;

use crate::open_questions::{OpenQuestions, no_json};
use crate::server::{About, Choice, LiveProgram, LiveState, Look, PublishedState, Server, ShownMistakes, saved_page};
use crate::times::Times;
use framewright::{Error, Renderer};
use renderers::Renderers;
use shown_frame::ShownFrame;
use std::collections::BTreeMap;
use std::hash::{BuildHasher, RandomState};
use std::io;
use std::net::{SocketAddr, ToSocketAddrs};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The page is told of times and pictures this often,
const EVERY: Duration = Duration::from_millis(500);
/// and of another Plan this often, where each frame has another one.
const EVERY_PLAN: Duration = Duration::from_millis(100);

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
///
/// A program that draws with several renderers calls [`Viewer::frame`] for each of them. The page shows one, which is chosen there, and
/// only that one costs anything.
#[derive(Debug)]
pub struct Viewer {
    server: Server,
    /// What tells it from earlier ones of the same address.
    id: Arc<str>,
    version: u64,
    renderers: Renderers,
    look: Look,
    shown: ShownFrame,
    questions: OpenQuestions,
    told: Option<Instant>,
    /// What was refused of the last choice.
    refused: Option<ShownMistakes>,
    /// What was chosen, by the renderers' ids.
    chosen: BTreeMap<u64, BTreeMap<String, String>>,
    with_sources: bool,
    /// Where the last frame goes of a device that is lost.
    lost_folder: Option<PathBuf>,
    lost_page: Option<PathBuf>,
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
            renderers: Renderers::default(),
            look: Look::default(),
            shown: ShownFrame::default(),
            questions: OpenQuestions::default(),
            told: None,
            refused: None,
            chosen: BTreeMap::new(),
            with_sources: true,
            lost_folder: None,
            lost_page: None,
        })
    }

    /// Where the page is.
    #[must_use]
    pub fn url(&self) -> String {
        self.server.url()
    }

    /// Leaves the texts of the pipelines' files out of all that is saved from now on.
    pub fn leave_out_sources(&mut self) {
        self.with_sources = false;
    }

    /// Saves what was shown last in a page in `folder`, which is made, when the device is lost. From now on frames cost what they do while
    /// a page is open: twice a second the outputs are read.
    pub fn save_when_lost(&mut self, folder: impl Into<PathBuf>) {
        self.lost_folder = Some(folder.into());
    }

    /// Shows the frame that `renderer` drew last, and has it take the settings that were chosen in the page: the next frame has them. Times
    /// are shown if the executor's options have [`timestamps`](framewright_vulkan::ExecutorOptions::timestamps) set.
    ///
    /// # Errors
    /// Those of reading what the device left, such as a lost device: then [`Viewer::failed`] was called. A setting that is refused is told
    /// in the page.
    pub fn frame(&mut self, renderer: &mut Renderer) -> Result<(), Error> {
        if !self.server.is_watched() && self.lost_folder.is_none() && !self.questions.is_waiting() {
            return Ok(());
        }
        let shown = self.show(renderer);
        if let Err(error) = &shown {
            // The program is told of the device first. A page that couldn't be written is told to whom calls `failed`.
            drop(self.failed(error));
        }
        shown
    }

    /// Tells of an error that a frame ended with. Where the device is lost and [`Viewer::save_when_lost`] was called, the path of the page
    /// is returned that has what was shown last; it is written once.
    ///
    /// ```no_run
    /// # fn frame(renderer: &mut framewright::Renderer, viewer: &mut framewright_viewer::Viewer, objects: &mut dyn framewright::DrawSource)
    /// # -> Result<(), Box<dyn std::error::Error>> {
    /// if let Err(error) = renderer.frame(objects) {
    ///     viewer.failed(&error)?;
    ///     return Err(error.into());
    /// }
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// If the page can't be written.
    pub fn failed(&mut self, error: &Error) -> Result<Option<PathBuf>, SaveError> {
        let Some(folder) = self.lost_folder.as_deref().filter(|_| is_lost(error)) else { return Ok(None) };
        if self.lost_page.is_none() {
            let write = |page: String| {
                let cant = |source| SaveError::Write { path: folder.to_owned(), source };
                files::write_lost(folder, &page).map_err(cant)
            };
            self.lost_page = self.saved(Some(&error.to_string()))?.map(write).transpose()?;
        }
        Ok(self.lost_page.clone())
    }

    /// Saves the frame that `renderer` drew last as a page of one file, in place of what was there. It opens from disk, in any browser.
    /// The page that is served shows it too.
    ///
    /// # Errors
    /// Those of reading what the device left, and of writing the file.
    pub fn save(&mut self, renderer: &mut Renderer, path: impl AsRef<Path>) -> Result<(), SaveError> {
        self.renderers.saw(renderer.id(), Instant::now(), || renderer.name());
        self.take(renderer, true)?;
        self.publish()?;
        let page = self.saved(None)?.ok_or(SaveError::NoFrame)?;
        let path = path.as_ref();
        files::write(path, &page).map_err(|source| SaveError::Write { path: path.to_owned(), source })
    }

    /// What was shown last as a page of one file; `None`: nothing was.
    fn saved(&self, lost: Option<&str>) -> Result<Option<String>, Error> {
        saved_page(&self.server.published(), self.with_sources, lost).map_err(no_json)
    }

    /// Does what a frame does while somebody looks.
    fn show(&mut self, renderer: &mut Renderer) -> Result<(), Error> {
        if renderer.plan().is_none() {
            return Ok(());
        }
        let (id, now) = (renderer.id(), Instant::now());
        self.renderers.saw(id, now, || renderer.name());
        let look = self.server.look();
        let before = self.shown.renderer();
        self.renderers.forget_gone(now, before.filter(|_| look.held));
        let is_shown = self.renderers.shown(look.renderer, before) == Some(id);
        // A captured frame is the page's whichever renderer it shows by now.
        if !is_shown && !self.questions.are_of(renderer) {
            return Ok(());
        }
        let chose = is_shown && self.take_choices(renderer);
        if self.questions.frame(&self.server, renderer, self.shown.version)? || !is_shown {
            return Ok(());
        }
        let was = std::mem::replace(&mut self.look, look);
        let same = self.shown.is_of(renderer);
        if same && !look.held {
            self.shown.take_times(renderer)?;
        }
        let asked = look.steps != was.steps || before != Some(id) || look.held != was.held;
        let at_once = asked || chose || self.renderers.take_changed();
        let gap = if same { EVERY } else { EVERY_PLAN };
        if !at_once && (look.held || self.told.is_some_and(|told| now.saturating_duration_since(told) < gap)) {
            return Ok(());
        }
        let stays = look.held && before == Some(id) && look.steps == was.steps;
        if !stays {
            // Reading outputs costs most: that is done while somebody sees them.
            let wanted = asked || self.lost_folder.is_some() || self.server.take_fetched();
            self.take(renderer, wanted)?;
        }
        self.publish_with(ShownMistakes::of_renderer(renderer))
    }

    /// Takes the frame that the renderer drew last, with pictures of its outputs if the Plan is another one or they are wanted.
    fn take(&mut self, renderer: &mut Renderer, wanted: bool) -> Result<(), Error> {
        let anew = !self.shown.is_of(renderer);
        if anew {
            let name = self.renderers.name(renderer.id()).map_or_else(|| renderer.name(), str::to_owned);
            let Some(shown) = ShownFrame::begin(renderer, name, self.version + 1)? else { return Ok(()) };
            self.shown = shown;
            self.shown.take_times(renderer)?;
        }
        self.shown.take_findings(renderer);
        if anew || wanted { self.shown.take_pictures(renderer, self.version + 1) } else { Ok(()) }
    }

    /// Gives the renderer what was chosen. Whether there was anything.
    fn take_choices(&mut self, renderer: &mut Renderer) -> bool {
        let choices: Vec<Choice> = self.server.choices().try_iter().collect();
        if choices.is_empty() {
            return false;
        }
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
            self.refused = refused.first().map(ShownMistakes::of_error);
        }
        true
    }

    fn set(&mut self, renderer: &mut Renderer, name: &str, value: &str) -> Result<(), Error> {
        renderer.set(name, value)?;
        self.chosen.entry(renderer.id()).or_default().insert(name.to_owned(), value.to_owned());
        Ok(())
    }

    /// Takes back all that was chosen, and chooses a preset.
    fn take_back(&mut self, renderer: &mut Renderer, preset: Option<&str>) -> Result<(), Error> {
        self.chosen.remove(&renderer.id()).unwrap_or_default().keys().for_each(|name| renderer.unset(name));
        renderer.preset(preset)
    }

    fn publish(&mut self) -> Result<(), Error> {
        self.publish_with(None)
    }

    /// Tells browsers what is shown, and what the renderer refused.
    fn publish_with(&mut self, of_files: Option<ShownMistakes>) -> Result<(), Error> {
        self.version += 1;
        self.told = Some(Instant::now());
        let shown = &self.shown;
        let times = shown.last.times();
        let none = BTreeMap::new();
        let renderer = shown.renderer().unwrap_or_default();
        let mistakes = of_files.or_else(|| self.refused.clone()).unwrap_or_default();
        let live = LiveState {
            format_version: About::FORMAT_VERSION,
            server: &self.id,
            version: self.version,
            frame: shown.version,
            busy: false,
            mistakes: &mistakes.mistakes,
            message: &mistakes.message,
            sources: &mistakes.sources,
            controls: &shown.controls,
            chosen: self.chosen.get(&renderer).unwrap_or(&none),
            preset: None,
            outputs: &shown.outputs,
            took: &took(times.as_ref()),
            program: Some(LiveProgram {
                renderers: self.renderers.list(),
                renderer,
                held: self.look.held,
                frame: shown.frame,
                device: &shown.device,
                driver: &shown.driver,
                findings: &shown.findings,
            }),
            times: times.as_ref(),
        };
        let live = serde_json::to_string(&live).map_err(no_json)?;
        let page = if shown.page.is_empty() { "null" } else { &shown.page };
        self.server.publish(PublishedState {
            version: self.version,
            server: Arc::clone(&self.id),
            json: format!("{{\"live\":{live},\"page\":{page}}}").into(),
            pictures: Arc::clone(&shown.pictures),
            history: Arc::default(),
        });
        Ok(())
    }
}

impl ShownMistakes {
    /// What an error says, with its places.
    fn of_error(error: &Error) -> ShownMistakes {
        match error.diagnostics() {
            Some((sources, mistakes)) => ShownMistakes::placed(error.to_string(), sources, mistakes),
            None => ShownMistakes::unplaced(error.to_string()),
        }
    }

    /// What a renderer refused last; `None`: it draws what it was asked for.
    fn of_renderer(renderer: &Renderer) -> Option<ShownMistakes> {
        let refused = renderer.refused()?;
        Some(match &refused.mistakes {
            Some(mistakes) => ShownMistakes::placed(refused.message.clone(), &mistakes.sources, &mistakes.diagnostics),
            None => ShownMistakes::unplaced(refused.message.clone()),
        })
    }
}

/// Whether the device can't be used any more.
fn is_lost(error: &Error) -> bool {
    fn of_vulkan(error: &framewright_vulkan::Error) -> bool {
        use framewright_vulkan::Error::{AtStep, DeviceLost, Timeout};
        match error {
            DeviceLost { .. } | Timeout { .. } => true,
            AtStep { error, .. } => of_vulkan(error),
            _ => false,
        }
    }
    match error {
        Error::Vulkan(error) => of_vulkan(error),
        _ => false,
    }
}

/// A number that nobody guesses: the keys of each are random.
fn secret() -> u64 {
    RandomState::new().hash_one(Instant::now())
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
