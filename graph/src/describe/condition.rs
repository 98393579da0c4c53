//! `when`: a small, total, typed language over settings and facts: `a && !b || c`.

use super::leaf::{Leaf, Shape};
use super::names::Scope;
use super::pipeline::{Condition, Fact, SettingKind, SettingRef, Subject, Term};
use super::reader::Reader;
use super::suggest;

/// A condition.
pub(super) fn lower<'src>(reader: &mut Reader<'src>, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Condition> {
    let Shape::Text = leaf.shape() else {
        reader.expected(leaf, "a condition in quotes");
        return None;
    };
    let super::leaf::Text::Plain(text) = reader.read(leaf, "condition")? else {
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
    complete.then_some(Condition { any, span: reader.span(leaf.0) })
}

fn term<'src>(reader: &mut Reader<'src>, scope: &Scope<'_>, whole: Leaf<'src>, part: &'src str) -> Option<Term> {
    let trimmed = part.trim();
    let name = trimmed.trim_start_matches(['!', ' ']);
    let negated = trimmed[..trimmed.len() - name.len()].matches('!').count() % 2 == 1;
    if name.is_empty() {
        let help = "a condition is a setting or a fact such as `scene.has_transparent`, with `!`, `&&` and `||`";
        reader.wrong(whole, "a name is missing in this condition", help);
        return None;
    }
    let odd = |c: char| !(c.is_alphanumeric() || matches!(c, '_' | '-' | '.'));
    // A blank within a name stands before what doesn't belong there.
    if let Some(at) = name.find(|c: char| odd(c) && c != ' ').or_else(|| name.find(odd)) {
        let found = name[at..].trim_start();
        let found = &found[..found.chars().next().map_or(0, char::len_utf8)];
        let help = "a condition is made of names, `!`, `&&` and `||`";
        reader.wrong(Leaf(found), format!("unexpected `{found}` in a condition"), help);
        return None;
    }
    let subject = if name.contains('.') {
        Subject::Fact(fact(reader, Leaf(name))?)
    } else {
        Subject::Setting(truth(reader, scope, Leaf(name))?)
    };
    Some(Term { subject, negated })
}

fn fact<'src>(reader: &mut Reader<'src>, leaf: Leaf<'src>) -> Option<Fact> {
    let found = Fact::ALL.into_iter().find(|fact| fact.name() == leaf.0);
    if found.is_none() {
        let help = suggest::help(leaf.0, Fact::ALL.map(Fact::name)).unwrap_or_default();
        reader.wrong(leaf, format!("there is no fact named `{}`", leaf.0), &help);
    }
    found
}

/// A setting that is `true` or `false`.
fn truth<'src>(reader: &mut Reader<'src>, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<SettingRef> {
    let span = reader.span(leaf.0);
    let name = super::Name { text: leaf.0.into(), span };
    let index = scope.settings.find(reader, &name)?;
    let reference = SettingRef { index, span };
    scope.fitting(reader, reference, |kind| matches!(kind, SettingKind::Bool { .. }), "`true` or `false`")
}
