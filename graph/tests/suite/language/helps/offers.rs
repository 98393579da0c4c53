//! Offers: the edits that a help suggests. Helps are sentences; text for a file stands in backticks or is a number.

/// One edit that a help suggests.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Offer {
    /// The text `new` in place of `old`, or of the underlined text.
    Write { new: String, old: Option<String> },
    /// A name that exists, in place of the underlined one. It need not be the one that was meant.
    Known(String),
    /// A field with a value: of the things of these names, or of the record around the underlined text.
    Say { field: String, value: String, of: Vec<String> },
    /// Nothing in place of a field, or of the underlined text.
    Leave(Option<String>),
    /// The underlined text, without its quotes.
    Unquote,
    /// A pass further up.
    Move(String),
    /// Two edits together.
    Both(Box<Offer>, Box<Offer>),
}

/// The use of a snippet.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verb {
    Write,
    Known,
    Leave,
    Move,
}

/// Words before text that is to be written.
const WRITE: [&str; 14] = [
    "did you mean",
    "write",
    "write one of",
    "say",
    "add",
    "give it",
    "it is",
    "is one of",
    "choose",
    "name one of",
    "takes instead:",
    "a name:",
    "insert at it by",
    "left is",
];
/// First words of clauses that tell an edit, and show it behind a colon.
const IMPERATIVES: [&str; 9] = ["say", "read", "write", "let", "clear", "compare", "list", "name", "texts stand"];
/// Words before names that exist.
const KNOWN: [&str; 2] = ["there are", "there is only"];

/// The offers of a help, one for each edit that it suggests. Words about the shader are for another file.
pub(super) fn offers(help: &str) -> Vec<Offer> {
    let line = help.lines().next().unwrap_or_default();
    // "write another `format` of `color`: `R8_UNORM`"
    if let Some((field, rest)) = line.strip_prefix("write another `").and_then(|rest| rest.split_once("` of `")) {
        let quoted: Vec<&str> = rest.split(", which ").next().unwrap_or(rest).split('`').step_by(2).collect();
        let values = rest.split('`').skip(2).step_by(2).take(quoted.len() - 2);
        let of = rest.split('`').next().unwrap_or_default();
        let say =
            |value: &str| Offer::Say { field: field.to_owned(), value: value.to_owned(), of: vec![of.to_owned()] };
        return values.map(say).collect();
    }
    let (mut all, mut verb) = (Vec::new(), None);
    let parts: Vec<&str> = line.split('`').collect();
    if line.starts_with("in the shader:") {
        return all;
    }
    let mut narrowed = false;
    for (at, part) in parts.iter().enumerate() {
        if at % 2 == 0 {
            verb = said(part, verb);
            all.extend(bare(part));
            continue;
        }
        let (before, after) = (parts[at - 1], parts.get(at + 1).unwrap_or(&""));
        narrowed = [" of ", " in place of "].contains(&before) || narrowed && before == " and ";
        if narrowed {
            all.iter_mut().for_each(|offer| narrow(offer, before, part));
        } else if let Some(verb) = verb.filter(|_| !after.starts_with(" in the shader")) {
            let next = offer(verb, part);
            match all.pop() {
                Some(first) if before == ", and " => all.push(Offer::Both(Box::new(first), Box::new(next))),
                first => all.extend(first.into_iter().chain([next])),
            }
        }
    }
    all
}

/// Narrows an offer by words behind it: to the field of `name`, or to writing in place of `name`.
fn narrow(offer: &mut Offer, by: &str, name: &str) {
    match offer {
        Offer::Say { of, .. } if of.is_empty() || by == " and " => of.push(name.to_owned()),
        Offer::Both(first, second) => [first, second].into_iter().for_each(|it| narrow(it, by, name)),
        Offer::Write { old, .. } if by == " in place of " => *old = Some(name.to_owned()),
        _ => {}
    }
}

fn offer(verb: Verb, part: &str) -> Offer {
    let is_word = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    match (verb, part.split_once(": ").filter(|(field, _)| is_word(field))) {
        (Verb::Leave, _) => Offer::Leave(Some(part.to_owned())),
        (Verb::Move, _) => Offer::Move(part.to_owned()),
        (Verb::Known, _) => Offer::Known(part.to_owned()),
        (Verb::Write, Some((field, value))) => {
            Offer::Say { field: field.to_owned(), value: value.to_owned(), of: Vec::new() }
        }
        (Verb::Write, None) => Offer::Write { new: part.to_owned(), old: None },
    }
}

/// The use of the snippet after some words, if `before` was the use of the one in front of them.
fn said(words: &str, before: Option<Verb>) -> Option<Verb> {
    if [",", "or", "and", ", or", ", and", "of", "in place of", ""].contains(&words.trim()) {
        return before;
    }
    let clause = words.rsplit("; ").next().unwrap_or(words);
    let clause = clause.rsplit(" or ").next().unwrap_or(clause).trim();
    let ends = |end: &&str| clause.strip_suffix(*end).is_some_and(|rest| !rest.ends_with(char::is_alphabetic));
    let form = words.starts_with("a ") && words.contains(" is ") || words.starts_with("the size of a view is");
    let shown = clause.ends_with(':') && IMPERATIVES.iter().any(|it| clause.starts_with(it));
    match () {
        () if KNOWN.iter().any(ends) => Some(Verb::Known),
        () if form || shown || WRITE.iter().any(ends) => Some(Verb::Write),
        () if ["leave", "leave out", "remove"].iter().any(ends) => Some(Verb::Leave),
        () if ends(&"move pass") => Some(Verb::Move),
        () => None,
    }
}

/// The offers of words without a snippet.
fn bare(words: &str) -> Vec<Offer> {
    let write = |new: &str| Offer::Write { new: new.to_owned(), old: None };
    let numbers = |text: &str| -> Vec<Offer> {
        let split = text.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == 'e' || c == '-'));
        split.filter(|it| it.parse::<f64>().is_ok()).map(write).collect()
    };
    let behind = |lead: &str| words.split_once(lead).map(|(_, rest)| rest.split([';', ':']).next().unwrap_or(rest));
    // The number behind "in steps" is no value.
    let range = |text: &str| numbers(text.split(" in steps").next().unwrap_or(text)).into_iter();
    let mut all = Vec::new();
    if words.contains("leave it out") || words.contains("leave one of them out") {
        all.push(Offer::Leave(None));
    }
    if words.contains("without quotes") {
        all.push(Offer::Unquote);
    }
    if let Some(allowed) = words.strip_suffix(" are allowed") {
        all.extend(range(allowed));
    } else if let Some(text) = behind(" from ").filter(|text| text.contains(" to ")) {
        all.extend(range(text).take(if text.contains("in steps") { 1 } else { 2 }));
    }
    let leads =
        ["nearest is ", "nearest are ", "next is ", "is one of ", "counts are ", "reaches about ", "reads version "];
    all.extend(leads.iter().filter_map(|lead| behind(lead)).flat_map(numbers));
    all
}
