//! What changed between two frames of the live page.

use framewright_graph::plan::SettingUsed;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Files that changed since the last good frame, by their names.
#[derive(Debug, Default)]
pub(super) struct Changes {
    files: BTreeSet<String>,
}

impl Changes {
    /// Notes files.
    pub(super) fn add(&mut self, files: Vec<PathBuf>) {
        let names = files.iter().filter_map(|file| file.file_name());
        self.files.extend(names.map(|name| name.to_string_lossy().into_owned()));
    }

    /// What changed since the frame that was drawn with the settings `before`, in words, and then nothing more. `None`: there was none.
    pub(super) fn take(&mut self, before: Option<&[SettingUsed]>, after: &[SettingUsed]) -> Vec<String> {
        let files = std::mem::take(&mut self.files);
        let Some(before) = before else { return vec!["the first frame".to_owned()] };
        let value = |settings: &[SettingUsed], name: &str| {
            settings.iter().find(|it| *it.name == *name).map(|it| it.value.clone())
        };
        let turned = after.iter().filter_map(|setting| {
            let was = value(before, &setting.name)?;
            (was != setting.value).then(|| format!("{}: {was} → {}", setting.name, setting.value))
        });
        let mut changed: Vec<String> = files.into_iter().chain(turned).collect();
        if changed.is_empty() {
            changed.push("no file and no setting".to_owned());
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(msaa: &str) -> [SettingUsed; 1] {
        [SettingUsed { name: "msaa".into(), value: msaa.to_owned() }]
    }

    #[test]
    fn lv_9_files_and_settings_are_told_once() {
        let mut changes = Changes::default();
        assert_eq!(changes.take(None, &settings("4")), ["the first frame"]);
        changes.add(vec!["a/first.ron".into(), "a/blur.frag".into()]);
        changes.add(vec!["a/first.ron".into()]);
        let told = changes.take(Some(&settings("4")), &settings("1"));
        assert_eq!(told, ["blur.frag", "first.ron", "msaa: 4 → 1"]);
        assert_eq!(changes.take(Some(&settings("1")), &settings("1")), ["no file and no setting"]);
    }
}
