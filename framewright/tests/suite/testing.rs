//! Helpers that the tests share.

use framewright::{Change, Device, Renderer, RendererOptions, Scene, SceneDrawSource, load_scene};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Width and height of pictures.
pub(crate) const EXTENT: [u32; 2] = [64, 36];

/// A scene with opaque objects, objects with holes, glass, and light brighter than white.
pub(crate) fn scene() -> Scene {
    load_scene("spheres_and_cubes").expect("it is shipped")
}

/// A renderer of a small picture of the scene.
pub(crate) fn renderer(device: &Device, pipeline: impl AsRef<Path>) -> Renderer {
    renderer_with(device, pipeline, RendererOptions::default())
}

/// The same with options.
pub(crate) fn renderer_with(device: &Device, pipeline: impl AsRef<Path>, options: RendererOptions) -> Renderer {
    let mut renderer = Renderer::open(device, pipeline, options).expect("it is right");
    renderer.set_scene(&scene());
    renderer.set_extent(EXTENT).expect("allowed");
    renderer
}

/// What changed, and the bytes of the picture after some frames.
pub(crate) fn draw(renderer: &mut Renderer, frames: u32) -> (Change, Vec<u8>) {
    let device = renderer.device().clone();
    let prepared = renderer.prepare().expect("planned");
    let extent = prepared.plan.extent;
    let (change, mut objects) =
        (prepared.change, SceneDrawSource::for_plan(&device, &scene(), extent, prepared.plan).expect("uploaded"));
    for _ in 0..frames {
        renderer.frame(&mut objects).expect("drawn");
    }
    (change, renderer.read("screen").expect("read").bytes)
}

/// How many channels of texels differ, and by how much on average.
pub(crate) fn difference(one: &[u8], other: &[u8]) -> f64 {
    assert_eq!(one.len(), other.len());
    let sum: f64 = one.iter().zip(other).map(|(one, other)| f64::from(one.abs_diff(*other))).sum();
    sum / f64::from(u32::try_from(one.len()).expect("small"))
}

/// A folder of files, until it is dropped.
pub(crate) struct Place(TempDir);

impl Place {
    pub(crate) fn new() -> Place {
        Place(tempfile::tempdir().expect("a folder"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file, and returns its path.
    pub(crate) fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(&path, contents).expect("written");
        path
    }
}
