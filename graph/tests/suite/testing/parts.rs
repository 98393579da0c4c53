//! Parts of frames that are built in memory, and a device for them.

use framewright_graph::base::Span;
use framewright_graph::device::{FormatSupport, MemoryModel, Profile, Queues};
use framewright_graph::frame::{ImageIndex, Storage};
use framewright_graph::vulkan::{Format, ResolveMode, Stages, Subresources, Usage};
use std::sync::Arc;

/// A device that has every format at 1, 4 and 8 samples, adds nothing to an image's bytes, and has one queue.
pub(crate) fn device() -> Profile {
    let everything = Usage::all().difference(Usage::TRANSIENT_ATTACHMENT);
    let support = |format: &Format| FormatSupport {
        format: *format,
        usage: everything,
        linear_filter: true,
        minmax_filter: true,
        blend: true,
        samples: vec![1, 4, 8],
    };
    Profile {
        name: "a device for tests".to_owned(),
        source: "built in memory".to_owned(),
        max_attachment_extent: 16384,
        max_color_attachments: 8,
        lazily_allocated_memory: false,
        formats: Format::ALL.iter().map(support).collect(),
        max_extent_3d: 2048,
        max_layers: u32::MAX,
        queues: Queues::default(),
        local_read: false,
        max_multiview_views: 6,
        refuted_multiview: false,
        untested_multiview: false,
        vertex_layer: true,
        max_clip_distances: Some(8),
        features: None,
        without: Vec::new(),
        limits: None,
        vertex_formats: None,
        depth_resolve: vec![ResolveMode::SampleZero],
        refuted_depth_resolve: Vec::new(),
        refuted_layered_depth_resolve: Vec::new(),
        untested_depth_resolve: Vec::new(),
        refuted_integer_resolve: false,
        memory: MemoryModel {
            alignment: 256,
            row_texels: 1,
            row_bytes: 1,
            rows: 1,
            separate_stencil: false,
            buffer_alignment: 256,
            type_bits: 1,
            heap_bytes: None,
        },
        known_needs: Vec::new(),
        unknown: Vec::new(),
    }
}

/// All of an image, written as storage by a compute shader: whole, or on top of what it reads.
pub(crate) fn stored(binding: impl Into<Arc<str>>, image: ImageIndex, read: bool) -> Storage {
    let (range, span, stages) = (Subresources::WHOLE, Span::NONE, Stages::COMPUTE_SHADER);
    Storage { binding: binding.into(), image, range, span, read, write: true, eye: None, stages }
}
