//! The JSON form of a Plan, taken apart.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// An image or buffer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Named(&'static str, u64);

impl Named {
    /// An entry of `images` or `buffers`.
    pub(crate) fn of(kind: &'static str, entry: &Value) -> Named {
        Named(kind, number(&entry["id"]))
    }

    /// The image that something names.
    pub(crate) fn image(by: &Value) -> Named {
        Named("image", number(&by["image"]))
    }

    /// The buffer that something names.
    pub(crate) fn buffer(by: &Value) -> Named {
        Named("buffer", number(&by["buffer"]))
    }
}

pub(crate) fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], |list| list)
}

pub(crate) fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is no number"))
}

pub(crate) fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_else(|| panic!("{value} is no text"))
}

pub(crate) fn flags(value: &Value) -> BTreeSet<&str> {
    text(value).split(" | ").filter(|flag| !flag.is_empty()).collect()
}

pub(crate) fn has(value: &Value, field: &str) -> bool {
    value.get(field).is_some()
}

/// All image barriers of a step, in the order in which they happen.
pub(crate) fn barriers(step: &Value) -> impl Iterator<Item = &Value> {
    list(&step["image_barriers"]).iter().chain(list(&step["releases"]))
}

/// The passes of a step that aren't transfers.
pub(crate) fn passes(step: &Value) -> impl Iterator<Item = &Value> {
    let work = &step["work"];
    let alone = ["dispatch", "custom"].into_iter().filter_map(|kind| work.get(kind));
    list(&work["render"]["passes"]).iter().chain(alone)
}

/// Images, with their parts, and buffers that the work of a step touches.
pub(crate) fn accesses(step: &Value) -> Vec<(Named, Option<&Value>)> {
    let (work, mut all) = (&step["work"], Vec::new());
    let scope = &work["render"];
    let attachments = list(&scope["attachments"]).iter();
    let attachments = attachments.filter(|it| !it.is_null()).flat_map(|it| [it, &it["resolve"]]);
    let by_passes = passes(step).flat_map(|pass| list(&pass["accesses"]));
    for it in attachments.chain(by_passes).filter(|it| !it.is_null()) {
        all.push((Named::image(it), Some(&it["range"])));
    }
    all.extend(passes(step).flat_map(|pass| list(&pass["buffers"])).map(|it| (Named::buffer(it), None)));
    for transfer in ["resolve", "copy", "blit", "fill"].iter().filter_map(|kind| work.get(kind)) {
        for side in ["source", "target"].iter().filter_map(|side| transfer.get(side)) {
            all.extend(side.get("image").map(|it| (Named::image(it), Some(&it["range"]))));
            all.extend(side.get("buffer").map(|it| (Named::buffer(it), None)));
        }
    }
    all
}

pub(crate) fn touched(step: &Value) -> Vec<Named> {
    accesses(step).into_iter().map(|it| it.0).collect()
}

/// Whether two parts of an image, or of a buffer, which has none, have something in common.
pub(crate) fn meet(one: Option<&Value>, other: Option<&Value>) -> bool {
    let (Some(one), Some(other)) = (one, other) else { return true };
    let overlap = |first: &str, count: &str| {
        let [[from, to], [start, end]] =
            [one, other].map(|range| [number(&range[first]), number(&range[first]) + number(&range[count])]);
        from < end && start < to
    };
    let planes = !flags(&one["aspects"]).is_disjoint(&flags(&other["aspects"]));
    planes && overlap("base_mip", "mips") && overlap("base_layer", "layers")
}

/// The images that a pass accesses so.
pub(crate) fn images(pass: &Value, access: &str) -> BTreeSet<u64> {
    let so = list(&pass["accesses"]).iter().filter(|it| flags(&it["accesses"]).contains(access));
    so.map(|it| number(&it["image"])).collect()
}

/// Something that shares memory.
#[derive(Debug)]
pub(crate) struct Transient {
    pub(crate) what: Named,
    pub(crate) lifetime: [u64; 2],
    heap: u64,
    from: u64,
    to: u64,
}

impl Transient {
    pub(crate) fn shares_bytes(&self, other: &Transient) -> bool {
        self.heap == other.heap && self.from < other.to && other.from < self.to
    }
}

pub(crate) fn transient(plan: &Value) -> Vec<Transient> {
    let images = list(&plan["images"]).iter().map(|it| ("image", it));
    let all = images.chain(list(&plan["buffers"]).iter().map(|it| ("buffer", it)));
    let placed = all.filter_map(|(kind, it)| it["role"].get("transient").map(|place| (Named::of(kind, it), place)));
    let placed = placed.map(|(what, place)| Transient {
        what,
        lifetime: [&place["lifetime"][0], &place["lifetime"][1]].map(number),
        heap: number(&place["heap"]),
        from: number(&place["offset"]),
        to: number(&place["offset"]) + number(&place["bytes"]),
    });
    placed.collect()
}

/// Something that is said of each plane, mip level and layer of an image.
#[derive(Debug)]
pub(crate) struct Cells(BTreeMap<(&'static str, u64, u64), String>);

impl Cells {
    pub(crate) fn new(image: &Value, is: String) -> Cells {
        let faces = if image["shape"] == "Cube" { 6 } else { 1 };
        let planes: &[&str] = match text(&image["format"]) {
            format if format.starts_with('D') && format.contains("_S8") => &["DEPTH", "STENCIL"],
            format if format.starts_with('D') => &["DEPTH"],
            _ => &["COLOR"],
        };
        let cells = planes.iter().flat_map(|plane| {
            let mips = 0..number(&image["mips"]);
            mips.flat_map(move |mip| (0..faces * number(&image["layers"])).map(move |layer| (*plane, mip, layer)))
        });
        Cells(cells.map(|cell| (cell, is.clone())).collect())
    }

    /// The states of a part's cells.
    pub(crate) fn of(&mut self, range: &Value) -> impl Iterator<Item = &mut String> {
        let planes = flags(&range["aspects"]);
        let [mip, mips, layer, layers] =
            ["base_mip", "mips", "base_layer", "layers"].map(|field| number(&range[field]));
        let within = move |(plane, of_mip, of_layer): &(&'static str, u64, u64)| {
            planes.contains(plane) && (mip..mip + mips).contains(of_mip) && (layer..layer + layers).contains(of_layer)
        };
        self.0.iter_mut().filter(move |(cell, _)| within(cell)).map(|(_, is)| is)
    }

    pub(crate) fn all(&self) -> impl Iterator<Item = &String> {
        self.0.values()
    }
}
