//! The example pipelines and scenes that the binary carries.

use framewright_graph::language::Shipped;
use std::path::Path;

macro_rules! carried {
    ($folder:literal: $($file:literal),* $(,)?) => {
        &[$(($file, include_str!(concat!("../../../examples/", $folder, "/", $file)))),*]
    };
}

/// The files in `examples/pipelines`: pipelines, and in folders what they are made of.
pub(crate) const PIPELINES: Shipped = carried!(
    "pipelines":
    "auto_exposure.ron",
    "deferred.ron",
    "deferred_mobile.ron",
    "dynamic_resolution.ron",
    "forward.ron",
    "forward_overlay.ron",
    "image_quality.ron",
    "library/ambient_occlusion.ron",
    "library/bloom.ron",
    "library/blur.ron",
    "library/color_grading.ron",
    "library/depth_of_field.ron",
    "library/depth_stripes.ron",
    "library/film.ron",
    "library/fxaa.ron",
    "library/motion.ron",
    "library/over_bright.ron",
    "library/overlay.ron",
    "library/resolve.ron",
    "library/scale.ron",
    "library/sun_shadow.ron",
    "library/taa.ron",
    "library/tone_mapping.ron",
    "library/upscaler.ron",
    "post.ron",
    "shadows.ron",
    "snow.ron",
    "soft_focus.ron",
    "temporal.ron",
);

/// The scenes in `examples/scenes`.
pub(crate) const SCENES: Shipped = carried!("scenes": "courtyard.ron", "passing.ron", "spheres_and_cubes.ron");

/// Names by which shipped files are asked for: of those in no folder, without their ending.
pub(crate) fn names(files: Shipped) -> impl Iterator<Item = &'static str> {
    files.iter().filter_map(|(file, _)| name(file))
}

/// File name and text of the shipped file that `path` asks for: by name or file name, in no folder.
pub(crate) fn find(files: Shipped, path: &Path) -> Option<(&'static str, &'static str)> {
    let called = |file: &str| name(file).is_some_and(|name| path == Path::new(name) || path == Path::new(file));
    files.iter().find(|(file, _)| called(file)).copied()
}

fn name(file: &str) -> Option<&str> {
    file.strip_suffix(".ron").filter(|name| !name.contains('/'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn files(folder: &Path, before: &str) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        for entry in std::fs::read_dir(folder).expect("the folder is there") {
            let entry = entry.expect("readable");
            let name = format!("{before}{}", entry.file_name().into_string().expect("a plain name"));
            match entry.path().is_dir() {
                true => found.extend(files(&entry.path(), &format!("{name}/"))),
                false => drop(found.insert(name)),
            }
        }
        found.retain(|name| name.ends_with(".ron"));
        found
    }

    #[test]
    fn every_example_in_the_repository_is_carried() {
        for (folder, carried) in [("pipelines", PIPELINES), ("scenes", SCENES)] {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples").join(folder);
            assert_eq!(files(&path, ""), carried.iter().map(|(file, _)| (*file).to_owned()).collect());
        }
    }

    #[test]
    fn what_pipelines_are_made_of_is_not_asked_for_by_name() {
        assert!(find(PIPELINES, Path::new("forward")).is_some() && find(PIPELINES, Path::new("forward.ron")).is_some());
        assert!(find(PIPELINES, Path::new("library/bloom.ron")).is_none());
        assert!(names(PIPELINES).all(|name| !name.contains('/')) && names(PIPELINES).any(|name| name == "forward"));
    }
}
