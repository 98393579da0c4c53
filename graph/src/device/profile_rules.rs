//! Figures that no device has are refused where they stand: rules for the fields of a profile that is read from text.

use super::{FormatSupport, KnownNeeds};
use crate::vulkan::{Aspects, Usage};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Largest extent or number of layers that is taken, four times the largest of any device today.
const LARGEST_EXTENT: u32 = 1 << 16;
/// Largest alignment that is taken, in bytes.
const LARGEST_ALIGNMENT: u64 = 1 << 30;
/// Most bytes of one image that are taken.
const MOST_BYTES: u64 = 1 << 48;

/// A name that can be shown.
pub(super) fn name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let name = String::deserialize(deserializer)?;
    if name.trim().is_empty() { Err(D::Error::custom("the device has no name")) } else { Ok(name) }
}

/// A width, height, depth or number of layers.
pub(super) fn extent<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    within(deserializer, 1, LARGEST_EXTENT)
}

/// A number of attachments.
pub(super) fn attachments<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    within(deserializer, 1, 64)
}

/// A number of views.
pub(super) fn views<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    within(deserializer, 1, 32)
}

fn within<'de, D: Deserializer<'de>>(deserializer: D, least: u32, most: u32) -> Result<u32, D::Error> {
    match u32::deserialize(deserializer)? {
        value if (least..=most).contains(&value) => Ok(value),
        value => Err(D::Error::custom(format!("this is {value}, and must be {least} to {most}"))),
    }
}

/// An alignment in bytes.
pub(super) fn alignment<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
    power_of_two(u64::deserialize(deserializer)?, LARGEST_ALIGNMENT)
}

/// The multiple that rows or heights are padded to.
pub(super) fn padding<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    let value = u32::deserialize(deserializer)?;
    power_of_two(u64::from(value), u64::from(LARGEST_EXTENT)).map(|_: u64| value)
}

fn power_of_two<E: Error>(value: u64, most: u64) -> Result<u64, E> {
    if value.is_power_of_two() && value <= most {
        Ok(value)
    } else {
        Err(E::custom(format!("this is {value}, and must be a power of two up to {most}")))
    }
}

/// Bytes of a heap, where they are known.
pub(super) fn heap_bytes<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u64>, D::Error> {
    match u64::deserialize(deserializer).map_err(written_anew)? {
        0 => Err(D::Error::custom("a heap without memory: leave it out if it isn't known")),
        bytes => Ok(Some(bytes)),
    }
}

/// A number of clip distances, where it is known.
pub(super) fn clip_distances<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u32>, D::Error> {
    u32::deserialize(deserializer).map(Some).map_err(written_anew)
}

/// What stands for itself where it is known.
pub(super) fn where_known<'de, D: Deserializer<'de>, T: Deserialize<'de>>(from: D) -> Result<Option<T>, D::Error> {
    T::deserialize(from).map(Some)
}

/// Older profiles have `Some(…)` around such a number.
fn written_anew<E: serde::de::Error>(error: E) -> E {
    E::custom(format!(
        "{error}: a plain number stands here; a profile with `Some(…)` is an older one, which is saved anew"
    ))
}

/// Writes a number that stands for itself where it is known. Where it isn't the field is left out, and this isn't called.
#[allow(clippy::ref_option, reason = "serde hands a field over so")]
pub(super) fn known<S: Serializer, T: Serialize>(number: &Option<T>, to: S) -> Result<S::Ok, S::Error> {
    match number {
        Some(number) => number.serialize(to),
        None => to.serialize_none(),
    }
}

/// Memory types.
pub(super) fn type_bits<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    match u32::deserialize(deserializer)? {
        0 => Err(D::Error::custom("no memory type will do: at least one bit must be set")),
        bits => Ok(bits),
    }
}

/// The support for formats, each format once.
pub(super) fn formats<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<FormatSupport>, D::Error> {
    let formats: Vec<FormatSupport> = list(deserializer)?;
    for (at, support) in formats.iter().enumerate() {
        if formats[..at].iter().any(|other| other.format == support.format) {
            return Err(D::Error::custom(format!("{} stands in this list twice", support.format)));
        }
    }
    Ok(formats)
}

/// Memory needs, sorted so that they can be looked up.
pub(super) fn known_needs<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<KnownNeeds>, D::Error> {
    let all: Vec<KnownNeeds> = list(deserializer)?;
    let unsorted = all.windows(2).find(|pair| (pair[0].format, pair[0].samples) > (pair[1].format, pair[1].samples));
    match unsorted {
        Some(pair) => {
            let [before, after] = [&pair[0], &pair[1]].map(|it| format!("{} with {} samples", it.format, it.samples));
            Err(D::Error::custom(format!("{after} must stand before {before}: this list is sorted")))
        }
        None => Ok(all),
    }
}

/// Checks of an entry of a list, beyond its single fields.
trait Check {
    /// The mistake, in words.
    fn check(&self) -> Result<(), String>;
}

/// An entry without fault.
struct SoundEntry<T>(T);

impl<'de, T: Deserialize<'de> + Check> Deserialize<'de> for SoundEntry<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<SoundEntry<T>, D::Error> {
        let entry = T::deserialize(deserializer)?;
        entry.check().map_err(D::Error::custom)?;
        Ok(SoundEntry(entry))
    }
}

/// A list whose entries are checked one by one, so that a fault is told where it stands.
fn list<'de, D: Deserializer<'de>, T: Deserialize<'de> + Check>(deserializer: D) -> Result<Vec<T>, D::Error> {
    Vec::<SoundEntry<T>>::deserialize(deserializer).map(|list| list.into_iter().map(|entry| entry.0).collect())
}

/// Returns the mistake unless `sound`.
fn demand(sound: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if sound { Ok(()) } else { Err(otherwise()) }
}

impl Check for FormatSupport {
    fn check(&self) -> Result<(), String> {
        let FormatSupport { format, usage, samples, .. } = self;
        let attachments = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT;
        let attached = usage.intersects(attachments);
        demand(Usage::all().contains(*usage), || format!("{format} has usages that are not known"))?;
        let depth = format.aspects().intersects(Aspects::DEPTH | Aspects::STENCIL);
        let wrong = if depth { Usage::COLOR_ATTACHMENT } else { Usage::DEPTH_STENCIL_ATTACHMENT };
        demand(!usage.contains(wrong), || format!("{format} can't be {}", names(wrong)))?;
        let only_attached = *usage & (Usage::TRANSIENT_ATTACHMENT | Usage::INPUT_ATTACHMENT);
        demand(attached || only_attached.is_empty(), || {
            format!("{format} can't be {} without being an attachment", names(only_attached))
        })?;
        demand(usage.contains(Usage::SAMPLED) || !self.linear_filter, || {
            format!("{format} can't be filtered without being SAMPLED")
        })?;
        demand(usage.contains(Usage::SAMPLED) || !self.minmax_filter, || {
            format!("{format} has no least and greatest texels without being SAMPLED")
        })?;
        demand(!self.linear_filter || !format.is_integer(), || {
            format!("{format} holds integers: it can't be filtered")
        })?;
        let blends = usage.contains(Usage::COLOR_ATTACHMENT) && !format.is_integer();
        demand(blends || !self.blend, || format!("{format} can't be blended: it holds no colour that is drawn into"))?;
        let possible = |count: &u32| count.is_power_of_two() && *count <= 64;
        if let Some(count) = samples.iter().find(|count| !possible(count)) {
            return Err(format!("{format} has {count} samples; 1, 2, 4, 8, 16, 32 or 64 are possible"));
        }
        demand(samples.is_sorted_by(|a, b| a < b), || format!("the sample counts of {format} must rise"))?;
        demand(samples.contains(&1) == attached && samples.is_empty() != attached, || match attached {
            true => format!("{format} is an attachment: 1 must be among its sample counts"),
            false => format!("{format} is no attachment: it has no sample counts"),
        })
    }
}

impl Check for KnownNeeds {
    fn check(&self) -> Result<(), String> {
        let KnownNeeds { format, samples, usages, sizes } = self;
        demand(samples.is_power_of_two() && *samples <= 64, || {
            format!("{format} has {samples} samples; 1, 2, 4, 8, 16, 32 or 64 are possible")
        })?;
        demand(usages.iter().all(|usage| Usage::all().contains(*usage)), || {
            format!("{format} has usages that are not known")
        })?;
        demand(sizes.is_sorted_by(|a, b| a.0 < b.0), || format!("the sizes of {format} must rise"))?;
        for ([width, height], needs) in sizes {
            let shown = || format!("{format} of {width}×{height} with {samples} samples");
            let extents = 1..=LARGEST_EXTENT;
            demand(extents.contains(width) && extents.contains(height), || {
                format!("{} is not 1 to {LARGEST_EXTENT} texels wide and high", shown())
            })?;
            // At most 2^16 · 2^16 · 2^6 · 2^4.
            let texels = format.least_bytes([*width, *height]) * u64::from(*samples);
            demand((texels..=MOST_BYTES).contains(&needs.bytes), || {
                format!("{} can't take {} bytes: its texels alone are {texels}", shown(), needs.bytes)
            })?;
        }
        Ok(())
    }
}

/// Vulkan's names of usages.
fn names(usage: Usage) -> String {
    usage.iter_names().map(|(name, _)| name).collect::<Vec<_>>().join(" or ")
}
