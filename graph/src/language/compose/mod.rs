//! The files of a pipeline are put together: `include`, `extends`, `extensions` and `changes`.

pub(crate) mod apply;
pub(crate) mod build;
pub(crate) mod change_log;
pub(crate) mod changes;
pub(crate) mod draft;
pub(crate) mod entry;
pub(crate) mod extend;
pub(crate) mod files;
pub(crate) mod includes;
pub(crate) mod keyed_fields;
pub(crate) mod layers;
pub(crate) mod loader;
pub(crate) mod order;
pub(crate) mod origins;
pub(crate) mod pictures;
pub(crate) mod pipeline_files;
pub(crate) mod removed_settings;
pub(crate) mod tables;
