//! Scenes: from files to data.

mod fixture_files;
mod fixtures;
mod gltf_files;
mod gltf_mistakes;
mod loading;
mod mutations;
mod text_mistakes;
