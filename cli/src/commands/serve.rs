//! `framewright serve`: the page of a pipeline, which follows every change to its files.

use crate::command_line::serving::ServeArguments;
use crate::error::Error;
use crate::files::inputs;
use crate::planning::{device, helper};
use crate::serving::Session;
use crate::system::{Exit, interrupt, text};
use framewright_viewer::Server;
use std::net::Ipv4Addr;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

/// Files are looked at this often.
const EVERY: Duration = Duration::from_millis(100);
/// Files that change stay as they are for this long before they are read.
const AT_REST: Duration = Duration::from_millis(50);

/// Serves the page until Ctrl-C.
///
/// # Errors
/// If there is no such pipeline or scene, the port or the device can't be had, or the device is lost.
pub(crate) fn serve(arguments: &ServeArguments) -> Result<Exit, Error> {
    // A name that leads nowhere is a slip. Files that go missing later are waited for.
    inputs::are_there(&arguments.pipeline.file, &arguments.drawn.scene)?;
    interrupt::watch();
    let helper = helper::of(&arguments.pipeline)?;
    let choice = device::to_draw_on(arguments.device.name.as_deref())?;
    let port = arguments.port;
    let server =
        Server::start((Ipv4Addr::LOCALHOST, port).into(), None).map_err(|source| Error::Port { port, source })?;
    let (address, choices) = (server.address(), server.choices());
    let device = device::open(choice, false, &helper)?;
    let mut session = Session::new(arguments, &device, helper);
    text::print(&format!("http://{address}/ shows the page; Ctrl-C ends it\n")).map_err(Error::Print)?;
    loop {
        server.publish(session.published(true)?);
        match session.draw() {
            Err(_) if interrupt::asked() => return Ok(Exit::Fine),
            other => other?,
        }
        server.publish(session.published(false)?);
        loop {
            if interrupt::asked() {
                return Ok(Exit::Fine);
            }
            for question in server.questions().try_iter() {
                match session.answer(question) {
                    Err(_) if interrupt::asked() => return Ok(Exit::Fine),
                    other => other?,
                }
            }
            match choices.recv_timeout(EVERY) {
                Ok(choice) => {
                    session.choose(choice);
                    // Only the last value of a slider that is pulled is drawn.
                    choices.try_iter().for_each(|choice| session.choose(choice));
                    break;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    let source = std::io::Error::other("the server has stopped");
                    return Err(Error::Port { port: address.port(), source });
                }
            }
            if session.files_changed() {
                session.let_files_rest(AT_REST);
                break;
            }
        }
    }
}
