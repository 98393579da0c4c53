//! `when`: a small, total, typed language over settings and facts: `a && !b || c`.

use super::leaf::{Leaf, Shape};
use super::names::Scope;
use super::pipeline::{Condition, SettingKind, SettingRef, Subject, Term};
use super::reader::Reader;
use super::suggest;
use crate::facts::{Fact, FactType};

/// A condition.
pub(super) fn lower<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Condition> {
    let Shape::Text = leaf.shape() else {
        reader.expected(leaf, "a condition in quotes");
        return None;
    };
    let Some(text) = leaf.plain() else {
        reader.wrong(leaf, "conditions take no escapes", "");
        return None;
    };
    let mut any = Vec::new();
    let mut complete = true;
    for group in text.split("||") {
        let mut terms = Vec::new();
        for part in group.split("&&") {
            match term(reader, scope, leaf, part) {
                Some(term) => terms.push(term),
                None => complete = false,
            }
        }
        any.push(terms);
    }
    complete.then_some(Condition { any, span: leaf.span() })
}

fn term<'src>(reader: &mut Reader, scope: &Scope<'_>, whole: Leaf<'src>, part: &'src str) -> Option<Term> {
    let trimmed = part.trim();
    let name = trimmed.trim_start_matches(['!', ' ']);
    let negated = trimmed[..trimmed.len() - name.len()].matches('!').count() % 2 == 1;
    if name.is_empty() {
        let help = "a condition is a setting or a fact such as `scene.has_transparent`, with `!`, `&&` and `||`";
        reader.wrong(whole, "a name is missing in this condition", help);
        return None;
    }
    let odd = |c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.'));
    // A blank within a name stands before what doesn't belong there.
    if let Some(at) = name.find(|c: char| odd(c) && c != ' ').or_else(|| name.find(odd)) {
        let found = name[at..].trim_start();
        let found = &found[..found.chars().next().map_or(0, char::len_utf8)];
        let help = "a condition is made of names, `!`, `&&` and `||`";
        reader.wrong_part(whole, found, format!("unexpected `{found}` in a condition"), help);
        return None;
    }
    let subject = if name.contains('.') {
        Subject::Fact(fact(reader, whole, name)?)
    } else {
        Subject::Setting(truth(reader, scope, whole, name)?)
    };
    Some(Term { subject, negated })
}

/// A fact that is `true` or `false`.
fn fact(reader: &mut Reader, whole: Leaf<'_>, name: &str) -> Option<Fact> {
    let asked = || Fact::ALL.into_iter().filter(|fact| fact.ty() == FactType::Bool).map(Fact::name);
    match Fact::ALL.into_iter().find(|fact| fact.name() == name) {
        Some(fact) if fact.ty() == FactType::Bool => Some(fact),
        Some(_) => {
            let names: Vec<String> = asked().map(|name| format!("`{name}`")).collect();
            let help = format!("a condition may ask {}", names.join(", "));
            let message = format!("`{name}` is a number, and a condition asks what is true or false");
            reader.wrong_part(whole, name, message, &help);
            None
        }
        None => {
            let help = suggest::help(name, asked().collect::<Vec<_>>()).unwrap_or_default();
            reader.wrong_part(whole, name, format!("there is no fact named `{name}`"), &help);
            None
        }
    }
}

/// A setting that is `true` or `false`.
fn truth(reader: &mut Reader, scope: &Scope<'_>, whole: Leaf<'_>, name: &str) -> Option<SettingRef> {
    let span = whole.span_of(name);
    let name = super::Name { text: name.into(), span };
    let index = scope.settings.find(reader, &name)?;
    let reference = SettingRef { index, span };
    scope.fitting(reader, reference, |kind| matches!(kind, SettingKind::Bool { .. }), "`true` or `false`")
}
