//! Joins results of several folders. The order of the folders doesn't matter, and a row that is there twice counts once.

use super::{Outcome, Results, Row, Subject};
use framewright_graph::base::escape;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Results, and the folder that they are from.
#[derive(Debug)]
pub struct Part {
    /// The folder, for messages.
    pub folder: PathBuf,
    /// The results.
    pub results: Results,
}

/// Results that can't be joined.
#[derive(Debug, thiserror::Error)]
pub enum JoiningProblem {
    /// They are of different things.
    #[error("`{}` and `{}` hold results of different things, which can't be compared: `{field}` is {} in one and {} in the other", shown(&folders[0]), shown(&folders[1]), escape(&values[0]), escape(&values[1]))]
    Subject {
        /// The folders.
        folders: Box<[PathBuf; 2]>,
        /// The first field that differs.
        field: &'static str,
        /// Its value in each.
        values: [String; 2],
    },
    /// A scene changed.
    #[error("the scene `{}` changed between the results in `{}` and those in `{}`: their figures can't be compared", escape(scene), shown(&folders[0]), shown(&folders[1]))]
    Scene {
        /// The folders.
        folders: Box<[PathBuf; 2]>,
        /// The scene's file.
        scene: String,
    },
    /// One row was measured twice.
    #[error("`{}` and `{}` hold the same row with different figures ({field}): {}\nhelp: remove it from one of them, or leave one of them out", shown(&folders[0]), shown(&folders[1]), escape(row))]
    Row {
        /// The folders.
        folders: Box<[PathBuf; 2]>,
        /// The row, for people.
        row: String,
        /// The first field that differs.
        field: &'static str,
    },
}

fn shown(path: &Path) -> String {
    escape(&path.to_string_lossy())
}

/// What a row is found by. Its order is that of joined rows.
type Key = (String, [u32; 2], String, BTreeMap<String, String>);

fn key(row: &Row) -> Key {
    (row.scene.clone(), row.size, row.stereo.clone(), row.choice.clone())
}

/// Joins results; `None` of none.
///
/// # Errors
/// If they are of different things, or hold the same row with different figures.
pub fn joined(parts: Vec<Part>) -> Result<Option<Results>, JoiningProblem> {
    let mut parts = parts.into_iter();
    let Some(first) = parts.next() else { return Ok(None) };
    let mut rows: BTreeMap<Key, (PathBuf, Row)> = BTreeMap::new();
    let mut scenes: BTreeMap<String, (PathBuf, String)> = BTreeMap::new();
    let Part { folder, results: Results { format_version, subject, rows: of_first } } = first;
    put(&mut rows, &mut scenes, &folder, of_first)?;
    for part in parts {
        if let Some((field, values)) = difference(&subject, &part.results.subject) {
            return Err(JoiningProblem::Subject { folders: Box::new([folder, part.folder]), field, values });
        }
        put(&mut rows, &mut scenes, &part.folder, part.results.rows)?;
    }
    Ok(Some(Results { format_version, subject, rows: rows.into_values().map(|(_, row)| row).collect() }))
}

fn put(
    rows: &mut BTreeMap<Key, (PathBuf, Row)>,
    scenes: &mut BTreeMap<String, (PathBuf, String)>,
    folder: &Path,
    added: Vec<Row>,
) -> Result<(), JoiningProblem> {
    for row in added {
        let scene = scenes.entry(row.scene.clone());
        let (of, digest) = scene.or_insert_with(|| (folder.to_owned(), row.scene_digest.clone()));
        if *digest != row.scene_digest {
            let folders = Box::new([of.clone(), folder.to_owned()]);
            return Err(JoiningProblem::Scene { folders, scene: row.scene });
        }
        match rows.get(&key(&row)) {
            Some((of, other)) if *other != row => {
                let folders = Box::new([of.clone(), folder.to_owned()]);
                return Err(JoiningProblem::Row { folders, row: row.name(), field: differing(other, &row) });
            }
            Some(_) => {}
            None => drop(rows.insert(key(&row), (folder.to_owned(), row))),
        }
    }
    Ok(())
}

/// The first field in which two subjects differ, and both values.
#[must_use]
pub fn difference(a: &Subject, b: &Subject) -> Option<(&'static str, [String; 2])> {
    let fields = |subject: &Subject| {
        let Subject { framewright, shipped_shaders, pipeline, pipeline_digest, device, driver, .. } = subject;
        let Subject { frames, flicker_frames, reference, baseline, .. } = subject;
        let other = |name: &String, value: &String| [a, b].iter().any(|it| it.baseline.get(name) != Some(value));
        let baseline = baseline.iter().filter(|(name, value)| other(name, value));
        let baseline: Vec<String> = baseline.map(|(name, value)| format!("{name}={value}")).collect();
        [
            ("framewright", format!("`{framewright}`")),
            ("shipped_shaders", format!("`{shipped_shaders}`")),
            ("pipeline", format!("`{pipeline}`")),
            ("pipeline_digest", format!("`{pipeline_digest}`")),
            ("device", format!("`{device}`")),
            ("driver", format!("`{driver}`")),
            ("frames", frames.to_string()),
            ("flicker_frames", flicker_frames.map_or_else(|| "none".to_owned(), |frames| frames.to_string())),
            ("reference", format!("`{reference}`")),
            ("baseline", format!("`{}`", baseline.join(" "))),
        ]
    };
    let pairs = fields(a).into_iter().zip(fields(b));
    let mut different = pairs.filter(|(a, b)| a != b).map(|(a, b)| (a.0, [a.1, b.1]));
    different.next()
}

/// The first field in which two rows of one key differ.
fn differing(a: &Row, b: &Row) -> &'static str {
    match (&a.outcome, &b.outcome) {
        _ if a.settings != b.settings => "settings",
        (Outcome::Measured(a), Outcome::Measured(b)) if a.cost != b.cost => "cost",
        (Outcome::Measured(a), Outcome::Measured(b)) if a.errors != b.errors => "errors",
        (Outcome::Measured(a), Outcome::Measured(b)) if a.reference_errors != b.reference_errors => "reference_errors",
        (Outcome::Measured(a), Outcome::Measured(b)) if a.flicker != b.flicker => "flicker",
        (Outcome::Measured(a), Outcome::Measured(b)) if a.passes != b.passes => "passes",
        (Outcome::Measured(_), Outcome::Measured(_)) => "pictures",
        _ => "outcome",
    }
}
