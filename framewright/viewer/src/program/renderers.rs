//! The renderers that a program draws with, as far as its viewer has seen them.

use crate::server::LiveRenderer;
use std::time::{Duration, Instant};

/// A renderer that drew nothing for this long is gone.
const GONE_AFTER: Duration = Duration::from_secs(10);

/// The renderers that drew lately.
#[derive(Debug, Default)]
pub(super) struct Renderers {
    list: Vec<LiveRenderer>,
    /// When each of them drew last.
    drew: Vec<Instant>,
    /// Whether the list is another one than when it was told last.
    changed: bool,
}

impl Renderers {
    /// Notes that the renderer `id` drew; `name` is asked for where it is new.
    pub(super) fn saw(&mut self, id: u64, now: Instant, name: impl FnOnce() -> String) {
        if let Some(at) = self.list.iter().position(|known| known.id == id) {
            self.drew[at] = now;
            return;
        }
        let name = self.own_name(name());
        self.list.push(LiveRenderer { id, name });
        self.drew.push(now);
        self.changed = true;
    }

    /// Forgets those that are gone, but for the renderer `shown` if its frame is held.
    pub(super) fn forget_gone(&mut self, now: Instant, held: Option<u64>) {
        let stays = |(one, drew): (&LiveRenderer, &Instant)| {
            Some(one.id) == held || now.saturating_duration_since(*drew) < GONE_AFTER
        };
        if self.list.iter().zip(&self.drew).all(stays) {
            return;
        }
        let kept = std::mem::take(&mut self.list).into_iter().zip(std::mem::take(&mut self.drew));
        (self.list, self.drew) = kept.filter(|(one, drew)| stays((one, drew))).unzip();
        self.changed = true;
    }

    /// The one to show: that which was chosen, else that which is shown, else the first.
    pub(super) fn shown(&self, chosen: Option<u64>, before: Option<u64>) -> Option<u64> {
        let is_known = |id: &u64| self.list.iter().any(|one| one.id == *id);
        chosen.filter(is_known).or(before.filter(is_known)).or(self.list.first().map(|one| one.id))
    }

    /// All of them, to be told.
    pub(super) fn list(&self) -> &[LiveRenderer] {
        &self.list
    }

    /// The name of one.
    pub(super) fn name(&self, id: u64) -> Option<&str> {
        self.list.iter().find(|one| one.id == id).map(|one| &*one.name)
    }

    /// Whether there are others since the last call.
    pub(super) fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// A name that no other one has.
    fn own_name(&self, name: String) -> String {
        let is_taken = |name: &str| self.list.iter().any(|one| one.name == name);
        if !is_taken(&name) {
            return name;
        }
        (2..).map(|number| format!("{name} ({number})")).find(|name| !is_taken(name)).unwrap_or(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lv_1_renderers_of_one_name_are_told_apart_and_those_that_are_gone_are_forgotten() {
        let mut renderers = Renderers::default();
        let begun = Instant::now();
        for id in [7, 8, 9] {
            renderers.saw(id, begun, || if id == 9 { "post".to_owned() } else { "forward".to_owned() });
        }
        let names = |renderers: &Renderers| renderers.list().iter().map(|one| one.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&renderers), ["forward", "forward (2)", "post"]);
        assert!(renderers.take_changed() && !renderers.take_changed());
        assert_eq!(renderers.shown(None, None), Some(7));
        assert_eq!(renderers.shown(Some(9), Some(8)), Some(9));
        assert_eq!(renderers.shown(Some(1), Some(8)), Some(8), "one that was never there");
        let later = begun + GONE_AFTER;
        renderers.saw(9, later, || unreachable!("it is known"));
        renderers.forget_gone(later, Some(7));
        assert_eq!(names(&renderers), ["forward", "post"], "the held one stays");
        renderers.forget_gone(later, None);
        assert_eq!(names(&renderers), ["post"]);
        assert!(renderers.take_changed());
        assert_eq!(renderers.shown(Some(7), Some(7)), Some(9));
        // The name is free again.
        renderers.saw(10, later, || "forward".to_owned());
        assert_eq!(renderers.name(10), Some("forward"));
    }
}
