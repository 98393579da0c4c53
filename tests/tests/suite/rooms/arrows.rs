//! The files that each file of a crate uses: its `use` declarations and paths, with re-exports followed to the file that defines the name.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;
use syn::visit::{self, Visit};
use syn::{Attribute, Ident, Item, ItemMod, ItemUse, Macro, UseTree, Visibility};

/// A path in a crate, without `crate`.
type Names = Vec<String>;

/// For each file of a crate, the other files that it uses. Files are named by their paths below `src`.
pub(super) type Arrows = BTreeMap<String, BTreeSet<String>>;

/// One module: a file, or a module inside one.
#[derive(Default)]
struct Module {
    file: String,
    /// Paths that `use` brings in, by the names that they get.
    imports: HashMap<String, Names>,
    /// Modules of which `use` brings in everything.
    globs: Vec<Names>,
    /// Names that are defined in it.
    defines: BTreeSet<String>,
    /// Paths that it names.
    paths: Vec<Names>,
    /// Paths that it exports again.
    exports: Vec<Names>,
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
        let mut reader = Reader::new(module_of(file), file);
        reader.visit_file(&parsed);
        macros.extend(reader.macros.into_iter().map(|name| (name, reader.name.clone())));
        modules.extend(reader.inner);
        modules.insert(reader.name, reader.module);
    }
    // Exported macros are named from the crate's root, wherever they are defined.
    if let Some(face) = modules.get_mut(&Names::new()) {
        let path = |(name, module): (String, Names)| {
            let path = ["crate".to_owned()].into_iter().chain(module).chain([name.clone()]).collect();
            (name, path)
        };
        face.imports.extend(macros.into_iter().map(path));
    }
    let mut arrows = Arrows::new();
    for (name, module) in &modules {
        arrows.entry(module.file.clone()).or_default().extend(used_by(&modules, name, module));
    }
    arrows
}

/// `a/b.rs` and `a/b/mod.rs` are the module `a::b`.
fn module_of(file: &str) -> Names {
    let mut names: Names = file.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if names.last().is_some_and(|last| matches!(last.as_str(), "mod" | "lib" | "main")) {
        names.pop();
    }
    names
}

/// The other files that a module uses. A module that exports again what lies below it doesn't use that: the files that name the
/// item do.
fn used_by(modules: &HashMap<Names, Module>, name: &Names, module: &Module) -> BTreeSet<String> {
    let file = |path: &Names| defining(modules, &rooted(modules, name, module, path)?, 0);
    let used = module.paths.iter().filter_map(file);
    let exported = module.exports.iter().filter_map(file).filter(|file| !module_of(file).starts_with(name));
    used.chain(exported).filter(|file| **file != module.file).cloned().collect()
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
    let Some(next) = path.get(at).filter(|next| depth < 8 && !module.defines.contains(*next)) else {
        return Some(&module.file);
    };
    let (name, rest) = (path[..at].to_vec(), &path[at + 1..]);
    let imported = |import: &Names| {
        let root = rooted(modules, &name, module, import)?;
        (root != path[..at + 1]).then(|| [&root, rest].concat())
    };
    let named = module.imports.get(next).and_then(imported);
    let globbed = || {
        module.globs.iter().find_map(|glob| {
            let root = rooted(modules, &name, module, glob).filter(|root| *root != name)?;
            modules.get(&root)?.has(next).then(|| [&root, &path[at..]].concat())
        })
    };
    match named.or_else(globbed) {
        Some(root) => defining(modules, &root, depth + 1),
        None => Some(&module.file),
    }
}

impl Module {
    /// Whether it defines a name or brings it in by this name.
    fn has(&self, name: &str) -> bool {
        self.defines.contains(name) || self.imports.contains_key(name)
    }
}

/// Reads the modules of a file.
struct Reader {
    name: Names,
    module: Module,
    /// The modules inside it.
    inner: Vec<(Names, Module)>,
    /// Macros that `#[macro_export]` puts into the crate's root.
    macros: Vec<String>,
}

/// Whether something is compiled for tests alone.
fn is_test(attributes: &[Attribute]) -> bool {
    let test = |attribute: &Attribute| matches!(&attribute.meta, syn::Meta::List(list) if list.path.is_ident("cfg") && list.tokens.to_string() == "test");
    attributes.iter().any(test)
}

/// Stands for all names.
const GLOB: &str = "*";

/// Each name that `use` brings in, with its path.
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
        UseTree::Glob(_) => found.push((GLOB.to_owned(), prefix.clone())),
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
                    self.macros.extend(it.ident.iter().map(Ident::to_string));
                }
                (&it.attrs, it.ident.as_ref())
            }
            _ => return visit::visit_item(self, item),
        };
        if !is_test(attributes) {
            self.module.defines.extend(name.map(Ident::to_string));
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        if !is_test(&module.attrs)
            && let Some((_, items)) = &module.content
        {
            let name = [&self.name[..], &[module.ident.to_string()]].concat();
            let mut reader = Reader::new(name, &self.module.file);
            items.iter().for_each(|item| reader.visit_item(item));
            self.macros.extend(reader.macros);
            self.inner.extend(reader.inner);
            self.inner.push((reader.name, reader.module));
        }
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let mut found = Vec::new();
        flatten(&item.tree, &mut Names::new(), &mut found);
        for (name, path) in found {
            match item.vis {
                Visibility::Inherited => self.module.paths.push(path.clone()),
                _ => self.module.exports.push(path.clone()),
            }
            match &*name {
                GLOB => self.module.globs.push(path),
                _ => drop(self.module.imports.insert(name, path)),
            }
        }
    }

    /// `pub(super)` names no file.
    fn visit_visibility(&mut self, _: &'ast Visibility) {}

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.module.paths.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'ast Macro) {
        self.tokens(called.tokens.clone());
        visit::visit_macro(self, called);
    }
}

impl Reader {
    fn new(name: Names, file: &str) -> Self {
        let module = Module { file: file.to_owned(), ..Module::default() };
        Self { name, module, inner: Vec::new(), macros: Vec::new() }
    }

    /// Paths in what a macro is given.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path = Names::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => {
                    if colons != 2 {
                        self.module.paths.push(std::mem::take(&mut path));
                    }
                    path.push(ident.to_string());
                    colons = 0;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                TokenTree::Group(group) => {
                    self.module.paths.push(std::mem::take(&mut path));
                    self.tokens(group.stream());
                }
                _ => colons = 0,
            }
        }
        self.module.paths.push(path);
        // `pub(crate)` names no file.
        self.module.paths.retain(|path| !path.is_empty() && *path != ["crate"]);
    }
}
