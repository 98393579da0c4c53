//! The picture files that textures name.

use super::loader::Loader;
use super::pipeline_files::WITHIN_ROOT;
use crate::base::{Code, Diagnostic, FilePath, OutsideChoice, Sources};
use crate::frame::{TextureFile, TextureInfo, TextureProblem};
use crate::language::entries::textures::{Picture, Pictures, TextureFields, color_space};
use crate::ron::{Leaf, Reader};
use std::sync::Arc;

impl Loader<'_> {
    /// Looks at the pictures that a list of textures names.
    pub(crate) fn look(&mut self, reader: &mut Reader, textures: Option<Leaf<'_>>) {
        let Loader { sources, files, looked, pictures, .. } = self;
        let info = |file: &TextureFile| match looked.get(file) {
            Some(known) => known.clone(),
            None => looked.entry(file.clone()).insert_entry(files.picture(file)).get().clone(),
        };
        look(reader, sources, info, textures, pictures);
    }

    /// Looks at the pictures that the fragments of a file name.
    pub(crate) fn look_in_fragments(&mut self, reader: &mut Reader, all: Leaf<'_>) {
        let fragments = all.field("fragments").and_then(Leaf::values);
        for textures in fragments.into_iter().flatten().filter_map(|fragment| fragment.field("textures")) {
            self.look(reader, Some(textures));
        }
    }
}

/// Looks at the files that a list of textures names; `info` tells of them. Mistakes in the list itself are reported when
/// it is evaluated.
fn look(
    reader: &mut Reader,
    sources: &Sources,
    mut info: impl FnMut(&TextureFile) -> Result<TextureInfo, TextureProblem>,
    list: Option<Leaf<'_>>,
    pictures: &mut Pictures,
) {
    let mut silent = Reader::default();
    let entries = list.and_then(|list| silent.list(list, "`textures`")).unwrap_or_default();
    for entry in entries {
        let Some(fields) = silent.read::<TextureFields<'_>>(entry, "a texture") else { continue };
        let Some(path) = silent.words(fields.file, "the path of a file") else { continue };
        let Some(color_space) = color_space(&mut silent, fields.color_space) else { continue };
        let span = fields.file.span();
        let from = span.file().and_then(|file| sources.file(file)).map(|file| &file.path);
        let wrong =
            |problem: &dyn std::fmt::Display| Diagnostic::new(Code::TEXTURE_FILE, span, format!("`{path}` {problem}"));
        let picture = match from.unwrap_or(&"".into()).beside(&path) {
            Ok(FilePath::Own(own)) => {
                let mut file = TextureFile { path: own, color_space, stored: false };
                let known = in_own_space(&mut file, fields.color_space.is_some(), &mut info);
                let stored = known.as_ref().is_ok_and(|info| info.stored);
                let file = Arc::new(TextureFile { stored, ..file });
                known.map(|info| Picture { file, info }).map_err(|problem| {
                    let wrong = Diagnostic { of_machine: problem.is_of_machine(), ..wrong(&problem) };
                    match problem {
                        TextureProblem::Basis { .. } => Diagnostic { code: Code::TEXTURE_BASIS, ..wrong },
                        TextureProblem::Outside => {
                            let outside = Diagnostic { code: Code::FILE_OUTSIDE_ROOT, ..wrong };
                            outside.help(WITHIN_ROOT).choice(OutsideChoice::Root)
                        }
                        _ => wrong,
                    }
                })
            }
            Ok(FilePath::Shipped(_)) => Err(wrong(&"can't be read: no textures are shipped")),
            Err(problem) => Err(wrong(&problem)),
        };
        let picture = picture.map_err(|wrong| reader.report(wrong)).ok();
        pictures.insert(span, picture);
    }
}

/// What is known of a file in the colour space that it names itself; where the pipeline says another one (`is_said`), it is wrong.
fn in_own_space(
    file: &mut TextureFile,
    is_said: bool,
    info: &mut impl FnMut(&TextureFile) -> Result<TextureInfo, TextureProblem>,
) -> Result<TextureInfo, TextureProblem> {
    let known = info(file)?;
    match known.color_space {
        Some(named) if named != file.color_space && is_said => Err(TextureProblem::ColorSpace { named }),
        Some(named) if named != file.color_space => {
            file.color_space = named;
            info(file)
        }
        _ => Ok(known),
    }
}
