//! Device profiles: saved ones say what the device says, those that lie are refused where they lie.

mod support;

use framewright_graph::device::{Profile, SHIPPED_PROFILES};
use support::{Place, Vulkan};

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
        assert!(profile.known_needs.len() >= 2 * profile.formats.len());
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
            let file = support::repository(&format!("graph/src/device/profiles/{name}.ron"));
            std::fs::write(file, saved.to_ron().expect("text")).expect("written");
        } else if saved.source != shipped.source {
            eprintln!("skipped: the driver is {}, the profile {}", saved.source, shipped.source);
        } else {
            assert_eq!(
                saved, shipped,
                "see:    FRAMEWRIGHT_UPDATE=1 cargo test --package framewright --test profiles; git diff graph\n\
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
    for (driver, name) in DRIVERS {
        let Some(variables) = driver.variables() else { return };
        let place = Place::new();
        let table = place.run_with(&variables, &["devices"]).exits(0).out;
        assert!(table.contains("queues") && table.contains("local reads") && table.contains("graphics"), "{table}");
        let json = place.run_with(&variables, &["devices", "--format", "json"]).exits(0).out;
        let answer: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        let device = &answer["devices"][0];
        let profile = Profile::from_ron(shipped(name)).expect("a profile");
        assert_eq!(device["queues"], serde_json::json!(["graphics"]), "{json}");
        assert_eq!(device["local_read"], profile.local_read, "{json}");
    }
}

/// What is replaced in lavapipe's profile, with what, and what is said.
const LIES: [(&str, &str, &str); 9] = [
    ("max_attachment_extent: 16384", "max_attachment_extent: 0", ":4:28: this is 0, and must be 1 to 65536"),
    ("max_attachment_extent: 16384", "max_attachment_extent: NaN", ":4:27: Expected integer"),
    ("max_color_attachments: 8", "max_color_attachments: 99999", ":7:28: this is 99999, and must be 1 to 64"),
    ("samples: [1, 4]", "samples: [1, 3]", "R8_UNORM has 3 samples; 1, 2, 4, 8, 16, 32 or 64 are possible"),
    ("samples: [1, 4]", "samples: [4, 1]", "the sample counts of R8_UNORM must rise"),
    ("format: R8_UINT, usage", "format: R8_UNORM, usage", "R8_UNORM stands in this list twice"),
    ("alignment: 16,\n", "alignment: 24,\n", "this is 24, and must be a power of two up to 1073741824"),
    ("bytes: 65536", "bytes: 65535", "R8_UNORM of 256×256 with 1 samples can't take 65535 bytes"),
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
