//! The lines of the list: what fits into the window, and how much doesn't.

use super::contents::{Contents, Entry};

/// Columns that the list takes at most.
const WIDEST: usize = 60;
/// Columns of a time.
const TIME: usize = 10;

const KEYS: [&str; 3] = [
    "up, down: choose · left, right: change",
    "E: eyes · T: rotate · R: camera · P: picture",
    "L: this list · Esc: end",
];

/// A line of the list.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub(super) text: String,
    pub(super) tone: Tone,
    /// How much of the width a bar behind it takes, in hundredths.
    pub(super) bar: u32,
}

/// How a line is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tone {
    /// As most are.
    Plain,
    /// What is less important.
    Dim,
    /// The setting that keys turn.
    Chosen,
    /// What is wrong.
    Wrong,
}

impl Line {
    fn new(text: impl Into<String>, tone: Tone) -> Line {
        Line { text: text.into(), tone, bar: 0 }
    }
}

/// The lines of the list, cut to `columns` characters and `rows` lines.
pub(super) fn of(contents: &Contents, columns: usize, rows: usize) -> Vec<Line> {
    let columns = columns.min(WIDEST);
    let mut head = vec![Line::new(&contents.title, Tone::Plain)];
    head.extend(contents.preset.as_ref().map(|preset| Line::new(format!("preset {preset}"), Tone::Plain)));
    head.push(Line::new(&contents.speed, Tone::Plain));
    if let Some(wrong) = &contents.wrong {
        head.push(Line::new(wrong, Tone::Wrong));
        head.push(Line::new("the last good frame is shown", Tone::Wrong));
    }
    let settings: Vec<Line> = contents.settings.iter().map(setting).collect();
    let times = times(&contents.times, columns);
    // The keys are known from the terminal: they make room first.
    let left = rows.saturating_sub(head.len());
    let (needed, keys) = (settings.len() + times.len(), KEYS.map(|keys| Line::new(keys, Tone::Dim)));
    let keys = if needed + keys.len() <= left { &keys[..] } else { &[] };
    let for_settings = settings.len().min((left / 2).max(left.saturating_sub(times.len())).max(left.min(2)));
    let chosen = contents.settings.iter().position(|setting| setting.allowed.is_some());
    let mut lines = head;
    lines.extend(cut(settings, for_settings, chosen.unwrap_or(0)));
    lines.extend(cut(times, left - for_settings, 0));
    lines.extend_from_slice(keys);
    lines.truncate(rows);
    for line in &mut lines {
        line.text = within(&line.text, columns);
    }
    lines
}

/// The line of a setting.
fn setting(Entry { name, value, allowed }: &Entry) -> Line {
    match allowed {
        Some(allowed) => Line::new(format!("> {name} = {value}  ({allowed})"), Tone::Chosen),
        None => Line::new(format!("  {name} = {value}"), Tone::Plain),
    }
}

/// The lines of the times, with bars that are as long as their part of the longest.
fn times(times: &[(String, f64)], columns: usize) -> Vec<Line> {
    let longest = times.iter().map(|(_, milliseconds)| *milliseconds).fold(0.0, f64::max);
    let line = |(name, milliseconds): &(String, f64)| {
        let room = columns.saturating_sub(TIME);
        let text = format!("{:room$}{milliseconds:>7.2} ms", within(name, room));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 100")]
        let bar = if longest > 0.0 { (milliseconds / longest * 100.0).round() as u32 } else { 0 };
        Line { text, tone: Tone::Plain, bar }
    };
    times.iter().map(line).collect()
}

/// At most `most` of the lines. If some are left out, the line `chosen` stays, and the last line counts those that are left out.
fn cut(lines: Vec<Line>, most: usize, chosen: usize) -> Vec<Line> {
    let all = lines.len();
    if all <= most {
        return lines;
    }
    let Some(kept) = most.checked_sub(1) else { return Vec::new() };
    let first = (chosen + 1).saturating_sub(kept);
    let mut some: Vec<Line> = lines.into_iter().skip(first).take(kept).collect();
    some.push(Line::new(format!("and {} more", all - some.len()), Tone::Dim));
    some
}

/// The text, cut to `columns` characters with a mark at its end if it is longer.
fn within(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.to_owned();
    }
    let Some(kept) = columns.checked_sub(1) else { return String::new() };
    text.chars().take(kept).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contents(settings: usize, chosen: usize, times: usize) -> Contents {
        let setting = |number| Entry {
            name: format!("s{number}"),
            value: "1".to_owned(),
            allowed: (number == chosen).then(|| "one of 1 and 2".to_owned()),
        };
        Contents {
            title: "forward · 640×360".to_owned(),
            preset: Some("high".to_owned()),
            speed: "4.0 ms · 60 frames/s".to_owned(),
            wrong: None,
            settings: (0..settings).map(setting).collect(),
            times: (0..times).map(|number| (format!("p{number}"), 4.0 / 2.0_f64.powi(number as i32))).collect(),
        }
    }

    fn texts(lines: &[Line]) -> Vec<&str> {
        lines.iter().map(|line| line.text.trim_end()).collect()
    }

    #[test]
    fn em_4_the_list_tells_all_where_there_is_room() {
        let lines = of(&contents(2, 1, 2), 40, 20);
        let expected = [
            "forward · 640×360",
            "preset high",
            "4.0 ms · 60 frames/s",
            "  s0 = 1",
            "> s1 = 1  (one of 1 and 2)",
            "p0                               4.00 ms",
            "p1                               2.00 ms",
            "up, down: choose · left, right: change",
            "E: eyes · T: rotate · R: camera · P: pi…",
            "L: this list · Esc: end",
        ];
        assert_eq!(texts(&lines), expected);
        assert_eq!(lines.iter().map(|line| line.bar).collect::<Vec<_>>(), [0, 0, 0, 0, 0, 100, 50, 0, 0, 0]);
        assert_eq!(lines[4].tone, Tone::Chosen);
    }

    #[test]
    fn em_4_what_keeps_the_newest_from_being_shown_stands_above_the_settings() {
        let wrong = Contents { wrong: Some("error: a.ron:3:4: no".to_owned()), ..contents(1, 0, 0) };
        let lines = of(&wrong, 40, 20);
        assert_eq!(texts(&lines)[3..5], ["error: a.ron:3:4: no", "the last good frame is shown"]);
        assert_eq!([lines[3].tone, lines[4].tone], [Tone::Wrong; 2]);
    }

    #[test]
    fn em_4_what_does_not_fit_is_counted_and_the_chosen_setting_is_among_what_does() {
        for rows in 0..40 {
            for chosen in 0..12 {
                let lines = of(&contents(12, chosen, 9), 40, rows);
                assert!(lines.len() <= rows, "{rows} rows: {lines:?}");
                if rows < 6 {
                    continue;
                }
                let settings = lines.iter().filter(|line| line.text.contains(" = ")).count();
                let times = lines.iter().filter(|line| line.text.ends_with(" ms")).count();
                assert!(lines.iter().any(|line| line.tone == Tone::Chosen), "{rows} rows, {chosen}: {lines:?}");
                let more: Vec<_> = lines.iter().filter_map(|line| line.text.strip_prefix("and ")).collect();
                let left_out = [12 - settings, 9 - times].into_iter().filter(|left| *left > 0);
                let expected: Vec<_> = left_out.map(|left| format!("{left} more")).collect();
                assert_eq!(more, expected, "{rows} rows");
            }
        }
        assert_eq!(of(&contents(12, 0, 9), 40, 27).len(), 27, "all of it");
    }

    #[test]
    fn a_line_that_is_too_long_is_cut_with_a_mark() {
        assert_eq!(within("größer", 6), "größer");
        assert_eq!(within("größer", 5), "größ…");
        assert_eq!([within("a", 0), within("ab", 1)], ["", "…"]);
        assert!(of(&contents(3, 0, 3), 0, 9).iter().all(|line| line.text.is_empty()));
    }
}
