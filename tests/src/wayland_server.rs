//! A Wayland compositor that nobody sees, for tests that show windows.

use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// How long it may take to start.
const STARTS: Duration = Duration::from_secs(60);

/// Its socket, in the folder of its own.
const SOCKET: &str = "wayland-test";

/// Who decides where windows are, and which of them are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shell {
    /// Windows have the size that they ask for.
    Desktop,
    /// A window fills the screen. Without a screen nobody asks for its frames.
    Kiosk,
}

/// A running Weston. It ends with it.
pub struct WaylandServer {
    server: Child,
    folder: TempDir,
}

impl WaylandServer {
    /// Starts one.
    ///
    /// # Errors
    /// What is missing, in words.
    pub fn start(shell: Shell) -> Result<WaylandServer, String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let shell = match shell {
            Shell::Desktop => "desktop-shell.so",
            Shell::Kiosk => "kiosk-shell.so",
        };
        let server = Command::new("weston")
            .args(["--backend=headless-backend.so", "--idle-time=0", "--width=640", "--height=480", "--no-config"])
            .args([format!("--shell={shell}"), format!("--socket={SOCKET}")])
            .env("XDG_RUNTIME_DIR", folder.path())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| format!("no Weston ({error}); mend it with: apt-get install weston"))?;
        let started = WaylandServer { server, folder };
        let begun = Instant::now();
        while !started.socket().exists() {
            if begun.elapsed() > STARTS {
                return Err("Weston doesn't start".to_owned());
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        Ok(started)
    }

    fn socket(&self) -> PathBuf {
        self.folder.path().join(SOCKET)
    }

    /// The variables for programs that show windows on it. `DISPLAY` must be taken from them.
    #[must_use]
    pub fn variables(&self) -> [(&'static str, String); 2] {
        [("XDG_RUNTIME_DIR", self.folder.path().to_string_lossy().into_owned()), ("WAYLAND_DISPLAY", SOCKET.to_owned())]
    }
}

impl Drop for WaylandServer {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
