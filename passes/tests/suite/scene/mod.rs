//! Scenes: from files to data.

mod coplanar;
mod exposure;
mod fixture_files;
mod fixtures;
mod gltf_files;
mod gltf_mistakes;
mod gltf_notes;
mod loading;
mod mutations;
mod text_mistakes;
