//! What a viewer is asked.

use super::address::ViewerAddress;
use crate::error::Error;
use framewright_viewer::About;
use std::time::Duration;
use ureq::Agent;

/// A question is answered within this time; one for a later state may take 25 seconds.
const PATIENCE: Duration = Duration::from_secs(40);
/// A page has at most this many bytes.
const LARGEST: u64 = 1 << 30;

/// The viewer of a program that runs.
pub(crate) struct ProgramViewer {
    agent: Agent,
    /// The address of its page.
    pub(crate) url: String,
    /// What it says of itself.
    pub(crate) about: About,
}

impl ProgramViewer {
    /// Finds the viewer at `address`.
    ///
    /// # Errors
    /// [`Error::ViewerAddress`], [`Error::NoViewer`].
    pub(crate) fn find(address: &str, token: Option<&str>) -> Result<ProgramViewer, Error> {
        let read = ViewerAddress::read(address, token);
        let url = read.map_err(|why| Error::ViewerAddress { address: address.to_owned(), why })?.url();
        let config = Agent::config_builder().proxy(None).max_redirects(0).http_status_as_error(false);
        let agent: Agent = config.timeout_global(Some(PATIENCE)).build().into();
        let mut found = ProgramViewer { agent, url, about: About::own() };
        let told = match found.ask("about")? {
            (200, told) => told,
            (404, _) => return Err(found.none("what answers there doesn't know the secret part of the address")),
            (403, _) => return Err(found.none("what answers there refuses the name of the machine")),
            (status, _) => return Err(found.none(&format!("another program answers there, with the status {status}"))),
        };
        let about: Option<About> = serde_json::from_str(&told).ok();
        let is_viewer = |about: &About| about.server == About::VIEWER;
        found.about = about.filter(is_viewer).ok_or_else(|| found.none("another program answers there"))?;
        Ok(found)
    }

    /// The frame that the program draws, as a page that opens from disk.
    ///
    /// # Errors
    /// [`Error::NoViewer`].
    pub(crate) fn saved(&self, with_sources: bool) -> Result<String, Error> {
        self.await_frame()?;
        match self.ask(if with_sources { "frame.html" } else { "frame.html?sources=no" })? {
            (200, page) => Ok(page),
            (404, _) => Err(self.none("it shows no frame yet")),
            (status, _) => Err(self.none(&format!("it can't save the frame: its status is {status}"))),
        }
    }

    /// Waits until the program has ended a frame since it was asked.
    fn await_frame(&self) -> Result<(), Error> {
        let (status, told) = self.ask("state/none/0")?;
        if status != 200 {
            return Err(self.none("the program ended no frame within 25 seconds"));
        }
        // What is shown may be of an hour ago: nobody looked. A frame that is held stays, and one of `serve` is the newest.
        let state: serde_json::Value = serde_json::from_str(&told).map_err(|_| self.none("its state is no JSON"))?;
        let live = &state["live"];
        if live["program"]["held"] == serde_json::json!(false) {
            let (server, version) = (live["server"].as_str().unwrap_or_default(), &live["version"]);
            self.ask(&format!("state/{server}/{version}"))?;
        }
        Ok(())
    }

    /// The status and the body of an answer.
    fn ask(&self, what: &str) -> Result<(u16, String), Error> {
        let asked = || -> Result<(u16, String), ureq::Error> {
            let mut answer = self.agent.get(format!("{}{what}", self.url)).call()?;
            let text = answer.body_mut().with_config().limit(LARGEST).read_to_string()?;
            Ok((answer.status().as_u16(), text))
        };
        asked().map_err(|error| self.none(&error.to_string()))
    }

    fn none(&self, why: &str) -> Error {
        Error::NoViewer { url: self.url.clone(), why: why.to_owned() }
    }
}
