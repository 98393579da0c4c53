//! Messages of the compiler of this program, with the lines that they speak of.

use framewright_graph::base::Quote;
use framewright_graph::shader::ShaderMessage;

/// More messages than this about one stage are only counted.
const MOST: usize = 20;

/// The messages with the lines that they are about. `text` is the text of a file that was compiled, by the name that messages
/// show.
pub(super) fn located<'t>(messages: Vec<String>, text: impl Fn(&str) -> Option<&'t str>) -> Vec<ShaderMessage> {
    let with_quote = |message: String| ShaderMessage { quote: quote(&message, &text), text: message, limit: None };
    bounded(messages.into_iter().map(with_quote).collect())
}

/// The first messages, and how many more there are.
pub(super) fn bounded(mut messages: Vec<ShaderMessage>) -> Vec<ShaderMessage> {
    let more = messages.len().saturating_sub(MOST);
    messages.truncate(MOST);
    if more > 0 {
        messages.push(ShaderMessage { text: format!("and {more} more"), quote: None, limit: None });
    }
    messages
}

/// The line that a message `FILE:LINE: error: WORDS` is about.
fn quote<'t>(message: &str, text: &impl Fn(&str) -> Option<&'t str>) -> Option<Quote> {
    let (place, words) = message.split_once(": error: ")?;
    let (file, line) = place.rsplit_once(':')?;
    let number: u32 = line.parse().ok()?;
    let line = text(file)?.lines().nth(number.checked_sub(1)? as usize)?;
    Some(Quote {
        file: file.to_owned(),
        line: number,
        underlined: underlined(line, words),
        text: line.to_owned(),
        remark: words.to_owned(),
    })
}

/// The part of a line that a message is about: the token that it names first, or the whole line without the space around it.
pub(super) fn underlined(line: &str, words: &str) -> std::ops::Range<usize> {
    let named = words.strip_prefix('\'').and_then(|rest| rest.split_once('\'')).map(|(token, _)| token);
    let token = named.filter(|token| !token.is_empty()).and_then(|token| {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let alone = |at: usize| {
            let (before, behind) = (&line[..at], &line[at + token.len()..]);
            !(token.starts_with(word) && before.ends_with(word) || token.ends_with(word) && behind.starts_with(word))
        };
        let at = line.match_indices(token).map(|(at, _)| at).find(|at| alone(*at))?;
        Some(at..at + token.len())
    });
    token.unwrap_or_else(|| {
        line.len() - line.trim_start().len()..line.trim_end().len().max(line.len() - line.trim_start().len())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_underlines_the_token_that_it_names_and_else_the_line() {
        let text = |name: &str| (name == "a:b.frag").then_some("one\n  color = ab + b;\n");
        let of = |message: &str| {
            quote(message, &text).map(|quote| (quote.line, quote.text[quote.underlined].to_owned(), quote.remark))
        };
        let found = |token: &str, remark: &str| Some((2, token.to_owned(), remark.to_owned()));
        assert_eq!(of("a:b.frag:2: error: 'b' : undeclared identifier"), found("b", "'b' : undeclared identifier"));
        assert_eq!(underlined("  color = ab + b;", "'b' : what"), 15..16);
        assert_eq!(of("a:b.frag:2: error: '' : syntax"), found("color = ab + b;", "'' : syntax"));
        assert_eq!(of("a:b.frag:9: error: 'b' : beyond the end"), None);
        assert_eq!(of("other.frag:1: error: 'b' : unknown file"), None);
        assert_eq!(of("a:b.frag: error: no line"), None);
    }
}
