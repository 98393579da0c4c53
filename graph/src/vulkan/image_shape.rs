//! Images as shaders declare them.

use super::{Format, Numeric, Shape};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fmt::{Display, Formatter};
use std::ops::Range;

/// The shape of an image in a shader. Its text, in the JSON form of a Plan too, is GLSL's type of such an image that is
/// sampled: `sampler2D`, `usampler2DArray`, `sampler2DMS`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ImageShape {
    /// Dimension.
    pub dimension: Dimension,
    /// Whether it is an array of layers.
    pub arrayed: bool,
    /// Whether single samples are read.
    pub multisampled: bool,
    /// The type of a component.
    pub component: Component,
}

/// Image dimension.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// One.
    D1,
    /// Two.
    D2,
    /// Three.
    D3,
    /// Six square faces.
    Cube,
    /// A texel buffer.
    Buffer,
}

/// The type of an image's component in a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Component {
    /// Floating point (UNORM and SRGB formats too).
    Float,
    /// Signed integer.
    Int,
    /// Unsigned integer.
    Uint,
}

/// Width, height and depth of mip level number `mip` of an image with this extent, in texels.
pub(crate) fn extent_at(extent: [u32; 3], mip: u32) -> [u32; 3] {
    extent.map(|side| side.checked_shr(mip).unwrap_or(0).max(1))
}

impl Component {
    /// The type of a component of `format` in a shader.
    #[must_use]
    pub const fn of(format: Format) -> Component {
        match format.numeric() {
            Numeric::Uint => Component::Uint,
            Numeric::Sint => Component::Int,
            Numeric::Sfloat | Numeric::Ufloat | Numeric::Unorm | Numeric::Snorm | Numeric::Srgb => Component::Float,
        }
    }

    /// The type in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Component::Float => "floating point",
            Component::Int => "signed integers",
            Component::Uint => "unsigned integers",
        }
    }
}

impl ImageShape {
    /// How a shader best declares `layers` of an image of the shape `shape`, each counted from 0: as an array if there are
    /// several, as cubes if they are whole ones.
    #[must_use]
    pub fn of(shape: Shape, layers: Range<u32>, multisampled: bool, component: Component) -> ImageShape {
        let whole_cubes = layers.start.is_multiple_of(6) && layers.len().is_multiple_of(6);
        let (dimension, arrayed) = match shape {
            Shape::D3 => (Dimension::D3, false),
            Shape::Cube if whole_cubes => (Dimension::Cube, layers.len() > 6),
            Shape::D2 | Shape::Cube => (Dimension::D2, layers.len() > 1),
        };
        ImageShape { dimension, arrayed, multisampled, component }
    }
}

/// GLSL's words for components, dimensions, samples and layers, in the order in which a type's name holds them.
const COMPONENTS: [(Component, &str); 3] = [(Component::Int, "i"), (Component::Uint, "u"), (Component::Float, "")];
const DIMENSIONS: [(Dimension, &str); 5] = [
    (Dimension::D1, "1D"),
    (Dimension::D2, "2D"),
    (Dimension::D3, "3D"),
    (Dimension::Cube, "Cube"),
    (Dimension::Buffer, "Buffer"),
];
const MULTISAMPLED: &str = "MS";
const ARRAYED: &str = "Array";

impl Display for ImageShape {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let component = COMPONENTS.iter().find(|(component, _)| *component == self.component).map_or("", |it| it.1);
        let dimension = DIMENSIONS.iter().find(|(dimension, _)| *dimension == self.dimension).map_or("", |it| it.1);
        let multisampled = if self.multisampled { MULTISAMPLED } else { "" };
        let arrayed = if self.arrayed { ARRAYED } else { "" };
        write!(f, "{component}sampler{dimension}{multisampled}{arrayed}")
    }
}

impl From<ImageShape> for String {
    fn from(shape: ImageShape) -> String {
        shape.to_string()
    }
}

impl TryFrom<String> for ImageShape {
    type Error = String;

    fn try_from(text: String) -> Result<ImageShape, String> {
        let read = || {
            let (prefix, rest) = text.split_once("sampler")?;
            let (rest, arrayed) = rest.strip_suffix(ARRAYED).map_or((rest, false), |rest| (rest, true));
            let (rest, multisampled) = rest.strip_suffix(MULTISAMPLED).map_or((rest, false), |rest| (rest, true));
            let (component, _) = *COMPONENTS.iter().find(|(_, word)| *word == prefix)?;
            let (dimension, _) = *DIMENSIONS.iter().find(|(_, word)| *word == rest)?;
            Some(ImageShape { dimension, arrayed, multisampled, component })
        };
        read().ok_or_else(|| format!("`{text}` is no type of a sampled image in GLSL"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_shape_is_read_from_its_own_text() {
        for (component, _) in COMPONENTS {
            for (dimension, _) in DIMENSIONS {
                for (arrayed, multisampled) in [(false, false), (false, true), (true, false), (true, true)] {
                    let shape = ImageShape { dimension, arrayed, multisampled, component };
                    assert_eq!(ImageShape::try_from(shape.to_string()), Ok(shape));
                }
            }
        }
        for wrong in ["", "sampler", "sampler4D", "xsampler2D", "sampler2DArrayMS", "image2D", "sampler2D "] {
            assert!(ImageShape::try_from(wrong.to_owned()).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_words_are_those_of_glsl() {
        let float =
            |shape, layers, multisampled| ImageShape::of(shape, 0..layers, multisampled, Component::Float).to_string();
        assert_eq!(float(Shape::D2, 1, false), "sampler2D");
        assert_eq!(float(Shape::D2, 6, false), "sampler2DArray");
        assert_eq!(float(Shape::D2, 1, true), "sampler2DMS");
        assert_eq!(float(Shape::D2, 2, true), "sampler2DMSArray");
        assert_eq!(float(Shape::D3, 1, false), "sampler3D");
        assert_eq!(float(Shape::Cube, 6, false), "samplerCube");
        assert_eq!(float(Shape::Cube, 12, false), "samplerCubeArray");
        assert_eq!(float(Shape::Cube, 1, false), "sampler2D");
        assert_eq!(ImageShape::of(Shape::D2, 0..2, false, Component::Uint).to_string(), "usampler2DArray");
    }

    #[test]
    fn six_layers_of_two_cubes_are_no_cube() {
        let part = |layers| ImageShape::of(Shape::Cube, layers, false, Component::Float).to_string();
        assert_eq!(part(6..12), "samplerCube");
        assert_eq!(part(3..9), "sampler2DArray");
    }
}
