//! Scenes: from files to data.

mod fixture_files;
mod fixtures;
mod glb_mistakes;
mod loading;
mod mutations;
mod text_mistakes;
