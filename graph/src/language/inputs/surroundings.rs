//! What a pipeline is made for: the names `scene.…`, `view.…` and `device.…` in expressions, and their values.

use super::facts::{Fact, FactType, FactValue, Facts};
use crate::device::Profile;
use crate::expression::{Origin, Type, Value};
use crate::frame::Allowances;
use crate::vulkan::Format;

/// What a pipeline is made for, besides the values of its settings.
#[derive(Debug, Clone, Copy)]
pub struct Surroundings<'a> {
    /// What is known about the scene.
    pub facts: Facts,
    /// Width and height of the frame, or of the view at hand, in texels.
    pub extent: [u32; 2],
    /// How many eyes see it: 1 or 2.
    pub eyes: u32,
    /// What may be spent on it.
    pub allows: Allowances,
    /// The device; `None`: one that can do just what Vulkan 1.3 demands of every device.
    pub device: Option<&'a Profile>,
}

/// A name that every pipeline may use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Input {
    Fact(Fact),
    View(View),
    Device(Device),
}

/// A property of the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum View {
    Width,
    Height,
    Eyes,
    AllowsMsaa,
    AllowsHdr,
    AllowsScale,
}

/// A property of the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Device {
    MaxSamples,
    MaxSize,
    MaxLayers,
    MaxColorTargets,
    LocalRead,
    LazilyAllocatedMemory,
    ComputeQueue,
    TransferQueue,
}

const VIEW: [(&str, View, Type, &str); 6] = [
    ("view.width", View::Width, Type::Integer, "width of the view in texels"),
    ("view.height", View::Height, Type::Integer, "height of the view in texels"),
    ("view.eyes", View::Eyes, Type::Integer, "how many eyes see it: 1 or 2"),
    ("view.allows_msaa", View::AllowsMsaa, Type::Bool, "whether it allows several samples"),
    ("view.allows_hdr", View::AllowsHdr, Type::Bool, "whether it allows high dynamic range"),
    ("view.allows_scale", View::AllowsScale, Type::Bool, "whether it allows another size than its own"),
];

const DEVICE: [(&str, Device, Type, &str); 8] = [
    ("device.max_samples", Device::MaxSamples, Type::Integer, "most samples that colour and depth both can have"),
    ("device.max_size", Device::MaxSize, Type::Integer, "most texels of width and height"),
    ("device.max_layers", Device::MaxLayers, Type::Integer, "most layers of an image"),
    ("device.max_color_targets", Device::MaxColorTargets, Type::Integer, "most colour targets of a pass"),
    ("device.local_read", Device::LocalRead, Type::Bool, "whether a pass can read what its own rendering scope draws"),
    (
        "device.lazily_allocated_memory",
        Device::LazilyAllocatedMemory,
        Type::Bool,
        "whether images that never leave their scope take no memory",
    ),
    ("device.compute_queue", Device::ComputeQueue, Type::Bool, "whether it has a queue for compute alone"),
    ("device.transfer_queue", Device::TransferQueue, Type::Bool, "whether it has a queue for transfer alone"),
];

/// All of them, by number.
fn all() -> impl Iterator<Item = (&'static str, Input, Type, Origin)> {
    let facts = Fact::ALL.into_iter().map(|fact| {
        let ty = match fact.ty() {
            FactType::Bool => Type::Bool,
            FactType::Integer => Type::Integer,
            FactType::Number => Type::Number,
        };
        (fact.name(), Input::Fact(fact), ty, Origin::Fact)
    });
    let view = VIEW.into_iter().map(|(name, view, ty, _)| (name, Input::View(view), ty, Origin::View));
    let device = DEVICE.into_iter().map(|(name, device, ty, _)| (name, Input::Device(device), ty, Origin::Device));
    facts.chain(view).chain(device)
}

/// Every name that begins with `prefix`: "scene", "view" or "device", with its type and what it says.
pub fn names_of(prefix: &str) -> impl Iterator<Item = (&'static str, Type, &'static str)> {
    let about = |name: &str| {
        let facts = Fact::ALL.into_iter().map(|fact| (fact.name(), fact.about()));
        let view = VIEW.into_iter().map(|(name, _, _, about)| (name, about));
        let device = DEVICE.into_iter().map(|(name, _, _, about)| (name, about));
        facts.chain(view).chain(device).find(|(known, _)| *known == name).map_or("", |(_, about)| about)
    };
    let of_it = move |name: &str| name.split_once('.').is_some_and(|(first, _)| first == prefix);
    all().filter(move |(name, ..)| of_it(name)).map(move |(name, _, ty, _)| (name, ty, about(name)))
}

/// Every such name.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    all().map(|(name, ..)| name)
}

/// The number, type and kind of a name.
pub(crate) fn find(name: &str) -> Option<(u32, Type, Origin)> {
    if !name.contains('.') {
        return None;
    }
    (0..).zip(all()).find(|(_, (known, ..))| *known == name).map(|(at, (_, _, ty, origin))| (at, ty, origin))
}

impl Surroundings<'_> {
    /// The value of the name with this number.
    pub(crate) fn value(&self, number: u32) -> Option<Value> {
        let (_, known, ..) = all().nth(number as usize)?;
        Some(match known {
            Input::Fact(fact) => match self.facts.value(fact) {
                FactValue::Bool(value) => Value::Bool(value),
                FactValue::Integer(value) => Value::Integer(value),
                FactValue::Number(value) => Value::Number(value),
            },
            Input::View(View::Width) => Value::Integer(self.extent[0].into()),
            Input::View(View::Height) => Value::Integer(self.extent[1].into()),
            Input::View(View::Eyes) => Value::Integer(self.eyes.into()),
            Input::View(View::AllowsMsaa) => Value::Bool(self.allows.msaa),
            Input::View(View::AllowsHdr) => Value::Bool(self.allows.hdr),
            Input::View(View::AllowsScale) => Value::Bool(self.allows.scale),
            Input::Device(device) => self.of_device(device),
        })
    }

    /// Where there is no device, the limits of the Vulkan 1.3 specification ("Required Limits", "Feature Requirements").
    fn of_device(&self, asked: Device) -> Value {
        let device = self.device;
        let count = |value: Option<u32>, least: u32| Value::Integer(value.unwrap_or(least).into());
        let has = |value: Option<bool>| Value::Bool(value.unwrap_or(false));
        match asked {
            Device::MaxSamples => count(device.map(max_samples), 4),
            Device::MaxSize => count(device.map(|device| device.max_attachment_extent), 4096),
            Device::MaxLayers => count(device.map(|device| device.max_layers), 256),
            Device::MaxColorTargets => count(device.map(|device| device.max_color_attachments), 4),
            Device::LocalRead => has(device.map(|device| device.local_read)),
            Device::LazilyAllocatedMemory => has(device.map(|device| device.lazily_allocated_memory)),
            Device::ComputeQueue => has(device.map(|device| device.queues.compute)),
            Device::TransferQueue => has(device.map(|device| device.queues.transfer)),
        }
    }
}

/// The most samples that colour of high dynamic range and depth can both have as attachments.
fn max_samples(device: &Profile) -> u32 {
    let most = |format| device.format(format).and_then(|support| support.samples.last().copied()).unwrap_or(1);
    most(Format::R16G16B16A16_SFLOAT).min(most(Format::D32_SFLOAT))
}
