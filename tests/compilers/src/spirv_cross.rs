//! What `spirv-cross --reflect` says.

use crate::facts::{Facts, PUSHED, add, add_sampler, own, rounded};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Reads an entry point.
pub fn read(file: &Path, entry: &str, stage: &str) -> Result<Facts, String> {
    let mut command = Command::new("spirv-cross");
    command.arg(file).args(["--entry", entry, "--stage", stage, "--reflect", "--remove-unused-variables"]);
    let output = command.output().map_err(|error| error.to_string())?;
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        return Err(said.lines().next().unwrap_or("it says nothing").to_owned());
    }
    let json: Value = serde_json::from_slice(&output.stdout).map_err(|error| error.to_string())?;
    Ok(of_json(&json, entry))
}

fn list<'j>(json: &'j Value, key: &str) -> impl Iterator<Item = &'j Value> {
    json[key].as_array().into_iter().flatten()
}

fn text<'j>(json: &'j Value, key: &str) -> &'j str {
    json[key].as_str().unwrap_or_default()
}

fn place(json: &Value) -> String {
    format!("{} {}", json["set"], json["binding"])
}

fn of_json(json: &Value, entry: &str) -> Facts {
    let mut facts = Facts::new();
    if let Some(size) = list(json, "entryPoints").find(|it| it["name"] == entry).and_then(|it| {
        let by_constants = list(it, "workgroup_size_is_spec_constant_id").any(|it| it == true);
        it["workgroup_size"].as_array().filter(|_| !by_constants)
    }) {
        add(&mut facts, "size", "", format!("{} {} {}", size[0], size[1], size[2]));
    }
    for (key, kind) in [
        ("textures", "combined"),
        ("separate_images", "image"),
        ("images", "storage_image"),
        ("subpass_inputs", "input_attachment"),
    ] {
        for it in list(json, key) {
            let (at, (component, shape)) = (place(it), shape(text(it, "type")));
            let buffer = shape.starts_with("Buffer") || shape.is_empty() && kind != "input_attachment";
            add(&mut facts, "resource", &at, if buffer { "texel_buffer" } else { kind });
            add(&mut facts, "name", &at, own(text(it, "name")));
            if kind != "input_attachment" {
                add(&mut facts, "shape", &at, shape);
                add(&mut facts, "component", &at, component);
            }
            add(&mut facts, "count", &at, count(it));
            if kind == "storage_image" {
                add(&mut facts, "access", &at, access(it));
            }
        }
    }
    for it in list(json, "separate_samplers") {
        add_sampler(&mut facts, &place(it));
        add(&mut facts, "count", &place(it), count(it));
    }
    for (key, kind) in [("ubos", "uniform"), ("ssbos", "storage"), ("push_constants", "uniform")] {
        for it in list(json, key) {
            let at = if key == "push_constants" { PUSHED.to_owned() } else { place(it) };
            add(&mut facts, "resource", &at, kind);
            add(&mut facts, "count", &at, count(it));
            let bytes = it["block_size"].as_u64().unwrap_or(0);
            match kind {
                "storage" => {
                    add(&mut facts, "bytes", &at, bytes);
                    add(&mut facts, "access", &at, access(it));
                }
                _ => {
                    if key == "ubos" {
                        add(&mut facts, "bytes", &at, rounded(bytes));
                    }
                    members(&mut facts, json, &at, text(it, "type"));
                }
            }
        }
    }
    for (key, kind) in [("inputs", "input"), ("outputs", "output")] {
        for it in list(json, key).filter(|it| it["location"].is_u64() && !text(it, "type").starts_with('_')) {
            let at = format!("{} {}", it["location"], it["component"].as_u64().unwrap_or(0));
            add(&mut facts, kind, &at, of_type(it));
            add(&mut facts, &format!("{kind}_name"), &at, own(text(it, "name")));
        }
    }
    for it in list(json, "specialization_constants") {
        let number = it["id"].to_string();
        add(&mut facts, "constant", &number, text(it, "type"));
        add(&mut facts, "constant_name", &number, own(text(it, "name")));
    }
    facts
}

/// The members of a uniform block; of a struct that is all of it, those of the struct.
fn members(facts: &mut Facts, json: &Value, at: &str, ty: &str) {
    let of = |ty: &str| json["types"][ty]["members"].as_array().cloned().unwrap_or_default();
    let mut all = of(ty);
    if let [only] = &all[..]
        && text(only, "type").starts_with('_')
        && only["array"].is_null()
    {
        all = of(text(only, "type"));
    }
    for member in &all {
        let at = format!("{at} {}", member["offset"]);
        add(facts, "member", &at, of_type(member));
        let name = text(member, "name");
        add(facts, "member_name", &at, if name.starts_with("_m") { "" } else { own(name) });
    }
}

/// A type as GLSL writes it. Structs have names that mean nothing.
fn of_type(it: &Value) -> String {
    let ty = text(it, "type");
    if ty.starts_with('_') {
        return String::new();
    }
    let lengths = list(it, "array").map(|length| match length.as_u64() {
        Some(0) | None => "[]".to_owned(),
        Some(length) => format!("[{length}]"),
    });
    ty.to_owned() + &lengths.collect::<String>()
}

fn count(it: &Value) -> String {
    list(it, "array").map(|length| length.as_u64().unwrap_or(0)).product::<u64>().to_string()
}

fn access(it: &Value) -> &'static str {
    match (it["readonly"] == true, it["writeonly"] == true) {
        (true, false) => "r",
        (false, true) => "w",
        (true, true) => "",
        (false, false) => "rw",
    }
}

/// The component and the shape of an image's type: `usampler2DArray`.
fn shape(ty: &str) -> (&'static str, String) {
    let words = ["sampler", "texture", "image"];
    let Some((prefix, rest)) = words.iter().find_map(|word| ty.split_once(word)) else { return ("", String::new()) };
    let component = match prefix {
        "u" => "uint",
        "i" => "int",
        _ => "float",
    };
    (component, rest.trim_end_matches("Shadow").to_owned())
}
