//! Findings of a check, with their places.

use crate::system::text;
use framewright_graph::base::Code;
use serde_json::Value;

/// A thing that was checked: a device, or variants that have a mistake in common.
pub(crate) struct Case {
    /// Its name, unique among the cases.
    pub(crate) name: String,
    /// The findings; none: it is fine.
    pub(crate) findings: Vec<Finding>,
}

/// A finding.
pub(crate) struct Finding {
    pub(super) code: Code,
    pub(super) message: String,
    /// Remarks and help, a line each.
    more: Vec<String>,
    pub(super) place: Option<FilePlace>,
    /// Other places that it is about, with their remarks.
    pub(super) related: Vec<(FilePlace, String)>,
}

/// A place in a file as the user named it. Lines and columns count from 1.
pub(super) struct FilePlace {
    pub(super) file: String,
    pub(super) line: u64,
    pub(super) column: u64,
    /// Line and column behind it.
    pub(super) end: [u64; 2],
}

impl Case {
    /// A case with these mistakes, as `base::to_json` has them.
    pub(crate) fn new(name: impl Into<String>, mistakes: &Value) -> Case {
        let mistakes = mistakes.as_array().into_iter().flatten();
        Case { name: name.into(), findings: mistakes.map(Finding::of).collect() }
    }

    /// With violations of a Plan's rules.
    pub(crate) fn violations(mut self, violations: &[String]) -> Case {
        self.findings.extend(violations.iter().map(|violation| Finding {
            code: Code::OWN_MISTAKE,
            message: violation.clone(),
            more: Vec::new(),
            place: None,
            related: Vec::new(),
        }));
        self
    }
}

impl Finding {
    fn of(mistake: &Value) -> Finding {
        let text = |value: &Value, name: &str| value[name].as_str().unwrap_or_default().to_owned();
        let code = Code::find(&text(mistake, "code")).unwrap_or(Code::OWN_MISTAKE);
        let message = format!("{} [{code}]", text(mistake, "message"));
        let labels = mistake["labels"].as_array().into_iter().flatten();
        let mut places: Vec<(FilePlace, String)> =
            labels.filter_map(|label| Some((FilePlace::of(label)?, text(label, "text")))).collect();
        let mut more = Vec::new();
        let mut place = None;
        if !places.is_empty() {
            let (first, remark) = places.remove(0);
            place = Some(first);
            more.extend(Some(remark).filter(|remark| !remark.is_empty()));
        }
        more.extend(mistake["help"].as_str().map(|help| format!("help: {help}")));
        Finding { code, message, more, place, related: places }
    }

    /// A finding of one place, without remarks.
    #[cfg(test)]
    pub(super) fn at(message: String, place: FilePlace) -> Finding {
        Finding { code: Code::OWN_MISTAKE, message, more: Vec::new(), place: Some(place), related: Vec::new() }
    }

    /// The message with its remarks and all other places that it is about.
    pub(super) fn text_with_places(&self) -> String {
        let places = self.related.iter().map(|(FilePlace { file, line, column, .. }, remark)| {
            format!("\n{}:{line}:{column}: {remark}", text::escape(file))
        });
        std::iter::once(self.text()).chain(places).collect()
    }

    /// The message with its remarks.
    pub(super) fn text(&self) -> String {
        std::iter::once(&self.message).chain(&self.more).cloned().collect::<Vec<_>>().join("\n")
    }
}

impl FilePlace {
    fn of(value: &Value) -> Option<FilePlace> {
        let number = |value: &Value, name: &str| value[name].as_u64();
        Some(FilePlace {
            file: value["file"].as_str()?.to_owned(),
            line: number(value, "line")?,
            column: number(value, "column")?,
            end: [number(&value["end"], "line")?, number(&value["end"], "column")?],
        })
    }
}
