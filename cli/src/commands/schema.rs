//! `framewright schema`: the language as a JSON Schema, and files as the JSON that it describes.

use crate::command_line::args::SchemaArguments;
use crate::error::Error;
use crate::files::inputs;
use crate::system::{Exit, text};
use framewright_graph::base::{ReadFiles, Sources};
use framewright_graph::language::{self, LARGEST_FILE};
use framewright_graph::ron::{self, Tree};

/// Prints the schema, or a file as JSON.
///
/// # Errors
/// If the file can't be read, is no RON, or holds what JSON can't.
pub(crate) fn schema(arguments: &SchemaArguments) -> Result<Exit, Error> {
    let shown = match &arguments.file {
        None => language::schema(),
        Some(path) => {
            let text = inputs::text(inputs::FileRole::ANY, path, LARGEST_FILE, &ReadFiles::default())?;
            let shown = path.to_string_lossy();
            let mut sources = Sources::default();
            let number = sources.add(shown.clone(), &*shown, text.clone());
            let mut diagnostics = Vec::new();
            let tree = Tree::read(number, text.into(), &mut diagnostics).filter(|_| diagnostics.is_empty());
            let wrong = |diagnostics| Error::mistakes(sources, diagnostics, Exit::Found);
            match tree.map(|tree| ron::convert(tree.root())) {
                Some(Ok(value)) => value,
                Some(Err(diagnostics)) => return Err(wrong(diagnostics)),
                None => return Err(wrong(diagnostics)),
            }
        }
    };
    text::print(&text::json(&shown)?).map_err(Error::Print)?;
    Ok(Exit::Fine)
}
