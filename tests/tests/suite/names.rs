//! Types and modules are named for things: a name that is a question word, a preposition or a bare participle doesn't tell what it holds.

use framewright_tests::sources::{self, Source};
use syn::visit::{self, Visit};

/// Words that are no things by themselves. Behind a noun, or before one, they may stand: `CheckedShaders`, `sampled_images`.
const NO_THINGS: &str = "
    how what when where which who whose why
    after against apart before behind beside by for last next of off then together with within
    again all due each either neither other others otherwise so thing things ways
    covers holds leaves lies refuse takes tell telling turns
    adapted adopted arrayed assigned awaited batched bisected cached called captured changed checked chosen collected combined compared
    compiled completing composed converging counted created crossed declared described drawn dumped estimated explained failed filled
    following found given guarded held included inserted invented judged kept keyed known linked lost made measured mentioned misplaced
    missing moved named opened painted parsed passed placed planned pooled precompiled prepared published recorded reflected refused
    removed reported running said sampled saved scoped selected shared shown sought stored supplied taken taking told tracked unread
    unset unused unwritten used varied wanted
    eligible flat good greedy initial live open optional plain separate sound unavailable unbindable unsupported unturned usual versioned
    wrong
";

/// The names of types and modules of a file that are no things, with their lines.
#[derive(Default)]
struct Names(Vec<(usize, String)>);

impl Names {
    fn of(file: &syn::File) -> Vec<(usize, String)> {
        let mut names = Names::default();
        names.visit_file(file);
        names.0
    }

    fn add(&mut self, name: &syn::Ident) {
        let lower = name.to_string().to_lowercase();
        if NO_THINGS.split_whitespace().any(|word| word == lower) {
            self.0.push((name.span().start().line, name.to_string()));
        }
    }
}

impl<'ast> Visit<'ast> for Names {
    fn visit_item_struct(&mut self, it: &'ast syn::ItemStruct) {
        self.add(&it.ident);
    }

    fn visit_item_enum(&mut self, it: &'ast syn::ItemEnum) {
        self.add(&it.ident);
    }

    fn visit_item_union(&mut self, it: &'ast syn::ItemUnion) {
        self.add(&it.ident);
    }

    fn visit_item_type(&mut self, it: &'ast syn::ItemType) {
        self.add(&it.ident);
    }

    fn visit_item_trait(&mut self, it: &'ast syn::ItemTrait) {
        self.add(&it.ident);
        visit::visit_item_trait(self, it);
    }

    fn visit_item_mod(&mut self, it: &'ast syn::ItemMod) {
        self.add(&it.ident);
        visit::visit_item_mod(self, it);
    }
}

/// What of a source is no test, as items.
fn items(Source { path, tokens, .. }: &Source) -> syn::File {
    syn::parse2(tokens.iter().cloned().collect()).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn types_and_modules_are_named_for_things() {
    let found: Vec<String> = sources::all()
        .iter()
        .flat_map(|source| {
            let names = Names::of(&items(source)).into_iter();
            names.map(|(line, name)| format!("{}:{line}: {name}", source.path))
        })
        .collect();
    assert!(
        found.is_empty(),
        "{} names are no things:\n{}\nname each for what it holds, in the field's words",
        found.len(),
        found.join("\n")
    );
}

#[test]
fn each_kind_of_name_is_looked_at() {
    let found = |text: &str| {
        Names::of(&syn::parse_str(text).expect("Rust")).into_iter().map(|(_, name)| name).collect::<Vec<_>>()
    };
    for (text, name) in [
        ("struct Told(u8);", "Told"),
        ("pub(crate) enum Ways { One }", "Ways"),
        ("trait Kept {}", "Kept"),
        ("type Of = u8;", "Of"),
        ("mod held;", "held"),
        ("mod names { struct Apart; }", "Apart"),
        ("fn f() { enum For { One } }", "For"),
    ] {
        assert_eq!(found(text), [name], "{text}");
    }
    let things = "struct CheckedShaders; enum PassEyes { For, Of } mod sampled_images; impl Iterator for List { type Held = u8; }";
    assert_eq!(found(things), Vec::<String>::new());
}
