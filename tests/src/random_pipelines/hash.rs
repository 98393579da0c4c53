//! The hash that passes write, in Rust and in GLSL, and what is drawn from it.

use super::pipeline::{Contents, Extent, TRIANGLES};

/// The hash in GLSL.
pub const GLSL: &str = "\
uint hash(uint state, uint word) {
    state = (state ^ word) * 0x9E3779B1u;
    return state ^ (state >> 15);
}

uint hash4(uint state, uvec4 words, uint parts) {
    state = hash(state, words.x);
    return parts == 1u ? state : hash(hash(hash(state, words.y), words.z), words.w);
}

uvec4 hashes(uint state, uint from) {
    return uvec4(hash(state, from), hash(state, from + 1u), hash(state, from + 2u), hash(state, from + 3u));
}
";

/// One more word in the hash.
#[must_use]
pub const fn hash(state: u32, word: u32) -> u32 {
    let state = (state ^ word).wrapping_mul(0x9E37_79B1);
    state ^ (state >> 15)
}

/// The hash of several words.
#[must_use]
pub fn hash_all(state: u32, words: impl IntoIterator<Item = u32>) -> u32 {
    words.into_iter().fold(state, hash)
}

/// Four words from a hash.
#[must_use]
pub fn hashes(state: u32, from: u32) -> [u32; 4] {
    std::array::from_fn(|component| hash(state, from + component as u32))
}

/// The word number `at` that a buffer of `contents` gets where the hash is `state`.
#[must_use]
pub const fn content(contents: Contents, at: u32, state: u32) -> u32 {
    match contents {
        Contents::Words => state,
        Contents::Vertices => ((state & 0xFFFF) as f32).to_bits(),
        Contents::Indices => 3 * (state % TRIANGLES) + at % 3,
        Contents::Draw => command(at % 4, state),
        Contents::IndexedDraw => command(at % 5, state),
        Contents::Dispatch => 1 + state % 3,
    }
}

/// Member number `member` of an indirect draw: up to four triangles, up to two instances, the first vertex or index.
const fn command(member: u32, state: u32) -> u32 {
    match member {
        0 => 3 * (state % TRIANGLES),
        1 => (state >> 8) % 3,
        2 => 3 * ((state >> 12) % 2),
        _ => 0,
    }
}

/// [`content`] in GLSL.
pub const CONTENT_GLSL: &str = "\
uint command(uint member, uint state) {
    if (member == 0u) return 3u * (state % 5u);
    if (member == 1u) return (state >> 8) % 3u;
    return member == 2u ? 3u * ((state >> 12) % 2u) : 0u;
}

uint content(uint contents, uint at, uint state) {
    if (contents == 1u) return floatBitsToUint(float(state & 0xFFFFu));
    if (contents == 2u) return 3u * (state % 5u) + at % 3u;
    if (contents == 3u) return command(at % 4u, state);
    if (contents == 4u) return command(at % 5u, state);
    return contents == 5u ? 1u + state % 3u : state;
}
";

/// A triangle's right-angled corner, the quarter of the target that it covers, its depth, and the hash of all that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quarter {
    /// The corner, in pixels.
    corner: [u32; 2],
    /// Whether it covers what is right of the corner, and what is below it; else left and above.
    onwards: [bool; 2],
    /// 256ths of depth.
    pub depth: u32,
    /// The hash.
    pub state: u32,
}

impl Quarter {
    /// The triangle number `triangle` of an instance, for a pass and a target.
    #[must_use]
    pub const fn new(pass: u32, triangle: u32, instance: u32, extent: Extent) -> Quarter {
        let state = hash(hash(hash(0x5BD1_E995, pass), triangle), instance);
        Quarter {
            corner: [state % (extent[0] + 1), (state >> 8) % (extent[1] + 1)],
            onwards: [state & 0x1_0000 != 0, state & 0x2_0000 != 0],
            depth: (state >> 18) & 255,
            state,
        }
    }

    /// Whether it covers a pixel.
    #[must_use]
    pub fn covers(&self, pixel: [u32; 2]) -> bool {
        (0..2).all(|axis| (pixel[axis] >= self.corner[axis]) == self.onwards[axis])
    }
}

/// [`Quarter`] in GLSL, as a vertex shader's `main`. The long side lies outside of the target.
pub const QUARTER_GLSL: &str = "\
void main() {
    const uint quarter = hash(hash(hash(0x5BD1E995u, number), uint(gl_VertexIndex) / 3u), uint(gl_InstanceIndex));
    const vec2 extent = vec2(width, height);
    const vec2 corner = vec2(quarter % (width + 1u), (quarter >> 8) % (height + 1u));
    const vec2 onwards = vec2((quarter & 0x10000u) != 0u ? 1.0 : -1.0, (quarter & 0x20000u) != 0u ? 1.0 : -1.0);
    const uint at = uint(gl_VertexIndex) % 3u;
    const vec2 along = onwards * vec2(at == 1u ? 1.0 : 0.0, at == 2u ? 1.0 : 0.0) * 4.0 * max(extent.x, extent.y);
    gl_Position = vec4((corner + along) / extent * 2.0 - 1.0, float((quarter >> 18) & 255u) / 256.0, 1.0);
    uint state = hash(quarter, VERTEX);
READS    triangle = state;
}
";
