//! Lists of a Plan beside its steps: views, images, buffers, outputs, notes and totals.

use super::outline::Outline;
use super::words::{bytes, cause, count, held, place, samples, size};
use crate::frame::{Allowances, ColorSpace, EyeForm, Jitter};
use crate::plan::names::ShownText;
use crate::plan::{
    Buffer, ChosenFormat, EntryKind, FirstContents, Image, Note, Output, Plan, Resource, Role, Totals, View, ViewEye,
};
use crate::vulkan::{Encoding, Format, name_of};

pub(super) fn view(view: &View) -> String {
    let [width, height] = view.extent;
    let camera =
        view.camera.as_ref().map_or_else(|| "default camera".to_owned(), |it| format!("camera `{}`", ShownText(it)));
    let Allowances { msaa, hdr, scale } = view.allows;
    let not = [(msaa, "MSAA"), (hdr, "HDR"), (scale, "scaling")];
    let not: Vec<&str> = not.iter().filter(|(allowed, _)| !allowed).map(|(_, what)| *what).collect();
    let not = if not.is_empty() { String::new() } else { format!(", without {}", not.join(", ")) };
    let eye = view.eye.map_or_else(String::new, |ViewEye { eye, .. }| format!(", {} eye", eye.name()));
    let jitter = view.jitter.as_ref().map_or_else(String::new, jitter);
    format!("`{}` {width}×{height}, {camera}{eye}{not}{jitter}", ShownText(&view.name))
}

fn jitter(jitter: &Jitter) -> String {
    let [width, height] = jitter.extent;
    format!(", shifted in turn by {} parts of a texel of {width}×{height}", jitter.offsets.len())
}

pub(super) fn buffer(plan: &Plan, buffer: &Buffer) -> String {
    let next = |at: u32| plan.buffers.get(at as usize).map_or("", |buffer| &buffer.name);
    let role = role(&buffer.role, &buffer.name, None, next);
    format!("`{}` {}{role}{}", ShownText(&buffer.name), bytes(buffer.bytes), cause(&buffer.cause))
}

/// Where the memory of the image or buffer `name` comes from; `format`: that of an image.
fn role<'p>(role: &Role, name: &str, format: Option<Format>, next: impl Fn(u32) -> &'p str) -> String {
    match role {
        Role::Transient(placement) => {
            let [first, last] = placement.lifetime;
            let steps =
                if first == last { format!("step {}", first.0) } else { format!("steps {}–{}", first.0, last.0) };
            let [taken, offset] = [placement.bytes, placement.offset].map(bytes);
            format!(": {taken} at {offset} in heap {}, {steps}", placement.heap)
        }
        Role::Persistent { initial: FirstContents::File(file), .. } => {
            let decoded = match file.color_space {
                ColorSpace::Srgb => "sRGB",
                ColorSpace::Linear => "linear",
            };
            format!(": the file `{}` ({decoded}), only read", ShownText(&file.path))
        }
        Role::Persistent { becomes, initial: FirstContents::Value(initial), .. } => {
            let next = next(*becomes);
            let becomes = if next == name { "stays".to_owned() } else { format!("becomes `{}`", ShownText(next)) };
            format!(
                ": persistent, {becomes} in the next frame, at first {}",
                held(initial, format.map(|format| (format, format.aspects())))
            )
        }
        Role::External { owner: None, .. } => ": external".to_owned(),
        Role::External { owner: Some(owner), .. } => format!(": external, {} has it between frames", owner.words()),
    }
}

pub(super) fn image(plan: &Plan, image: &Image) -> String {
    let whole = image.allocated.map_or_else(String::new, |[width, height]| format!(" of {width}×{height}"));
    let mut text = format!("`{}` {} {}{whole}", ShownText(&image.name), image.format, size(image.extent));
    for (count, word) in [(image.mips, "mips"), (image.layers, "layers")] {
        if count > 1 {
            text += &format!(", {count} {word}");
        }
    }
    text += &format!(", {}", samples(image.samples));
    match image.eyes {
        Some(EyeForm::Layers) => text += ", a layer for each eye",
        Some(EyeForm::Halves) => text += ", both eyes' side by side",
        None => {}
    }
    if image.rotation.turns() {
        text += &format!(", rotated by {}°", image.rotation.degrees());
    }
    let next = |at: u32| plan.images.get(at as usize).map_or("", |image| &image.name);
    text += &role(&image.role, &image.name, Some(image.format), next);
    text + &cause(&image.cause)
}

pub(super) fn chosen(chosen: &ChosenFormat) -> Outline {
    let ChosenFormat { because, usual, more_bytes } = chosen;
    let amount = bytes(more_bytes.unsigned_abs());
    let comes_to = match more_bytes {
        0 => "as many bytes as".to_owned(),
        1.. => format!("{amount} more than"),
        ..0 => format!("{amount} fewer than"),
    };
    Outline::detail(format!("{}: {comes_to} in {usual}", ShownText(because)))
}

pub(super) fn output(plan: &Plan, output: &Output) -> String {
    let resource = output.resource;
    let name = ShownText(plan.resource_name(resource));
    let role = match resource {
        Resource::Image(id) => plan.images.get(id.0 as usize).map(|image| &image.role),
        Resource::Buffer(id) => plan.buffers.get(id.0 as usize).map(|buffer| &buffer.role),
    };
    let Some([_, after]) = role.and_then(Role::states) else { return format!("`{name}`") };
    let [layout, stages, accesses] = [name_of(&after.layout), name_of(&after.stages), name_of(&after.accesses)];
    let encoded = output.encoding.map_or_else(String::new, |encoding| {
        let by = output.encoded.as_deref().unwrap_or("");
        match encoding {
            Encoding::Srgb => format!("; sRGB, encoded {}", ShownText(by)),
            Encoding::Hdr10 => format!("; HDR10, encoded {}", ShownText(by)),
            Encoding::Linear => "; linear light, not encoded".to_owned(),
            Encoding::Unorm => "; shares from 0 to 1, not encoded".to_owned(),
        }
    });
    match resource {
        Resource::Image(_) => format!("`{name}` in {layout}, last {accesses} in {stages}{encoded}"),
        Resource::Buffer(_) => format!("`{name}`, last {accesses} in {stages}"),
    }
}

pub(super) fn note(note: &Note) -> String {
    format!("{} `{}`: {}{}", name_of(&note.stage()), ShownText(&note.subject), ShownText(&note.text), place(&note.at))
}

pub(super) fn totals(totals: &Totals) -> Outline {
    let Totals { transient_bytes, placed_bytes, live_peak_bytes, kept_bytes, .. } = *totals;
    let ratio = if live_peak_bytes == 0 {
        String::new()
    } else {
        format!(" ({:.3} × live peak {})", placed_bytes as f64 / live_peak_bytes as f64, bytes(live_peak_bytes))
    };
    let work = format!(
        "{} ({} inserted) in {}, {} ({} folded), {}",
        count(totals.passes.saturating_add(totals.inserted_passes), "pass", "passes"),
        totals.inserted_passes,
        count(totals.scopes, "scope", "scopes"),
        count(totals.resolves, "resolve", "resolves"),
        totals.folded_resolves,
        count(totals.copies, "copy", "copies"),
    );
    let barriers = format!(
        "{} and {} in {}",
        count(totals.image_barriers, "image barrier", "image barriers"),
        count(totals.memory_barriers, "memory barrier", "memory barriers"),
        count(totals.barrier_calls, "call", "calls"),
    );
    let [transient, placed, kept] = [transient_bytes, placed_bytes, kept_bytes].map(bytes);
    let memory = format!("transient {transient} placed in {placed}{ratio}, kept {kept}");
    Outline::of(EntryKind::Total, EntryKind::Total.heading(), [work, barriers, memory].map(Outline::detail).into())
}
