//! The surroundings of a pipeline: the names `scene.…`, `view.…` and `device.…` in expressions, and their values.

use super::facts::{Fact, FactType, FactValue, Facts};
use super::reads::{Read, Reads};
use crate::device::Profile;
use crate::expression::Type::{Bool, Integer};
use crate::expression::{Origin, Type, Value};
use crate::frame::Allowances;
use crate::vulkan::Format;

/// The scene, view and device that a pipeline is evaluated for.
#[derive(Debug, Clone, Copy)]
pub struct Surroundings<'a> {
    /// The facts of the scene.
    pub facts: Facts,
    /// Width and height of the frame, or of the view at hand, in texels.
    pub extent: [u32; 2],
    /// The number of eyes: 1 or 2.
    pub eyes: u32,
    /// Costs that the view allows.
    pub allows: Allowances,
    /// The device; `None`: a device with the least that Vulkan 1.3 demands.
    pub device: Option<&'a Profile>,
    /// Where reads are noted, if anywhere.
    pub reads: Option<&'a Reads>,
}

/// A name that every pipeline may use, besides facts of the scene.
struct Input {
    name: &'static str,
    ty: Type,
    origin: Origin,
    about: &'static str,
    value: fn(&Surroundings<'_>) -> Value,
}

const fn view(name: &'static str, ty: Type, about: &'static str, value: fn(&Surroundings<'_>) -> Value) -> Input {
    Input { name, ty, origin: Origin::View, about, value }
}

const fn device(name: &'static str, ty: Type, about: &'static str, value: fn(&Surroundings<'_>) -> Value) -> Input {
    Input { name, ty, origin: Origin::Device, about, value }
}

/// Without a device, its properties are the limits of the Vulkan 1.3 specification ("Required Limits", "Feature
/// Requirements").
const INPUTS: [Input; 14] = [
    view("view.width", Integer, "width of the view in texels", |of| Value::Integer(of.extent[0].into())),
    view("view.height", Integer, "height of the view in texels", |of| Value::Integer(of.extent[1].into())),
    view("view.eyes", Integer, "how many eyes see it: 1 or 2", |of| Value::Integer(of.eyes.into())),
    view("view.allows_msaa", Bool, "whether it allows several samples", |of| Value::Bool(of.allows.msaa)),
    view("view.allows_hdr", Bool, "whether it allows high dynamic range", |of| Value::Bool(of.allows.hdr)),
    view("view.allows_scale", Bool, "whether it allows another size than its own", |of| Value::Bool(of.allows.scale)),
    device("device.max_samples", Integer, "most samples that colour and depth both can have", |of| {
        of.limit(4, max_samples)
    }),
    device("device.max_size", Integer, "most texels of width and height", |of| {
        of.limit(4096, |device| device.max_attachment_extent)
    }),
    device("device.max_layers", Integer, "most layers of an image", |of| of.limit(256, |device| device.max_layers)),
    device("device.max_color_targets", Integer, "most colour targets of a pass", |of| {
        of.limit(4, |device| device.max_color_attachments)
    }),
    device("device.local_read", Bool, "whether a pass can read what its own rendering scope draws", |of| {
        of.feature(|device| device.local_read)
    }),
    device(
        "device.lazily_allocated_memory",
        Bool,
        "whether images that never leave their scope take no memory",
        |of| of.feature(|device| device.lazily_allocated_memory),
    ),
    device("device.compute_queue", Bool, "whether it has a queue for compute alone", |of| {
        of.feature(|device| device.queues.compute)
    }),
    device("device.transfer_queue", Bool, "whether it has a queue for transfer alone", |of| {
        of.feature(|device| device.queues.transfer)
    }),
];

/// The names that every pipeline may use, by number, facts first: name, type, kind and meaning.
fn all() -> impl Iterator<Item = (&'static str, Type, Origin, &'static str)> {
    let facts = Fact::ALL.into_iter().map(|fact| {
        let ty = match fact.ty() {
            FactType::Bool => Bool,
            FactType::Integer => Integer,
            FactType::Number => Type::Number,
        };
        (fact.name(), ty, Origin::Fact, fact.about())
    });
    facts.chain(INPUTS.iter().map(|input| (input.name, input.ty, input.origin, input.about)))
}

/// Every name that begins with `prefix`: "scene", "view" or "device", with its type and meaning.
pub fn names_of(prefix: &str) -> impl Iterator<Item = (&'static str, Type, &'static str)> {
    let of_it = move |name: &str| name.split_once('.').is_some_and(|(first, _)| first == prefix);
    all().filter(move |(name, ..)| of_it(name)).map(|(name, ty, _, about)| (name, ty, about))
}

/// Every name of the scene, the view and the device.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    all().map(|(name, ..)| name)
}

/// The number, type and kind of a name.
pub(crate) fn find(name: &str) -> Option<(u32, Type, Origin)> {
    if !name.contains('.') {
        return None;
    }
    (0..).zip(all()).find(|(_, (known, ..))| *known == name).map(|(at, (_, ty, origin, _))| (at, ty, origin))
}

impl Surroundings<'_> {
    /// The value of the name with this number.
    pub(crate) fn value(&self, number: u32) -> Option<Value> {
        let number = number as usize;
        let Some(fact) = Fact::ALL.get(number) else {
            return INPUTS.get(number - Fact::ALL.len()).map(|input| (input.value)(self));
        };
        self.note(Read::Fact(*fact));
        Some(match self.facts.value(*fact) {
            FactValue::Bool(value) => Value::Bool(value),
            FactValue::Integer(value) => Value::Integer(value),
            FactValue::Number(value) => Value::Number(value),
        })
    }

    /// Notes a read.
    pub(crate) fn note(&self, read: Read) {
        if let Some(reads) = self.reads {
            reads.add(read);
        }
    }

    fn limit(&self, least: u32, of: impl Fn(&Profile) -> u32) -> Value {
        Value::Integer(self.device.map_or(least, of).into())
    }

    fn feature(&self, of: impl Fn(&Profile) -> bool) -> Value {
        Value::Bool(self.device.is_some_and(of))
    }
}

/// The most samples that colour of high dynamic range and depth can both have as attachments.
fn max_samples(device: &Profile) -> u32 {
    let most = |format| device.format(format).and_then(|support| support.samples.last().copied()).unwrap_or(1);
    most(Format::R16G16B16A16_SFLOAT).min(most(Format::D32_SFLOAT))
}
