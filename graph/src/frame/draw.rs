//! Draws: the geometry of raster passes, and what is known of each kind.

use super::IndirectDraws;
use serde::{Deserialize, Serialize};
use std::num::NonZero;

#[cfg(doc)]
use super::BufferRole;

/// The geometry of a raster pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Draw {
    /// One of the scene's draw lists.
    Objects(DrawList),
    /// Objects that cast the sun's shadow, as the sun sees them.
    Casters(Cascade),
    /// The sky, behind everything.
    Sky,
    /// One triangle that covers every pixel, unless the shader has a vertex stage of its own.
    FullScreen,
    /// Triangles: a number of vertices and instances. The vertex shader finds its data itself or in the pass's vertex
    /// buffers.
    Vertices {
        /// Vertices, or indices if the pass has an index buffer (32 bits each).
        count: u32,
        /// Instances.
        instances: u32,
    },
    /// As `Vertices`; the counts stand in the pass's buffer of the role [`BufferRole::Indirect`]: a
    /// `VkDrawIndirectCommand`, or `VkDrawIndexedIndirectCommand` if the pass has an index buffer.
    Indirect,
    /// As `Indirect`, several draws.
    Indirects(IndirectDraws),
    /// Draws that the embedding program records inside the rendering scope. The program knows them by the pass's shader name.
    Custom,
}

/// What is known of a kind of draw.
struct DrawRow {
    full_screen: bool,
    custom: bool,
    indirect: bool,
    own_vertices: bool,
    /// Whether it draws objects of the scene.
    objects: bool,
    /// Whether it draws as a camera sees the scene.
    camera: bool,
    vertex_shader: &'static str,
}

impl Draw {
    /// All that [`Draw::usual_vertex_shader`] gives.
    #[must_use]
    pub const fn usual_vertex_shaders() -> [&'static str; 4] {
        ["objects.vert", "sky.vert", "full_screen.vert", "vertices.vert"]
    }

    /// The row of its kind.
    const fn row(self) -> DrawRow {
        const NONE: DrawRow = DrawRow {
            full_screen: false,
            custom: false,
            indirect: false,
            own_vertices: false,
            objects: false,
            camera: false,
            vertex_shader: "full_screen.vert",
        };
        match self {
            Draw::Objects(_) => DrawRow { objects: true, camera: true, vertex_shader: "objects.vert", ..NONE },
            Draw::Casters(_) => DrawRow { objects: true, vertex_shader: "objects.vert", ..NONE },
            Draw::Sky => DrawRow { camera: true, vertex_shader: "sky.vert", ..NONE },
            Draw::FullScreen => DrawRow { full_screen: true, ..NONE },
            Draw::Vertices { .. } => DrawRow { own_vertices: true, vertex_shader: "vertices.vert", ..NONE },
            Draw::Indirect | Draw::Indirects(_) => {
                DrawRow { own_vertices: true, indirect: true, vertex_shader: "vertices.vert", ..NONE }
            }
            Draw::Custom => DrawRow { custom: true, ..NONE },
        }
    }

    /// Whether it is one triangle that covers every pixel, unless its shader has a vertex stage of its own.
    #[must_use]
    pub const fn is_full_screen(self) -> bool {
        self.row().full_screen
    }

    /// Whether the embedding program records it.
    #[must_use]
    pub const fn is_custom(self) -> bool {
        self.row().custom
    }

    /// Whether a buffer of the pass holds its counts.
    #[must_use]
    pub const fn is_indirect(self) -> bool {
        self.row().indirect
    }

    /// Whether its vertices are the pass's own: the shader finds them, or they stand in the pass's buffers.
    #[must_use]
    pub const fn has_own_vertices(self) -> bool {
        self.row().own_vertices
    }

    /// Whether it draws objects of the scene, as a camera or as the sun sees them.
    #[must_use]
    pub const fn draws_objects(self) -> bool {
        self.row().objects
    }

    /// Whether it draws what of the scene a camera sees: objects or the sky.
    #[must_use]
    pub const fn shows_scene(self) -> bool {
        self.row().camera
    }

    /// Whether it draws objects of the scene as a camera sees them.
    #[must_use]
    pub const fn shows_objects(self) -> bool {
        self.draws_objects() && self.shows_scene()
    }

    /// The shipped vertex shader that it has, unless its shader brings one.
    #[must_use]
    pub const fn usual_vertex_shader(self) -> &'static str {
        self.row().vertex_shader
    }

    /// How many vertices, or indices, and instances it draws, if the pass says so.
    #[must_use]
    pub const fn counts(self) -> Option<[u32; 2]> {
        match self {
            Draw::Vertices { count, instances } => Some([count, instances]),
            _ => None,
        }
    }

    /// The draws whose counts a buffer holds, if it draws such.
    #[must_use]
    pub const fn indirect(self) -> Option<IndirectDraws> {
        match self {
            Draw::Indirect => Some(IndirectDraws::ONE),
            Draw::Indirects(draws) => Some(draws),
            Draw::Objects(_)
            | Draw::Casters(_)
            | Draw::Sky
            | Draw::FullScreen
            | Draw::Vertices { .. }
            | Draw::Custom => None,
        }
    }

    /// Whether a buffer of the pass holds how many draws it makes.
    #[must_use]
    pub fn is_counted(self) -> bool {
        self.indirect().is_some_and(|draws| draws.count.is_some())
    }

    /// The part of the shadows' reach for which it draws casters, if it does.
    #[must_use]
    pub const fn cascade(self) -> Option<Cascade> {
        match self {
            Draw::Casters(cascade) => Some(cascade),
            _ => None,
        }
    }
}

/// One part of the scene that the sun's shadows fall on, by distance from the camera; each part has a shadow map of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cascade {
    /// Which of the objects that may cast shadows are drawn.
    pub list: DrawList,
    /// Which part, from 0, the nearest.
    pub index: u8,
    /// How many there are, 1 to [`Cascade::MOST`].
    pub of: u8,
    /// How far shadows reach; `None`: through the whole scene.
    pub reach: Option<Metres>,
    /// How logarithmic the distances are at which parts end: 0 cuts parts of equal depth, 1 parts whose ends are multiples of each
    /// other.
    pub logarithmic: Share,
}

impl Cascade {
    /// The most that there are.
    pub const MOST: u8 = 4;

    /// The part and how the view is cut, for people: "cascade 1 of 4 through 14 m".
    #[must_use]
    pub fn in_words(&self) -> String {
        let reach = self.reach.map_or_else(|| "the whole scene".to_owned(), |reach| format!("{} m", f32::from(reach)));
        let words = format!("cascade {} of {} through {reach}", self.index, self.of);
        if self.logarithmic == Share::OF_CASCADES {
            return words;
        }
        format!("{words}, with ends {} logarithmic", f32::from(self.logarithmic))
    }
}

/// A share of a whole, 0 to 1.
// Bits of such numbers are ordered as the numbers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "f32", into = "f32")]
pub struct Share(u32);

impl Share {
    /// How logarithmic the ends of cascades are if a pipeline says nothing.
    pub const OF_CASCADES: Share = Share(0.85f32.to_bits());
}

impl TryFrom<f32> for Share {
    type Error = &'static str;

    fn try_from(share: f32) -> Result<Share, &'static str> {
        // A zero loses its sign.
        (0.0..=1.0).contains(&share).then(|| Share((share + 0.0).to_bits())).ok_or("no number from 0 to 1")
    }
}

impl From<Share> for f32 {
    fn from(share: Share) -> f32 {
        f32::from_bits(share.0)
    }
}

/// A length in metres, finite and above 0.
// Bits of such numbers are ordered as the numbers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "f32", into = "f32")]
pub struct Metres(NonZero<u32>);

impl TryFrom<f32> for Metres {
    type Error = &'static str;

    fn try_from(metres: f32) -> Result<Metres, &'static str> {
        let bits = NonZero::new(metres.to_bits()).filter(|_| metres.is_finite() && metres > 0.0);
        bits.map(Metres).ok_or("no length above 0")
    }
}

impl From<Metres> for f32 {
    fn from(metres: Metres) -> f32 {
        f32::from_bits(metres.0.get())
    }
}

/// The scene's draw lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum DrawList {
    /// Objects that hide what is behind them.
    Opaque,
    /// Objects with holes: fragments whose alpha is below the material's cut-off are discarded.
    Masked,
    /// Objects that let through what is behind them, sorted back to front.
    Transparent,
}

impl DrawList {
    /// All lists, by name.
    pub const NAMED: [(&'static str, DrawList); 3] =
        [("Opaque", DrawList::Opaque), ("Masked", DrawList::Masked), ("Transparent", DrawList::Transparent)];
    /// Those of objects that light doesn't go through, by name.
    pub const CASTERS: [(&'static str, DrawList); 2] = [DrawList::NAMED[0], DrawList::NAMED[1]];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_numbers_from_0_to_1_are_shares_and_they_are_ordered_as_numbers() {
        for bad in [-f32::MIN_POSITIVE, 1.0 + f32::EPSILON, f32::INFINITY, f32::NAN] {
            assert!(Share::try_from(bad).is_err(), "{bad}");
        }
        let shares = [-0.0, 0.0, f32::MIN_POSITIVE, 0.5, 1.0].map(|share| Share::try_from(share).expect("a share"));
        assert_eq!(shares[0], shares[1]);
        assert!(shares.is_sorted() && f32::from(shares[3]) == 0.5);
    }

    #[test]
    fn only_finite_lengths_above_0_are_lengths_and_they_are_ordered_as_numbers() {
        for bad in [0.0, -0.0, -1.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
            assert!(Metres::try_from(bad).is_err(), "{bad}");
        }
        let lengths = [f32::MIN_POSITIVE / 2.0, 1e-3, 1.0, 14.0, f32::MAX];
        let known = lengths.map(|length| Metres::try_from(length).expect("a length"));
        assert!(known.is_sorted() && known.map(f32::from) == lengths);
    }

    #[test]
    fn no_draw_takes_more_room_than_several_indirect_draws() {
        assert_eq!(size_of::<Draw>(), size_of::<IndirectDraws>());
    }
}
