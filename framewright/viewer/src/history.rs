//! The last states of a page: any two of them can be compared.

use crate::page::{Page, ShownPlan, page_value};
use crate::times::Times;
use framewright_graph::difference::Differences;
use framewright_graph::plan::{Detail, Plan};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

/// A frame that was drawn for a page.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptState {
    /// The number of the state that had it first.
    pub version: u64,
    /// When it was drawn, in milliseconds since 1970.
    pub drawn_at: u64,
    /// What changed since the one before, such as `first.ron` or `msaa: 4 → 1`. Text, to be escaped where it is shown.
    pub changed: Vec<String>,
    /// The settings that were chosen in the page.
    pub chosen: BTreeMap<String, String>,
    /// The preset that was chosen in the page.
    pub preset: Option<String>,
    /// The name of the Plan for people.
    pub name: String,
    /// The Plan's JSON form.
    pub plan: Arc<str>,
    /// How long its frames took; `None`: the device measures no times.
    pub times: Option<Times>,
    /// What it takes, in words.
    pub took: String,
    /// PNG files of its outputs by their addresses, the first output first.
    pub pictures: Vec<(String, Arc<[u8]>)>,
}

/// The last states, the oldest first. There are at most [`History::MOST`], and those but the last take at most [`History::LARGEST`] bytes.
#[derive(Debug, Clone, Default)]
pub struct History {
    states: VecDeque<Arc<KeptState>>,
}

/// A state as the page lists it.
#[derive(Serialize)]
struct Listed<'h> {
    version: u64,
    drawn_at: u64,
    changed: &'h [String],
    chosen: &'h BTreeMap<String, String>,
    preset: Option<&'h str>,
    took: &'h str,
    /// The device's milliseconds of a frame.
    milliseconds: Option<f64>,
    recording: Option<f64>,
    pictures: Vec<String>,
}

impl KeptState {
    fn bytes(&self) -> usize {
        self.plan.len() + self.pictures.iter().map(|(_, png)| png.len()).sum::<usize>()
    }

    /// Its Plan on a page.
    fn shown<'s>(&'s self, plan: &'s Plan) -> ShownPlan<'s> {
        ShownPlan {
            name: format!("{} ({})", self.name, self.version),
            plan,
            detail: Detail { objects: None, verbose: true },
            sources: None,
            times: self.times.as_ref(),
        }
    }

    fn listed(&self) -> Listed<'_> {
        Listed {
            version: self.version,
            drawn_at: self.drawn_at,
            changed: &self.changed,
            chosen: &self.chosen,
            preset: self.preset.as_deref(),
            took: &self.took,
            milliseconds: self.times.as_ref().map(|times| times.frame.median),
            recording: self.times.as_ref().map(|times| times.recording.median),
            pictures: self.pictures.iter().map(|(address, _)| format!("picture/{address}")).collect(),
        }
    }
}

impl History {
    /// The number of states that are kept.
    pub const MOST: usize = 20;
    /// The bytes of Plans and pictures that are kept, at most. The last state is kept whatever it takes.
    pub const LARGEST: usize = 128 << 20;

    /// Keeps a state, and forgets the oldest ones beyond the bounds.
    pub fn keep(&mut self, state: KeptState) {
        self.states.push_back(Arc::new(state));
        let bytes = |states: &VecDeque<Arc<KeptState>>| states.iter().map(|state| state.bytes()).sum::<usize>();
        while self.states.len() > History::MOST || self.states.len() > 1 && bytes(&self.states) > History::LARGEST {
            self.states.pop_front();
        }
    }

    /// The last state.
    #[must_use]
    pub fn last(&self) -> Option<&KeptState> {
        self.states.back().map(|state| &**state)
    }

    /// The state of this number; `None`: there was none, or it is forgotten.
    #[must_use]
    pub fn state(&self, version: u64) -> Option<&KeptState> {
        self.states.iter().find(|state| state.version == version).map(|state| &**state)
    }

    /// PNG files of all states, by their addresses.
    pub fn pictures(&self) -> impl Iterator<Item = (String, Arc<[u8]>)> + '_ {
        self.states.iter().flat_map(|state| state.pictures.iter().cloned())
    }

    /// The states as JSON, for the page's list.
    ///
    /// # Errors
    /// None that happens.
    pub fn listed(&self) -> serde_json::Result<Value> {
        serde_json::to_value(self.states.iter().map(|state| state.listed()).collect::<Vec<_>>())
    }

    /// The data of a page that compares two states, as JSON; `None`: one of them is forgotten.
    ///
    /// # Errors
    /// If a Plan has no JSON form.
    pub fn compared(&self, a: u64, b: u64) -> serde_json::Result<Option<String>> {
        let (Some(a), Some(b)) = (self.state(a), self.state(b)) else { return Ok(None) };
        let [Ok(plan_a), Ok(plan_b)] = [a, b].map(|state| Plan::from_json(&state.plan)) else { return Ok(None) };
        let differences = Differences::between((&a.name, &plan_a), (&b.name, &plan_b));
        let page = Page {
            plans: vec![a.shown(&plan_a), b.shown(&plan_b)],
            differences: Some(&differences),
            devices: &[],
            captures: &[],
        };
        let mut data = page_value(&page)?;
        data["sides"] = json!([a.listed(), b.listed()]);
        serde_json::to_string(&data).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(version: u64, bytes: usize) -> KeptState {
        KeptState {
            version,
            drawn_at: 0,
            changed: vec!["<b>.ron".to_owned()],
            chosen: BTreeMap::new(),
            preset: None,
            name: "p".to_owned(),
            plan: include_str!("../../../docs/plan-example.json").into(),
            times: None,
            took: String::new(),
            pictures: vec![(format!("{version}/0.png"), vec![0; bytes].into())],
        }
    }

    fn versions(history: &History) -> Vec<u64> {
        history.states.iter().map(|state| state.version).collect()
    }

    #[test]
    fn lv_9_twenty_states_are_kept_and_no_more_bytes_than_is_said() {
        let mut history = History::default();
        (1..=25).for_each(|version| history.keep(state(version, 10)));
        assert_eq!(versions(&history), (6..=25).collect::<Vec<_>>());
        assert_eq!(history.pictures().count(), 20);
        // Three of these are beyond the bound.
        (26..=29).for_each(|version| history.keep(state(version, History::LARGEST / 2 - (1 << 20))));
        assert_eq!(versions(&history), [28, 29]);
        // One that is beyond it alone is kept.
        history.keep(state(30, History::LARGEST));
        assert_eq!(versions(&history), [30]);
        assert!(history.state(29).is_none() && history.last().is_some_and(|last| last.version == 30));
    }

    #[test]
    fn lv_9_two_states_are_compared_and_a_forgotten_one_is_not() {
        let mut history = History::default();
        history.keep(state(1, 1));
        let mut other = state(2, 1);
        other.plan = other.plan.replace("\"grain\"", "\"noise level\"").into();
        history.keep(other);
        let data = history.compared(1, 2).expect("JSON").expect("both are there");
        let data: Value = serde_json::from_str(&data).expect("JSON");
        assert_eq!(data["plans"][1]["name"], "p (2)");
        assert_eq!(
            (&data["sides"][0]["version"], &data["sides"][1]["pictures"][0]),
            (&1.into(), &"picture/2/0.png".into())
        );
        assert_eq!(data["differences"]["b"]["settings"][0]["name"], "noise level");
        assert!(history.compared(1, 3).expect("JSON").is_none());
    }
}
