//! Profiles as text: they are read and written back without loss, and figures that no device has are refused in their place.

use framewright_graph::device::{MemoryModel, Profile, SHIPPED_PROFILES};
use framewright_graph::vulkan::{Format, Sharing};

/// A small profile, to be damaged.
const SMALL: &str = r#"(
    name: "small",
    source: "made up",
    max_attachment_extent: 4096,
    max_extent_3d: 256,
    max_layers: 256,
    max_color_attachments: 4,
    lazily_allocated_memory: false,
    queues: (compute: true, transfer: false, sharing: EXCLUSIVE),
    formats: [
        (format: R8_UNORM, usage: "SAMPLED", linear_filter: true, blend: false, samples: []),
        (format: R8G8B8A8_UNORM, usage: "SAMPLED | COLOR_ATTACHMENT | INPUT_ATTACHMENT", linear_filter: true, blend: true, samples: [1, 4]),
        (format: R32_UINT, usage: "SAMPLED | STORAGE", linear_filter: false, blend: false, samples: []),
        (format: D16_UNORM, usage: "DEPTH_STENCIL_ATTACHMENT", linear_filter: false, blend: false, samples: [1]),
    ],
    memory: (alignment: 256, row_bytes: 64, rows: 8),
    known_needs: [
        (format: R8_UNORM, samples: 1, usages: ["SAMPLED"], sizes: [((4, 4), (bytes: 256, alignment: 256, type_bits: 1)), ((4, 8), (bytes: 512, alignment: 256, type_bits: 1))]),
        (format: R8G8B8A8_UNORM, samples: 4, usages: ["COLOR_ATTACHMENT"], sizes: [((4, 4), (bytes: 1024, alignment: 256, type_bits: 1))]),
    ],
)
"#;

#[test]
fn every_shipped_profile_is_read_and_written_back_without_loss() {
    for (name, text) in SHIPPED_PROFILES {
        let profile = Profile::from_ron(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        let again = Profile::from_ron(&profile.to_ron().expect("written"));
        assert_eq!(again, Ok(profile), "{name}");
    }
}

#[test]
fn numbers_that_may_be_unknown_stand_for_themselves_or_are_left_out() {
    let small = Profile::from_ron(SMALL).expect("read");
    assert_eq!((small.max_clip_distances, small.memory.heap_bytes), (None, None));
    let unknown = small.to_ron().expect("written");
    assert!(!unknown.contains("max_clip_distances") && !unknown.contains("heap_bytes"), "{unknown}");
    let memory = MemoryModel { heap_bytes: Some(1 << 30), ..small.memory.clone() };
    let known = Profile { max_clip_distances: Some(0), memory, ..small };
    let text = known.to_ron().expect("written");
    assert!(text.contains("max_clip_distances: 0,") && text.contains("heap_bytes: 1073741824"), "{text}");
    assert_eq!(Profile::from_ron(&text), Ok(known));
}

#[test]
fn shipped_profiles_that_no_driver_wrote_say_what_was_assumed() {
    for (name, text) in SHIPPED_PROFILES {
        let profile = Profile::from_ron(text).expect("read");
        let read = profile.source.starts_with("read from ");
        assert_eq!(read, ["lavapipe", "swiftshader"].contains(name), "{name}: {}", profile.source);
        assert_eq!(profile.known_needs.is_empty(), !read, "{name}");
        assert_eq!(profile.unknown.is_empty(), read, "{name}");
        assert!(read || profile.source.contains("github.com/"), "{name}");
    }
}

/// The differences between the kinds of devices that Plans are made for.
#[test]
fn shipped_profiles_differ_where_devices_do() {
    let all = SHIPPED_PROFILES.iter().map(|(_, text)| Profile::from_ron(text).expect("read"));
    let all: Vec<Profile> = all.collect();
    let some = |has: fn(&Profile) -> bool| all.iter().any(has) && !all.iter().all(has);
    assert!(some(|it| it.lazily_allocated_memory));
    assert!(some(|it| it.local_read));
    assert!(some(|it| it.queues.compute && it.queues.transfer));
    assert!(some(|it| it.queues.sharing == Sharing::Concurrent));
    assert!(some(|it| it.format(Format::D24_UNORM_S8_UINT).is_some()));
    assert!(some(|it| it.format(Format::R8G8B8A8_UNORM).is_some_and(|it| it.samples.contains(&8))));
    assert!(some(|it| it.format(Format::R32_SFLOAT).is_some_and(|it| it.blend)));
}

#[test]
fn what_is_left_out_is_the_least_that_a_device_has() {
    let small = Profile::from_ron(SMALL).expect("sound");
    assert_eq!((small.memory.row_texels, small.memory.row_bytes, small.memory.rows), (1, 64, 8));
    assert_eq!((small.memory.buffer_alignment, small.memory.type_bits), (256, 1));
    assert!(!small.local_read && small.unknown.is_empty());
    assert_eq!(small.format(Format::D32_SFLOAT), None);
}

#[test]
fn a_text_that_is_no_profile_is_refused_with_its_place() {
    let wrong = SMALL.replacen("max_attachment_extent", "max_attachment_size", 1);
    let error = Profile::from_ron(&wrong).expect_err("an unknown field");
    assert!(error.problem.contains("max_attachment_size"), "{error}");
    assert_eq!(error.line, 4);
    for wrong in ["", "(", "()", "3", "\u{feff}", "Profile(name: \"x\")", &"[".repeat(100_000), &"(name:".repeat(9999)]
    {
        assert!(Profile::from_ron(wrong).is_err(), "{wrong:.40}");
    }
}

#[test]
fn a_profile_that_is_cut_short_anywhere_is_refused() {
    let whole = SMALL.trim_end();
    for end in 0..whole.len() {
        assert!(Profile::from_ron(&whole[..end]).is_err(), "cut at {end}");
    }
}

/// The text that is replaced, its replacement, the line of the mistake, and a part of the message.
const LIES: &[(&str, &str, usize, &str)] = &[
    ("\"small\"", "\" \"", 2, "the device has no name"),
    ("extent: 4096", "extent: 0", 4, "this is 0, and must be 1 to 65536"),
    ("extent: 4096", "extent: 65537", 4, "this is 65537, and must be 1 to 65536"),
    ("extent: 4096", "extent: -1", 4, ""),
    ("extent: 4096", "extent: NaN", 4, ""),
    ("extent: 4096", "extent: 4096.5", 4, ""),
    ("extent: 4096", "extent: 4294967296", 4, ""),
    ("extent_3d: 256", "extent_3d: 0", 5, "this is 0"),
    ("layers: 256", "layers: 0", 6, "this is 0"),
    ("attachments: 4", "attachments: 0", 7, "this is 0, and must be 1 to 64"),
    ("attachments: 4", "attachments: 4000000000", 7, "this is 4000000000"),
    ("memory: false", "memory: maybe", 8, ""),
    ("sharing: EXCLUSIVE", "sharing: SOMETIMES", 9, "SOMETIMES"),
    (", sharing: EXCLUSIVE", "", 9, "sharing"),
    ("\"SAMPLED\", linear", "\"SAMPLD\", linear", 11, "unrecognized named flag"),
    ("\"SAMPLED\", linear", "\"0x8000\", linear", 11, "R8_UNORM has usages that are not known"),
    ("\"SAMPLED\", linear", "\"TRANSFER_DST\", linear", 11, "R8_UNORM can't be filtered without being SAMPLED"),
    (
        "\"SAMPLED\", linear",
        "\"SAMPLED | TRANSIENT_ATTACHMENT\", linear",
        11,
        "TRANSIENT_ATTACHMENT without being an attachment",
    ),
    (
        "blend: false, samples: []),\n        (format: R8G",
        "blend: true, samples: []),\n        (format: R8G",
        11,
        "R8_UNORM can't be blended",
    ),
    ("[1, 4]", "[1, 3]", 12, "R8G8B8A8_UNORM has 3 samples"),
    ("[1, 4]", "[1, 0]", 12, "R8G8B8A8_UNORM has 0 samples"),
    ("[1, 4]", "[1, 128]", 12, "R8G8B8A8_UNORM has 128 samples"),
    ("[1, 4]", "[4, 1]", 12, "must rise"),
    ("[1, 4]", "[1, 1, 4]", 12, "must rise"),
    ("[1, 4]", "[4]", 12, "1 must be among"),
    ("[1, 4]", "[]", 12, "1 must be among"),
    (
        "\"SAMPLED | STORAGE\", linear_filter: false",
        "\"SAMPLED | STORAGE\", linear_filter: true",
        13,
        "it can't be filtered",
    ),
    (
        "\"SAMPLED | STORAGE\"",
        "\"SAMPLED | DEPTH_STENCIL_ATTACHMENT\"",
        13,
        "R32_UINT can't be DEPTH_STENCIL_ATTACHMENT",
    ),
    ("\"DEPTH_STENCIL_ATTACHMENT\"", "\"COLOR_ATTACHMENT\"", 14, "D16_UNORM can't be COLOR_ATTACHMENT"),
    ("\"DEPTH_STENCIL_ATTACHMENT\"", "\"\"", 14, "D16_UNORM is no attachment"),
    ("format: D16_UNORM", "format: R8_UNORM", 14, ""),
    ("format: R32_UINT", "format: R8_UNORM", 15, "R8_UNORM stands in this list twice"),
    ("format: R32_UINT", "format: R32_UNIT", 13, "R32_UNIT"),
    ("(alignment: 256, row", "(alignment: 3, row", 16, "this is 3, and must be a power of two"),
    ("(alignment: 256, row", "(alignment: 0, row", 16, "this is 0, and must be a power of two"),
    ("(alignment: 256, row", "(alignment: 2147483648, row", 16, "this is 2147483648"),
    ("row_bytes: 64", "row_bytes: 48", 16, "this is 48, and must be a power of two up to 65536"),
    ("rows: 8", "rows: 0", 16, "this is 0"),
    ("rows: 8", "rows: 8, type_bits: 0", 16, "no memory type will do"),
    ("rows: 8", "rows: 8, buffer_alignment: 5", 16, "this is 5"),
    ("(bytes: 256, alignment: 256", "(bytes: 256, alignment: 0", 18, "this is 0, and must be a power of two"),
    ("(bytes: 256,", "(bytes: 15,", 18, "R8_UNORM of 4×4 with 1 samples can't take 15 bytes: its texels alone are 16"),
    ("(bytes: 256,", "(bytes: 18446744073709551615,", 18, "can't take 18446744073709551615 bytes"),
    ("(bytes: 1024,", "(bytes: 255,", 19, "its texels alone are 256"),
    ("((4, 8)", "((4, 4)", 18, "the sizes of R8_UNORM must rise"),
    ("((4, 8)", "((0, 8)", 18, "the sizes of R8_UNORM must rise"),
    ("((4, 8)", "((4, 0)", 18, "the sizes of R8_UNORM must rise"),
    ("((4, 4), (bytes: 256", "((0, 4), (bytes: 256", 18, "R8_UNORM of 0×4 with 1 samples is not 1 to 65536 texels"),
    ("((4, 8)", "((4, 4294967295)", 18, "is not 1 to 65536 texels"),
    ("samples: 4, usages", "samples: 5, usages", 19, "R8G8B8A8_UNORM has 5 samples"),
    ("usages: [\"COLOR_ATTACHMENT\"]", "usages: [\"0x80000000\"]", 19, "usages that are not known"),
    (
        "(format: R8_UNORM, samples: 1",
        "(format: D16_UNORM, samples: 1",
        20,
        "R8G8B8A8_UNORM with 4 samples must stand before D16_UNORM with 1 samples",
    ),
];

#[test]
fn figures_that_no_device_has_are_refused_with_their_place() {
    for (old, new, line, problem) in LIES {
        assert!(SMALL.contains(old), "{old}");
        let error = Profile::from_ron(&SMALL.replacen(old, new, 1)).expect_err(new);
        assert!(error.problem.contains(problem), "{new}: {error}");
        assert_eq!(error.line, *line, "{new}: {error}");
        assert!(error.column > 1 || *line == 15 || *line == 20, "{new}: {error}");
    }
}
