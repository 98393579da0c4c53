//! Draw interfaces: what draws of the program bring along.

use crate::arguments::{list, one_of, optional_text, text};
use crate::passes::FramewrightDraw;
use crate::status::Problem;
use framewright::graph::shader::{PushConstants, VertexBuffer, VertexRate};
use framewright::graph::vulkan::{PrimitiveTopology, Stages, VertexFormat};
use framewright::passes::draw;
use framewright::vulkan::ash::vk;
use framewright::{Attribute, DrawInterface, DrawInterfaces, DrawKind, DrawList, SuppliedKind, SuppliedResource};
use std::collections::BTreeSet;
use std::ffi::c_char;

/// A vertex buffer of a draw interface.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightVertexBuffer {
    /// Bytes from element to element.
    pub stride: u32,
    /// 0: it has an element for each vertex. Else how many instances in a row read one element: 1 for an element for each instance. More than 1
    /// needs the feature `vertexAttributeInstanceRateDivisor`.
    pub instances: u32,
}

/// A vertex attribute of a draw interface. Shaders choose locations, and find attributes by name.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightAttribute {
    /// Its name in shaders.
    pub name: *const c_char,
    /// Its format; of a matrix or an array that of one location.
    pub format: vk::Format,
    /// Where it lies in an element of the buffer, in bytes.
    pub offset: u32,
    /// The number of its vertex buffer.
    pub buffer: u32,
    /// How many locations it takes, one behind the other in the buffer: of a matrix as many as it has columns; 0 counts as 1.
    pub locations: u32,
    /// Whether shaders that have no name for it read it at `location`. 0 is false.
    pub has_location: u32,
    /// That location.
    pub location: u32,
}

/// The kind of a resource that draws bring along.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum FramewrightResourceKind {
    /// A uniform block.
    UniformBlock = 0,
    /// A storage block that shaders read (`readonly buffer`).
    StorageBlock = 1,
    /// A two-dimensional image of floats with its sampler (`sampler2D`), or an array of such ones.
    SampledImage = 2,
}

/// A resource of a draw interface. All stages of the shaders of its kind of draws see it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightSuppliedResource {
    /// Its name in shaders.
    pub name: *const c_char,
    /// Its descriptor set, 1 to 3.
    pub set: u32,
    /// Its binding, 0 to 255.
    pub binding: u32,
    /// A FramewrightResourceKind.
    pub kind: u32,
    /// How many images an array has; 0 counts as 1.
    pub count: u32,
}

/// What one kind of draws of the program's brings along: vertices, push constants, and resources in bind groups. 0 in a field is its default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightDrawInterface {
    /// The kind: a FramewrightDraw. Full-screen passes have no vertices of the program's; compute passes and draws of a pass's own vertices have no
    /// push constants of it either.
    pub draw: u32,
    /// With `FRAMEWRIGHT_DRAW_CUSTOM`: what the pipeline calls the custom passes that are meant, alone; NULL: all that no other entry means.
    pub custom: *const c_char,
    /// Vertex buffers, by their numbers.
    pub vertex_buffers: *const FramewrightVertexBuffer,
    /// How many there are.
    pub vertex_buffer_count: usize,
    /// Vertex attributes.
    pub attributes: *const FramewrightAttribute,
    /// How many there are.
    pub attribute_count: usize,
    /// Whether `topology` is what vertices make; else the pass says it, or it is a triangle of each three. 0 is false.
    pub has_topology: u32,
    /// What vertices make: points, lines or triangles, without adjacency and patches.
    pub topology: vk::PrimitiveTopology,
    /// Whether an index of all ones ends a strip or a fan, and begins another. 0 is false.
    pub primitive_restart: u32,
    /// Push constants that the program sets for each draw. `stageFlags` of 0 are vertex and fragment shaders.
    pub push_constants: *const vk::PushConstantRange,
    /// How many ranges there are.
    pub push_constant_count: usize,
    /// Resources.
    pub supplied: *const FramewrightSuppliedResource,
    /// How many there are.
    pub supplied_count: usize,
}

/// What each kind of draws brings along, and whether the program draws it or a scene.
#[derive(Clone)]
pub(crate) struct ProgramDraws {
    pub(crate) interfaces: DrawInterfaces,
    /// The kinds that the program has told of.
    pub(crate) own: BTreeSet<DrawKind>,
    /// Whether the other kinds are a scene's.
    pub(crate) scene: bool,
}

impl ProgramDraws {
    /// Takes what the program tells. `custom`: the names of all custom passes, if there are any.
    ///
    /// # Safety
    /// The fields are as they say.
    pub(crate) unsafe fn read(
        given: &[FramewrightDrawInterface],
        scene_draws: bool,
        custom: &[&str],
    ) -> Result<ProgramDraws, Problem> {
        let scene = given.is_empty() || scene_draws;
        let mut interfaces = if scene { draw::interfaces() } else { DrawInterfaces::default() };
        let (mut own, mut named) = (BTreeSet::new(), BTreeSet::new());
        for (number, one) in given.iter().enumerate() {
            let at = format!("draws[{number}]");
            let kind = *one_of(&KINDS, one.draw, &format!("{at}.draw"))?;
            // SAFETY: the caller's word.
            let (interface, name) =
                unsafe { (interface(one, &at)?, optional_text(one.custom, &format!("{at}.custom"))?) };
            let misuse = |what: String| Err(Problem::Misuse(format!("`{at}`: {what}")));
            match name {
                Some(_) if kind != DrawKind::Custom => {
                    return misuse(format!("a name of custom passes, and the kind is `{kind}`"));
                }
                Some(name) if !custom.is_empty() && !custom.contains(&name) => {
                    return misuse(format!("no custom pass is called `{name}`"));
                }
                Some(name) if !named.insert(name) => return misuse(format!("`{name}` stands here twice")),
                Some(name) => interfaces = interfaces.with_custom(name, interface),
                None if !own.insert(kind) => return misuse(format!("`{kind}` stands here twice")),
                None => {
                    interfaces = interfaces.with(kind, interface.clone());
                    if interfaces.of_kind(kind) != interface {
                        return misuse(format!("draws of the kind `{kind}` bring no such vertices or push constants"));
                    }
                }
            }
        }
        if !custom.is_empty() {
            interfaces = interfaces.with_custom_passes(custom.iter().copied());
        }
        Ok(ProgramDraws { interfaces, own, scene })
    }

    /// Whether the program records these draws, whatever scene there is.
    pub(crate) fn is_own(&self, kind: DrawKind) -> bool {
        kind == DrawKind::Custom || self.own.contains(&kind)
    }
}

/// The kinds of draws by their FramewrightDraw.
const KINDS: [DrawKind; 10] = [
    DrawKind::Custom,
    DrawKind::Objects(DrawList::Opaque),
    DrawKind::Objects(DrawList::Masked),
    DrawKind::Objects(DrawList::Transparent),
    DrawKind::Casters(DrawList::Opaque),
    DrawKind::Casters(DrawList::Masked),
    DrawKind::Sky,
    DrawKind::FullScreen,
    DrawKind::Vertices,
    DrawKind::Compute,
];

/// What the header calls a kind of draws.
pub(crate) const fn draw_of(kind: DrawKind) -> FramewrightDraw {
    match kind {
        DrawKind::Custom => FramewrightDraw::Custom,
        DrawKind::Objects(DrawList::Opaque) => FramewrightDraw::Opaque,
        DrawKind::Objects(DrawList::Masked) => FramewrightDraw::Masked,
        DrawKind::Objects(DrawList::Transparent) => FramewrightDraw::Transparent,
        DrawKind::Casters(DrawList::Masked) => FramewrightDraw::MaskedCasters,
        DrawKind::Casters(DrawList::Opaque | DrawList::Transparent) => FramewrightDraw::OpaqueCasters,
        DrawKind::Sky => FramewrightDraw::Sky,
        DrawKind::FullScreen => FramewrightDraw::FullScreen,
        DrawKind::Vertices => FramewrightDraw::Vertices,
        DrawKind::Compute => FramewrightDraw::Compute,
    }
}

/// An interface in Rust, of which all devices could bind each part.
///
/// # Safety
/// The fields are as they say.
pub(crate) unsafe fn interface(given: &FramewrightDrawInterface, at: &str) -> Result<DrawInterface, Problem> {
    // SAFETY: the caller's word.
    let (buffers, attributes, ranges, supplied) = unsafe {
        (
            list(given.vertex_buffers, given.vertex_buffer_count, &format!("{at}.vertex_buffers"))?,
            list(given.attributes, given.attribute_count, &format!("{at}.attributes"))?,
            list(given.push_constants, given.push_constant_count, &format!("{at}.push_constants"))?,
            list(given.supplied, given.supplied_count, &format!("{at}.supplied"))?,
        )
    };
    let attributes = attributes.iter().enumerate().map(|(number, it)| {
        // SAFETY: the caller's word.
        unsafe { attribute(it, &format!("{at}.attributes[{number}]")) }
    });
    let supplied = supplied.iter().enumerate().map(|(number, it)| {
        // SAFETY: the caller's word.
        unsafe { resource(it, &format!("{at}.supplied[{number}]")) }
    });
    let ranges = ranges.iter().map(|it| range(it, at));
    let interface = DrawInterface {
        vertex_buffers: buffers.iter().map(buffer).collect(),
        attributes: attributes.collect::<Result<_, _>>()?,
        topology: if given.has_topology == 0 { None } else { Some(topology(given.topology, at)?) },
        primitive_restart: given.primitive_restart != 0,
        push_constants: ranges.collect::<Result<_, _>>()?,
        supplied: supplied.collect::<Result<_, _>>()?,
    };
    match interface.faults().into_iter().next() {
        Some(fault) => Err(Problem::Misuse(format!("`{at}`: {}", fault.message))),
        None => Ok(interface),
    }
}

fn buffer(given: &FramewrightVertexBuffer) -> VertexBuffer {
    let rate = match given.instances {
        0 => VertexRate::Vertex,
        divisor => VertexRate::Instance { divisor },
    };
    VertexBuffer { stride: given.stride, rate }
}

/// # Safety
/// The name is NULL or a text.
unsafe fn attribute(given: &FramewrightAttribute, at: &str) -> Result<Attribute, Problem> {
    // SAFETY: the caller's word.
    let name = unsafe { text(given.name, &format!("{at}.name"))? };
    let raw = given.format.as_raw();
    let format = VertexFormat::NAMED.iter().find(|(_, format)| format.vulkan() == raw).map(|(_, format)| *format);
    let none = || Problem::Misuse(format!("`{at}`: no vertex attribute has the `format` of the number {raw}"));
    Ok(Attribute {
        name: name.to_owned().into(),
        format: format.ok_or_else(none)?,
        locations: given.locations.max(1),
        location: (given.has_location != 0).then_some(given.location),
        buffer: given.buffer,
        offset: given.offset,
    })
}

/// # Safety
/// The name is NULL or a text.
unsafe fn resource(given: &FramewrightSuppliedResource, at: &str) -> Result<SuppliedResource, Problem> {
    const ALL: [SuppliedKind; 3] = [SuppliedKind::UniformBlock, SuppliedKind::StorageBlock, SuppliedKind::SampledImage];
    // SAFETY: the caller's word.
    let name = unsafe { text(given.name, &format!("{at}.name"))? };
    Ok(SuppliedResource {
        set: given.set,
        binding: given.binding,
        name: name.to_owned().into(),
        kind: *one_of(&ALL, given.kind, &format!("{at}.kind"))?,
        count: given.count.max(1),
    })
}

fn range(given: &vk::PushConstantRange, at: &str) -> Result<PushConstants, Problem> {
    let mut stages = Stages::empty();
    let mut left = given.stage_flags.as_raw();
    for (_, bit, stage) in Stages::of_sets() {
        if left & bit != 0 {
            stages |= stage;
            left &= !bit;
        }
    }
    if left != 0 {
        return Err(Problem::Misuse(format!("`{at}.push_constants` are for vertex and fragment shaders")));
    }
    let both = PushConstants::new(given.offset, given.size);
    Ok(if stages.is_empty() { both } else { both.for_stages(stages) })
}

fn topology(given: vk::PrimitiveTopology, at: &str) -> Result<PrimitiveTopology, Problem> {
    const ALL: [PrimitiveTopology; 6] = [
        PrimitiveTopology::PointList,
        PrimitiveTopology::LineList,
        PrimitiveTopology::LineStrip,
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::TriangleFan,
    ];
    let number = u32::try_from(given.as_raw()).unwrap_or(u32::MAX);
    one_of(&ALL, number, &format!("{at}.topology")).copied()
}
