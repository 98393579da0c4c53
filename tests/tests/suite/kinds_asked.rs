//! Code outside the owner of a kind (of work, draw, role or binding) calls a predicate of the owner, or matches all variants. So the compiler
//! shows each place that a new variant touches.

use framewright_tests::sources::{self, KINDS, Source};
use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeSet;
use syn::visit::{self, Visit};

/// Looks for questions about a kind that the compiler doesn't hold complete.
struct Questions<'k> {
    names: BTreeSet<&'k str>,
    found: Vec<(usize, &'static str)>,
}

impl Questions<'_> {
    fn is_variant(&self, path: &syn::Path) -> bool {
        let mut segments = path.segments.iter().rev();
        let variant = segments.next().is_some_and(|it| it.ident.to_string().starts_with(char::is_uppercase));
        variant && segments.next().is_some_and(|it| self.names.contains(it.ident.to_string().as_str()))
    }

    /// Whether a pattern names a variant at any depth.
    fn names_variant(&self, pattern: &syn::Pat) -> bool {
        struct Paths<'q, 'k>(&'q Questions<'k>, bool);
        impl<'ast> Visit<'ast> for Paths<'_, '_> {
            fn visit_path(&mut self, path: &'ast syn::Path) {
                self.1 |= self.0.is_variant(path);
                visit::visit_path(self, path);
            }
        }
        let mut paths = Paths(self, false);
        paths.visit_pat(pattern);
        paths.1
    }

    /// The places at which a pattern names variants: the steps to each, from the whole pattern.
    fn places(&self, pattern: &syn::Pat, way: &[String], found: &mut BTreeSet<Vec<String>>) {
        let path = match pattern {
            syn::Pat::Path(it) => Some(&it.path),
            syn::Pat::TupleStruct(it) => Some(&it.path),
            syn::Pat::Struct(it) => Some(&it.path),
            _ => None,
        };
        if path.is_some_and(|path| self.is_variant(path)) {
            found.insert(way.to_owned());
        }
        for (step, part) in parts(pattern) {
            let way: Vec<String> = way.iter().cloned().chain(step).collect();
            self.places(part, &way, found);
        }
    }

    fn is_value(&self, expression: &syn::Expr) -> bool {
        match expression {
            syn::Expr::Path(path) => self.is_variant(&path.path),
            syn::Expr::Struct(of) => self.is_variant(&of.path),
            syn::Expr::Call(call) => self.is_value(&call.func) || call.args.iter().any(|it| self.is_value(it)),
            syn::Expr::Reference(of) => self.is_value(&of.expr),
            syn::Expr::Array(of) => of.elems.iter().any(|it| self.is_value(it)),
            _ => false,
        }
    }

    fn in_tokens(&self, tokens: TokenStream) -> bool {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let text = |at: usize| tokens.get(at).map(ToString::to_string).unwrap_or_default();
        (0..tokens.len()).any(|at| {
            let named = self.names.contains(text(at).as_str()) && text(at + 1) == ":" && text(at + 2) == ":";
            let within = matches!(&tokens[at], TokenTree::Group(group) if self.in_tokens(group.stream()));
            within || named && text(at + 3).starts_with(char::is_uppercase)
        })
    }
}

/// Whether a pattern takes anything.
fn takes_all(pattern: &syn::Pat) -> bool {
    match pattern {
        syn::Pat::Wild(_) | syn::Pat::Rest(_) => true,
        syn::Pat::Ident(it) => it.subpat.is_none() && it.ident.to_string().starts_with(char::is_lowercase),
        syn::Pat::Tuple(tuple) => tuple.elems.iter().all(takes_all),
        syn::Pat::Reference(it) => takes_all(&it.pat),
        syn::Pat::Paren(it) => takes_all(&it.pat),
        syn::Pat::Or(it) => it.cases.iter().any(takes_all),
        _ => false,
    }
}

fn last(path: &syn::Path) -> String {
    path.segments.last().map(|it| it.ident.to_string()).unwrap_or_default()
}

/// The parts of a pattern, and the step to each: none where the part stands for the same value.
fn parts(pattern: &syn::Pat) -> Vec<(Option<String>, &syn::Pat)> {
    match pattern {
        syn::Pat::Ident(it) => it.subpat.iter().map(|(_, part)| (None, &**part)).collect(),
        syn::Pat::Reference(it) => vec![(None, &*it.pat)],
        syn::Pat::Paren(it) => vec![(None, &*it.pat)],
        syn::Pat::Or(it) => it.cases.iter().map(|part| (None, part)).collect(),
        syn::Pat::Tuple(it) => (0..).zip(&it.elems).map(|(at, part): (u32, _)| (Some(at.to_string()), part)).collect(),
        syn::Pat::Slice(it) => (0..).zip(&it.elems).map(|(at, part): (u32, _)| (Some(at.to_string()), part)).collect(),
        syn::Pat::TupleStruct(it) => {
            let step = |at: u32| Some(format!("{} {at}", last(&it.path)));
            (0..).zip(&it.elems).map(|(at, part)| (step(at), part)).collect()
        }
        syn::Pat::Struct(it) => {
            let step = |field: &syn::Member| match field {
                syn::Member::Named(field) => Some(format!("{} {field}", last(&it.path))),
                syn::Member::Unnamed(field) => Some(format!("{} {}", last(&it.path), field.index)),
            };
            it.fields.iter().map(|field| (step(&field.member), &*field.pat)).collect()
        }
        _ => Vec::new(),
    }
}

/// Whether a pattern takes anything at a place; a tuple only if it takes anything beside the place too.
fn takes_all_at(pattern: &syn::Pat, way: &[String]) -> bool {
    let (parts, next) = (parts(pattern), way.first());
    // Fields behind `..` aren't looked at.
    let hidden = match (pattern, next) {
        (syn::Pat::Struct(it), Some(next)) => {
            it.rest.is_some()
                && next.starts_with(&format!("{} ", last(&it.path)))
                && parts.iter().all(|(step, _)| step.as_ref() != Some(next))
        }
        _ => false,
    };
    let all_others = |step: &Option<String>| {
        let others = || parts.iter().filter(|(other, _)| other != step);
        !matches!(pattern, syn::Pat::Tuple(_)) || others().all(|(_, part)| takes_all(part))
    };
    let in_part = |(step, part): &(Option<String>, &syn::Pat)| match step {
        None => takes_all_at(part, way),
        Some(_) => step.as_ref() == next && takes_all_at(part, &way[1..]) && all_others(step),
    };
    takes_all(pattern) || hidden || parts.iter().any(in_part)
}

impl<'ast> Visit<'ast> for Questions<'_> {
    fn visit_expr_let(&mut self, it: &'ast syn::ExprLet) {
        if self.names_variant(&it.pat) {
            self.found.push((it.let_token.span.start().line, "let"));
        }
        visit::visit_expr_let(self, it);
    }

    fn visit_local(&mut self, it: &'ast syn::Local) {
        if self.names_variant(&it.pat) {
            self.found.push((it.let_token.span.start().line, "let … else"));
        }
        visit::visit_local(self, it);
    }

    fn visit_expr_binary(&mut self, it: &'ast syn::ExprBinary) {
        let found = match &it.op {
            syn::BinOp::Eq(token) => Some((token.spans[0], "==")),
            syn::BinOp::Ne(token) => Some((token.spans[0], "!=")),
            _ => None,
        };
        if let Some((span, how)) = found.filter(|_| self.is_value(&it.left) || self.is_value(&it.right)) {
            self.found.push((span.start().line, how));
        }
        visit::visit_expr_binary(self, it);
    }

    fn visit_expr_match(&mut self, it: &'ast syn::ExprMatch) {
        let mut places = BTreeSet::new();
        it.arms.iter().for_each(|arm| self.places(&arm.pat, &[], &mut places));
        let open = |arm: &syn::Arm| places.iter().any(|place| takes_all_at(&arm.pat, place));
        if it.arms.iter().any(open) {
            self.found.push((it.match_token.span.start().line, "match with `_`"));
        }
        visit::visit_expr_match(self, it);
    }

    fn visit_expr_method_call(&mut self, it: &'ast syn::ExprMethodCall) {
        if it.method == "contains" && self.is_value(&it.receiver) {
            self.found.push((it.method.span().start().line, "contains"));
        }
        visit::visit_expr_method_call(self, it);
    }

    fn visit_macro(&mut self, it: &'ast syn::Macro) {
        let name = it.path.segments.last().map(|it| it.ident.to_string());
        if name.as_deref() == Some("matches") && self.in_tokens(it.tokens.clone()) {
            self.found.push((it.bang_token.span.start().line, "matches!"));
        }
    }
}

/// The questions of a source about one kind: lines, and how each asks.
fn questions(text: &TokenStream, kind: &str) -> Vec<(usize, &'static str)> {
    let file: syn::File = syn::parse2(text.clone()).unwrap_or_else(|error| panic!("{error}"));
    let mut names = BTreeSet::from([kind.to_owned()]);
    struct Aliases<'n>(&'n mut BTreeSet<String>, String);
    impl<'ast> Visit<'ast> for Aliases<'_> {
        fn visit_use_rename(&mut self, it: &'ast syn::UseRename) {
            if it.ident == self.1 {
                self.0.insert(it.rename.to_string());
            }
        }
    }
    Aliases(&mut names, kind.to_owned()).visit_file(&file);
    let mut questions = Questions { names: names.iter().map(String::as_str).collect(), found: Vec::new() };
    questions.visit_file(&file);
    questions.found
}

#[test]
fn kinds_are_asked_for_beside_their_enumeration_or_listed_whole() {
    let mut open = Vec::new();
    for Source { path, tokens, .. } in sources::all() {
        for kind in KINDS.iter().filter(|kind| kind.is_foreign_to(&path)) {
            let (tokens, name) = (tokens.iter().cloned().collect(), kind.name);
            let questions = questions(&tokens, name).into_iter();
            open.extend(questions.map(|(line, how)| format!("{path}:{line}: {name} by {how}")));
        }
    }
    assert!(
        open.is_empty(),
        "{} places ask for a kind so that a new one is missed:\n{}\nask a predicate beside the enumeration, or list all kinds",
        open.len(),
        open.join("\n")
    );
}

#[test]
fn each_way_to_miss_a_kind_is_found() {
    let found = |text: &str| {
        let tokens: TokenStream = text.parse().expect("Rust");
        questions(&tokens, "Work").into_iter().map(|(_, how)| how).collect::<Vec<_>>()
    };
    for (text, how) in [
        ("fn f(it: &Work) -> bool { matches!(it, Some(Work::Copy(_))) }", "matches!"),
        ("fn f(it: &Work) { if let Work::Copy(_) = it {} }", "let"),
        ("fn f(it: &Work) { while let Some(Work::Copy(_)) = it {} }", "let"),
        ("fn f(it: &Work) { let Work::Copy(_) = it else { return }; }", "let … else"),
        ("fn f(it: Work) -> bool { it == Work::Copy }", "=="),
        ("fn f(it: Work) -> bool { Some(Work::Copy) != it }", "!="),
        ("fn f(it: Work) -> u32 { match it { Work::Copy => 1, _ => 2 } }", "match with `_`"),
        ("fn f(it: Work) -> u32 { match (it, 1) { (Work::Copy, 1) => 1, (_, _) => 2 } }", "match with `_`"),
        ("fn f(it: Work) -> u32 { match it { Work::Copy => 1, other => 2 } }", "match with `_`"),
        ("fn f(it: Work) -> u32 { match it { Some(Work::Copy(_)) => 1, Some(_) | None => 2 } }", "match with `_`"),
        (
            "fn f(it: Work) -> u32 { match it { (Some(Work::Copy), true) => 1, (Some(_), _) => 2, (None, _) => 3 } }",
            "match with `_`",
        ),
        ("fn f(it: It) -> u32 { match it { It { work: Work::Copy, .. } => 1, It { .. } => 2 } }", "match with `_`"),
        ("fn f(it: Work) -> bool { [Work::Copy, Work::Fill].contains(&it) }", "contains"),
        ("use crate::Work as FrameWork; fn f(it: FrameWork) -> bool { matches!(it, FrameWork::Copy) }", "matches!"),
    ] {
        assert_eq!(found(text), [how], "{text}");
    }
    for text in [
        "fn f(it: Work) -> u32 { match it { Work::Copy => 1, Work::Blit | Work::Fill => 2 } }",
        "fn f(it: Work) -> u32 { match it { Some(Work::Copy) => 1, Some(Work::Fill) => 2, None => 3 } }",
        "fn f(it: Work) -> u32 { match it { (Work::Copy, _) => 1, (Work::Fill, it) => 2 } }",
        "fn f() -> Work { Work::Copy }",
        "fn f(it: &Works) -> bool { matches!(it, Works::Copy) }",
        "fn f(it: &Work) -> bool { it.copies() }",
    ] {
        assert_eq!(found(text), Vec::<&str>::new(), "{text}");
    }
}
