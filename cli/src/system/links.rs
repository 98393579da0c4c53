//! Targets of symbolic links, even of dangling ones.

use std::path::{Component, Path, PathBuf};

/// A path has at most this many links: the limit of Linux.
const MOST_LINKS: usize = 40;

/// `path` with every link in it replaced by its target, even if no file is there. A circle of links ends at one of them.
pub(crate) fn destination(path: &Path) -> PathBuf {
    let mut links = 0;
    let mut left: Vec<PathBuf> = parts(path);
    let mut found = PathBuf::new();
    while let Some(part) = left.pop() {
        found.push(&part);
        if links < MOST_LINKS
            && let Ok(target) = found.read_link()
        {
            links += 1;
            found.pop();
            // An absolute target takes the place of all before it.
            left.extend(parts(&target));
        }
    }
    found
}

/// The components of a path, the last one first.
fn parts(path: &Path) -> Vec<PathBuf> {
    path.components().rev().map(|part: Component| PathBuf::from(part.as_os_str())).collect()
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn every_link_is_followed_to_where_nothing_is_and_circles_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let made = |target: &str, name: &str| symlink(target, at(name)).expect("a link");
        made("missing", "link");
        made("link/deeper", "second");
        made("/none/at/all", "absolute");
        made("circle", "circle");
        for (path, leads_to) in [
            ("file", at("file")),
            ("link/x.png", at("missing/x.png")),
            ("second/x.png", at("missing/deeper/x.png")),
            ("absolute/x.png", PathBuf::from("/none/at/all/x.png")),
            ("circle/x.png", at("circle/x.png")),
        ] {
            assert_eq!(destination(&at(path)), leads_to, "{path}");
        }
    }
}
