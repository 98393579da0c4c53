//! The file of a draw source's interfaces.

use super::interface_values::{list, number};
use super::interface_vertices::{self, VertexFields, VertexPlaces};
use super::{
    DrawInterface, DrawInterfaces, DrawKind, DrawPart, InterfaceOf, PushConstants, SuppliedKind, SuppliedResource,
    interface_sets,
};
use crate::base::{Code, Diagnostic, Sources, Span};
use crate::fields;
use crate::frame::DrawList;
use crate::ron::{Leaf, Names, Reader, Tree};
use std::collections::HashMap;
use std::fmt::Write as _;
use std::sync::Arc;

/// The version of the file that this library reads and writes.
const VERSION: i64 = 1;
/// A file of a draw source's interfaces has at most this many bytes.
pub const LARGEST_INTERFACE: usize = 1 << 20;
const FORM: &str = "an interface is `Interface(version: 1, draws: [(of: [Sky], supplied: […]), …], custom: [\"…\"])`";
const KINDS: &str = "a kind of draw is `Objects(Opaque)`, `Objects(Masked)`, `Objects(Transparent)`, `Casters(Opaque)`, \
                     `Casters(Masked)`, `Sky`, `FullScreen`, `Vertices`, `Custom`, `Custom(\"grass\")` or `Compute`";

fields! {
    struct InterfaceFields<'t> as "Interface" {
        #[expect(dead_code, reason = "read before the others, so that a later version is said first")]
        version: Leaf<'t>,
        draws: Leaf<'t>,
        sets: Option<Leaf<'t>>,
        addresses: Option<Leaf<'t>>,
        custom: Option<Leaf<'t>>,
    }
}

fields! {
    struct DrawFields<'t> {
        of: Leaf<'t>,
        vertex_stride: Option<Leaf<'t>>,
        vertex_buffers: Option<Leaf<'t>>,
        attributes: Option<Leaf<'t>>,
        topology: Option<Leaf<'t>>,
        primitive_restart: Option<Leaf<'t>>,
        push_constants: Option<Leaf<'t>>,
        supplied: Option<Leaf<'t>>,
    }
}

fields! {
    struct PushFields<'t> {
        stages: Option<Leaf<'t>>,
        offset: Option<Leaf<'t>>,
        bytes: Leaf<'t>,
    }
}

fields! {
    struct SuppliedFields<'t> {
        name: Leaf<'t>,
        set: Leaf<'t>,
        binding: Leaf<'t>,
        kind: Leaf<'t>,
        count: Option<Leaf<'t>>,
    }
}

impl<'t> DrawFields<'t> {
    fn vertices(&self) -> VertexFields<'t> {
        VertexFields {
            stride: self.vertex_stride,
            buffers: self.vertex_buffers,
            attributes: self.attributes,
            topology: self.topology,
            restart: self.primitive_restart,
        }
    }
}

/// Writes the file. Kinds of draws that bring the same stand in one entry.
pub(super) fn write(interfaces: &DrawInterfaces) -> String {
    let mut entries: Vec<(String, &DrawInterface)> = Vec::new();
    for (kind, interface) in interfaces.all_of_file() {
        match entries.iter_mut().find(|(_, other)| *other == interface) {
            Some((kinds, _)) => *kinds += &format!(", {kind}"),
            None => entries.push((kind.to_string(), interface)),
        }
    }
    let mut text = format!("Interface(\n    version: {VERSION},\n    draws: [\n");
    for (kinds, interface) in entries {
        // Writing to a text can't fail.
        let _ = writeln!(text, "        (\n            of: [{kinds}],");
        interface_vertices::write(interface, &mut text);
        write_pushed(interface, &mut text);
        text += "            supplied: [\n";
        for SuppliedResource { set, binding, name, kind, count } in &interface.supplied {
            let count = if *count == 1 { String::new() } else { format!(", count: {count}") };
            let one = format!("(name: {name:?}, set: {set}, binding: {binding}, kind: {kind:?}{count})");
            let _ = writeln!(text, "                {one},");
        }
        text += "            ],\n        ),\n";
    }
    text += "    ],\n";
    interface_sets::write(interfaces.sets(), &mut text);
    if interfaces.addresses() {
        text += "    addresses: true,\n";
    }
    if let Some(custom) = interfaces.custom_passes() {
        let _ = writeln!(text, "    custom: {custom:?},");
    }
    text + ")\n"
}

fn write_pushed(interface: &DrawInterface, text: &mut String) {
    if interface.push_constants.is_empty() {
        return;
    }
    *text += "            push_constants: [\n";
    for PushConstants { stages, offset, bytes } in &interface.push_constants {
        let stages = interface_sets::stage_words(*stages, PushConstants::new(0, 0).stages);
        let _ = writeln!(text, "                (offset: {offset}, bytes: {bytes}{stages}),");
    }
    *text += "            ],\n";
}

/// Reads the file.
pub(super) fn read(
    sources: &mut Sources,
    shown: &str,
    relative: &str,
    text: String,
) -> Result<DrawInterfaces, Vec<Diagnostic>> {
    if text.len() > LARGEST_INTERFACE {
        let message = format!("`{shown}` has {} bytes; an interface has at most {LARGEST_INTERFACE}", text.len());
        return Err(vec![Diagnostic::nowhere(Code::FILE_TOO_LARGE, message)]);
    }
    let text: Arc<str> = text.into();
    let file = sources.add(shown, relative, text.clone());
    if text.trim().is_empty() {
        return Err(vec![Diagnostic::new(Code::FILE_EMPTY, Span::new(file, 0, 0), "the file is empty").help(FORM)]);
    }
    let mut reader = Reader::default();
    let tree = Tree::read(file, text, &mut reader.errors);
    let read = tree.as_ref().and_then(|tree| whole(&mut reader, tree.root()));
    let mut mistakes = reader.errors;
    match read {
        Some(read) if mistakes.is_empty() => Ok(read),
        _ => {
            mistakes.sort_by_key(|mistake| mistake.labels.first().map_or(0, |label| label.span.start));
            Err(mistakes)
        }
    }
}

fn whole(reader: &mut Reader, all: Leaf<'_>) -> Option<DrawInterfaces> {
    if let Some(version) = all.field("version") {
        let number = reader.integer(version)?;
        if number != VERSION {
            reader.errors.clear();
            let message = format!("this interface is written in version {number}");
            reader.wrong(Code::VERSION, version, message, &format!("this program reads version {VERSION}"));
            return None;
        }
    }
    let before = reader.errors.len();
    let fields: Option<InterfaceFields<'_>> = reader.read(all, "the interface");
    reader.errors.iter_mut().skip(before).for_each(|error| _ = error.help.get_or_insert_with(|| FORM.to_owned()));
    let fields = fields?;
    let mut interfaces = DrawInterfaces::default();
    let mut seen = HashMap::new();
    for entry in reader.list(fields.draws, "the draws")? {
        let Some(fields) = reader.read::<DrawFields<'_>>(entry, "an entry of `draws`") else { continue };
        let kinds = kinds(reader, fields.of, &mut seen);
        let (vertices, pushed) = (fields.vertices(), fields.push_constants);
        let interface = interface(reader, fields);
        let told = vertices.told(&interface);
        let pushed = pushed.filter(|_| told.is_none() && !interface.push_constants.is_empty());
        for (kind, leaf, what, help) in [
            (DrawKind::Compute, told, "compute passes have no vertices", "give `Compute` an entry of its own"),
            (
                DrawKind::FullScreen,
                told,
                "full-screen passes have no vertices of a draw source",
                "give `FullScreen` an entry of its own",
            ),
            (
                DrawKind::Vertices,
                told,
                "draws of a pass's own vertices have none of a draw source",
                "give `Vertices` an entry of its own",
            ),
            (
                DrawKind::Compute,
                pushed,
                "compute passes have no push constants of a draw source",
                "give `Compute` an entry of its own",
            ),
            (
                DrawKind::Vertices,
                pushed,
                "draws of a pass's own vertices have no push constants of a draw source",
                "give `Vertices` an entry of its own",
            ),
        ] {
            if let Some(leaf) = leaf.filter(|_| kinds.contains(&InterfaceOf::Kind(kind))) {
                reader.wrong(Code::INTERFACE_FILE, leaf, what, help);
            }
        }
        interfaces = kinds.into_iter().fold(interfaces, |all, of| match of {
            InterfaceOf::Kind(kind) => all.with(kind, interface.clone()),
            InterfaceOf::Custom(name) => all.with_custom(name, interface.clone()),
        });
    }
    if let Some(sets) = fields.sets {
        interfaces = interface_sets::read(reader, sets, interfaces)?;
    }
    if fields.addresses.and_then(|leaf| reader.truth(leaf)).unwrap_or(false) {
        interfaces = interfaces.with_addresses();
    }
    let Some(custom) = fields.custom else { return Some(interfaces) };
    let mut names = Names::new("custom pass", Code::CUSTOM_UNKNOWN);
    for leaf in reader.list(custom, "the custom passes")? {
        let name = reader.outside_name(leaf, "a custom pass");
        names.give(reader, name);
    }
    let interfaces = interfaces.with_custom_passes(names.in_order());
    for (of, place) in &seen {
        let InterfaceOf::Custom(name) = of else { continue };
        if interfaces.custom_passes().is_some_and(|known| !known.contains(name)) {
            let message = format!("no custom pass is called `{name}`");
            reader.report(Diagnostic::new(Code::INTERFACE_FILE, *place, message).label(custom.span(), "these are"));
        }
    }
    Some(interfaces)
}

/// The kinds of draws of an entry. `seen`: where they stand.
fn kinds(reader: &mut Reader, leaf: Leaf<'_>, seen: &mut HashMap<InterfaceOf, Span>) -> Vec<InterfaceOf> {
    let mut kinds = Vec::new();
    let leaves = reader.list(leaf, "kinds of draws").unwrap_or_default();
    if leaves.is_empty() {
        reader.wrong(Code::INTERFACE_FILE, leaf, "an entry of `draws` is for one kind of draw at least", KINDS);
    }
    for leaf in leaves {
        let Some(kind) = kind(reader, leaf) else { continue };
        match seen.get(&kind) {
            Some(first) => reader.report(
                Diagnostic::new(Code::LISTED_TWICE, leaf.span(), format!("`{kind}` stands here twice"))
                    .remark("again here")
                    .label(*first, "first here"),
            ),
            None => {
                seen.insert(kind.clone(), leaf.span());
                kinds.push(kind);
            }
        }
    }
    kinds
}

fn kind(reader: &mut Reader, leaf: Leaf<'_>) -> Option<InterfaceOf> {
    const WORDS: [&str; 7] = ["Objects", "Casters", "Sky", "FullScreen", "Vertices", "Custom", "Compute"];
    let (word, rest) = reader.word(leaf, "a kind of draw", &WORDS, KINDS)?;
    let mut list = |lists: &[(&'static str, DrawList)], form| {
        let [list]: [Leaf<'_>; 1] = reader.inside(leaf, rest, form)?;
        reader.choice(list, "a draw list", lists)
    };
    match word {
        "Objects" => {
            return list(&DrawList::NAMED, "Objects(Opaque)").map(|list| InterfaceOf::Kind(DrawKind::Objects(list)));
        }
        "Casters" => {
            return list(&DrawList::CASTERS, "Casters(Opaque)").map(|list| InterfaceOf::Kind(DrawKind::Casters(list)));
        }
        "Custom" if rest.is_some() => {
            let [name]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Custom(\"grass\")")?;
            return reader.outside_name(name, "a custom pass").map(|name| InterfaceOf::Custom(name.text));
        }
        _ => reader.bare(word, rest)?,
    }
    Some(InterfaceOf::Kind(match word {
        "Sky" => DrawKind::Sky,
        "FullScreen" => DrawKind::FullScreen,
        "Vertices" => DrawKind::Vertices,
        "Compute" => DrawKind::Compute,
        _ => DrawKind::Custom,
    }))
}

/// An interface. After a mistake it is something like it.
fn interface(reader: &mut Reader, fields: DrawFields<'_>) -> DrawInterface {
    let before = reader.errors.len();
    let mut interface = DrawInterface::default();
    let vertices = interface_vertices::read(reader, fields.vertices(), &mut interface);
    let mut places = Places { vertices, pushed: Vec::new(), supplied: Vec::new() };
    for leaf in list(reader, fields.push_constants, "push constants") {
        interface.push_constants.extend(pushed(reader, leaf));
        places.pushed.push(leaf);
    }
    for leaf in list(reader, fields.supplied, "resources") {
        interface.supplied.extend(supplied(reader, leaf));
        places.supplied.push(leaf);
    }
    // Numbers of parts are those of leaves only if all were read.
    if reader.errors.len() > before {
        return interface;
    }
    for fault in interface.faults() {
        let Some(leaf) = places.of(fault.at) else { continue };
        let mut wrong = Diagnostic::new(Code::INTERFACE_FILE, leaf.span(), fault.message);
        if let Some(first) = fault.first.and_then(|first| places.of(first)) {
            wrong = wrong.remark("again here").label(first.span(), "first here");
        }
        reader.report(wrong);
    }
    interface
}

/// Where the parts of an interface stand.
struct Places<'t> {
    vertices: VertexPlaces<'t>,
    pushed: Vec<Leaf<'t>>,
    supplied: Vec<Leaf<'t>>,
}

impl<'t> Places<'t> {
    fn of(&self, part: DrawPart) -> Option<Leaf<'t>> {
        match part {
            DrawPart::VertexBuffer(_) | DrawPart::Attribute(_) | DrawPart::Restart => self.vertices.of(part),
            DrawPart::PushConstants(number) => self.pushed.get(number).copied(),
            DrawPart::Supplied(number) => self.supplied.get(number).copied(),
        }
    }
}

fn pushed(reader: &mut Reader, leaf: Leaf<'_>) -> Option<PushConstants> {
    let fields: PushFields<'_> = reader.read(leaf, "push constants")?;
    let stages = match fields.stages {
        None => Some(PushConstants::new(0, 0).stages),
        Some(leaf) => interface_sets::stages(reader, leaf),
    };
    let offset = fields.offset.map_or(Some(0), |leaf| number(reader, leaf, "the offset"));
    let bytes = number(reader, fields.bytes, "the number of bytes");
    Some(PushConstants { stages: stages?, offset: offset?, bytes: bytes? })
}

fn supplied(reader: &mut Reader, leaf: Leaf<'_>) -> Option<SuppliedResource> {
    let fields: SuppliedFields<'_> = reader.read(leaf, "a resource")?;
    let name = reader.reference(fields.name, "a resource");
    let set = number(reader, fields.set, "the set");
    let binding = number(reader, fields.binding, "the binding");
    let kind = reader.choice(fields.kind, "a kind of resource", &SuppliedKind::NAMED);
    let count = fields.count.map_or(Some(1), |leaf| number(reader, leaf, "the count"));
    Some(SuppliedResource {
        set: set?,
        binding: binding?,
        name: name?.text.to_string().into(),
        kind: kind?,
        count: count?,
    })
}
