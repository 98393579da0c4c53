//! Sentences of docs/plan-format.md about Plans, held against the JSON form of real Plans. Nothing but that form is looked at,
//! as another program would.

mod json;

use crate::testing::pipelines::{INPUTS, shipped};
use crate::testing::plans::shipped as shipped_device;
use crate::testing::table::Table;
use framewright_graph::base::{self, Root, Sources};
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{BufferDescriptor, ImageDescriptor, MemoryNeeds, MemoryProvider, Profile, Queues};
use framewright_graph::expand::expand;
use framewright_graph::frame::Draw;
use framewright_graph::language::{self, PipelineFiles};
use framewright_graph::shader::{BindingKind, ShaderInterfaces, Variant};
use framewright_graph::vulkan::{Dimension, ImageShape, Sharing};
use json::{
    Cells, Named, accesses, barriers, flags, has, images, list, meet, number, passes, text, touched, transient,
};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// Memory needs that this test can tell by itself: a byte for each sample of each texel of each mip level, or of a buffer.
struct Ruler;

impl Ruler {
    fn of([width, height, depth]: [u64; 3], [mips, layers, samples]: [u64; 3]) -> u64 {
        let level = |mip: u64| [width, height, depth].iter().map(|side| (side >> mip).max(1)).product::<u64>();
        (0..mips).map(level).sum::<u64>() * layers * samples
    }
}

impl MemoryProvider for Ruler {
    fn exact(&self) -> bool {
        true
    }

    fn image(&mut self, image: &ImageDescriptor) -> MemoryNeeds {
        let counts = [image.mips, image.layers, image.samples].map(u64::from);
        MemoryNeeds { bytes: Ruler::of(image.extent.map(u64::from), counts), alignment: 1, type_bits: 1 }
    }

    fn buffer(&mut self, buffer: &BufferDescriptor) -> MemoryNeeds {
        MemoryNeeds { bytes: buffer.bytes, alignment: 1, type_bits: 1 }
    }
}

/// Every shipped pipeline, and one of what none of them has, on a device of one queue and on one of three, in two orders.
fn plans() -> Vec<(String, Value)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/pipelines");
    let files = std::fs::read_dir(&folder).expect("pipelines are shipped");
    let names = files.map(|file| file.expect("the folder can be listed").file_name().to_string_lossy().into_owned());
    let shipped = names.filter(|name| name.ends_with(".ron")).map(|name| (name.clone(), shipped(&name)));
    let one = Profile { local_read: true, ..shipped_device("lavapipe") };
    let queues = Queues { compute: true, transfer: true, sharing: Sharing::Exclusive, wait_bytes: 0 };
    let devices = [("one queue", one.clone()), ("three queues", Profile { queues, ..one })];
    let cases = devices.iter().flat_map(|device| [Order::Default, Order::File].map(|order| (device, order)));
    let mut plans = Vec::new();
    for (file, said) in shipped.chain([("more.ron".to_owned(), include_str!("plan_format/more.ron").to_owned())]) {
        let mut sources = Sources::default();
        let mut files = PipelineFiles::beside(Root::new(folder.clone()), &file, &[]);
        let pipeline = language::read_with(&mut sources, &mut files, &file, &file, said);
        let sources = Arc::new(sources);
        let pipeline = pipeline.unwrap_or_else(|errors| panic!("{}", base::render(&sources, &errors)));
        let frame = expand(&pipeline, sources.clone(), &INPUTS, &mut Table);
        let frame = frame.unwrap_or_else(|errors| panic!("{}", base::render(&sources, &errors)));
        for ((device, profile), order) in cases.clone() {
            let plan = compile(&frame, profile, &mut Ruler, &Options { order, ..Options::default() });
            let plan = plan.unwrap_or_else(|wrong| panic!("{file}: {wrong:?}")).to_json().expect("it has a JSON form");
            plans.push((format!("{file}, {device}, {order:?}"), serde_json::from_str(&plan).expect("JSON")));
        }
    }
    plans
}

/// "`lifetime` (first and last step whose work touches it …). Its first barrier may stand before an earlier step than the
/// first one, and before no step of the lifetime of what had the bytes before".
#[test]
fn a_lifetime_reaches_from_the_first_to_the_last_step_whose_work_touches_it_and_barriers_respect_it() {
    let mut earlier = 0;
    for (name, plan) in plans() {
        let transient = transient(&plan);
        for own in &transient {
            let touching: Vec<u64> = (0..)
                .zip(list(&plan["steps"]))
                .filter(|(_, step)| touched(step).contains(&own.what))
                .map(|it| it.0)
                .collect();
            assert_eq!([touching[0], touching[touching.len() - 1]], own.lifetime, "{name}: {:?}", own.what);
            let names_it = |step: &&Value| barriers(step).any(|barrier| Named::image(barrier) == own.what);
            let first = (0..).zip(list(&plan["steps"])).find(|(_, step)| names_it(step)).map(|it| it.0);
            let Some(first) = first.filter(|first| *first < own.lifetime[0]) else { continue };
            earlier += 1;
            let before = transient.iter().filter(|it| it.shares_bytes(own) && it.lifetime[1] < own.lifetime[0]);
            for other in before {
                assert!(other.lifetime[1] < first, "{name}: {:?} before step {first}, {:?}", own.what, other.what);
            }
        }
    }
    assert!(earlier > 5, "{earlier} first barriers stand before an earlier step");
}

/// "An image with the layout `UNDEFINED` is found without contents. A buffer has no layout: its `layout` is always `UNDEFINED`".
/// "`after`: the state that the frame leaves it in". "`before` of that one is `after` of this one."
#[test]
fn what_outlives_the_frame_is_found_and_left_in_the_states_that_are_said() {
    let (mut buffers, mut persistent, mut undefined) = (0, 0, 0);
    for (name, plan) in plans() {
        for buffer in list(&plan["buffers"]) {
            for role in
                ["persistent", "external"].map(|role| &buffer["role"][role]).into_iter().filter(|it| !it.is_null())
            {
                buffers += usize::from(text(&buffer["name"]) == "bins");
                assert_eq!(
                    [&role["before"]["layout"], &role["after"]["layout"]],
                    ["UNDEFINED"; 2],
                    "{name}: {buffer:#}"
                );
            }
        }
        for (kind, all) in [("image", &plan["images"]), ("buffer", &plan["buffers"])] {
            for one in list(all) {
                let role = &one["role"]["persistent"];
                let Some(next) = role["becomes"].as_u64().or_else(|| role["becomes"][kind].as_u64()) else { continue };
                persistent += 1;
                assert_eq!(all[next as usize]["role"]["persistent"]["before"], role["after"], "{name}: {one:#}");
            }
        }
        for image in list(&plan["images"]) {
            let role = ["persistent", "external"].map(|role| &image["role"][role]).into_iter().find(|it| !it.is_null());
            let start = role.map_or("UNDEFINED", |role| text(&role["before"]["layout"]));
            let mut layouts = Cells::new(image, start.to_owned());
            let mut first = true;
            for barrier in list(&plan["steps"]).iter().flat_map(barriers).filter(|it| it["image"] == image["id"]) {
                let (old, new) = (text(&barrier["old_layout"]), text(&barrier["new_layout"]));
                if first && start == "UNDEFINED" {
                    undefined += usize::from(role.is_some());
                    assert_eq!(old, start, "{name}: nothing was there: {barrier:#}");
                }
                first = false;
                // A handover's second half repeats the first.
                let repeats = !barrier["ownership"].is_null() && barrier["dst_stages"] != "";
                for layout in layouts.of(&barrier["range"]) {
                    let is = [old, "UNDEFINED"].contains(&&**layout) || old == "UNDEFINED" || repeats && layout == new;
                    assert!(is, "{name}: it is in {layout}: {barrier:#}");
                    new.clone_into(layout);
                }
            }
            if let Some(role) = role {
                let after = text(&role["after"]["layout"]);
                assert!(layouts.all().all(|layout| layout == after), "{name}: left in {layouts:?}: {image:#}");
            }
        }
    }
    assert!(buffers > 1 && persistent > 10 && undefined > 10, "{buffers}, {persistent}, {undefined}");
}

/// "The accesses of `before` were made on the queue of the first step that touches it, and that queue owns it when the frame
/// begins; the queue of the last step that touches it owns it when the frame ends." And: "An `EXCLUSIVE` image is used by the
/// queue that owns it."
#[test]
fn an_image_belongs_to_the_queue_that_uses_it_from_the_first_step_to_the_last() {
    let mut handed_over = 0;
    for (name, plan) in plans() {
        for image in list(&plan["images"]).iter().filter(|image| image["sharing"] == "EXCLUSIVE") {
            let what = Named::of("image", image);
            let touching = || list(&plan["steps"]).iter().filter(|step| touched(step).contains(&what));
            let Some(first) = touching().next() else { continue };
            let mut owner = Cells::new(image, text(&first["queue"]).to_owned());
            for step in list(&plan["steps"]) {
                let taken = list(&step["image_barriers"]).iter().filter(|it| it["image"] == image["id"]);
                for barrier in taken.filter(|it| !it["ownership"].is_null()) {
                    handed_over += 1;
                    for owner in owner.of(&barrier["range"]) {
                        assert_eq!(*owner, text(&barrier["ownership"][0]), "{name}: {barrier:#}");
                        text(&barrier["ownership"][1]).clone_into(owner);
                    }
                }
                for range in accesses(step).into_iter().filter(|it| it.0 == what).filter_map(|it| it.1) {
                    assert!(owner.of(range).all(|owner| owner == text(&step["queue"])), "{name}: {what:?}: {step:#}");
                }
            }
        }
    }
    assert!(handed_over > 1, "{handed_over} images are handed over");
}

/// "What it waits for, the signal behind `step`, comes after all that the other queue was given up to there: that step and all
/// before it on its queue, what they release included." And what the halves of an ownership transfer mean.
#[test]
fn the_halves_of_a_transfer_are_alike_and_a_wait_between_them_covers_the_first() {
    let mut transfers = 0;
    for (name, plan) in plans() {
        let steps = list(&plan["steps"]);
        let given: Vec<(usize, &Value)> = steps
            .iter()
            .enumerate()
            .flat_map(|(from, step)| list(&step["releases"]).iter().map(move |it| (from, it)))
            .collect();
        let mut taken: Vec<(usize, &Value)> = (0..)
            .zip(steps)
            .flat_map(|(to, step)| list(&step["image_barriers"]).iter().map(move |it| (to, it)))
            .filter(|(_, barrier)| !barrier["ownership"].is_null())
            .collect();
        for (from, release) in given {
            transfers += 1;
            let same = |other: &Value| {
                ["image", "range", "old_layout", "new_layout", "ownership"]
                    .iter()
                    .all(|field| other[field] == release[field])
            };
            let at = taken.iter().position(|(to, other)| *to > from && same(other));
            let (to, acquire) = taken.remove(at.unwrap_or_else(|| panic!("{name}: nothing takes over: {release:#}")));
            assert_eq!([&release["dst_stages"], &release["dst_accesses"], &acquire["src_accesses"]], [""; 3], "{name}");
            assert!(release["src_stages"] != "" && acquire["dst_stages"] != "", "{name}: {release:#} {acquire:#}");
            let [giver, taker] = [&steps[from]["queue"], &steps[to]["queue"]];
            assert_eq!([giver, taker], [&release["ownership"][0], &release["ownership"][1]], "{name}");
            let on_it =
                steps[..=to].iter().filter(|step| step["queue"] == *taker).flat_map(|step| list(&step["waits"]));
            let covers = |wait: &&Value| {
                let step = number(&wait["step"]) as usize;
                wait["frames_ago"] == 0 && steps[step]["queue"] == *giver && step >= from
            };
            let leads = flags(&acquire["src_stages"]);
            let waits: Vec<&Value> = on_it.filter(covers).collect();
            let leads_on = waits.iter().any(|wait| {
                wait["stages"] == "ALL_COMMANDS" || flags(&wait["stages"]).iter().any(|stage| leads.contains(stage))
            });
            assert!(leads_on, "{name}: {acquire:#} goes on from none of {waits:#?}");
        }
        assert!(taken.is_empty(), "{name}: nobody gives {taken:#?}");
        for (at, wait) in
            (0..).zip(steps).flat_map(|(at, step)| list(&step["waits"]).iter().map(move |wait| (at, wait)))
        {
            let other = number(&wait["step"]);
            assert!(steps[other as usize]["queue"] != steps[at as usize]["queue"], "{name}: {wait:#}");
            assert!(wait["frames_ago"] != 0 || other < at, "{name}: {wait:#}");
        }
    }
    assert!(transfers > 1, "{transfers} transfers");
}

/// "A pass is an entry of `passes` in a scope, a dispatch, or what a program records, and a copy, blit or fill with a `name`." "A
/// call is one `vkCmdPipelineBarrier2`. A step has up to three". "`kept_bytes` holds all persistent and all external images and
/// buffers".
#[test]
fn passes_calls_and_bytes_are_counted_as_is_said() {
    let (mut inserted, mut kept) = (0, 0);
    for (name, plan) in plans() {
        let mut counted = [0_u64; 5];
        for step in list(&plan["steps"]) {
            let by_transfer =
                ["copy", "blit", "fill"].iter().filter(|work| step["work"][work]["name"].is_string()).count();
            let written = passes(step).filter(|pass| !pass["cause"]["written"].is_null()).count();
            let calls = ["memory_barriers", "image_barriers", "releases"].map(|part| list(&step[part]).len());
            counted[0] += (written + by_transfer) as u64;
            counted[1] += (passes(step).count() - written) as u64;
            counted[2] += calls.iter().filter(|barriers| **barriers > 0).count() as u64;
            counted[3] += (calls[1] + calls[2]) as u64;
            counted[4] += calls[0] as u64;
        }
        let said = ["passes", "inserted_passes", "barrier_calls", "image_barriers", "memory_barriers"];
        assert_eq!(said.map(|field| number(&plan["totals"][field])), counted, "{name}: {said:?}");
        inserted += counted[1];
        let outlives = |one: &&Value| one["role"]["transient"].is_null();
        let of_image = |image: &Value| {
            let room = if image["room"].is_null() { &image["extent"] } else { &image["room"] };
            let extent = [&room[0], &room[1], &image["extent"][2]].map(number);
            Ruler::of(extent, ["mips", "layers", "samples"].map(|field| number(&image[field])))
        };
        let bytes: u64 = list(&plan["images"]).iter().filter(outlives).map(of_image).sum();
        let buffers: u64 = list(&plan["buffers"]).iter().filter(outlives).map(|buffer| number(&buffer["bytes"])).sum();
        assert_eq!(number(&plan["totals"]["kept_bytes"]), bytes + buffers, "{name}");
        kept += buffers;
    }
    assert!(inserted > 0 && kept > 0, "{inserted} passes are inserted, {kept} bytes of buffers are kept");
}

/// GLSL's word for what samples an image of this shape.
fn sampler(shape: ImageShape) -> String {
    let prefix = match format!("{:?}", shape.component).as_str() {
        "Uint" => "u",
        "Sint" => "i",
        _ => "",
    };
    let dimension = match shape.dimension {
        Dimension::D2 => "2D",
        Dimension::D3 => "3D",
        Dimension::Cube => "Cube",
        other => panic!("nothing here samples {other:?}"),
    };
    let [samples, layers] =
        [(shape.multisampled, "MS"), (shape.arrayed, "Array")].map(|(is, word)| if is { word } else { "" });
    format!("{prefix}sampler{dimension}{samples}{layers}")
}

/// "`texture`, as what the shader is compiled to declare it … (`null`: the shader's own declaration stands, which fits the image:
/// its shape, its layers, its samples and its format)".
#[test]
fn what_samples_an_image_fits_it_whether_the_shader_or_the_pass_declares_it() {
    let (mut own, mut given) = (0, 0);
    for (name, plan) in plans() {
        for pass in list(&plan["steps"]).iter().flat_map(passes) {
            let sampled = list(&pass["accesses"]).iter().filter(|access| has(&access["binding"]["kind"], "sampled"));
            for access in sampled {
                let binding = &access["binding"];
                let declared = match binding["texture"].as_str() {
                    Some(texture) => texture.to_owned(),
                    None => match own_declaration(pass, text(&binding["name"])) {
                        Some(declared) => declared,
                        None => continue,
                    },
                };
                let image = &plan["images"][number(&access["image"]) as usize];
                let what = format!("{name}: {} declares {declared}: {image:#}", pass["name"]);
                let dimension = match text(&image["shape"]) {
                    "D2" => "2D",
                    "D3" => "3D",
                    _ => "Cube",
                };
                let format = text(&image["format"]);
                let prefix = match text(&access["range"]["aspects"]) {
                    "STENCIL" => "usampler",
                    "COLOR" if format.ends_with("_UINT") => "usampler",
                    "COLOR" if format.ends_with("_SINT") => "isampler",
                    _ => "sampler",
                };
                assert!(declared.starts_with(&format!("{prefix}{dimension}")), "{what}");
                assert_eq!(declared.contains("MS"), number(&image["samples"]) > 1, "{what}");
                assert!(
                    declared.ends_with("Array") || number(&access["range"]["layers"]) == 1 || dimension == "Cube",
                    "{what}"
                );
                *if binding["texture"].is_null() { &mut own } else { &mut given } += 1;
            }
        }
    }
    assert!(own > 10 && given > 10, "{own} shaders declare what they sample by themselves, {given} are told");
}

/// The declaration that a shader of the table has by itself; `None` for a shader that the compiler inserted, which isn't there.
fn own_declaration(pass: &Value, binding: &str) -> Option<String> {
    let shader = text(&pass["shader"]).trim_start_matches("shipped:");
    let variant = Variant::default();
    let drawn = Table.draw_shader(shader, Draw::FullScreen, &variant);
    let shader = drawn.or_else(|_| Table.compute_shader(shader, &variant)).ok()?;
    let found = shader.bindings.iter().find(|it| it.name == binding)?;
    match &found.kind {
        BindingKind::SampledImage(shape) => Some(sampler(*shape)),
        BindingKind::ComparedDepth(shape) => Some(format!("{}Shadow", sampler(*shape))),
        // It is declared in either way, as the device has local reads or not.
        BindingKind::InputAttachment { .. } => None,
        other => panic!("it doesn't sample {other:?}"),
    }
}

/// "It serves later passes of the scope too: one that reads only what was drawn before an earlier local barrier has none. A pass
/// that draws over what was read has one too, unless one stands in between".
#[test]
fn a_local_barrier_stands_where_a_pass_reads_or_draws_over_what_no_earlier_one_serves() {
    let (mut needed, mut served) = (0, 0);
    for (name, plan) in plans() {
        for step in list(&plan["steps"]).iter().filter(|step| has(&step["work"], "render")) {
            let (mut drawn, mut read) = (BTreeSet::new(), BTreeSet::new());
            let mut ever_drawn = BTreeSet::new();
            for pass in passes(step) {
                let reads = images(pass, "INPUT_ATTACHMENT_READ");
                let draws = images(pass, "COLOR_ATTACHMENT_WRITE");
                let needs = !drawn.is_disjoint(&reads) || !read.is_disjoint(&draws);
                assert_eq!(pass["local_barrier"], needs, "{name}: {}", pass["name"]);
                if needs {
                    needed += 1;
                    drawn.clear();
                    read.clear();
                }
                served += usize::from(!needs && !ever_drawn.is_disjoint(&reads));
                ever_drawn.extend(draws.iter().copied());
                drawn.extend(draws);
                read.extend(reads);
            }
        }
    }
    assert!(needed > 1 && served > 0, "{needed} local barriers, and {served} passes that one serves");
}

/// "`needed_by` (the first step that needs it: a barrier may stand before an earlier step …; `null`: what comes after the
/// frame)", and `after`, "the last step that it waits for".
#[test]
fn a_barrier_stands_behind_what_it_waits_for_and_before_the_first_step_that_needs_it() {
    let (mut after_the_frame, mut earlier, mut of_parts) = (0, 0, 0);
    for (name, plan) in plans() {
        let steps = list(&plan["steps"]);
        for (at, step) in steps.iter().enumerate() {
            let images = list(&step["image_barriers"]).iter().map(|it| (Named::image(it), it));
            let buffers = list(&step["memory_barriers"]).iter().flat_map(|it| list(&it["buffers"]));
            for (what, barrier) in images.chain(buffers.map(|it| (Named::buffer(it), it))) {
                let said = format!("{name}: step {at}: {barrier:#}");
                assert!(barrier["after"].as_u64().is_none_or(|after| after < at as u64), "{said}");
                let range = barrier.get("range");
                let needs = |step: &Value| accesses(step).iter().any(|it| it.0 == what && meet(range, it.1));
                let first = (at..steps.len()).find(|step| needs(&steps[*step]));
                assert_eq!(barrier["needed_by"].as_u64(), first.map(|step| step as u64), "{said}");
                assert_eq!(barrier["hazard"] == "export", first.is_none(), "{said}");
                after_the_frame += usize::from(first.is_none());
                earlier += usize::from(first.is_some_and(|first| first > at));
                let all = |step: &Value| accesses(step).iter().any(|it| it.0 == what && it.1 == range);
                of_parts += usize::from(first.is_some_and(|first| !all(&steps[first])));
            }
        }
    }
    let counted = [after_the_frame, earlier, of_parts];
    assert!(counted.iter().all(|count| *count > 1), "{counted:?}");
}
