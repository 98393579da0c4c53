//! Parts of a glTF file that aren't drawn are noted, and unusual ways to say things are read.

use crate::scene::fixtures::builder::pack;
use crate::scene::gltf_mistakes::sound;
use framewright_passes::scene::{Scene, Wrap, gltf};
use glam::DVec3;
use serde_json::{Value, json};
use std::sync::Arc;

/// The result of reading the file after its JSON was changed.
fn read(change: impl FnOnce(&mut Value)) -> Result<Scene, String> {
    let file = sound();
    let mut json = file.json();
    change(&mut json);
    let scene = gltf::read_glb(&pack(&json.to_string(), file.binary()), None).map_err(|error| error.to_string())?;
    match scene.mistakes.first() {
        Some(mistake) => Err(mistake.rsplit_once(", so ").map_or(mistake.as_str(), |(mistake, _)| mistake).to_owned()),
        None => Ok(scene),
    }
}

fn loaded(change: impl FnOnce(&mut Value)) -> Scene {
    read(change).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn what_is_not_drawn_is_noted() {
    let scene = loaded(|json| {
        let primitive = &mut json["meshes"][0]["primitives"][0];
        primitive["attributes"]["COLOR_0"] = json!(1);
        primitive["targets"] = json!([{"POSITION": 0}]);
        json["materials"][0]["emissiveFactor"] = json!([1, 1, 1]);
        json["materials"][0]["emissiveTexture"] = json!({"index": 0});
        json["materials"][0]["normalTexture"] = json!({"index": 0, "scale": 2.0});
        json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
            json!({"KHR_texture_transform": {"offset": [0.5, 0.5]}});
        let lines = json!({"attributes": {"POSITION": 0}, "mode": 1});
        json["meshes"][0]["primitives"].as_array_mut().expect("a list").push(lines);
        json["animations"] = json!([{}]);
    });
    assert_eq!(scene.materials[0].emissive, [0.0; 3]);
    assert_eq!(
        scene.notes,
        [
            "animations are ignored",
            "material 0: its emissive texture is not supported, so it gives no light of its own",
            "material 0: its normal texture is ignored",
            "material 0: the transform of its base colour texture is ignored",
            "mesh 0, primitive 0: morph targets are ignored",
            "mesh 0, primitive 0: vertex colours are ignored",
            "mesh 0, primitive 1: points and lines are not drawn",
        ]
    );
}

#[test]
fn every_extension_that_is_not_known_is_noted_once_with_what_uses_it() {
    let scene = loaded(|json| {
        let unlit = json!({"KHR_materials_unlit": {}});
        json["materials"][0]["extensions"] = json!({
            "KHR_materials_unlit": {}, "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_emissive_strength": {"emissiveStrength": 2},
        });
        for _ in 0..3 {
            let same = json!({"extensions": unlit.clone(), "pbrMetallicRoughness": {"metallicFactor": 0}});
            json["materials"].as_array_mut().expect("a list").push(same);
        }
        json["nodes"][0]["extensions"] =
            json!({"EXT_mesh_gpu_instancing": {"attributes": {}}, "KHR_node_visibility": {"visible": false}});
        json["textures"][0]["extensions"] = json!({"KHR_texture_basisu": {"source": 0}});
        json["extensions"] = json!({"KHR_lights_punctual": {"lights": []}, "EXT_root": {}});
        json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_unlit", "EXT_listed\u{1b}"]);
        json["asset"]["extras"] = json!({"extensions": {"NOT_one": {}}});
        json["nodes"][0]["extras"] = json!({"extensions": {"NOT_one": {}}});
    });
    let note = |what: &str| format!("the extension {what}");
    assert_eq!(
        scene.notes,
        [
            note("`EXT_listed\\u{1b}` is not supported, and ignored"),
            note("`EXT_mesh_gpu_instancing` is not supported, and ignored (node 0)"),
            note("`EXT_root` is not supported, and ignored (the file)"),
            note("`KHR_materials_transmission` is not supported, and ignored (material 0)"),
            note("`KHR_materials_unlit` is not supported, and ignored (material 0 and 3 more)"),
            note("`KHR_node_visibility` is not supported, and ignored (node 0)"),
            note("`KHR_texture_basisu` is not supported, and ignored (texture 0)"),
        ]
    );
}

#[test]
fn a_texture_without_a_picture_that_can_be_read_is_noted() {
    let scene = loaded(|json| {
        json["textures"][0] = json!({"extensions": {"KHR_texture_basisu": {"source": 0}}});
    });
    assert_eq!(scene.materials[0].base_color_texture, None);
    assert_eq!(
        scene.notes,
        [
            "the extension `KHR_texture_basisu` is not supported, and ignored (texture 0)",
            "material 0: its base colour texture has no PNG or JPEG picture, so it is left out",
        ]
    );
}

#[test]
fn metallic_and_roughness_factors_are_noted_once_each() {
    let scene = loaded(|json| {
        json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = json!(0);
        json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.25);
        for _ in 0..2 {
            let metal = json!({"pbrMetallicRoughness": {"metallicFactor": 1.0, "roughnessFactor": 0.5}});
            json["materials"].as_array_mut().expect("a list").push(metal);
        }
    });
    assert_eq!(
        scene.notes,
        [
            "metallic factors, 1 where none is given, are ignored (material 1 and 1 more)",
            "roughness factors are ignored (material 0 and 2 more)",
        ]
    );
}

/// glTF 2.0, section 5.22: a metallic factor that is left out is 1.
#[test]
fn a_material_that_gives_no_metallic_factor_is_a_metal_and_noted_like_one() {
    let noted = |materials: Value| loaded(|json| json["materials"] = materials).notes;
    let none = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}});
    let zero = json!({"pbrMetallicRoughness": {"metallicFactor": 0.0}});
    let metals = "metallic factors, 1 where none is given, are ignored";
    assert_eq!(noted(json!([zero, none])), [format!("{metals} (material 1)")]);
    assert_eq!(
        noted(json!([{}, zero, none, {"pbrMetallicRoughness": {}}])),
        [format!("{metals} (material 0 and 2 more)")]
    );
    assert_eq!(noted(json!([zero, zero])), [""; 0]);
}

#[test]
fn a_whole_number_may_be_written_with_a_point() {
    let pointed = |value: &mut Value| {
        fn all(value: &mut Value) {
            match value {
                Value::Number(number) => *value = json!(number.as_f64().expect("a number")),
                Value::Array(values) => values.iter_mut().for_each(all),
                Value::Object(members) => members.values_mut().for_each(all),
                _ => {}
            }
        }
        all(value);
        assert!(value.to_string().contains("\"scene\":0.0"), "{value}");
    };
    assert!(loaded(pointed) == loaded(|_| {}), "the same scene");
    let half = read(|json| json["accessors"][0]["count"] = json!(3.5));
    let expected = "accessor 0: count: invalid type: floating point `3.5`, expected a whole number, 0 or more";
    assert_eq!(half.err().as_deref(), Some(expected));
}

#[test]
fn mistakes_in_json_are_named_by_their_field() {
    type Lie = fn(&mut Value);
    let cases: [(Lie, &str); 5] = [
        (
            |json| json["accessors"][0]["sparse"] = json!({"count": 1, "indices": {"bufferView": "4"}, "values": {}}),
            "accessor 0: sparse.indices.bufferView: invalid type: string \"4\", expected a whole number, 0 or more",
        ),
        (
            |json| json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([1, 1, "white", 1]),
            "material 0: pbrMetallicRoughness.baseColorFactor[2]: invalid type: string \"white\", expected a number",
        ),
        (|json| json["meshes"][0]["primitives"] = json!({}), "mesh 0: primitives: invalid type: map, expected a list"),
        (|json| json["scene"] = json!(-1), "scene: invalid value: integer `-1`, expected a whole number, 0 or more"),
        (
            |json| json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": 5}]}}),
            "light 0: type: invalid type: integer `5`, expected a string",
        ),
    ];
    for (lie, expected) in cases {
        assert_eq!(read(lie).err().as_deref(), Some(expected));
    }
    let list = read(|json| json["asset"]["version"] = json!(2)).err().unwrap_or_default();
    assert!(list.starts_with("asset.version: invalid type: integer `2`, expected a string at line 1"), "{list}");
    let nodes = read(|json| json["nodes"] = json!({})).err().unwrap_or_default();
    assert!(nodes.starts_with("nodes: invalid type: map, expected a list at line 1"), "{nodes}");
}

#[test]
fn gltf_1_is_named_before_anything_else_in_it() {
    let old = gltf::read_json(br#"{"asset": {"version": "1.0"}, "accessors": {}}"#, None);
    let said = old.err().map(|error| error.to_string());
    assert_eq!(said.as_deref(), Some("glTF version `1.0` is not supported; only 2.x is"));
}

#[test]
fn a_scene_that_lists_a_child_draws_it_once_where_its_parent_places_it() {
    let nodes = json!([{"children": [1, 2], "translation": [5, 0, 0]}, {"mesh": 0}, {"mesh": 0, "name": "other"}]);
    let places = |scene: &Scene| -> Vec<DVec3> {
        scene.objects.iter().map(|object| object.transform.w_axis.truncate()).collect()
    };
    let inner = "it lists node 1, a child of node 0, which is drawn once, where its parent places it";
    for (listed, drawn) in [(json!([1]), 1), (json!([0, 1]), 2), (json!([1, 0]), 2)] {
        let scene = loaded(|json| {
            json["nodes"] = nodes.clone();
            json["scenes"][0]["nodes"] = listed.clone();
        });
        assert_eq!(scene.notes, [format!("scene 0: {inner}")], "{listed}");
        assert_eq!(places(&scene), vec![DVec3::new(5.0, 0.0, 0.0); drawn], "{listed}");
    }
    let twice = loaded(|json| json["scenes"][0]["nodes"] = json!([0, 0]));
    assert_eq!(twice.notes, ["scene 0: it lists node 0 twice, which is drawn once"]);
    assert_eq!(twice.objects.len(), 1);
}

#[test]
fn a_picture_is_decoded_once_however_many_textures_show_it() {
    let scene = loaded(|json| {
        for number in 1..1000 {
            let clamped = json!({"sampler": number % 2, "source": 0});
            json["textures"].as_array_mut().expect("a list").push(clamped);
            let pbr = json!({"baseColorTexture": {"index": number}});
            json["materials"].as_array_mut().expect("a list").push(json!({"pbrMetallicRoughness": pbr}));
        }
        json["samplers"].as_array_mut().expect("a list").push(json!({"wrapS": 33071}));
    });
    let [repeated, clamped] = &scene.textures[..] else { panic!("{} textures", scene.textures.len()) };
    assert_eq!([repeated.sampler.wrap_u, clamped.sampler.wrap_u], [Wrap::Repeat, Wrap::ClampToEdge]);
    assert!(Arc::ptr_eq(&repeated.rgba8, &clamped.rgba8), "both show the same texels");
    let used: Vec<_> = scene.materials[..4].iter().map(|material| material.base_color_texture).collect();
    assert_eq!(used, [Some(0), Some(1), Some(0), Some(1)]);
}
