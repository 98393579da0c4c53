//! Device profiles: saved ones say what the device says, those that lie are refused where they lie.

use crate::testing::{self, Place, Vulkan, live_profile};
use framewright_graph::device::{Profile, SHIPPED_PROFILES};

/// The drivers of this machine, each with the name of its shipped profile.
const DRIVERS: [(Vulkan, &str); 2] = [(Vulkan::LAVAPIPE, "lavapipe"), (Vulkan::SWIFTSHADER, "swiftshader")];

fn shipped(name: &str) -> &'static str {
    SHIPPED_PROFILES.iter().find(|(known, _)| *known == name).expect("it is shipped").1
}

/// Saves the profile of a driver's device into `p.ron`.
fn save(place: &Place, driver: Vulkan) -> Option<Profile> {
    let variables = driver.variables()?;
    let said = place.run_with(&variables, &["devices", "--save", "p.ron"]).exits(0).out;
    assert!(said.starts_with("p.ron: the profile of ") && said.contains("memory needs of"), "{said}");
    assert_eq!(place.names(), ["p.ron"], "nothing is left beside it");
    let text = std::fs::read_to_string(place.path("p.ron")).expect("written");
    Some(Profile::from_ron(&text).expect("what is saved can be read"))
}

#[test]
fn a_saved_profile_takes_the_place_of_its_device() {
    for (driver, _) in DRIVERS {
        let place = Place::new();
        let Some(profile) = save(&place, driver) else { return };
        // Formats that are attachments have several sample counts.
        let attachments = profile.formats.iter().filter(|support| !support.samples.is_empty()).count();
        // Compressed images lie in no heap.
        let plain = profile.formats.iter().filter(|support| !support.format.is_compressed()).count();
        assert!(profile.known_needs.len() >= plain + attachments);
        assert!(profile.unknown.is_empty());
        for pipeline in ["forward", "soft_focus"] {
            let out = place.run(&["check", pipeline, "--device", "p.ron"]).exits(0).out;
            assert!(out.starts_with(&format!("{pipeline}: fine on {}: ", profile.name)), "{out}");
        }
    }
}

/// On another version of the driver there is nothing to compare. `FRAMEWRIGHT_UPDATE=1` takes over what the driver says.
#[test]
fn shipped_profiles_of_drivers_that_are_here_are_what_they_say_themselves() {
    for (driver, name) in DRIVERS {
        let place = Place::new();
        let Some(saved) = save(&place, driver) else { return };
        let text = shipped(name);
        let shipped = Profile::from_ron(text).expect("a profile");
        let saved = Profile { name: name.to_owned(), ..saved };
        if std::env::var_os("FRAMEWRIGHT_UPDATE").is_some() {
            let file = testing::repository(&format!("graph/src/device/profiles/{name}.ron"));
            std::fs::write(file, saved.to_ron().expect("text")).expect("written");
        } else if saved.source != shipped.source {
            eprintln!("skipped: the driver is {}, the profile {}", saved.source, shipped.source);
        } else {
            assert_eq!(
                saved, shipped,
                "see:    FRAMEWRIGHT_UPDATE=1 cargo test --package framewright-cli --test suite profiles; git diff graph\n\
                 accept: git add graph/src/device/profiles"
            );
        }
    }
}

#[test]
fn a_profile_is_saved_of_the_device_that_is_named_and_whole_or_not_at_all() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let save = |arguments: &[&str]| place.run_with(&variables, &[&["devices", "--save"], arguments].concat());
    save(&["p.ron", "--device", "llvmpipe"]).exits(0);
    let first = std::fs::read(place.path("p.ron")).expect("written");
    save(&["p.ron", "--device", "0"]).exits(0);
    assert_eq!(std::fs::read(place.path("p.ron")).expect("written"), first, "the same device, the same bytes");

    save(&["p.ron", "--device", "voodoo"]).exits(3).mentions("error: no device named voodoo");
    save(&["p.ron", "--device", "other.ron"]).exits(2).mentions("`other.ron` is a device profile");
    save(&["none/p.ron"]).exits(3).mentions("its folder must exist: mkdir -p none");
    save(&["/dev/full"]).exits(3).mentions("make room");
    assert_eq!(std::fs::read(place.path("p.ron")).expect("still there"), first);
    assert_eq!(place.names(), ["p.ron"]);
}

#[test]
fn what_is_said_of_saving_without_saving_is_a_wrong_command_line() {
    Place::new().run(&["devices", "--device", "0"]).exits(2).mentions("--save");
    Place::new().run(&["devices", "--save", "p.ron", "--format", "json"]).exits(2).mentions("--format");
}

#[test]
fn the_list_of_devices_tells_queues_and_local_reads() {
    for (driver, _) in DRIVERS {
        let Some(variables) = driver.variables() else { continue };
        let place = Place::new();
        let table = place.run_with(&variables, &["devices"]).exits(0).out;
        assert!(table.contains("queues") && table.contains("local reads") && table.contains("graphics"), "{table}");
        let json = place.run_with(&variables, &["devices", "--format", "json"]).exits(0).out;
        let answer: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        let device = &answer["devices"][0];
        assert_eq!(device["queues"], serde_json::json!(["graphics"]), "{json}");
        assert_eq!(device["local_read"], live_profile(&variables).local_read, "{json}");
    }
}

/// A text of lavapipe's profile, its replacement, and the answer to that.
const LIES: [(&str, &str, &str); 9] = [
    ("max_attachment_extent: 16384", "max_attachment_extent: 0", ":4:28: this is 0, and must be 1 to 65536"),
    ("max_attachment_extent: 16384", "max_attachment_extent: NaN", ":4:27: Expected integer"),
    ("max_color_attachments: 8", "max_color_attachments: 99999", ":7:28: this is 99999, and must be 1 to 64"),
    ("samples: [1, 4]", "samples: [1, 3]", "R8_UNORM has 3 samples; 1, 2, 4, 8, 16, 32 or 64 are possible"),
    ("samples: [1, 4]", "samples: [4, 1]", "the sample counts of R8_UNORM must rise"),
    ("format: R8_UINT, usage", "format: R8_UNORM, usage", "R8_UNORM stands in this list twice"),
    ("alignment: 16,\n", "alignment: 24,\n", "this is 24, and must be a power of two up to 1073741824"),
    ("(bytes: 65536", "(bytes: 65535", "R8_UNORM of 256×256 with 1 samples can't take 65535 bytes"),
    ("type_bits: 1", "type_bits: 0", "no memory type will do"),
];

#[test]
fn a_profile_that_lies_is_refused_where_it_lies() {
    let place = Place::new();
    for (old, new, said) in LIES {
        let text = shipped("lavapipe");
        assert!(text.contains(old), "{old}");
        place.file("p.ron", text.replacen(old, new, 1));
        let error = place.run(&["check", "forward", "--device", "p.ron"]).exits(1).mentions(said).err;
        assert!(error.contains("error: p.ron:"), "{error}");
        place.run(&["inspect", "forward", "--device", "p.ron"]).exits(1).mentions(said);
    }
}

#[test]
fn a_damaged_profile_is_refused_with_its_place() {
    let place = Place::new();
    let text = shipped("lavapipe");
    for length in [0, 1, 20, 500, 5_000, text.len() - 3] {
        place.file("p.ron", &text[..length]);
        place.run(&["check", "forward", "--device", "p.ron"]).exits(1).mentions("error: p.ron:");
    }
    place.file("p.ron", b"(name: \"\xff\")");
    place.run(&["check", "forward", "--device", "p.ron"]).exits(1).mentions("is not text");
    place.file("p.ron", "[".repeat(100_000));
    place.run(&["check", "forward", "--device", "p.ron"]).exits(1).mentions("error: p.ron:");
    place.file("p.ron", "(name: \"\u{1b}[2J\", nonsense\u{7}: 1)");
    let error = place.run(&["check", "forward", "--device", "p.ron"]).exits(1).err;
    assert!(!error.contains('\u{1b}') && !error.contains('\u{7}'), "{error:?}");
}

/// Figures at the ends of what is taken: whatever a Plan then takes, nothing overflows.
#[test]
fn the_most_that_a_profile_may_say_breaks_nothing() {
    let place = Place::new();
    let text = shipped("lavapipe");
    let needs = text.find("known_needs: [").expect("there");
    let bare = format!("{}known_needs: [], unknown: [])", &text[..needs]);
    let most = bare
        .replace("alignment: 16,", "alignment: 1073741824,")
        .replace("row_texels: 4", "row_texels: 65536")
        .replace("row_bytes: 64", "row_bytes: 65536")
        .replace("rows: 4", "rows: 65536")
        .replace("[1, 4]", "[1, 2, 4, 8, 16, 32, 64]")
        .replace("16384", "65536");
    place.file("p.ron", most);
    let huge = ["inspect", "forward", "--device", "p.ron", "--size", "16384x16384", "--set", "msaa=8"];
    let outcome = place.run(&huge);
    assert!(matches!(outcome.code, Some(0 | 1)), "{outcome:?}");
    place.file(
        "p.ron",
        bare.replace("[1, 4]", "[1]").replace("16384", "1").replace("linear_filter: true", "linear_filter: false"),
    );
    place.run(&["inspect", "forward", "--device", "p.ron"]).exits(1).mentions("1×1");
}

#[test]
fn a_buffer_that_takes_more_memory_than_the_device_has_is_named_and_placed() {
    let place = Place::new();
    let buffer = r#"Pipeline(version: 1,
        images: [(name: "screen", format: Output, size: Output)],
        buffers: [
            (name: "large", bytes: 3221225472, lifetime: Persistent),
        ],
        passes: [
            (name: "sky", draw: Sky, color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]),
            (name: "fill", fill: (to: "large", value: 0)),
        ],
        outputs: ["screen"])"#;
    place.file("buffer.ron", buffer);
    place
        .run(&["check", "buffer.ron"])
        .exits(1)
        .mentions("error: the frame takes more memory than the device has\n --> buffer.ron:4:")
        .mentions("GiB of 2.0 GiB, for `large` (3.0 GiB), `screen` ");
}

#[test]
fn an_image_that_the_compiler_makes_of_a_declared_one_is_placed_there_if_it_takes_more_than_the_device_has() {
    let place = Place::new();
    // Of two of one size the second is the largest: `color (1 frame ago)`.
    let text = r#"Pipeline(version: 1,
        images: [
            (name: "screen", format: Output, size: Output),
            (name: "color", format: R32G32B32A32_SFLOAT, size: Fixed(16384, 8192), lifetime: History),
        ],
        passes: [
            (name: "sky", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
            (name: "show", draw: FullScreen("reinhard"), sample: {"source": (image: "color", previous: 1)}, color: ["screen"]),
        ],
        outputs: ["screen"])"#;
    place.file("p.ron", text);
    place
        .run(&["check", "p.ron"])
        .exits(1)
        .mentions("error: the frame takes more memory than the device has\n --> p.ron:4:")
        .mentions("`color (1 frame ago)` (2.0 GiB)");
}

#[test]
fn a_plan_that_needs_more_memory_than_the_device_has_is_a_finding_that_names_the_largest_images() {
    let place = Place::new();
    // Two images of 1 GiB with 16 bytes a texel: the device has 2 GiB for them and the output.
    let text = r#"Pipeline(version: 1,
        settings: [(name: "side", value: Integer(default: 8192, min: 64, max: 8192))],
        images: [
            (name: "small", format: R8_UNORM, size: Fixed(64, 64)),
            (name: "large", format: R32G32B32A32_SFLOAT, size: Fixed("side", "side")),
            (name: "larger", format: R32G32B32A32_SFLOAT, size: Fixed("side", "side"), samples: 4),
            (name: "screen", format: Output, size: Output),
        ],
        passes: [
            (name: "sky", draw: Sky, color: [(image: "larger", clear: (0.0, 0.0, 0.0, 1.0))]),
            (name: "less", draw: FullScreen("downsample"), sample: {"source": "larger"}, color: ["large"]),
            (name: "dot", draw: FullScreen("downsample"), sample: {"source": "large"}, color: ["small"]),
            (name: "show", draw: FullScreen("reinhard"), sample: {"source": "small"}, color: ["screen"]),
        ],
        outputs: ["screen"])"#;
    place.file("p.ron", text);
    let help = "GiB of 2.0 GiB, for `larger` (4.0 GiB), `large";
    place
        .run(&["check", "p.ron"])
        .exits(1)
        .mentions("error: the frame takes more memory than the device has\n --> p.ron:6:")
        .mentions(help);
    let json = place.run(&["check", "p.ron", "--format", "json"]).exits(1).out;
    assert!(json.contains("more memory than the device has"), "{json}");
    let all = place.run(&["check", "p.ron", "--device", "all"]).exits(1).out;
    assert!(all.contains("p.ron: refused on lavapipe\n") && all.contains("p.ron: fine on amd-rx-7800-xt: "), "{all}");
    let variants = place.run(&["check", "p.ron", "--all-variants"]).exits(1);
    assert!(variants.out.contains("more memory than the device has"), "{}", variants.out);
    // It fits when it is smaller, or where nobody knows how much memory there is.
    place.run(&["check", "p.ron", "--set", "side=2048"]).exits(0);
    let without =
        shipped("lavapipe").lines().filter(|line| !line.contains("heap_bytes")).collect::<Vec<_>>().join("\n");
    place.file("unknown.ron", without);
    place.run(&["check", "p.ron", "--device", "unknown.ron"]).exits(0);
}
