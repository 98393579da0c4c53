//! `framewright attach`: the page of a program that runs.

use crate::attaching::ProgramViewer;
use crate::command_line::attaching::AttachArguments;
use crate::error::Error;
use crate::files::outputs;
use crate::system::{Exit, text};
use framewright_graph::base::ReadFiles;
use framewright_viewer::About;
use serde::Serialize;

#[derive(Debug, Serialize)]
struct Answer<'a> {
    format_version: u32,
    url: &'a str,
    /// The version of Framewright that the program has.
    version: &'a str,
    /// The file that the frame was saved in.
    saved: Option<String>,
    /// Whether a browser was opened.
    opened: bool,
}

/// Opens the page of a program in a browser, or saves the frame that it draws.
///
/// # Errors
/// If no viewer answers at the address, or the file can't be written.
pub(crate) fn attach(arguments: &AttachArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    outputs::prepare(arguments.save.as_deref().into_iter(), &read)?;
    let viewer = ProgramViewer::find(&arguments.address, arguments.token.as_deref())?;
    let (about, own) = (&viewer.about, About::own());
    if (&about.version, about.format_version) != (&own.version, own.format_version) {
        let (other, own) = (text::escape(&about.version), own.version);
        text::say(&format!("note: the program has Framewright {other}, and serves its page; this command is of {own}"));
    }
    if let Some(file) = &arguments.save {
        let page = viewer.saved(!arguments.no_sources)?;
        outputs::write(&[(file, page.as_bytes())], &read)?;
    }
    let opened = !arguments.no_open && arguments.save.is_none() && open(&viewer.url);
    let shown = if arguments.json {
        let saved = arguments.save.as_deref().map(|file| file.to_string_lossy().into_owned());
        text::json(&Answer { format_version: 1, url: &viewer.url, version: &about.version, saved, opened })?
    } else {
        match &arguments.save {
            Some(file) => format!("{} has the frame of {}\n", text::path(file), viewer.url),
            None => format!("{} shows the program\n", viewer.url),
        }
    };
    text::print(&shown).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

/// Opens a browser. Whether there is one.
fn open(url: &str) -> bool {
    open::that_detached(url)
        .inspect_err(|error| {
            let why = text::escape(&error.to_string());
            text::say(&format!("note: no browser can be opened ({why}): give one the address"));
        })
        .is_ok()
}
