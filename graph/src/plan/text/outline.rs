//! An outline drawn with lines: a heading, and its parts under it.

/// Columns that text is kept within, as far as its words allow.
const COLUMNS: usize = 120;
/// Columns that a wrapped line keeps at least, however deep it stands.
const LEAST: usize = 40;

/// A line with its parts.
#[derive(Debug)]
pub(super) struct Node {
    text: String,
    children: Vec<Node>,
}

impl Node {
    pub(super) fn leaf(text: impl Into<String>) -> Node {
        Node { text: text.into(), children: Vec::new() }
    }

    pub(super) fn new(text: impl Into<String>, children: Vec<Node>) -> Node {
        Node { text: text.into(), children }
    }

    /// The whole outline, with a final line break.
    pub(super) fn draw(&self) -> String {
        let mut drawn = String::new();
        self.add(&mut drawn, "", "");
        drawn
    }

    /// Adds this node: `first` stands before its first line, `rest` before all others.
    fn add(&self, drawn: &mut String, first: &str, rest: &str) {
        let under = if self.children.is_empty() { "   " } else { "│  " };
        let mut before = first.to_owned();
        for line in wrap(&self.text, COLUMNS.saturating_sub(first.chars().count())) {
            drawn.push_str(&before);
            drawn.push_str(&line);
            drawn.push('\n');
            before = format!("{rest}{under}");
        }
        let last = self.children.len().saturating_sub(1);
        for (at, child) in self.children.iter().enumerate() {
            let [branch, trunk] = if at == last { ["└─ ", "   "] } else { ["├─ ", "│  "] };
            child.add(drawn, &format!("{rest}{branch}"), &format!("{rest}{trunk}"));
        }
    }
}

/// Breaks a text between words. Lines after the first are drawn three columns further in, so they are shorter.
fn wrap(text: &str, columns: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    let mut used = 0;
    for word in text.split(' ') {
        let length = word.chars().count();
        let room = columns.saturating_sub(if lines.is_empty() { 0 } else { 3 }).max(LEAST);
        if used > 0 && used + 1 + length > room {
            lines.push(std::mem::take(&mut line));
            used = 0;
        }
        if used > 0 {
            line.push(' ');
            used += 1;
        }
        line.push_str(word);
        used += length;
    }
    lines.push(line);
    lines
}
