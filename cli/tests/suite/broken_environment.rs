//! Files that the Vulkan loader reads, absent or broken: every command says which variable leads there and what mends it, and
//! commands that need no device don't mind.

use crate::testing::{Place, Vulkan};

/// Kinds of files that stand for a driver or a layer, and the library that it names.
const KINDS: [(&str, Option<&str>); 5] = [
    ("absent", None),
    ("no JSON", Some("")),
    ("without its library", Some("/nonexistent/library.so")),
    ("with a library that is none", Some("p.ron")),
    ("with a library of another kind", Some("libc.so.6")),
];

/// Commands that need no device.
const WITHOUT_DEVICE: [&[&str]; 5] = [
    &["check", "forward"],
    &["inspect", "forward", "-o", "plan.txt"],
    &["facts", "spheres_and_cubes"],
    &["schema"],
    &["new", "fresh"],
];

/// Commands that need one.
const WITH_DEVICE: [&[&str]; 3] = [
    &["devices"],
    &["devices", "--save", "device.ron"],
    &["run", "forward", "--scene", "spheres_and_cubes", "--size", "16x9", "-o", "a.png"],
];

/// And the layer.
const VALIDATED: &[&str] =
    &["run", "forward", "--scene", "spheres_and_cubes", "--size", "16x9", "-o", "a.png", "--validate"];

fn place() -> Place {
    let place = Place::new();
    place.file("p.ron", "no library");
    place
}

/// The contents of a driver's or a layer's file.
fn manifest(place: &Place, library: &str, layer: bool) -> String {
    let library = if library == "p.ron" { place.path(library).display().to_string() } else { library.to_owned() };
    match (library.is_empty(), layer) {
        (true, _) => "{".to_owned(),
        (false, false) => format!(
            r#"{{"file_format_version": "1.0.0", "ICD": {{"library_path": "{library}", "api_version": "1.3.0"}}}}"#
        ),
        (false, true) => format!(
            r#"{{"file_format_version": "1.2.0", "layer": {{"name": "VK_LAYER_KHRONOS_validation", "type": "GLOBAL",
                "library_path": "{library}", "api_version": "1.4.300", "implementation_version": "1", "description": ""}}}}"#
        ),
    }
}

#[test]
fn a_driver_that_is_absent_or_broken_is_told_by_the_variable_that_leads_there() {
    for (kind, library) in KINDS {
        let place = place();
        let file = place.path("driver.json");
        if let Some(library) = library {
            place.file("driver.json", manifest(&place, library, false));
        }
        let before = place.names();
        let file = file.to_str().expect("text");
        let variables = [("VK_DRIVER_FILES", file), ("VK_ICD_FILENAMES", file)];
        for command in WITH_DEVICE.into_iter().chain([VALIDATED]) {
            println!("{kind}: {command:?}");
            place
                .run_with(&variables, command)
                .exits(3)
                .mentions("mend it with: apt-get install ")
                .mentions("; or: unset VK_DRIVER_FILES VK_ICD_FILENAMES")
                .mentions(&format!("(now VK_DRIVER_FILES={file}, VK_ICD_FILENAMES={file}"));
        }
        assert_eq!(place.names(), before, "{kind}: nothing is written");
        for command in WITHOUT_DEVICE {
            println!("{kind}: {command:?}");
            place.run_with(&variables, command).exits(0);
        }
    }
}

#[test]
fn a_layer_that_is_absent_or_broken_is_told_by_the_variable_that_leads_there() {
    let Some(mut variables) = Vulkan::LAVAPIPE.variables() else { return };
    for (kind, library) in KINDS {
        let place = place();
        let layers = place.path("layers");
        std::fs::create_dir(&layers).expect("a folder");
        if let Some(library) = library {
            place.file("layers/VkLayer_khronos_validation.json", manifest(&place, library, true));
        }
        let before = place.names();
        let layers = layers.to_str().expect("text").to_owned();
        let layers: &str = layers.as_str();
        variables.truncate(2);
        let broken = [&variables[..], &[("VK_LAYER_PATH", layers)]].concat();
        println!("{kind}");
        place
            .run_with(&broken, VALIDATED)
            .exits(3)
            .mentions("mend it with: apt-get install ")
            .mentions(&format!("VK_LAYER_PATH={layers}"));
        assert_eq!(place.names(), before, "{kind}: nothing is written");
        for command in WITHOUT_DEVICE {
            println!("{kind}: {command:?}");
            place.run_with(&broken, command).exits(0);
        }
        for command in WITH_DEVICE {
            println!("{kind}: {command:?}");
            let outcome = place.run_with(&broken, command);
            // Some loaders refuse altogether when a layer's file is no JSON, whether the layer is asked for or not.
            if outcome.code == Some(0) || library != Some("") {
                outcome.exits(0);
            } else {
                outcome.exits(3).mentions("mend it with: ").mentions(&format!("VK_LAYER_PATH={layers}"));
            }
        }
    }
}

/// Silence proves nothing of a layer that doesn't report the mistakes that are planted to test it.
#[test]
fn a_layer_whose_settings_keep_it_from_speaking_is_told_from_one_that_finds_nothing() {
    for vulkan in [Vulkan::LAVAPIPE_CURRENT, Vulkan::LAVAPIPE_OLD] {
        let Some(variables) = vulkan.variables() else { return };
        let place = place();
        let filter = "khronos_validation.message_id_filter = SYNC-HAZARD-WRITE-AFTER-WRITE\n";
        let settings = place.file("vk_layer_settings.txt", filter);
        let quiet = [&variables[..], &[("VK_LAYER_SETTINGS_PATH", settings.to_str().expect("text"))]].concat();
        let before = place.names();
        let outcome = place.run_with(&quiet, VALIDATED).exits(3);
        outcome.mentions(
            " did not report a clear that doesn't wait for another clear, which was planted to test it: its checks of \
             synchronisation are switched off, ",
        );
        assert_eq!(place.names(), before, "nothing is written");
        place.file("vk_layer_settings.txt", "");
        let outcome = place.run_with(&quiet, VALIDATED).exits(0);
        assert!(outcome.out.contains(" reported the mistakes that were planted to test it\n"), "{}", outcome.out);
    }
}

/// Each of the layer's checks that a setting switches off is missed by a mistake of its own; what leaves out messages by their names is
/// refused as such.
#[test]
fn no_setting_of_the_layer_makes_a_run_silent() {
    let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
    let place = Place::new();
    for (name, value, checks) in [
        ("VK_LAYER_DISABLES", "VK_VALIDATION_FEATURE_DISABLE_CORE_CHECKS_EXT", Some("core checks")),
        ("VK_KHRONOS_VALIDATION_VALIDATE_CORE", "false", Some("core checks")),
        ("VK_KHRONOS_VALIDATION_CHECK_SHADERS", "false", Some("checks of shaders")),
        ("VK_KHRONOS_VALIDATION_STATELESS_PARAM", "false", Some("checks of parameters")),
        ("VK_KHRONOS_VALIDATION_THREAD_SAFETY", "false", Some("checks of threads")),
        ("VK_KHRONOS_VALIDATION_VALIDATE_SYNC", "false", Some("checks of synchronisation")),
        ("VK_KHRONOS_VALIDATION_CHECK_IMAGE_LAYOUT", "false", None),
        ("VK_KHRONOS_VALIDATION_CHECK_OBJECT_IN_USE", "false", None),
        ("VK_LAYER_MESSAGE_ID_FILTER", "VUID-vkCmdDraw-None-02699", None),
        ("VK_LAYER_REPORT_FLAGS", "info", None),
    ] {
        let outcome = place.run_with(&[&variables[..], &[(name, value)]].concat(), VALIDATED).exits(3);
        let outcome = outcome.mentions(&format!("take these settings back: {name}={value}"));
        if let Some(checks) = checks {
            outcome.mentions(&format!("which was planted to test it: its {checks} are switched off"));
        }
    }
    let on = [&variables[..], &[("VK_KHRONOS_VALIDATION_VALIDATE_BEST_PRACTICES", "false")]].concat();
    place.run_with(&on, VALIDATED).exits(0);
}

#[test]
fn a_layer_that_the_loader_hides_is_told_by_the_variable() {
    let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
    let place = Place::new();
    for hidden in ["*", "VK_LAYER_KHRONOS_validation", "~explicit~"] {
        place
            .run_with(&[&variables[..], &[("VK_LOADER_LAYERS_DISABLE", hidden)]].concat(), VALIDATED)
            .exits(3)
            .mentions(&format!("unset VK_LOADER_LAYERS_DISABLE (now VK_LOADER_LAYERS_DISABLE={hidden})"));
    }
}

/// A mistake that the layer reports of each draw is one finding.
#[test]
fn what_the_layer_says_of_each_draw_is_one_finding() {
    let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
    let place = Place::new();
    place.file(
        "red.frag",
        "#version 460
        layout(location = 0) out vec4 c;
        void main() { c = vec4(1.0); }",
    );
    place.file(
        "p.ron",
        r#"Pipeline(version: 1,
            images: [(name: "d", format: Depth, size: Output), (name: "o", format: R8G8B8A8_UNORM, size: Output)],
            passes: [
                (name: "prepass", draw: Objects(Opaque), shader: "red", depth: (image: "d", clear: 0.0)),
                (name: "draw", draw: Objects(Opaque), shader: "red", color: [(image: "o", clear: (0, 0, 0, 1))], depth: (image: "d", test: Equal, write: false)),
            ], outputs: [(image: "o", encoding: Unorm)])"#,
    );
    let words = [
        "run",
        "p.ron",
        "--scene",
        "spheres_and_cubes",
        "--size",
        "16x9",
        "--frames",
        "2",
        "--validate",
        "--report",
        "r.json",
    ];
    let outcome = place.run_with(&variables, &words).exits(1);
    assert!(outcome.out.contains("validation: 1 finding by "), "{}", outcome.out);
    let report = std::fs::read_to_string(place.path("r.json")).expect("written");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    let validation = &report["validation"];
    assert_eq!(validation["findings"], 1);
    let found = validation["messages"].as_array().expect("a list").iter().find(|it| it["finding"] == true);
    assert!(found.expect("a finding")["times"].as_u64() > Some(20), "{validation:#}");
}

/// The loader lists a driver like MoltenVK only to programs that say they know that such drivers lack parts of Vulkan.
#[test]
fn a_driver_that_lacks_parts_of_vulkan_is_listed() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let driver = variables.iter().find(|(name, _)| *name == "VK_DRIVER_FILES").expect("a driver").1;
    let text = std::fs::read_to_string(driver).expect("a manifest");
    let mut manifest: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    manifest["ICD"]["is_portability_driver"] = true.into();
    let place = Place::new();
    let file = place.file("driver.json", manifest.to_string());
    let file = file.to_str().expect("text");
    let found = place.run_with(&[("VK_DRIVER_FILES", file), ("VK_ICD_FILENAMES", file)], &["devices"]).exits(0).out;
    assert!(found.contains("llvmpipe"), "{found}");
}
