//! Values that scenes are made of: numbers in ranges, vectors, colours.

use crate::scene::limits;
use crate::scene::model::Movement;
use crate::srgb;
use framewright_graph::base::Code;
use framewright_graph::ron::{Leaf, Reader, Shape};
use glam::DVec3;

/// A number from `least` to `most`, both included.
pub(super) fn number<'s>(reader: &mut Reader, leaf: Leaf<'s>, what: &str, least: f64, most: f64) -> Option<f64> {
    let number = reader.number(leaf)?;
    if (least..=most).contains(&number) {
        return Some(number);
    }
    reader.wrong(Code::NUMBER_OUTSIDE, leaf, format!("{what} is {number}; expected {least} to {most}"), "");
    None
}

/// A whole number from `least` to `most`, both included.
pub(super) fn count<'s>(reader: &mut Reader, leaf: Leaf<'s>, what: &str, least: u32, most: u32) -> Option<u32> {
    let number = reader.integer(leaf)?;
    match u32::try_from(number) {
        Ok(count) if (least..=most).contains(&count) => Some(count),
        _ => {
            reader.wrong(Code::NUMBER_OUTSIDE, leaf, format!("{what} is {number}; expected {least} to {most}"), "");
            None
        }
    }
}

/// The leaves of `(…, …)`.
fn parts<'s, const N: usize>(reader: &mut Reader, leaf: Leaf<'s>, what: &str, form: &str) -> Option<[Leaf<'s>; N]> {
    let parts = leaf.tuple();
    if parts.is_none() {
        reader.expected(leaf, &format!("{what} as `{form}`"));
    }
    parts
}

/// Three numbers in a range each.
fn three<'s>(reader: &mut Reader, leaf: Leaf<'s>, what: &str, form: &str, least: f64, most: f64) -> Option<DVec3> {
    let [x, y, z] = parts(reader, leaf, what, form)?;
    // Each is read even where another one is wrong, so that all mistakes are reported.
    let [x, y, z] = [x, y, z].map(|part| number(reader, part, what, least, most));
    Some(DVec3::new(x?, y?, z?))
}

/// A place in the world, metres.
pub(super) fn place<'s>(reader: &mut Reader, leaf: Leaf<'s>, what: &str) -> Option<DVec3> {
    three(reader, leaf, what, "(x, y, z)", -limits::COORDINATE, limits::COORDINATE)
}

/// A direction: of any length but 0.
pub(super) fn direction<'s>(reader: &mut Reader, leaf: Leaf<'s>, what: &str) -> Option<DVec3> {
    let direction = place(reader, leaf, what)?.try_normalize();
    if direction.is_none() {
        reader.wrong(Code::SCENE_VALUE, leaf, format!("{what} has no length, so it points nowhere"), "");
    }
    direction
}

/// Angles about x, y and z in degrees.
pub(super) fn angles<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<DVec3> {
    three(reader, leaf, "the rotation", "(about x, about y, about z)", -36_000.0, 36_000.0)
}

/// The fastest that anything moves, metres a second, and spins, degrees a second.
const FASTEST: (f64, f64) = (1e6, 36_000.0);

/// How something moves; not at all where the file says nothing.
pub(super) fn movement<'s>(
    reader: &mut Reader,
    velocity: Option<Leaf<'s>>,
    spin: Option<Leaf<'s>>,
) -> Option<Movement> {
    let mut rate = |leaf: Option<Leaf<'s>>, what, most: f64| match leaf {
        Some(leaf) => three(reader, leaf, what, "(x, y, z)", -most, most),
        None => Some(DVec3::ZERO),
    };
    let (velocity, spin) = (rate(velocity, "the velocity", FASTEST.0), rate(spin, "the spin", FASTEST.1));
    Some(Movement { velocity: velocity?, spin: spin? * 1_f64.to_radians() })
}

/// The smallest and the largest extent of an object, metres.
const SIZES: (f64, f64) = (1e-6, limits::COORDINATE);

/// An extent that isn't 0.
pub(super) fn size<'s>(reader: &mut Reader, leaf: Leaf<'s>, what: &str) -> Option<f64> {
    number(reader, leaf, what, SIZES.0, SIZES.1)
}

/// Extents along `N` axes; one number stands for all of them.
pub(super) fn sizes<'s, const N: usize>(reader: &mut Reader, leaf: Leaf<'s>, form: &str) -> Option<[f64; N]> {
    if let Shape::Number = leaf.shape() {
        return size(reader, leaf, "the size").map(|size| [size; N]);
    }
    let parts = parts::<N>(reader, leaf, "the size", form)?;
    all(parts.map(|part| size(reader, part, "the size")))
}

/// Counts along `N` axes.
pub(super) fn counts<'s, const N: usize>(
    reader: &mut Reader,
    leaf: Leaf<'s>,
    form: &str,
    most: u32,
) -> Option<[u32; N]> {
    let parts = parts::<N>(reader, leaf, "the count", form)?;
    all(parts.map(|part| count(reader, part, "the count", 1, most)))
}

fn all<T: Copy + Default, const N: usize>(values: [Option<T>; N]) -> Option<[T; N]> {
    let all = values.map(Option::unwrap_or_default);
    values.iter().all(Option::is_some).then_some(all)
}

/// A colour: three linear numbers, each 0 to `most`, or an sRGB colour as the web writes it.
pub(super) fn color<'s>(reader: &mut Reader, leaf: Leaf<'s>, what: &str, most: f64) -> Option<[f32; 3]> {
    if let Shape::Text = leaf.shape() {
        return Some(web_color(reader, leaf, what)?.map(|byte| srgb::decode(f64::from(byte) / 255.0) as f32));
    }
    let color = three(reader, leaf, what, "(red, green, blue)` or `\"#rrggbb\"", 0.0, most)?;
    Some(color.as_vec3().to_array())
}

/// `"#rrggbb"`
pub(super) fn web_color<'s>(reader: &mut Reader, leaf: Leaf<'s>, what: &str) -> Option<[u8; 3]> {
    let text = reader.words(leaf, what)?;
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6);
    let code = digits.filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
    let Some(code) = code.and_then(|digits| u32::from_str_radix(digits, 16).ok()) else {
        let message = format!("`{text}` is not a colour");
        reader.wrong(
            Code::SCENE_VALUE,
            leaf,
            message,
            "write `\"#rrggbb\"` with six hexadecimal digits, or `(red, green, blue)` from 0 to 1",
        );
        return None;
    };
    Some([(code >> 16) as u8, (code >> 8) as u8, code as u8])
}
