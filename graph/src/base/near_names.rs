//! Near names for misspelt ones.

use super::shorten::MOST_LISTED;

/// Longer names are not compared: the comparison takes time that grows with the square of the length.
const LONGEST: usize = 64;

/// The known name nearest to `name`, if it is near enough to have been meant.
#[must_use]
pub fn nearest<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let length = name.chars().count();
    if length > LONGEST {
        return None;
    }
    // Any two single letters are one change apart.
    let allowed = if length < 2 { 0 } else { (length / 3).max(1) };
    let lower = name.to_lowercase();
    known
        .into_iter()
        .filter(|known| known.len() <= 4 * LONGEST && known.chars().count().abs_diff(length) <= allowed)
        .map(|known| (strsim::osa_distance(&lower, &known.to_lowercase()), known))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, known)| known)
}

/// The help for an unknown name that is near to none, where `words` may stand without quotes: "a number". `names`: the known
/// names, as [`suggestion`] lists them.
#[must_use]
pub(crate) fn without_quotes(words: &str, names: Option<String>) -> String {
    let names = names.map_or_else(String::new, |names| format!(", or a name: {names}"));
    format!("write {words} without quotes{names}")
}

/// The help for an unknown name: the near known name, or the first few known names.
#[must_use]
pub fn suggestion<'k>(name: &str, known: impl IntoIterator<Item = &'k str> + Clone) -> Option<String> {
    if let Some(near) = nearest(name, known.clone()) {
        return Some(format!("did you mean `{near}`?"));
    }
    let mut all = known.into_iter();
    let first: Vec<String> = all.by_ref().take(MOST_LISTED).map(|name| format!("`{name}`")).collect();
    let more = if all.next().is_some() { ", …" } else { "" };
    match &first[..] {
        [] => None,
        [only] => Some(format!("there is only {only}")),
        several => Some(format!("there are {}{more}", several.join(", "))),
    }
}
