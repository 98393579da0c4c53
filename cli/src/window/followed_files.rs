//! The files that a window follows: they are read anew when they have changed.

use crate::error::Error;
use crate::files::inputs;
use framewright::{ReadFiles, Renderer, Scene};
use std::path::Path;
use std::time::{Duration, Instant};

/// Files are looked at this often.
const LOOKED: Duration = Duration::from_millis(100);
/// Files that change stay as they are for this long before they are read.
const AT_REST: Duration = Duration::from_millis(50);

/// What a window reads.
pub(super) struct FollowedFiles {
    /// The files that the scene was read from.
    scene: ReadFiles,
    /// When they were looked at.
    looked: Instant,
}

impl FollowedFiles {
    /// Follows the files of a scene, and those of the pipeline.
    pub(super) fn new(scene: ReadFiles) -> FollowedFiles {
        FollowedFiles { scene, looked: Instant::now() }
    }

    /// Whether it is time to look at the files.
    pub(super) fn is_due(&mut self) -> bool {
        let due = self.looked.elapsed() >= LOOKED;
        if due {
            self.looked = Instant::now();
        }
        due
    }

    /// Reads the pipeline anew if a file of it has changed.
    pub(super) fn pipeline(&self, renderer: &mut Renderer) -> Option<Result<(), Error>> {
        if !renderer.files_changed() {
            return None;
        }
        std::thread::sleep(AT_REST);
        Some(renderer.reload().map(drop).map_err(Error::from))
    }

    /// Reads the scene anew if a file of it has changed.
    pub(super) fn scene(&mut self, path: &Path, strict: bool) -> Option<Result<Scene, Error>> {
        if !self.scene.changed() {
            return None;
        }
        std::thread::sleep(AT_REST);
        self.scene = ReadFiles::default();
        Some(inputs::scene(path, strict, &self.scene))
    }

    /// The files that the scene was read from.
    pub(super) fn scene_files(&self) -> &ReadFiles {
        &self.scene
    }
}
