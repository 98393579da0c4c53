//! Reads the file of a budget.

use super::bound::Bound;
use super::{Budget, Limit};
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::planning::device;
use crate::system::Exit;
use framewright::Pipeline;
use framewright_graph::base::{self, Code, Diagnostic, ReadFiles, Span};
use framewright_graph::hints::HintKind;
use framewright_graph::language::Document;
use ron::Options;
use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The version of budgets that this program reads.
const VERSION: u32 = 1;
/// A file of a budget has at most this many bytes.
const LARGEST: usize = 1 << 20;

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Budget")]
struct BudgetFile<'src> {
    version: u32,
    #[serde(borrow)]
    limits: Vec<&'src RawValue>,
}

/// An entry of `limits`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Limit")]
struct LimitEntry {
    #[serde(default)]
    settings: BTreeMap<String, ron::Value>,
    device: Option<String>,
    passes: Option<u32>,
    inserted_passes: Option<u32>,
    scopes: Option<u32>,
    resolves: Option<u32>,
    copies: Option<u32>,
    barriers: Option<u32>,
    barrier_calls: Option<u32>,
    waits: Option<u32>,
    memory_mib: Option<f64>,
    loaded_mib: Option<f64>,
    stored_mib: Option<f64>,
    resolved_mib: Option<f64>,
    copied_mib: Option<f64>,
    moved_mib: Option<f64>,
    hints: Option<HintsEntry>,
}

/// How many hints there may be.
#[derive(Deserialize)]
#[serde(untagged)]
enum HintsEntry {
    Together(u32),
    /// By the code of their kind.
    ByKind(BTreeMap<String, u32>),
}

impl HintsEntry {
    fn bounds(&self) -> Vec<(Bound, f64)> {
        match self {
            HintsEntry::Together(most) => vec![(Bound::Hints(None), f64::from(*most))],
            HintsEntry::ByKind(kinds) => {
                let bound = |(code, most): (&String, &u32)| Some((Bound::Hints(Some(kind(code)?)), f64::from(*most)));
                kinds.iter().filter_map(bound).collect()
            }
        }
    }

    /// The first code that no kind has.
    fn unknown(&self) -> Option<&str> {
        match self {
            HintsEntry::Together(_) => None,
            HintsEntry::ByKind(kinds) => kinds.keys().map(String::as_str).find(|code| kind(code).is_none()),
        }
    }
}

fn kind(code: &str) -> Option<HintKind> {
    HintKind::ALL.into_iter().find(|kind| kind.code() == code)
}

impl LimitEntry {
    fn bounds(&self) -> impl Iterator<Item = (Bound, f64)> {
        let counts = [
            (Bound::Passes, self.passes),
            (Bound::InsertedPasses, self.inserted_passes),
            (Bound::Scopes, self.scopes),
            (Bound::Resolves, self.resolves),
            (Bound::Copies, self.copies),
            (Bound::Barriers, self.barriers),
            (Bound::BarrierCalls, self.barrier_calls),
            (Bound::Waits, self.waits),
        ];
        let amounts = [
            (Bound::MemoryMib, self.memory_mib),
            (Bound::LoadedMib, self.loaded_mib),
            (Bound::StoredMib, self.stored_mib),
            (Bound::ResolvedMib, self.resolved_mib),
            (Bound::CopiedMib, self.copied_mib),
            (Bound::MovedMib, self.moved_mib),
        ];
        let counts = counts.into_iter().filter_map(|(bound, most)| Some((bound, f64::from(most?))));
        let amounts = amounts.into_iter().filter_map(|(bound, most)| Some((bound, most?)));
        counts.chain(amounts).chain(self.hints.iter().flat_map(HintsEntry::bounds))
    }
}

/// Reads a budget for a pipeline, to whose texts its own is added. Without a file there are no limits.
///
/// # Errors
/// If the file can't be read, or is no budget of this pipeline.
pub(crate) fn read(path: Option<&Path>, pipeline: &mut Pipeline) -> Result<Budget, Error> {
    let Some(path) = path else { return Ok(Budget::default()) };
    let (pipeline, sources) = (&pipeline.document, Arc::make_mut(&mut pipeline.sources));
    let text = inputs::text(FileRole::BUDGET, path, LARGEST, &ReadFiles::default())?;
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let file = sources.add(path.to_string_lossy(), &*name, &*text);
    parse(&text, file, pipeline).map_err(|mistakes| Error::mistakes(sources.clone(), mistakes, Exit::Found))
}

fn parse(text: &str, file: u32, pipeline: &Document) -> Result<Budget, Vec<Diagnostic>> {
    let BudgetFile { version, limits } = ron::from_str(text).map_err(|error| vec![wrong(file, text, 0, &error)])?;
    if version != VERSION {
        let message = format!("this is version {version} of budgets, and this program reads version {VERSION}");
        return Err(vec![Diagnostic::new(Code::VERSION, span(file, text, 0, text.len()), message)]);
    }
    let mut mistakes = Vec::new();
    let mut budget = Budget::default();
    for raw in limits {
        // The raw text is a part of the whole one, and may begin with blanks.
        let start = raw.get_ron().as_ptr() as usize - text.as_ptr() as usize;
        let start = start + raw.get_ron().len() - raw.get_ron().trim_start().len();
        let place = span(file, text, start, start + raw.get_ron().trim().len());
        let implicit = Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        match implicit.from_str::<LimitEntry>(raw.get_ron().trim()) {
            Ok(entry) => match limit(&entry, place, pipeline) {
                Ok(limit) => budget.limits.push(limit),
                Err(mistake) => mistakes.push(mistake),
            },
            Err(error) => mistakes.push(wrong(file, text, start, &error)),
        }
    }
    if mistakes.is_empty() { Ok(budget) } else { Err(mistakes) }
}

fn limit(entry: &LimitEntry, span: Span, pipeline: &Document) -> Result<Limit, Diagnostic> {
    let known = || pipeline.settings.iter().map(|setting| &*setting.name.text);
    let mut settings = Vec::new();
    for (name, value) in &entry.settings {
        if !known().any(|known| known == name) {
            let unknown = Diagnostic::new(Code::UNKNOWN_SETTING, span, format!("the pipeline has no setting `{name}`"));
            return Err(match base::nearest(name, known()) {
                Some(near) => unknown.help(format!("did you mean `{near}`?")),
                None => unknown,
            });
        }
        let value = match value {
            ron::Value::Bool(value) => value.to_string(),
            ron::Value::Number(value) => value.into_f64().to_string(),
            ron::Value::String(value) => value.clone(),
            _ => {
                return Err(Diagnostic::new(
                    Code::BUDGET_LIMIT,
                    span,
                    format!("the value of `{name}` is a number, a text, true or false"),
                ));
            }
        };
        settings.push((name.clone(), value));
    }
    if let Some(unknown) = entry.hints.as_ref().and_then(HintsEntry::unknown) {
        let codes: Vec<&str> = HintKind::ALL.iter().map(|kind| kind.code()).collect();
        let message = format!("there are no hints `{unknown}`");
        let help = format!("there are {}", codes.join(", "));
        return Err(Diagnostic::new(Code::BUDGET_LIMIT, span, message).help(help));
    }
    if entry.bounds().next().is_none() {
        return Err(
            Diagnostic::new(Code::BUDGET_LIMIT, span, "the limit bounds nothing").help("add for example `resolves: 3`")
        );
    }
    if let Some((bound, most)) = entry.bounds().find(|(_, most)| !most.is_finite() || *most < 0.0) {
        return Err(Diagnostic::new(
            Code::BUDGET_LIMIT,
            span,
            format!("a bound on {} can't be {most}", bound.words().0),
        ));
    }
    // A shipped profile is named as `--device` names it; another device by its own name.
    let profiles = device::all().unwrap_or_default();
    let own_name = |name: &String| match profiles.iter().find(|(profile, _)| profile == name) {
        Some((_, profile)) => profile.name.clone(),
        None => name.clone(),
    };
    Ok(Limit { span, settings, device: entry.device.as_ref().map(own_name), bounds: entry.bounds().collect() })
}

/// A mistake of the text that begins at byte `start`.
fn wrong(file: u32, text: &str, start: usize, error: &ron::error::SpannedError) -> Diagnostic {
    let part = &text[start..];
    let offset = |position: &ron::error::Position| {
        let lines: usize = part.split_inclusive('\n').take(position.line.saturating_sub(1)).map(str::len).sum();
        let line = part.get(lines..).unwrap_or("");
        let column = line.char_indices().nth(position.col.saturating_sub(1)).map_or(line.len(), |(at, _)| at);
        start + lines + column
    };
    let [from, to] = [offset(&error.span.start), offset(&error.span.end)];
    let help = "a budget is `Budget(version: 1, limits: [(resolves: 3, memory_mib: 64), …])`; docs/command.md lists the bounds";
    Diagnostic::new(
        Code::BUDGET_FILE,
        span(file, text, from, to.max(from)),
        format!("this is no budget: {}", error.code),
    )
    .help(help)
}

fn span(file: u32, text: &str, start: usize, end: usize) -> Span {
    let within = |at: usize| u32::try_from(at.min(text.len())).unwrap_or(u32::MAX);
    Span::new(file, within(start), within(end))
}
