//! A Wayland compositor that nobody sees, for tests that show windows.

use std::os::unix::net::UnixStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// How long it may take to start.
const STARTS: Duration = Duration::from_secs(60);

/// Its socket, in the folder of its own.
const SOCKET: &str = "wayland-test";
/// What it says, there too.
const LOG: &str = "log";

/// Who decides where windows are, and which of them are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shell {
    /// Windows have the size that they ask for.
    Desktop,
    /// A window fills the screen. In this server, which shows its picture nowhere, nobody asks for its frames.
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
            .arg(format!("--log={}", folder.path().join(LOG).display()))
            .env("XDG_RUNTIME_DIR", folder.path())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| format!("no Weston ({error}); mend it with: apt-get install weston"))?;
        let mut started = WaylandServer { server, folder };
        let begun = Instant::now();
        while UnixStream::connect(started.folder.path().join(SOCKET)).is_err() {
            let has_ended = started.server.try_wait().is_ok_and(|ended| ended.is_some());
            if has_ended || begun.elapsed() > STARTS {
                let said = std::fs::read_to_string(started.folder.path().join(LOG)).unwrap_or_default();
                return Err(format!("Weston doesn't start: {said}"));
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        Ok(started)
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
