//! Amounts as people read them.

/// Bytes: `512 B`, `1.5 KiB`, `35.2 MiB`.
#[must_use]
pub fn bytes(bytes: u64) -> String {
    const UNITS: [&str; 5] = ["KiB", "MiB", "GiB", "TiB", "PiB"];
    if bytes < 1024 {
        return format!("{bytes} B");
    }
    #[allow(clippy::cast_precision_loss, reason = "shown with one decimal")]
    let mut amount = bytes as f64 / 1024.0;
    let mut unit = 0;
    while amount >= 1023.95 && unit + 1 < UNITS.len() {
        amount /= 1024.0;
        unit += 1;
    }
    format!("{amount:.1} {}", UNITS[unit])
}

/// The largest of some named things and their bytes, largest first: `` `a` (2.0 GiB), `b` (1.0 GiB) and 3 more``.
#[must_use]
pub fn largest(mut parts: Vec<(&str, u64)>) -> String {
    const SHOWN: usize = 3;
    parts.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    let shown = parts.iter().take(SHOWN).map(|(name, amount)| format!("`{name}` ({})", bytes(*amount)));
    let shown = shown.collect::<Vec<_>>().join(", ");
    match parts.len().saturating_sub(SHOWN) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_shown_in_the_unit_that_people_expect() {
        assert_eq!(bytes(0), "0 B");
        assert_eq!(bytes(1023), "1023 B");
        assert_eq!(bytes(1024), "1.0 KiB");
        assert_eq!(bytes(1024 * 1024 - 1), "1.0 MiB");
        assert_eq!(bytes(36_909_875), "35.2 MiB");
    }

    #[test]
    fn of_many_parts_the_largest_are_named() {
        assert_eq!(largest(vec![("a", 1), ("b", 2048)]), "`b` (2.0 KiB), `a` (1 B)");
        assert_eq!(largest(vec![("a", 1), ("b", 2), ("c", 3), ("d", 4)]), "`d` (4 B), `c` (3 B), `b` (2 B) and 1 more");
    }
}
