//! Values of single arguments, and how they are read. The error of each reader says what was expected, in words.

use crate::system::text;
use clap::ValueEnum;
use framewright::ShaderCompilers;
use framewright_graph::compile::Order;
use framewright_graph::frame::Stereo;
use framewright_graph::vulkan::Rotation;
use framewright_lab::picture::FileFormat;
use framewright_lab::sweep::{Sweep, size_name};
use serde::Serialize;
use std::path::PathBuf;

/// A range has at most this many values.
const MOST_STEPS: u32 = 1_000;

/// Width and height of the output where the command line says none, in pixels.
pub(crate) const DEFAULT_SIZE: Size = Size { width: 1280, height: 720 };

/// Largest width or height that the command line takes, in pixels.
pub(crate) const MAX_SIZE: u32 = 16384;

/// Width and height in pixels, each 1…[`MAX_SIZE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

/// `NAME=VALUE`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Assignment {
    /// The setting, or the fact.
    pub(crate) name: String,
    /// Its value, as text.
    pub(crate) value: String,
}

/// `IMAGE=FILE.png`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Dump {
    /// The image's name in the pipeline.
    pub(crate) image: String,
    pub(crate) file: PathBuf,
}

/// `FILE.png` or `NAME=FILE.png`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct OutputFile {
    /// The name of one of the pipeline's outputs; `None`: the first.
    pub(crate) output: Option<String>,
    pub(crate) file: PathBuf,
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&size_name((*self).into()))
    }
}

impl From<Size> for [u32; 2] {
    fn from(size: Size) -> [u32; 2] {
        [size.width, size.height]
    }
}

impl std::str::FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Size, String> {
        let (width, height) = text.split_once(['x', 'X']).ok_or("expected WIDTHxHEIGHT, such as 1280x720")?;
        let side = |name: &str, digits: &str| {
            if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
                return Err("expected WIDTHxHEIGHT, such as 1280x720".to_owned());
            }
            match digits.parse::<u32>() {
                Ok(pixels @ 1..=MAX_SIZE) => Ok(pixels),
                _ => Err(format!("the {name} must be 1 to {MAX_SIZE} pixels")),
            }
        };
        Ok(Size { width: side("width", width)?, height: side("height", height)? })
    }
}

/// Reads `NAME=VALUE`.
pub(crate) fn assignment(text: &str) -> Result<Assignment, String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok(Assignment { name: name.to_owned(), value: value.to_owned() }),
        _ => Err("expected NAME=VALUE, such as msaa=4".to_owned()),
    }
}

/// Reads the compiler of a language.
pub(crate) fn shader_compiler(text: &str) -> Result<ShaderCompilers, String> {
    let mut compilers = ShaderCompilers::default();
    compilers.set_named(text).map_err(|bad| text::escape(&bad.to_string()))?;
    Ok(compilers)
}

/// Reads an order of execution.
pub(crate) fn order(text: &str) -> Result<Order, String> {
    match text.strip_prefix("random:") {
        Some(seed) if !seed.is_empty() && seed.bytes().all(|byte| byte.is_ascii_digit()) => match seed.parse() {
            Ok(seed) => Ok(Order::Random(seed)),
            Err(_) => Err(format!("the seed must be 0 to {}", u64::MAX)),
        },
        Some(_) => Err("the seed is a whole number, such as random:7".to_owned()),
        None => match text {
            "file" => Ok(Order::File),
            "default" => Ok(Order::Default),
            "low-memory" => Ok(Order::LowMemory),
            _ => Err("expected file, default, low-memory or random:SEED, such as random:7".to_owned()),
        },
    }
}

/// Reads `0`, `90`, `180` or `270`.
pub(crate) fn rotation(text: &str) -> Result<Rotation, String> {
    let degrees = text.parse().ok().filter(|_| text.bytes().all(|byte| byte.is_ascii_digit()));
    degrees.and_then(Rotation::from_degrees).ok_or_else(|| "expected 0, 90, 180 or 270".to_owned())
}

/// Ways of drawing for two eyes, the first one first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Modes(pub(crate) Vec<Stereo>);

/// Reads ways of drawing for two eyes.
pub(crate) fn stereo(text: &str) -> Result<Modes, String> {
    if text == "auto" {
        return Ok(Modes(Stereo::FASTEST_FIRST.into()));
    }
    let known = |name: &str| Stereo::ALL.into_iter().find(|stereo| stereo.name() == name);
    let modes: Option<Vec<Stereo>> = text.split(',').map(known).collect();
    let before_last = modes.as_ref().and_then(|modes| modes.split_last()).map_or(&[][..], |(_, others)| others);
    if before_last.contains(&Stereo::Off) {
        return Err("`off` is for one eye, which every device can draw: nothing comes after it".to_owned());
    }
    let expected = || Stereo::ALL.map(Stereo::name).join(", ");
    modes.map(Modes).ok_or_else(|| format!("expected auto, or some of {} with commas between them", expected()))
}

/// Reads `IMAGE=FILE.png`.
pub(crate) fn dump(text: &str) -> Result<Dump, String> {
    match text.split_once('=') {
        Some((image, file)) if !image.is_empty() => Ok(Dump { image: image.to_owned(), file: picture(file)? }),
        _ => Err("expected IMAGE=FILE.png, such as depth=depth.png".to_owned()),
    }
}

/// Reads `FILE.png` or `NAME=FILE.png`. What has a `/` before its first `=` is no name: `./a=b.png` is a file.
pub(crate) fn output_file(text: &str) -> Result<OutputFile, String> {
    match text.split_once('=') {
        Some((name, file)) if !name.is_empty() && !name.contains('/') => {
            Ok(OutputFile { output: Some(name.to_owned()), file: picture(file)? })
        }
        _ => Ok(OutputFile { output: None, file: picture(text)? }),
    }
}

/// Form of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum AnswerFormat {
    /// For people.
    #[default]
    Human,
    /// For programs.
    Json,
}

/// Reads a number.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| "expected a number, such as 0.02".to_owned())
}

/// Reads a number above 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    number(text).ok().filter(|number| *number > 0.0).ok_or_else(|| "expected a number above 0, such as 4.5".to_owned())
}

/// Reads `NAME=A,B,C` or `NAME=LO..HI:STEPS`. Blanks around names, values and numbers are no part of them.
///
/// # Errors
/// The form that was expected.
pub(crate) fn sweep(text: &str) -> Result<Sweep, String> {
    const FORM: &str = "expected NAME=A,B,C or NAME=LO..HI:STEPS, such as msaa=1,4 or render_scale=0.5..2:4";
    let (name, values) = text.split_once('=').map(|(name, values)| (name.trim(), values)).ok_or(FORM)?;
    // Paths of scenes may hold two dots.
    let range_of = values.split_once("..").filter(|_| !name.starts_with('@'));
    let values = match range_of {
        Some((low, rest)) => {
            let (high, steps) = rest.split_once(':').ok_or(FORM)?;
            range(low, high, steps)?
        }
        None => values.split(',').map(|value| value.trim().to_owned()).collect(),
    };
    if name.is_empty() || values.iter().any(String::is_empty) {
        return Err(FORM.to_owned());
    }
    match (1..values.len()).find(|at| values[..*at].contains(&values[*at])) {
        Some(twice) => Err(format!("`{}` stands there twice", text::escape(&values[twice]))),
        None => Ok(Sweep { name: name.to_owned(), values }),
    }
}

/// Values at equal distances from `low` to `high`, which both are among them. `steps` is their number.
fn range(low: &str, high: &str, steps: &str) -> Result<Vec<String>, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    let (Some(low), Some(high)) = (number(low), number(high)) else {
        return Err("a range goes from one number to another, such as 0.5..2:4".to_owned());
    };
    let steps = steps.trim().parse::<u32>().ok().filter(|steps| (2..=MOST_STEPS).contains(steps));
    let steps = steps.ok_or_else(|| format!("a range has 2 to {MOST_STEPS} values, such as 0.5..2:4"))?;
    if low >= high {
        return Err(format!("the range goes backwards: {low} is not below {high}"));
    }
    let last = steps - 1;
    let value = |at: u32| {
        let share = f64::from(at) / f64::from(last);
        let value = low + (high - low) * f64::from(at) / f64::from(last);
        match value.is_finite() {
            _ if at == last => high,
            true => shortest(value, (high - low) / f64::from(last)),
            // The distance is beyond all numbers, and neither part of this sum is.
            false => low * (1.0 - share) + high * share,
        }
    };
    Ok((0..steps).map(|at| value(at).to_string()).collect())
}

/// A value without the noise of its last digits, where that is nothing beside the distance of two values.
fn shortest(value: f64, distance: f64) -> f64 {
    let short = format!("{value:.11e}").parse().unwrap_or(value);
    if (short - value).abs() < 1e-6 * distance { short } else { value }
}

/// Reads the name of a PNG file.
pub(crate) fn png(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match FileFormat::of(&path) {
        Some(FileFormat::Png) => Ok(path),
        _ => Err("it is written as PNG: the file's name must end in .png".to_owned()),
    }
}

/// Reads the name of a picture's file.
pub(crate) fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match FileFormat::of(&path) {
        Some(_) => Ok(path),
        None => Err("pictures are written as PNG or OpenEXR: the file's name must end in .png or .exr".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_is_two_numbers_within_limits() {
        assert_eq!("640x480".parse(), Ok(Size { width: 640, height: 480 }));
        assert_eq!("16384x1".parse(), Ok(Size { width: 16384, height: 1 }));
        for wrong in ["", "640", "640x", "x480", "-1x480", "+1x480", "6 40x480", "640x480x1"] {
            assert_eq!(wrong.parse::<Size>(), Err("expected WIDTHxHEIGHT, such as 1280x720".to_owned()), "{wrong}");
        }
        assert_eq!("0x480".parse::<Size>(), Err("the width must be 1 to 16384 pixels".to_owned()));
        assert_eq!("640x16385".parse::<Size>(), Err("the height must be 1 to 16384 pixels".to_owned()));
        assert_eq!("1x99999999999999999999".parse::<Size>(), Err("the height must be 1 to 16384 pixels".to_owned()));
    }

    #[test]
    fn an_order_is_one_of_four_and_a_seed_a_whole_number() {
        assert_eq!(order("file"), Ok(Order::File));
        assert_eq!(order("low-memory"), Ok(Order::LowMemory));
        assert_eq!(order("random:18446744073709551615"), Ok(Order::Random(u64::MAX)));
        for wrong in ["", "File", "random", "low", "file "] {
            let expected = "expected file, default, low-memory or random:SEED, such as random:7";
            assert_eq!(order(wrong), Err(expected.to_owned()), "{wrong}");
        }
        for wrong in ["random:", "random:x", "random:-1", "random:+1", "random:1.5"] {
            assert_eq!(order(wrong), Err("the seed is a whole number, such as random:7".to_owned()), "{wrong}");
        }
        assert_eq!(order("random:18446744073709551616"), Err("the seed must be 0 to 18446744073709551615".to_owned()));
    }

    #[test]
    fn an_output_is_named_before_its_file_and_a_path_is_no_name() {
        let read = |text: &str| output_file(text).map(|read| (read.output, read.file));
        assert_eq!(read("a.png"), Ok((None, "a.png".into())));
        assert_eq!(read("depth=a.exr"), Ok((Some("depth".to_owned()), "a.exr".into())));
        assert_eq!(read("glow.down[0]=b/a=c.png"), Ok((Some("glow.down[0]".to_owned()), "b/a=c.png".into())));
        assert_eq!(read("./a=b.png"), Ok((None, "./a=b.png".into())));
        assert!(read("depth=").is_err() && read("depth=a.jpg").is_err() && read("a").is_err());
    }

    #[test]
    fn values_are_listed_or_a_range() {
        let values = |text: &str| sweep(text).map(|sweep| sweep.values);
        assert_eq!(values("msaa=1,4"), Ok(vec!["1".to_owned(), "4".to_owned()]));
        assert_eq!(values("s=0.5..2:4").expect("a range"), ["0.5", "1", "1.5", "2"]);
        assert_eq!(values("s=0.3..0.9:3").expect("a range"), ["0.3", "0.6", "0.9"]);
        for wrong in ["msaa", "=1", "msaa=", "msaa=1,,2", "s=1..2", "s=1..2:1", "s=2..1:3", "s=a..b:3", "s=0..1:1001"] {
            assert!(sweep(wrong).is_err(), "{wrong}");
        }
        assert_eq!(sweep("s=2..1:3"), Err("the range goes backwards: 2 is not below 1".to_owned()));
        assert_eq!(sweep("s=1,2,1"), Err("`1` stands there twice".to_owned()));
        // Both ends are among the values, even where their distance is beyond all numbers.
        let wide: Vec<f64> =
            values("s=-1e308..1e308:5").expect("a range").iter().map(|it| it.parse().expect("a number")).collect();
        assert_eq!(wide, [-1e308, -5e307, 0.0, 5e307, 1e308]);
        assert_eq!(values("s=0.1..0.7:7").expect("a range").last().map(String::as_str), Some("0.7"));
    }

    #[test]
    fn blanks_around_values_are_no_part_of_them() {
        assert_eq!(sweep(" msaa = 1, 4 "), sweep("msaa=1,4"));
        assert_eq!(sweep("s= 0.5 .. 2 : 4"), sweep("s=0.5..2:4"));
        assert_eq!(sweep("s=1, 1"), Err("`1` stands there twice".to_owned()));
        for wrong in ["msaa=1, ,4", " =1", "msaa= "] {
            assert!(sweep(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_value_may_hold_an_equals_sign() {
        assert_eq!(assignment("name=a=b"), Ok(Assignment { name: "name".to_owned(), value: "a=b".to_owned() }));
        assert!(assignment("=4").is_err());
        assert!(assignment("msaa").is_err());
    }
}
