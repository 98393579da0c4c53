//! Claims about what the binary carries.

use framewright_passes::shipped::SHADERS;
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
