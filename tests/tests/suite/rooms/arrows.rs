//! Which file of a crate uses which: its `use` declarations and paths, with re-exports followed to the file that defines the name.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;
use syn::visit::{self, Visit};
use syn::{Attribute, Ident, Item, ItemMod, ItemUse, Macro, UseTree, Visibility};

/// A path in a crate, without `crate`.
type Names = Vec<String>;

/// For each file of a crate, the other files that it uses. Files are named by their paths below `src`.
pub(super) type Arrows = BTreeMap<String, BTreeSet<String>>;

/// One module: a file of its own.
struct Module {
    file: String,
    /// What `use` brings in, by the name that it gets.
    imports: HashMap<String, Names>,
    /// Names that are defined in it.
    defines: BTreeSet<String>,
    /// Paths that it names.
    paths: Vec<Names>,
}

/// The arrows of the crate whose sources lie in `src`.
pub(super) fn of_folder(src: &Path) -> Arrows {
    let mut sources = Vec::new();
    collect(src, src, &mut sources);
    of_sources(sources.iter().map(|(file, text)| (file.as_str(), text.as_str())))
}

fn collect(src: &Path, folder: &Path, sources: &mut Vec<(String, String)>) {
    let mut entries: Vec<_> = folder.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            collect(src, &path, sources);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let file = path.strip_prefix(src).unwrap().to_str().unwrap().to_owned();
            sources.push((file, std::fs::read_to_string(&path).unwrap()));
        }
    }
}

/// The arrows between files that are given by path and text.
pub(super) fn of_sources<'s>(sources: impl IntoIterator<Item = (&'s str, &'s str)>) -> Arrows {
    let mut modules: HashMap<Names, Module> = HashMap::new();
    let mut macros: Vec<(String, Names)> = Vec::new();
    for (file, text) in sources {
        let parsed = syn::parse_file(text).unwrap_or_else(|error| panic!("{file}: {error}"));
        let mut reader = Reader { module: module_of(file), ..Reader::default() };
        reader.visit_file(&parsed);
        let Reader { module, imports, defines, paths, exported } = reader;
        macros.extend(exported.into_iter().map(|name| (name, module.clone())));
        modules.insert(module, Module { file: file.to_owned(), imports, defines, paths });
    }
    // Exported macros are named from the crate's root, wherever they are defined.
    if let Some(face) = modules.get_mut(&Names::new()) {
        let path = |(name, module): (String, Names)| {
            let path = ["crate".to_owned()].into_iter().chain(module).chain([name.clone()]).collect();
            (name, path)
        };
        face.imports.extend(macros.into_iter().map(path));
    }
    modules.iter().map(|(name, module)| (module.file.clone(), used_by(&modules, name, module))).collect()
}

/// `a/b.rs` and `a/b/mod.rs` are the module `a::b`.
fn module_of(file: &str) -> Names {
    let mut names: Names = file.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if names.last().is_some_and(|last| matches!(last.as_str(), "mod" | "lib" | "main")) {
        names.pop();
    }
    names
}

fn used_by(modules: &HashMap<Names, Module>, name: &Names, module: &Module) -> BTreeSet<String> {
    let mut files = BTreeSet::new();
    for path in &module.paths {
        let Some(path) = rooted(modules, name, module, path) else { continue };
        if let Some(file) = defining(modules, &path, 0).filter(|file| **file != module.file) {
            files.insert(file.clone());
        }
    }
    files
}

/// The path from the crate's root, of a path that a module names; `None` if it leads out of the crate.
fn rooted(modules: &HashMap<Names, Module>, name: &Names, module: &Module, path: &[String]) -> Option<Names> {
    let mut from = name.clone();
    let mut rest = path;
    match path.first()?.as_str() {
        "crate" => return Some(path[1..].to_vec()),
        "self" => rest = &path[1..],
        "super" => {
            while rest.first().is_some_and(|first| first == "super") {
                from.pop()?;
                rest = &rest[1..];
            }
        }
        first => {
            let child = || from.iter().cloned().chain([first.to_owned()]).collect::<Names>();
            if let Some(import) = module.imports.get(first).filter(|import| import[0] != first) {
                let root = rooted(modules, name, module, import)?;
                return Some(root.into_iter().chain(rest[1..].iter().cloned()).collect());
            } else if !modules.contains_key(&child()) {
                return None;
            }
        }
    }
    from.extend(rest.iter().cloned());
    Some(from)
}

/// The file in which what a path names is defined.
fn defining<'m>(modules: &'m HashMap<Names, Module>, path: &[String], depth: u32) -> Option<&'m String> {
    let (at, module) = (0..=path.len()).rev().find_map(|at| Some((at, modules.get(&path[..at])?)))?;
    let Some(next) = path.get(at) else { return Some(&module.file) };
    if depth < 8
        && !module.defines.contains(next)
        && let Some(import) = module.imports.get(next)
        && let Some(root) = rooted(modules, &path[..at].to_vec(), module, import)
        && root != path[..at + 1]
    {
        return defining(modules, &root, depth + 1);
    }
    Some(&module.file)
}

#[derive(Default)]
struct Reader {
    module: Names,
    imports: HashMap<String, Names>,
    defines: BTreeSet<String>,
    paths: Vec<Names>,
    /// Macros that `#[macro_export]` puts into the crate's root.
    exported: Vec<String>,
}

/// Whether something is compiled for tests alone.
fn is_test(attributes: &[Attribute]) -> bool {
    let test = |attribute: &Attribute| matches!(&attribute.meta, syn::Meta::List(list) if list.path.is_ident("cfg") && list.tokens.to_string() == "test");
    attributes.iter().any(test)
}

fn flatten(tree: &UseTree, prefix: &mut Names, found: &mut Vec<(String, Names)>) {
    let with = |prefix: &Names, name: &Ident| prefix.iter().cloned().chain([name.to_string()]).collect::<Names>();
    match tree {
        UseTree::Path(path) => {
            prefix.push(path.ident.to_string());
            flatten(&path.tree, prefix, found);
            prefix.pop();
        }
        UseTree::Name(name) if name.ident == "self" => {
            found.push((prefix.last().cloned().unwrap_or_default(), prefix.clone()));
        }
        UseTree::Name(name) => found.push((name.ident.to_string(), with(prefix, &name.ident))),
        UseTree::Rename(renamed) => found.push((renamed.rename.to_string(), with(prefix, &renamed.ident))),
        UseTree::Glob(_) => found.push(("*".to_owned(), prefix.clone())),
        UseTree::Group(group) => group.items.iter().for_each(|tree| flatten(tree, prefix, found)),
    }
}

impl<'ast> Visit<'ast> for Reader {
    fn visit_item(&mut self, item: &'ast Item) {
        let (attributes, name) = match item {
            Item::Fn(it) => (&it.attrs, Some(&it.sig.ident)),
            Item::Struct(it) => (&it.attrs, Some(&it.ident)),
            Item::Enum(it) => (&it.attrs, Some(&it.ident)),
            Item::Trait(it) => (&it.attrs, Some(&it.ident)),
            Item::Type(it) => (&it.attrs, Some(&it.ident)),
            Item::Const(it) => (&it.attrs, Some(&it.ident)),
            Item::Static(it) => (&it.attrs, Some(&it.ident)),
            Item::Impl(it) => (&it.attrs, None),
            Item::Macro(it) => {
                if it.attrs.iter().any(|attribute| attribute.path().is_ident("macro_export")) {
                    self.exported.extend(it.ident.iter().map(Ident::to_string));
                }
                (&it.attrs, it.ident.as_ref())
            }
            _ => return visit::visit_item(self, item),
        };
        if !is_test(attributes) {
            self.defines.extend(name.map(Ident::to_string));
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    /// A re-export is no use of the file: the files that name the item use it.
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let mut found = Vec::new();
        flatten(&item.tree, &mut Names::new(), &mut found);
        for (name, path) in found {
            if matches!(item.vis, Visibility::Inherited) {
                self.paths.push(path.clone());
            }
            self.imports.insert(name, path);
        }
    }

    /// `pub(super)` names no file.
    fn visit_visibility(&mut self, _: &'ast Visibility) {}

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.paths.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'ast Macro) {
        self.tokens(called.tokens.clone());
        visit::visit_macro(self, called);
    }
}

impl Reader {
    /// Paths in what a macro is given.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path = Names::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => {
                    if colons != 2 {
                        self.paths.push(std::mem::take(&mut path));
                    }
                    path.push(ident.to_string());
                    colons = 0;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                TokenTree::Group(group) => {
                    self.paths.push(std::mem::take(&mut path));
                    self.tokens(group.stream());
                }
                _ => colons = 0,
            }
        }
        self.paths.push(path);
        // `pub(crate)` names no file.
        self.paths.retain(|path| !path.is_empty() && *path != ["crate"]);
    }
}
