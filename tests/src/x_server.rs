//! An X server that nobody sees, for tests that show windows.

use std::error::Error;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use x11rb::COPY_DEPTH_FROM_PARENT;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt, CreateWindowAux, MapState, WindowClass};
use x11rb::rust_connection::RustConnection;

/// How long a window manager may take to start.
const STARTS: Duration = Duration::from_secs(60);
/// The time between two looks.
const PAUSE: Duration = Duration::from_millis(20);

/// A running X server, and perhaps a window manager. They end with it.
pub struct XServer {
    server: Child,
    manager: Option<Child>,
    display: String,
}

impl XServer {
    /// Starts one with a screen of 1280 by 1024 pixels.
    ///
    /// # Errors
    /// What is missing, in words.
    pub fn start() -> Result<XServer, String> {
        let missing = |error: std::io::Error| format!("no Xvfb ({error}); mend it with: apt-get install xvfb openbox");
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(missing)?;
        let mut number = String::new();
        let read = server.stdout.take().map(|out| BufReader::new(out).read_line(&mut number));
        let started = XServer { server, manager: None, display: format!(":{}", number.trim()) };
        match read {
            Some(Ok(bytes)) if bytes > 0 => Ok(started),
            _ => Err("Xvfb doesn't start".to_owned()),
        }
    }

    /// Starts one with a window manager, which can move, resize and minimise windows.
    ///
    /// # Errors
    /// Those of [`XServer::start`].
    pub fn with_manager() -> Result<XServer, String> {
        let mut started = XServer::start()?;
        let manager = Command::new("openbox")
            .args(["--sm-disable"])
            .env("DISPLAY", &started.display)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        started.manager =
            Some(manager.map_err(|error| format!("no openbox ({error}); mend it with: apt-get install openbox"))?);
        started.wait_for_manager().map_err(|error| error.to_string())?;
        Ok(started)
    }

    /// Waits until the window manager has taken over: its property of the root window says so, and it shows a window. Windows that ask
    /// between both are never shown.
    fn wait_for_manager(&self) -> Result<(), Box<dyn Error>> {
        let (x, screen) = RustConnection::connect(Some(&self.display))?;
        let (root, begun) = (x.setup().roots[screen].root, Instant::now());
        let check = x.intern_atom(false, b"_NET_SUPPORTING_WM_CHECK")?.reply()?.atom;
        while x.get_property(false, root, check, AtomEnum::ANY, 0, 1)?.reply()?.value.is_empty() {
            if begun.elapsed() > STARTS {
                return Err("openbox doesn't start".into());
            }
            std::thread::sleep(PAUSE);
        }
        loop {
            let window = x.generate_id()?;
            let class = WindowClass::INPUT_OUTPUT;
            x.create_window(COPY_DEPTH_FROM_PARENT, window, root, 0, 0, 8, 8, 0, class, 0, &CreateWindowAux::new())?;
            x.map_window(window)?.check()?;
            for _ in 0..20 {
                if x.get_window_attributes(window)?.reply()?.map_state == MapState::VIEWABLE {
                    x.destroy_window(window)?.check()?;
                    return Ok(());
                }
                std::thread::sleep(PAUSE);
            }
            x.destroy_window(window)?.check()?;
            if begun.elapsed() > STARTS {
                return Err("openbox shows no window".into());
            }
        }
    }

    /// The value of `DISPLAY` for programs that show windows on it.
    #[must_use]
    pub fn display(&self) -> &str {
        &self.display
    }
}

impl Drop for XServer {
    fn drop(&mut self) {
        for child in self.manager.iter_mut().chain([&mut self.server]) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
