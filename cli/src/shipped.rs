//! The example pipelines and scenes that the binary carries.

use std::path::Path;

/// A file that the binary carries.
#[derive(Debug)]
pub(crate) struct Example {
    /// Name by which it is asked for.
    pub(crate) name: &'static str,
    /// Name with its ending.
    pub(crate) file: &'static str,
    /// What it holds.
    pub(crate) text: &'static str,
}

impl Example {
    /// Whether `path` asks for it: by name or file name, in no folder.
    #[must_use]
    pub(crate) fn is_called(&self, path: &Path) -> bool {
        path == Path::new(self.name) || path == Path::new(self.file)
    }
}

macro_rules! carried {
    ($folder:literal: $($name:literal),* $(,)?) => {
        &[$(Example {
            name: $name,
            file: concat!($name, ".ron"),
            text: include_str!(concat!("../../examples/", $folder, "/", $name, ".ron")),
        },)*]
    };
}

/// The pipelines in `examples/pipelines`.
pub(crate) const PIPELINES: &[Example] =
    carried!("pipelines": "auto_exposure", "deferred", "forward", "snow", "soft_focus");

/// The scenes in `examples/scenes`.
pub(crate) const SCENES: &[Example] = carried!("scenes": "spheres_and_cubes");

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_example_in_the_repository_is_carried() {
        for (folder, carried) in [("pipelines", PIPELINES), ("scenes", SCENES)] {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples").join(folder);
            let there: BTreeSet<_> = std::fs::read_dir(path)
                .expect("the folder is there")
                .map(|entry| entry.expect("readable").file_name().into_string().expect("a plain name"))
                .filter(|name| name.ends_with(".ron"))
                .collect();
            assert_eq!(there, carried.iter().map(|example| example.file.to_owned()).collect());
        }
    }
}
