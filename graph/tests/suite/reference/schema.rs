//! The JSON Schema, held by a validator that isn't ours against what the readers read.

use crate::reference::catalogue;
use crate::reference::examples::{whole, whole_word};
use crate::testing::pipelines::Pictures;
use boon::{Compiler, SchemaIndex, Schemas};
use framewright_graph::base::Sources;
use framewright_graph::language::{self, schema};
use framewright_graph::ron::{Leaf, Tree, convert};
use serde_json::Value;
use std::collections::HashSet;
use std::path::Path;

/// The schema, which the draft's own schema has found right.
struct Judge {
    schemas: Schemas,
    index: SchemaIndex,
}

impl Judge {
    fn new() -> Judge {
        let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
        compiler.add_resource("language.json", schema()).expect("JSON");
        let index = compiler.compile("language.json", &mut schemas).unwrap_or_else(|wrong| panic!("{wrong:#}"));
        Judge { schemas, index }
    }

    /// Why a file is refused, if it is.
    fn refuses(&self, value: &Value) -> Option<String> {
        self.schemas.validate(value, self.index).err().map(|wrong| format!("{wrong:#}"))
    }
}

fn tree(text: &str) -> Tree {
    Tree::read(0, text.into(), &mut Vec::new()).expect("RON")
}

fn json(text: &str) -> Option<Value> {
    convert(tree(text).root()).ok()
}

/// Pipelines that are shipped, by their paths.
fn shipped() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/pipelines");
    let mut folders = vec![folder];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("pipelines are shipped") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "ron") {
                files.push((path.display().to_string(), std::fs::read_to_string(&path).expect("a text")));
            }
        }
    }
    files
}

/// Files in which every form and every word of the language stands somewhere.
fn examples() -> Vec<(String, String)> {
    let all = catalogue::all();
    let tables = all.tables.iter().filter(|(name, _)| !all.inner.contains(name));
    let forms = tables.map(|(name, table)| ((*name).to_owned(), whole(name, &catalogue::example(table))));
    let words = all.words.iter().flat_map(|(name, words)| {
        let written = words.all.iter().flat_map(|word| word.written());
        written.map(move |word| (format!("{name}: {word}"), whole_word(name, word)))
    });
    forms.chain(words).collect()
}

#[test]
fn the_schema_accepts_every_shipped_file_and_every_example_of_the_reference() {
    let judge = Judge::new();
    let files: Vec<_> = shipped().into_iter().chain(examples()).collect();
    assert!(files.len() > 80);
    for (name, text) in files {
        let refused = judge.refuses(&json(&text).expect("it has a form in JSON"));
        assert!(refused.is_none(), "{name}: {}", refused.unwrap_or_default());
    }
}

#[test]
fn the_schema_refuses_what_is_written_wrong() {
    let judge = Judge::new();
    let (_, forward) = shipped().into_iter().find(|(name, _)| name.ends_with("forward.ron")).expect("it is shipped");
    for (right, wrong) in [
        ("version: 1,", ""),
        ("version: 1", "version: \"1\""),
        ("settings:", "setings:"),
        ("OneOf(default: 4, of: [1, 2, 4, 8])", "OneOf(default: 4)"),
        ("OneOf(default: 4, of: [1, 2, 4, 8])", "Bool"),
        ("Bool(default: true)", "Bool(default: 1)"),
        ("Bool(default: true)", "Boole(default: true)"),
        ("Number(default: 100.0, min: 1.0, max: 100.0)", "Number(100.0)"),
        ("name: \"depth\"", "name: \"the depth\""),
        ("format: Depth", "format: Dpeth"),
        ("format: Depth", "format: Depth(32)"),
        ("size: Output", "size: Scaled"),
        ("size: Output", "size: Fixed(640)"),
        ("size: Output", "size: Fixed(0, 480)"),
        ("samples: \"msaa\"", "samples: 3"),
        ("samples: Like(\"color\")", "samples: Like(7)"),
        ("draw: Objects(Opaque)", "draw: Objects(Solid)"),
        ("draw: Sky", "draw: \"Sky\""),
        ("clear: (0.0, 0.0, 0.0, 1.0)", "clear: (0.0, 0.0, 0.0)"),
        ("blend: Premultiplied", "blend: Premultiply"),
        ("blend: Premultiplied", "blend: (src: One)"),
        ("write: false", "write: 0"),
        ("color: [\"screen\"]", "color: \"screen\""),
        ("otherwise: Forward(from: \"color\", to: \"screen\")", "otherwise: Forward(\"color\", \"screen\")"),
        ("outputs: [\"screen\"]", "outputs: \"screen\""),
    ] {
        assert!(forward.contains(right), "forward.ron no longer holds {right}");
        let Some(value) = json(&forward.replacen(right, wrong, 1)) else { panic!("{wrong} is no RON") };
        assert!(judge.refuses(&value).is_some(), "{wrong} for {right} is accepted");
    }
}

/// Every value of a file, and every field with its name, by where they stand.
fn places(leaf: Leaf<'_>, found: &mut Vec<std::ops::Range<usize>>) {
    let range = |leaf: Leaf<'_>| leaf.span().start as usize..leaf.span().end as usize;
    found.push(range(leaf));
    for value in leaf.values().into_iter().flatten() {
        places(value, found);
    }
    for (name, value) in leaf.fields().into_iter().flatten() {
        found.push(range(name).start..range(value).end);
        places(value, found);
    }
    for (_, value) in leaf.entries().into_iter().flatten() {
        places(value, found);
    }
    if let framewright_graph::ron::Shape::Word(_, Some(inside)) = leaf.shape() {
        places(inside, found);
    }
}

/// The schema knows less than the readers, but nothing that they don't: they refuse all that it refuses.
#[test]
fn what_the_schema_refuses_is_wrong() {
    let judge = Judge::new();
    let (mut refused, mut wrong) = (0, 0);
    let mut seen = HashSet::new();
    for (name, text) in shipped().into_iter().filter(|(_, text)| text.contains("Pipeline(")).chain(examples()) {
        let mut found = Vec::new();
        places(tree(&text).root(), &mut found);
        // Places with the same words in them and before them need one try.
        let before = |at: usize| text.floor_char_boundary(at.saturating_sub(24));
        found.retain(|place| seen.insert(text[before(place.start)..place.end].to_owned()));
        for place in found {
            for other in ["7", "\"color\"", "Output", "[]", "()", "true", "(name: \"a\")", "Like(\"image\")", ""] {
                let changed = format!("{}{other}{}", &text[..place.start], &text[place.end..]);
                let Some(tree) = Tree::read(0, changed.as_str().into(), &mut Vec::new()) else { continue };
                let Ok(value) = convert(tree.root()) else { continue };
                if judge.schemas.validate(&value, judge.index).is_ok() {
                    continue;
                }
                refused += 1;
                if changed.trim_start().starts_with("Pipeline") && !changed.contains("extends:") {
                    let mut sources = Sources::default();
                    let read = language::read_with(&mut sources, &mut Pictures, "a.ron", "a.ron", changed.clone());
                    wrong += 1;
                    let why = || judge.refuses(&value).unwrap_or_default();
                    assert!(read.is_err(), "{name}: it is read, and refused by the schema\n{changed}\n{}", why());
                }
            }
        }
    }
    assert!(refused > 1_000 && wrong > 1_000, "{refused} {wrong}");
}
