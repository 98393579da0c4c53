//! Vertex buffers and attributes in the file of a draw source's interfaces.

use super::interface_values::{list, number};
use super::{Attribute, DrawInterface, DrawPart, VertexBuffer, VertexRate};
use crate::base::Code;
use crate::fields;
use crate::ron::{Leaf, Reader};
use crate::vulkan::{PrimitiveTopology, VertexFormat};
use std::fmt::Write as _;

fields! {
    struct BufferFields<'t> {
        stride: Leaf<'t>,
        rate: Option<Leaf<'t>>,
    }
}

fields! {
    struct AttributeFields<'t> {
        name: Leaf<'t>,
        components: Option<Leaf<'t>>,
        format: Option<Leaf<'t>>,
        locations: Option<Leaf<'t>>,
        location: Option<Leaf<'t>>,
        buffer: Option<Leaf<'t>>,
        offset: Leaf<'t>,
    }
}

const FORMATS: &str = "a format is Vulkan's, as `R32G32B32_SFLOAT`, `R8G8B8A8_UNORM` or `R16G16_SINT`";
const RATES: &str = "a rate is `Vertex`, `Instance` or `Instance(4)`";

/// The fields of an entry that tell its vertices.
#[derive(Clone, Copy)]
pub(super) struct VertexFields<'t> {
    /// Short for one buffer of vertices; 0: there is none.
    pub(super) stride: Option<Leaf<'t>>,
    pub(super) buffers: Option<Leaf<'t>>,
    pub(super) attributes: Option<Leaf<'t>>,
    pub(super) topology: Option<Leaf<'t>>,
    pub(super) restart: Option<Leaf<'t>>,
}

impl<'t> VertexFields<'t> {
    /// Where an interface tells of vertices; `None`: it has none.
    pub(super) fn told(&self, interface: &DrawInterface) -> Option<Leaf<'t>> {
        let attributes = self.attributes.filter(|_| !interface.attributes.is_empty());
        let buffers = self.stride.or(self.buffers).filter(|_| !interface.vertex_buffers.is_empty());
        attributes.or(buffers).or(self.topology).or(self.restart)
    }
}

/// Where buffers and attributes stand.
#[derive(Default)]
pub(super) struct VertexPlaces<'t> {
    buffers: Vec<Leaf<'t>>,
    attributes: Vec<Leaf<'t>>,
    restart: Option<Leaf<'t>>,
}

impl<'t> VertexPlaces<'t> {
    pub(super) fn of(&self, part: DrawPart) -> Option<Leaf<'t>> {
        match part {
            DrawPart::VertexBuffer(number) => self.buffers.get(number).copied(),
            DrawPart::Attribute(number) => self.attributes.get(number).copied(),
            DrawPart::Restart => self.restart,
            DrawPart::PushConstants(_) | DrawPart::Supplied(_) => None,
        }
    }
}

/// Writes them.
pub(super) fn write(interface: &DrawInterface, text: &mut String) {
    // Writing to a text can't fail.
    match &interface.vertex_buffers[..] {
        [] => *text += "            vertex_stride: 0,\n",
        [VertexBuffer { stride, rate: VertexRate::Vertex }] => {
            let _ = writeln!(text, "            vertex_stride: {stride},");
        }
        several => {
            *text += "            vertex_buffers: [\n";
            for VertexBuffer { stride, rate } in several {
                let rate = match rate {
                    VertexRate::Vertex => String::new(),
                    VertexRate::Instance { divisor: 1 } => ", rate: Instance".to_owned(),
                    VertexRate::Instance { divisor } => format!(", rate: Instance({divisor})"),
                };
                let _ = writeln!(text, "                (stride: {stride}{rate}),");
            }
            *text += "            ],\n";
        }
    }
    *text += "            attributes: [\n";
    for Attribute { name, format, locations, location, buffer, offset } in &interface.attributes {
        let _ = write!(text, "                (name: {name:?}, ");
        let _ = match format.is_floats() {
            true => write!(text, "components: {}", format.components()),
            false => write!(text, "format: {format}"),
        };
        if *locations != 1 {
            let _ = write!(text, ", locations: {locations}");
        }
        if let Some(location) = location {
            let _ = write!(text, ", location: {location}");
        }
        if *buffer != 0 {
            let _ = write!(text, ", buffer: {buffer}");
        }
        let _ = writeln!(text, ", offset: {offset}),");
    }
    *text += "            ],\n";
    let named = interface.topology.and_then(|it| PrimitiveTopology::NAMED.iter().find(|(_, known)| *known == it));
    if let Some((word, _)) = named {
        let _ = writeln!(text, "            topology: {word},");
    }
    if interface.primitive_restart {
        *text += "            primitive_restart: true,\n";
    }
}

/// Reads them into `interface`, and says where they stand.
pub(super) fn read<'t>(
    reader: &mut Reader,
    fields: VertexFields<'t>,
    interface: &mut DrawInterface,
) -> VertexPlaces<'t> {
    let mut places = VertexPlaces::default();
    if let (Some(stride), Some(_)) = (fields.stride, fields.buffers) {
        let message = "`vertex_stride` is short for one vertex buffer, and `vertex_buffers` tells them all";
        reader.wrong(Code::INTERFACE_FILE, stride, message, "leave `vertex_stride` out");
    } else if let Some(leaf) = fields.stride
        && let Some(stride) = number(reader, leaf, "the stride").filter(|stride| *stride > 0)
    {
        interface.vertex_buffers.push(VertexBuffer::of_vertices(stride));
        places.buffers.push(leaf);
    }
    for leaf in list(reader, fields.buffers, "vertex buffers") {
        interface.vertex_buffers.extend(buffer(reader, leaf));
        places.buffers.push(leaf);
    }
    for leaf in list(reader, fields.attributes, "attributes") {
        interface.attributes.extend(attribute(reader, leaf));
        places.attributes.push(leaf);
    }
    interface.topology = fields.topology.and_then(|leaf| reader.choice(leaf, "a topology", PrimitiveTopology::NAMED));
    places.restart = fields.restart;
    interface.primitive_restart = fields.restart.and_then(|leaf| reader.truth(leaf)).unwrap_or(false);
    places
}

fn buffer(reader: &mut Reader, leaf: Leaf<'_>) -> Option<VertexBuffer> {
    let fields: BufferFields<'_> = reader.read(leaf, "a vertex buffer")?;
    let stride = number(reader, fields.stride, "the stride");
    let rate = fields.rate.map_or(Some(VertexRate::Vertex), |leaf| rate(reader, leaf));
    Some(VertexBuffer { stride: stride?, rate: rate? })
}

fn rate(reader: &mut Reader, leaf: Leaf<'_>) -> Option<VertexRate> {
    let (word, rest) = reader.word(leaf, "a rate", &["Vertex", "Instance"], RATES)?;
    Some(match (word, rest) {
        ("Instance", None) => VertexRate::Instance { divisor: 1 },
        ("Instance", rest) => {
            let [divisor]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Instance(4)")?;
            VertexRate::Instance { divisor: number(reader, divisor, "the number of instances")? }
        }
        (_, rest) => {
            reader.bare("Vertex", rest)?;
            VertexRate::Vertex
        }
    })
}

fn attribute(reader: &mut Reader, leaf: Leaf<'_>) -> Option<Attribute> {
    let fields: AttributeFields<'_> = reader.read(leaf, "an attribute")?;
    let name = reader.reference(fields.name, "an attribute");
    let format = format(reader, leaf, &fields);
    let mut count = |leaf: Option<Leaf<'_>>, usual, what| leaf.map_or(Some(usual), |leaf| number(reader, leaf, what));
    let locations = count(fields.locations, 1, "the number of locations");
    let location = count(fields.location, 0, "the location").map(|number| fields.location.map(|_| number));
    let buffer = count(fields.buffer, 0, "the vertex buffer");
    let offset = number(reader, fields.offset, "the offset");
    Some(Attribute {
        name: name?.text.to_string().into(),
        format: format?,
        locations: locations?,
        location: location?,
        buffer: buffer?,
        offset: offset?,
    })
}

/// The format, or 32-bit floats by the number of components.
fn format(reader: &mut Reader, leaf: Leaf<'_>, fields: &AttributeFields<'_>) -> Option<VertexFormat> {
    match (fields.components, fields.format) {
        (None, Some(format)) => {
            let words: Vec<&'static str> = VertexFormat::NAMED.iter().map(|(word, _)| *word).collect();
            let (word, rest) = reader.word(format, "a format of vertices", &words, FORMATS)?;
            reader.bare(word, rest)?;
            VertexFormat::NAMED.iter().find(|(known, _)| *known == word).map(|(_, format)| *format)
        }
        (Some(components), None) => {
            let count = number(reader, components, "the number of components")?;
            let floats = VertexFormat::floats(count);
            if floats.is_none() {
                let name = reader.reference(fields.name, "an attribute")?.text;
                let message = format!("the vertex attribute `{name}` has {count} components; it can have 1 to 4");
                reader.wrong(Code::INTERFACE_FILE, leaf, message, "");
            }
            floats
        }
        (Some(components), Some(_)) => {
            let message = "`components` is short for a format of 32-bit floats, and `format` tells another one";
            reader.wrong(Code::INTERFACE_FILE, components, message, "leave `components` out");
            None
        }
        (None, None) => {
            let message = "an attribute lacks its format";
            reader.wrong(
                Code::INTERFACE_FILE,
                leaf,
                message,
                "add `format: R8G8B8A8_UNORM`, or `components: 3` for 32-bit floats",
            );
            None
        }
    }
}
