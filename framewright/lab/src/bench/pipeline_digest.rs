//! A digest of all files that a pipeline is made of, shaders and pictures of the user's own among them.

use crate::digest::Digest;
use crate::mentions::Mentions;
use framewright::Pipeline;
use framewright_graph::base::{FilePath, unix_lines};
use framewright_passes::shipped::SHADERS;
use std::borrow::Cow;
use std::collections::BTreeSet;

/// The digest. It is that of the whole pipeline, whatever a choice leaves out of it: a shader is part of it if a string of a file
/// is its name. Shipped shaders are no part of it, nor are files that can't be read, nor are line endings.
pub(super) fn of(pipeline: &Pipeline) -> String {
    let files: Vec<_> = (0..).map_while(|file| pipeline.sources.file(file)).collect();
    let texts = files.iter().map(|file| unix_lines(&file.text).into_owned().into_bytes());
    let own = files.iter().filter(|file| matches!(file.path, FilePath::Own(_)));
    let shaders: BTreeSet<Vec<u8>> = own
        .flat_map(|file| {
            // A sky without a word is drawn by the shader of that name.
            let names = Mentions::of_text(&file.text).strings().chain(["sky"]).collect::<Vec<_>>();
            let own = names.into_iter().flat_map(|name| pipeline.assets.shaders.own_files(&file.path, name));
            own.collect::<Vec<_>>()
        })
        .collect();
    let pictures = pipeline.pictures.iter().filter_map(|path| pipeline.assets.textures.bytes(path).ok());
    let parts: Vec<Vec<u8>> = texts.chain(shaders).chain(pictures).collect();
    Digest::of_bytes(parts.iter().map(|part| &**part))
}

/// The digest of all shipped shaders.
pub(super) fn of_shipped_shaders() -> String {
    let texts: Vec<_> = SHADERS.iter().flat_map(|(name, text)| [Cow::Borrowed(*name), unix_lines(text)]).collect();
    Digest::of(texts.iter().map(|text| &**text))
}
