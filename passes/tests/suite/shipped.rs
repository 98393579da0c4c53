//! Claims about what the binary carries.

use framewright_passes::shipped::{PIPELINES, SCENES, SHADERS, find, names};
use std::collections::BTreeSet;
use std::path::Path;

fn files_below(folder: &Path, prefix: &str, found: &mut BTreeSet<String>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            files_below(&entry.path(), &format!("{name}/"), found)?;
        } else {
            found.insert(name);
        }
    }
    Ok(())
}

#[test]
fn every_file_in_the_shader_folder_is_carried() -> std::io::Result<()> {
    let mut on_disk = BTreeSet::new();
    files_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../shaders"), "", &mut on_disk)?;
    let carried: BTreeSet<String> = SHADERS.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(on_disk, carried);
    Ok(())
}

#[test]
fn every_pipeline_and_scene_among_the_examples_is_carried() -> std::io::Result<()> {
    for (folder, carried) in [("pipelines", PIPELINES), ("scenes", SCENES)] {
        let mut on_disk = BTreeSet::new();
        let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
        files_below(&examples.join(folder), "", &mut on_disk)?;
        on_disk.retain(|name| name.ends_with(".ron"));
        assert_eq!(on_disk, carried.iter().map(|(name, _)| (*name).to_owned()).collect());
    }
    Ok(())
}

#[test]
fn what_pipelines_are_made_of_is_not_asked_for_by_name() {
    assert!(find(PIPELINES, Path::new("forward")).is_some() && find(PIPELINES, Path::new("forward.ron")).is_some());
    assert!(find(PIPELINES, Path::new("library/bloom.ron")).is_none());
    assert!(names(PIPELINES).all(|name| !name.contains('/')) && names(PIPELINES).any(|name| name == "forward"));
}
