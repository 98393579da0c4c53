//! Libraries of window systems, which `winit` opens when it needs them: programs that open no window run without them.

/// Parts of the words in which `winit` says that it can't open a library, and Debian's packages that it may be of. If several fit,
/// the first one counts.
const LIBRARIES: [(&str, &[&str]); 5] = [
    ("libxkbcommon-x11.so", &["libxkbcommon-x11-0"]),
    ("libxkbcommon.so", &["libxkbcommon0"]),
    ("XKBNotFound", &["libxkbcommon0"]),
    ("xlib's shared libraries", &["libx11-6", "libx11-xcb1", "libxcursor1", "libxi6"]),
    ("wayland library could not be loaded", &["libwayland-client0"]),
];

/// The packages of the library whose lack these words tell of, if they do.
pub(super) fn missing(words: &str) -> Option<&'static [&'static str]> {
    LIBRARIES.iter().find(|(part, _)| words.contains(part)).map(|(_, packages)| *packages)
}
