//! The list as a picture.

use super::lines::{Line, Tone};
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};
use embedded_graphics_unicodefonts::{MONO_9X15, MONO_10X20};
use std::convert::Infallible;

/// Space around the text, in pixels of the font.
const MARGIN: u32 = 4;

/// Behind the text: dark, and the picture shines through.
const GROUND: [u8; 4] = [8, 10, 14, 232];
const BAR: Rgb888 = Rgb888::new(38, 78, 130);

/// The cells of a window that characters of the list stand in.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    pub(super) columns: usize,
    pub(super) rows: usize,
    font: &'static MonoFont<'static>,
    /// Pixels of the window for one of the font, along each side.
    zoom: u32,
}

/// A picture with its texels in the curve of sRGB, not multiplied by alpha.
#[derive(Debug)]
pub(super) struct Painting {
    pub(super) extent: [u32; 2],
    pub(super) texels: Vec<u8>,
}

impl Grid {
    /// The cells of a window of this size on a screen of this scale factor.
    pub(super) fn new([width, height]: [u32; 2], scale: f64) -> Grid {
        // The larger font stands for half a step.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "what is no number becomes 0")]
        let halves = ((scale * 2.0).round() as u32).clamp(2, 32);
        let font = if halves.is_multiple_of(2) { &MONO_9X15 } else { &MONO_10X20 };
        let zoom = halves / 2;
        let Size { width: wide, height: high } = font.character_size;
        let cells = |side: u32, one: u32| ((side / zoom).saturating_sub(2 * MARGIN) / one) as usize;
        Grid { columns: cells(width, wide), rows: cells(height, high), font, zoom }
    }
}

/// The lines as a picture; `None` if there is nothing to paint.
pub(super) fn painted(lines: &[Line], grid: &Grid) -> Option<Painting> {
    let columns = lines.iter().map(|line| line.text.chars().count()).max().filter(|columns| *columns > 0)?;
    let cell = grid.font.character_size;
    let [width, height] = [cell.width * count(columns), cell.height * count(lines.len())];
    let mut canvas = Canvas::new([width + 2 * MARGIN, height + 2 * MARGIN], grid.zoom);
    let mut top = MARGIN.cast_signed();
    for line in lines {
        let place = Point::new(MARGIN.cast_signed(), top);
        let bar = Rectangle::new(place, Size::new(width * line.bar / 100, cell.height - 2));
        let Ok(()) = canvas.fill_solid(&bar, BAR);
        let style = MonoTextStyle::new(grid.font, color(line.tone));
        let Ok(_) = Text::with_baseline(&line.text, place, style, Baseline::Top).draw(&mut canvas);
        top += cell.height.cast_signed();
    }
    Some(canvas.painted)
}

fn color(tone: Tone) -> Rgb888 {
    match tone {
        Tone::Plain => Rgb888::new(235, 235, 235),
        Tone::Dim => Rgb888::new(190, 195, 205),
        Tone::Chosen => Rgb888::new(255, 214, 90),
        Tone::Wrong => Rgb888::new(255, 130, 115),
    }
}

fn count(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

/// What is painted on: each pixel is a square of texels.
struct Canvas {
    painted: Painting,
    size: Size,
    zoom: u32,
}

impl Canvas {
    fn new([width, height]: [u32; 2], zoom: u32) -> Canvas {
        let extent = [width * zoom, height * zoom];
        let texels = GROUND.repeat((extent[0] * extent[1]) as usize);
        Canvas { painted: Painting { extent, texels }, size: Size::new(width, height), zoom }
    }
}

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        self.size
    }
}

impl DrawTarget for Canvas {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<Rgb888>>,
    {
        let (zoom, [width, _]) = (self.zoom, self.painted.extent);
        for Pixel(Point { x, y }, color) in pixels {
            let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { continue };
            if x >= self.size.width || y >= self.size.height {
                continue;
            }
            for row in y * zoom..(y + 1) * zoom {
                let first = (row * width + x * zoom) as usize * 4;
                for texel in self.painted.texels[first..first + zoom as usize * 4].chunks_exact_mut(4) {
                    texel.copy_from_slice(&[color.r(), color.g(), color.b(), u8::MAX]);
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str, bar: u32) -> Line {
        Line { text: text.to_owned(), tone: Tone::Plain, bar }
    }

    /// How many texels are neither ground nor bar.
    fn letters(painted: &Painting) -> usize {
        let [red, green, blue] = [BAR.r(), BAR.g(), BAR.b()];
        painted.texels.chunks_exact(4).filter(|texel| **texel != GROUND && **texel != [red, green, blue, 255]).count()
    }

    #[test]
    fn characters_of_many_scripts_are_painted_and_others_have_one_that_stands_for_them() {
        let grid = Grid::new([640, 480], 1.0);
        let one = |text: &str| painted(&[line(text, 0)], &grid).expect("a picture").texels;
        for text in ["a", "ü", "Ω", "Ж", "·", "×", "→", "…"] {
            assert_ne!(one(text), one(" "), "{text}");
            assert_ne!(one(text), one("\u{20000}"), "{text}");
        }
        assert_eq!(one("\u{20000}"), one("\u{fffd}"));
        assert_ne!(one("\u{20000}"), one(" "));
        assert!(painted(&[line("", 100)], &grid).is_none());
    }

    #[test]
    fn em_4_the_list_grows_with_the_scale_factor_and_stays_within_the_window() {
        let lines = [line("times", 0), line("opaque", 0)];
        let at = |scale| {
            let grid = Grid::new([200, 120], scale);
            (painted(&lines, &grid).expect("a picture"), grid)
        };
        let ((one, _), (two, _)) = (at(1.0), at(2.0));
        assert_eq!(one.extent, [6 * 9 + 8, 2 * 15 + 8]);
        assert_eq!(two.extent, one.extent.map(|side| 2 * side));
        assert_eq!(letters(&two), 4 * letters(&one));
        assert_eq!(at(1.5).0.extent, [6 * 10 + 8, 2 * 20 + 8]);
        for scale in [0.0, 0.5, 1.0, 1.3, 1.75, 2.5, 40.0, f64::NAN] {
            for extent in [[1, 1], [50, 30], [200, 120], [641, 363]] {
                let grid = Grid::new(extent, scale);
                let full = vec![line(&"x".repeat(grid.columns), 100); grid.rows];
                let fits =
                    painted(&full, &grid).is_none_or(|it| it.extent[0] <= extent[0] && it.extent[1] <= extent[1]);
                assert!(fits, "{extent:?} {scale}");
            }
        }
    }

    #[test]
    fn a_bar_takes_its_part_of_the_width() {
        let grid = Grid::new([640, 480], 1.0);
        let bar = [BAR.r(), BAR.g(), BAR.b(), 255];
        let wide = |part: u32| {
            let painted = painted(&[line("          ", part)], &grid).expect("a picture");
            let row = painted.texels.chunks_exact(4).skip((painted.extent[0] * (MARGIN + 3)) as usize);
            row.take(painted.extent[0] as usize).filter(|texel| **texel == bar).count()
        };
        assert_eq!([wide(0), wide(50), wide(100)], [0, 45, 90]);
    }
}
