//! The rules for the arrows between files: rooms in order, no two folders that use each other, no wide circle of files.

use super::arrows::Arrows;
use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;

/// A circle of files has at most this many.
const WIDEST_CIRCLE: usize = 3;

/// Everything that breaks the rules, each with the files that do. `order`: the folders and files of the crate's top level, each
/// of which uses only those before it.
pub(super) fn breaches(arrows: &Arrows, order: &[String]) -> Vec<String> {
    let mut breaches = upward(arrows, order);
    breaches.extend(folders(arrows));
    breaches.extend(circles(arrows));
    breaches
}

/// The top-level folder of a file, or the file itself. `None`: the crate's face, which shows all of it.
fn room(file: &str) -> Option<&str> {
    let room = file.split('/').next().unwrap_or(file).trim_end_matches(".rs");
    (!matches!(room, "lib" | "main")).then_some(room)
}

/// Arrows from a room to one that stands above it, and rooms that the order doesn't name, or that aren't there.
fn upward(arrows: &Arrows, order: &[String]) -> Vec<String> {
    let place = |file: &str| order.iter().position(|known| Some(known.as_str()) == room(file));
    let mut breaches = Vec::new();
    for (file, used) in arrows {
        let Some(name) = room(file) else { continue };
        let Some(from) = place(file) else {
            breaches.push(format!("{file}: the order of rooms doesn't name `{name}`"));
            continue;
        };
        for used in used {
            if place(used).is_some_and(|to| to > from) || room(used).is_none() {
                breaches.push(format!("{file} uses {used}, which stands above it"));
            }
        }
    }
    let missing = order.iter().filter(|known| !arrows.keys().any(|file| room(file) == Some(known)));
    breaches.extend(missing.map(|known| format!("the order of rooms names `{known}`, which isn't there")));
    breaches
}

/// The folder of a file that lies in `parent`, and isn't `parent` itself.
fn folder_in<'f>(parent: &str, file: &'f str) -> Option<&'f str> {
    let rest = file.strip_prefix(parent)?;
    Some(&file[..parent.len() + rest.find('/')?])
}

/// Folders beside each other that use each other, straight or through others.
fn folders(arrows: &Arrows) -> Vec<String> {
    let mut parents: Vec<&str> =
        arrows.keys().flat_map(|file| file.match_indices('/').map(|(at, _)| &file[..=at])).collect();
    parents.push("");
    parents.sort_unstable();
    parents.dedup();
    let mut breaches = Vec::new();
    for parent in parents {
        let between = || {
            arrows.iter().flat_map(|(file, used)| used.iter().map(move |used| (file, used))).filter_map(
                |(file, used)| {
                    let (from, to) = (folder_in(parent, file)?, folder_in(parent, used)?);
                    (from != to).then_some((from, to, file, used))
                },
            )
        };
        let graph: DiGraphMap<&str, ()> = between().map(|(from, to, ..)| (from, to)).collect();
        for circle in tarjan_scc(&graph).into_iter().filter(|circle| circle.len() > 1) {
            let inside = |(from, to, ..): &(&str, &str, &String, &String)| circle.contains(from) && circle.contains(to);
            let uses: Vec<String> =
                between().filter(inside).map(|(_, _, file, used)| format!("{file} uses {used}")).collect();
            breaches.push(format!("folders use each other: {}", uses.join(", ")));
        }
    }
    breaches
}

/// Circles of more files than are allowed.
fn circles(arrows: &Arrows) -> Vec<String> {
    let graph: DiGraphMap<&str, ()> =
        arrows.iter().flat_map(|(file, used)| used.iter().map(move |used| (file.as_str(), used.as_str()))).collect();
    let wide = tarjan_scc(&graph).into_iter().filter(|circle| circle.len() > WIDEST_CIRCLE);
    wide.map(|mut circle| {
        circle.sort_unstable();
        format!("{} files use each other in a circle: {}", circle.len(), circle.join(", "))
    })
    .collect()
}
