//! Lying, truncated and absurd GLB files: each gives one sentence that names what is wrong, and nothing panics. A mistake in a part of the
//! file leaves out that part; others leave no scene.

use crate::scene::fixtures::shapes::square;
use crate::scene::fixtures::{
    builder::{Builder, pack},
    png,
};
use framewright_passes::scene::{Scene, gltf, limits};
use serde_json::{Value, json};

/// Makes a file's JSON say something false.
type Lie = fn(&mut Value);

/// One textured square: accessor 0 holds positions, 1 normals, 2 texture coordinates, 3 indices.
pub(crate) fn sound() -> Builder {
    let mut file = Builder::default();
    let picture = image::RgbaImage::from_pixel(1, 1, image::Rgba([255, 0, 0, 255]));
    let texture = file.texture("dot", "image/png", &png(&picture), json!({}));
    let pbr = json!({"baseColorTexture": {"index": texture}});
    let material = file.material(json!({"name": "red", "pbrMetallicRoughness": pbr}));
    let primitive = file.primitive(&square(), Some(material));
    let mesh = file.mesh("square", vec![primitive]);
    file.root(json!({"mesh": mesh, "name": "square"}));
    file
}

/// The reader's answer to the file after `lie` has changed its JSON.
fn said(lie: impl FnOnce(&mut Value)) -> String {
    let file = sound();
    let mut json = file.json();
    lie(&mut json);
    verdict(&pack(&json.to_string(), file.binary()))
}

/// The first mistake, without what was left out because of it.
fn verdict(bytes: &[u8]) -> String {
    let scene = match gltf::read_glb(bytes, None) {
        Ok(scene) => scene,
        Err(error) => return error.to_string(),
    };
    let mistake = scene.mistakes.first().map_or("it loads", String::as_str);
    mistake.rsplit_once(", so ").map_or(mistake, |(mistake, _)| mistake).to_owned()
}

/// A textured square as in [`sound`], and another one that shares nothing with it.
fn two() -> Value {
    let mut file = sound();
    let primitive = file.primitive(&square(), None);
    let mesh = file.mesh("other", vec![primitive]);
    file.root(json!({"mesh": mesh, "name": "other"}));
    file.json()
}

/// The scene of the file after `lie` has changed its JSON.
fn with(lie: impl FnOnce(&mut Value)) -> Scene {
    let mut file = sound();
    let primitive = file.primitive(&square(), None);
    file.mesh("other", vec![primitive]);
    let mut json = two();
    lie(&mut json);
    gltf::read_glb(&pack(&json.to_string(), file.binary()), None).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_bad_part_is_left_out_with_a_note_and_all_else_is_drawn() {
    let whole = with(|_| {});
    assert_eq!((whole.objects.len(), whole.textures.len(), &*whole.mistakes), (2, 1, &[][..]));
    let camera = json!([{"perspective": {"yfov": 1.0, "znear": 0.0}, "type": "perspective"}]);
    // What is changed, how many objects and textures are left, and the end of the first note.
    type Case<'c> = (&'c str, &'c dyn Fn(&mut Value), usize, usize, &'c str);
    let cases: [Case<'_>; 23] = [
        (
            "stride 0",
            &|json| json["bufferViews"][1]["byteStride"] = json!(0),
            1,
            1,
            "so mesh 0, primitive 0 is left out",
        ),
        (
            "stride 2",
            &|json| json["bufferViews"][4]["byteStride"] = json!(2),
            1,
            1,
            "so mesh 0, primitive 0 is left out",
        ),
        ("seven corners", &|json| json["accessors"][3]["count"] = json!(5), 1, 1, "whole triangles, so it is left out"),
        (
            "a primitive that is none",
            &|json| json["meshes"][0]["primitives"][0] = json!(7),
            1,
            1,
            "primitive 0: invalid type: integer `7`, expected an object, so it is left out",
        ),
        ("a mesh that is none", &|json| json["meshes"][0] = json!({"name": 3}), 1, 1, "so it is left out"),
        ("no such mesh", &|json| json["nodes"][0]["mesh"] = json!(9), 1, 1, "only 2, so its mesh is left out"),
        ("an accessor", &|json| json["accessors"][0] = json!({}), 1, 1, "so it is left out"),
        ("an accessor that nothing uses", &|json| push(json, "accessors", json!([])), 2, 1, "so it is left out"),
        ("a buffer view", &|json| json["bufferViews"][1] = json!({"buffer": "a"}), 1, 1, "so it is left out"),
        ("a material", &|json| json["materials"][0]["name"] = json!(3), 2, 0, "so it is left out"),
        (
            "no such material",
            &|json| json["meshes"][0]["primitives"][0]["material"] = json!(5),
            2,
            1,
            "so a white one stands in its place",
        ),
        ("an alpha mode", &|json| json["materials"][0]["alphaMode"] = json!("X"), 2, 1, "so it is taken as OPAQUE"),
        ("a texture", &|json| json["textures"][0]["source"] = json!([]), 2, 0, "so it is left out"),
        (
            "an image",
            &|json| json["bufferViews"][0]["byteLength"] = json!(9),
            2,
            0,
            "so the base colour texture of material 0 is left out",
        ),
        (
            "a sampler",
            &|json| json["samplers"][0]["magFilter"] = json!(2),
            2,
            1,
            "so a usual sampler stands in its place",
        ),
        (
            "a camera",
            &|json| {
                json["cameras"] = camera.clone();
                json["nodes"][0]["camera"] = json!(0);
            },
            2,
            1,
            "expected 1e-6 to 1e9 m, so it is left out",
        ),
        ("no such camera", &|json| json["nodes"][0]["camera"] = json!(0), 2, 1, "so camera 0 is left out"),
        (
            "a light",
            &|json| {
                json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "sun"}]}});
                json["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
            },
            2,
            1,
            "so it is left out",
        ),
        (
            "rotation 0",
            &|json| json["nodes"][0]["rotation"] = json!([0, 0, 0, 0]),
            1,
            1,
            "so it and what is below it are left out",
        ),
        (
            "a matrix and a translation",
            &|json| {
                json["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
                json["nodes"][0]["translation"] = json!([0, 0, 0]);
            },
            1,
            1,
            "so it and what is below it are left out",
        ),
        (
            "a node that is none, with a child",
            &|json| {
                json["nodes"][0] = json!({"name": 3, "children": [2]});
                push(json, "nodes", json!({"mesh": 0}));
                json.as_object_mut().map(|json| (json.remove("scenes"), json.remove("scene")));
            },
            1,
            1,
            "so it and what is below it are left out",
        ),
        ("a scene's node", &|json| push(&mut json["scenes"][0], "nodes", json!(9)), 2, 1, "so that node is left out"),
        ("no such scene", &|json| json["scene"] = json!(4), 2, 1, "so all nodes are shown"),
    ];
    for (what, lie, objects, textures, note) in cases {
        let scene = with(lie);
        assert_eq!((scene.objects.len(), scene.textures.len()), (objects, textures), "{what}: {:?}", scene.mistakes);
        let first = scene.mistakes.first().map_or("", String::as_str);
        assert!(first.ends_with(note), "{what}: {first}");
        let other = scene.objects.iter().find(|object| object.name == "other").expect(what);
        assert_eq!(scene.meshes[other.mesh], whole.meshes[1], "{what}");
    }
    // What isn't drawn anyway can't be wrong.
    let ignored = with(|json| {
        json["nodes"][0]["skin"] = json!("a");
        json["animations"] = json!({"channels": 3});
        json["skins"] = json!(8);
        json["materials"][0]["normalTexture"] = json!({"index": "a"});
    });
    assert_eq!((ignored.objects.len(), &*ignored.mistakes), (2, &[][..]));
    assert_eq!(ignored.notes.len(), whole.notes.len() + 3, "{:?}", ignored.notes);
}

fn push(json: &mut Value, list: &str, element: Value) {
    json[list].as_array_mut().expect("a list").push(element);
}

#[test]
fn a_factor_out_of_range_is_taken_as_the_nearest_that_is_right() {
    let material = |factors: Value| {
        let scene = with(|json| json["materials"][0] = factors);
        (scene.materials[0].clone(), scene.mistakes)
    };
    let (hair, mistakes) = material(json!({"pbrMetallicRoughness": {"baseColorFactor": [1.000_000_1, 0.5, -0.5, 1]}}));
    assert_eq!(hair.base_color, [1.0, 0.5, 0.0, 1.0]);
    let said = "material 0: a base colour factor is";
    let expected = [("1.0000001", "1"), ("-0.5", "0")]
        .map(|(is, taken)| format!("{said} {is}; expected 0 to 1, so it is taken as {taken}"));
    assert_eq!(mistakes, expected);
    let strength = json!({"KHR_materials_emissive_strength": {"emissiveStrength": 2}});
    let (three, mistakes) = material(json!({"emissiveFactor": [3.0, 0.5, 0], "extensions": strength}));
    assert_eq!(three.emissive, [2.0, 1.0, 0.0]);
    assert_eq!(mistakes, ["material 0: an emissive factor is 3; expected 0 to 1, so it is taken as 1"]);
    let (_, mistakes) = material(json!({"alphaMode": "MASK", "alphaCutoff": -1}));
    assert_eq!(mistakes, ["material 0: the alpha cut-off is -1; expected 0 to 1e9, so it is taken as 0"]);
}

#[test]
fn a_file_with_nothing_to_draw_says_so() {
    const NOTHING: &str = "there is nothing to draw: no triangle of the file has an area";
    // As files with compressed meshes have it, of which one needn't say that it requires the extension.
    let compressed = with(|json| {
        for accessor in json["accessors"].as_array_mut().expect("a list") {
            accessor.as_object_mut().map(|accessor| accessor.remove("bufferView"));
        }
        for mesh in json["meshes"].as_array_mut().expect("a list") {
            mesh["primitives"][0]["extensions"] = json!({"KHR_draco_mesh_compression": {"bufferView": 0}});
        }
    });
    assert!(compressed.objects.is_empty());
    let reason = "it has neither a buffer view nor sparse values: they may stand in an extension that is not supported";
    assert_eq!(compressed.mistakes[0], format!("accessor 0: {reason}, so mesh 0, primitive 0 is left out"));
    assert_eq!(compressed.mistakes.last().map(String::as_str), Some(NOTHING));
    // One mesh of two is drawn.
    let half = with(|json| _ = json["accessors"][0].as_object_mut().map(|it| it.remove("bufferView")));
    assert_eq!((half.objects.len(), half.mistakes.len()), (1, 1), "{:?}", half.mistakes);
    type Lie = fn(&mut Value);
    let nothing: [Lie; 4] = [
        |json| json["nodes"] = json!([{}]),
        |json| json["meshes"] = json!([{"primitives": []}, {"primitives": []}]),
        |json| json["nodes"] = json!([{"mesh": 0, "scale": [0, 0, 0]}, {"mesh": 1, "scale": [1, 0, 1]}]),
        // All corners are one.
        |json| {
            for primitive in [0, 1] {
                let indices =
                    json["meshes"][primitive]["primitives"][0]["indices"].as_u64().expect("a number") as usize;
                json["accessors"][indices]["count"] = json!(1);
                json["meshes"][primitive]["primitives"][0]["mode"] = json!(4);
                json["accessors"][indices]["sparse"] = Value::Null;
            }
        },
    ];
    for (number, lie) in nothing.into_iter().enumerate() {
        let scene = with(lie);
        assert_eq!(scene.mistakes.last().map(String::as_str), Some(NOTHING), "{number}");
        assert!(scene.camera.transform.is_finite());
    }
}

#[test]
fn padding_of_zeros_and_a_byte_order_mark_are_no_part_of_the_json() {
    let (json, binary) = (sound().json().to_string(), sound().binary().to_vec());
    let scene = gltf::read_glb(&pack(&json, &binary), None).expect("it loads");
    for padded in [format!("{json}\0\0\0\0"), format!("\u{feff}{json}"), format!("\u{feff}{json}\0\0\0\0\0\0\0\0")] {
        assert_eq!(gltf::read_glb(&pack(&padded, &binary), None).as_ref(), Ok(&scene));
    }
    let marked = format!("\u{feff}{}", json!({"asset": {"version": "2.0"}, "nodes": [], "meshes": []}));
    assert!(gltf::read_json(marked.as_bytes(), None).is_ok());
    let utf16: Vec<u8> = marked.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let said = gltf::read_json(&utf16, None).expect_err("another encoding").to_string();
    assert_eq!(said, "this is no JSON: it is UTF-16: save it as UTF-8");
}

#[test]
fn bytes_that_are_read_in_vain_are_bounded() {
    let many = with(|json| {
        json["accessors"][0] = zeros(10_000_000);
        json["meshes"][0]["primitives"][0]["mode"] = json!(9);
    });
    assert_eq!(many.mistakes.len(), 1, "the mode is looked at first");
    let mut json = two();
    json["accessors"][0] = zeros(10_000_000);
    // Its normals are too few.
    let primitive = json["meshes"][0]["primitives"][0].clone();
    json["meshes"][0]["primitives"] = json!(vec![primitive; 1000]);
    let mut file = sound();
    file.primitive(&square(), None);
    let error = gltf::read_glb(&pack(&json.to_string(), file.binary()), None).expect_err("too much").to_string();
    assert!(error.contains("bytes of what is left out: "), "{error}");
}

#[test]
fn the_sound_file_loads() {
    assert_eq!(said(|_| {}), "it loads");
}

#[test]
fn containers_that_are_not_glb() {
    let sound = sound().finish();
    assert_eq!(verdict(b""), "this is not a GLB file: it doesn't begin with `glTF`");
    assert_eq!(verdict(b"\x89PNG\r\n"), "this is not a GLB file: it doesn't begin with `glTF`");
    assert_eq!(verdict(b"glTF\x02"), "the file is cut short: it has 5 bytes and says that it has 12");
    let mut old = sound.clone();
    old[4] = 1;
    assert_eq!(verdict(&old), "version 1 of GLB is not supported; only version 2 is");
    let cut = &sound[..sound.len() - 40];
    let (has, says) = (cut.len(), sound.len());
    assert_eq!(verdict(cut), format!("the file is cut short: it has {has} bytes and says that it has {says}"));
    let mut long = sound.clone();
    long[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    let left = sound.len() - 20;
    let expected = format!("JSON chunk: says that it has 4294967295 bytes, but only {left} are left in the file");
    assert_eq!(verdict(&long), expected);
    let mut kind = sound.clone();
    kind[16..20].copy_from_slice(b"BIN\0");
    assert_eq!(verdict(&kind), "the first chunk is not JSON");
    let mut text = sound;
    text[20] = 0xff;
    assert_eq!(verdict(&text), "the JSON is not UTF-8");
}

#[test]
fn json_that_is_not_gltf() {
    assert_eq!(verdict(&pack("[]", &[])), "invalid length 0, expected a glTF object at line 1 column 2");
    assert_eq!(verdict(&pack("{", &[])), "EOF while parsing an object at line 1 column 4");
    assert_eq!(verdict(&pack("{}", &[])), "missing field `asset` at line 1 column 2");
    let deep = format!("{{\"asset\": {{\"version\": \"2.0\"}}, \"nodes\": {}", "[".repeat(100_000));
    assert!(verdict(&pack(&deep, &[])).starts_with("nodes: EOF while parsing"), "{}", verdict(&pack(&deep, &[])));
    assert_eq!(
        said(|json| json["asset"]["version"] = json!("1.\u{7}")),
        "glTF version `1.\\u{7}` is not supported; only 2.x is"
    );
    let missing = "accessor 1: missing field `count`";
    assert_eq!(said(|json| _ = json["accessors"][1].as_object_mut().map(|it| it.remove("count"))), missing);
    let negative = "accessor 1: count: invalid value: integer `-1`, expected a whole number, 0 or more";
    assert_eq!(said(|json| json["accessors"][1]["count"] = json!(-1)), negative);
    let required = "the file requires the extension `KHR_draco_mesh_compression`, which is not supported";
    assert_eq!(said(|json| json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"])), required);
}

#[test]
fn references_that_lead_nowhere() {
    let cases: [(Lie, &str); 12] = [
        (|json| json["scene"] = json!(7), "refers to scene 7, but there are only 1"),
        (|json| json["scenes"][0]["nodes"] = json!([9]), "scene 0: refers to node 9, but there are only 1"),
        (
            |json| json["nodes"][0]["mesh"] = json!(4_294_967_296u64),
            "node 0: refers to mesh 4294967296, but there are only 1",
        ),
        (|json| json["nodes"][0]["children"] = json!([5]), "node 0: refers to node 5, but there are only 1"),
        (|json| json["nodes"][0]["camera"] = json!(0), "node 0: refers to camera 0, but there are only 0"),
        (
            |json| json["meshes"][0]["primitives"][0]["material"] = json!(3),
            "mesh 0, primitive 0: refers to material 3, but there are only 1",
        ),
        (
            |json| json["meshes"][0]["primitives"][0]["indices"] = json!(44),
            "mesh 0, primitive 0: refers to accessor 44, but there are only 4",
        ),
        (
            |json| json["accessors"][0]["bufferView"] = json!(77),
            "accessor 0: refers to buffer view 77, but there are only 5",
        ),
        (|json| json["bufferViews"][1]["buffer"] = json!(1), "buffer view 1: refers to buffer 1, but there are only 1"),
        (
            |json| json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = json!(2),
            "material 0: refers to texture 2, but there are only 1",
        ),
        (|json| json["textures"][0]["source"] = json!(6), "texture 0: refers to image 6, but there are only 1"),
        (|json| json["textures"][0]["sampler"] = json!(6), "texture 0: refers to sampler 6, but there are only 1"),
    ];
    for (lie, expected) in cases {
        assert_eq!(said(lie), expected);
    }
}

#[test]
fn ranges_outside_the_data() {
    let binary = sound().binary().len();
    let image = said(|json| json["bufferViews"][0]["byteLength"] = json!(u64::MAX));
    assert_eq!(image, format!("buffer view 0: bytes 0 to {} are outside buffer 0, which has {binary}", u64::MAX));
    let offset = said(|json| json["bufferViews"][1]["byteOffset"] = json!(1_000_000));
    assert_eq!(offset, format!("buffer view 1: bytes 1000000 to 1000048 are outside buffer 0, which has {binary}"));
    let buffer = said(|json| json["buffers"][0]["byteLength"] = json!(1_000_000));
    assert_eq!(
        buffer,
        format!("buffer 0: bytes 0 to 1000000 are outside the binary chunk, which has {}", binary.next_multiple_of(4))
    );
    let count = said(|json| json["accessors"][0]["count"] = json!(5));
    assert_eq!(count, "accessor 0: bytes 0 to 60 are outside buffer view 1, which has 48");
    let far = said(|json| json["accessors"][0]["byteOffset"] = json!(u64::MAX));
    assert_eq!(far, format!("accessor 0: bytes {} to {0} are outside buffer view 1, which has 48", u64::MAX));
    let absurd = said(|json| json["accessors"][0]["count"] = json!(1_000_000_000));
    assert_eq!(absurd, "accessor 0: bytes: 12000000000; at most 536870912 is allowed");
    let stride = said(|json| json["bufferViews"][1]["byteStride"] = json!(8));
    let expected = "a stride of 8 bytes doesn't fit elements of 12 bytes; 4 to 252, and no less than an element";
    assert_eq!(stride, format!("buffer view 1: {expected}"));
    assert_eq!(said(|json| json["accessors"][0]["count"] = json!(0)), "accessor 0: it holds no elements");
}

#[test]
fn data_outside_the_file() {
    let uri = said(|json| json["buffers"][0]["uri"] = json!("mesh.bin"));
    assert_eq!(uri, "buffer 0: its data stands in another file (`mesh.bin`), and only this one is read");
    let image = said(|json| json["images"][0]["uri"] = json!("\u{1b}[31mred.png"));
    let expected = "its data stands in another file (`\\u{1b}[31mred.png`), and only this one is read";
    assert_eq!(image, format!("image 0: {expected}"));
    let mut json = sound().json();
    json["images"] = json!([{}]);
    let nothing = "image 0: it has no data: it names no file, and only the first buffer can be the file's binary chunk, and only if there is one";
    assert_eq!(verdict(&pack(&json.to_string(), sound().binary())), nothing);
}

#[test]
fn elements_of_the_wrong_type() {
    let cases: [(Lie, &str); 8] = [
        (
            |json| json["accessors"][0]["type"] = json!("VEC2"),
            "accessor 0: positions are VEC2 of component type 5126, which is not supported; expected VEC3 of 32-bit floats",
        ),
        (
            |json| json["accessors"][1]["componentType"] = json!(5120),
            "accessor 1: normals are VEC3 of component type 5120, which is not supported; expected VEC3 of 32-bit floats",
        ),
        (
            |json| json["accessors"][2]["componentType"] = json!(5123),
            "accessor 2: texture coordinates are VEC2 of component type 5123, which is not supported; expected VEC2 of \
             32-bit floats, or normalised 8-bit or 16-bit unsigned integers",
        ),
        (
            |json| {
                json["accessors"][3]["componentType"] = json!(5126);
                json["accessors"][3]["count"] = json!(1);
            },
            "accessor 3: indices are SCALAR of component type 5126, which is not supported; expected SCALAR of 8, 16 or \
             32-bit unsigned integers",
        ),
        (
            |json| json["accessors"][0]["componentType"] = json!(5124),
            "accessor 0: component type `5124` is not known; expected 5120, 5121, 5122, 5123, 5125 or 5126",
        ),
        (
            |json| json["accessors"][0]["type"] = json!("VEC\n3"),
            "accessor 0: type `VEC\\n3` is not known; expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4",
        ),
        (
            |json| json["meshes"][0]["primitives"][0]["mode"] = json!(9),
            "mesh 0, primitive 0: mode `9` is not known; expected 0 to 6",
        ),
        (
            |json| json["samplers"][0]["wrapS"] = json!(1),
            "sampler 0: wrap mode `1` is not known; expected 10497, 33071 or 33648",
        ),
    ];
    for (lie, expected) in cases {
        // Too few bytes for a wider type would be the first thing to say.
        let roomy = |json: &mut Value| {
            lie(json);
            json["accessors"][3]["byteOffset"] = json!(0);
        };
        assert_eq!(said(roomy), expected);
    }
}

#[test]
fn meshes_that_do_not_hang_together() {
    let attribute = |name: &str| {
        let name = name.to_owned();
        move |json: &mut Value| {
            json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().map(|it| it.remove(&name));
        }
    };
    assert_eq!(said(attribute("POSITION")), "mesh 0, primitive 0: it has no POSITION attribute");
    assert_eq!(said(|json| json["accessors"][1]["count"] = json!(3)), "accessor 1: it has 3 elements for 4 vertices");
    let corners = said(|json| json["accessors"][3]["count"] = json!(5));
    assert_eq!(corners, "mesh 0, primitive 0: 5 corners don't make whole triangles");
    let vertices = said(|json| json["accessors"][0]["count"] = json!(3));
    assert_eq!(vertices, "accessor 3: index number 5 is 3, but there are only 3 vertices");
    let nothing = said(|json| _ = json["nodes"][0].as_object_mut().map(|it| it.remove("mesh")));
    assert_eq!(nothing, "there is nothing to draw: no triangle of the file has an area");
}

#[test]
fn numbers_that_are_not_finite_or_out_of_range() {
    let file = sound();
    let json = file.json();
    let offset = json["bufferViews"][1]["byteOffset"].as_u64().expect("a number") as usize;
    let mut binary = file.binary().to_vec();
    binary[offset..offset + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    let nan = verdict(&pack(&json.to_string(), &binary));
    assert_eq!(nan, "accessor 0: positions hold a number that is not finite");
    binary[offset..offset + 4].copy_from_slice(&1e30f32.to_le_bytes());
    let far = verdict(&pack(&json.to_string(), &binary));
    let expected = "node 0: its place in the world is [-0.5, -0.5, 0.0] to [1e30, 0.5, 0.0]; expected at most 1e9 m";
    assert_eq!(far, expected);
    let cases: [(Lie, &str); 9] = [
        (
            |json| json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 2.0, 0.0, 1.0]),
            "material 0: a base colour factor is 2; expected 0 to 1",
        ),
        (
            |json| json["materials"][0]["emissiveFactor"] = json!([0.0, -1.0, 0.0]),
            "material 0: an emissive factor is -1; expected 0 to 1",
        ),
        (
            |json| {
                json["materials"][0]["extensions"] =
                    json!({"KHR_materials_emissive_strength": {"emissiveStrength": 1e12}});
            },
            "material 0: the emissive strength is 1000000000000; expected 0 to 1e9",
        ),
        (
            |json| json["materials"][0]["alphaMode"] = json!("GLASS"),
            "material 0: alpha mode `GLASS` is not known; expected OPAQUE, MASK or BLEND",
        ),
        (
            |json| json["nodes"][0]["rotation"] = json!([0.0, 0.0, 0.0, 0.0]),
            "node 0: its rotation is [0.0, 0.0, 0.0, 0.0]; expected a unit quaternion",
        ),
        (
            |json| json["nodes"][0]["scale"] = json!([1e10, 1e10, 1]),
            "node 0: its place in the world is [-5000000000.0, -5000000000.0, 0.0] to [5000000000.0, 5000000000.0, 0.0]; expected at most 1e9 m",
        ),
        (
            |json| {
                json["cameras"] = json!([{"perspective": {"yfov": 4.0, "znear": 0.1}, "type": "perspective"}]);
                json["nodes"][0]["camera"] = json!(0);
            },
            "camera 0: the vertical field of view is 4; expected 1e-4 to 3.1 radians",
        ),
        (
            |json| {
                json["cameras"] = json!([{"perspective": {"yfov": 1.0, "znear": 0.0}, "type": "perspective"}]);
                json["nodes"][0]["camera"] = json!(0);
            },
            "camera 0: the near distance is 0; expected 1e-6 to 1e9 m",
        ),
        (
            |json| {
                let perspective = json!({"yfov": 1.0, "znear": 0.1, "zfar": 0.1});
                json["cameras"] = json!([{"perspective": perspective, "type": "perspective"}]);
                json["nodes"][0]["camera"] = json!(0);
            },
            "camera 0: the far distance is 0.1; expected more than the near distance",
        ),
    ];
    for (lie, expected) in cases {
        assert_eq!(said(lie), expected);
    }
}

#[test]
fn nodes_that_make_no_tree() {
    let own = said(|json| json["nodes"][0]["children"] = json!([0]));
    assert_eq!(own, "node 0: it is its own ancestor");
    let circle = said(|json| {
        json["nodes"] = json!([{"children": [1]}, {"children": [2]}, {"children": [0]}]);
    });
    assert_eq!(circle, "node 0: it is its own ancestor");
    let shared = said(|json| json["nodes"] = json!([{"children": [2]}, {"children": [2]}, {"mesh": 0}]));
    assert_eq!(shared, "node 2: it is a child of both node 0 and node 1");
    let both = said(|json| {
        json["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
        json["nodes"][0]["scale"] = json!([1, 1, 1]);
    });
    assert_eq!(both, "node 0: it has both a matrix and a translation, rotation or scale");
    let projective =
        said(|json| json["nodes"][0]["matrix"] = json!([1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]));
    assert_eq!(projective, "node 0: its matrix is not affine: the last row must be 0 0 0 1");
}

#[test]
fn a_hundred_thousand_nested_nodes_are_walked() {
    let deep = said(|json| {
        let chain = (1..100_000).map(|child| json!({"children": [child]}));
        json["nodes"] = chain.chain([json!({"mesh": 0})]).collect();
    });
    assert_eq!(deep, "it loads");
}

#[test]
fn sparse_elements_out_of_place() {
    let lie = |count: u64, component: u32| {
        move |json: &mut Value| {
            // The indices' own bytes, 0 1 2 0 2 3, serve as places.
            json["accessors"][0]["sparse"] = json!({
                "count": count,
                "indices": {"bufferView": 4, "componentType": component},
                "values": {"bufferView": 1},
            });
        }
    };
    assert_eq!(said(lie(3, 5121)), "it loads");
    assert_eq!(said(lie(4, 5121)), "accessor 0: sparse index number 3 is 0; they must ascend and be less than 4");
    assert_eq!(said(lie(5, 5121)), "accessor 0: sparse elements: 5; at most 4 is allowed");
    assert_eq!(said(lie(0, 5121)), "accessor 0: it holds no elements");
    let kind = "component type of sparse indices `5126` is not known; expected 5121, 5123 or 5125";
    assert_eq!(said(lie(1, 5126)), format!("accessor 0: {kind}"));
    assert_eq!(said(lie(1, 5125)), "accessor 0: sparse index number 0 is 131328; they must ascend and be less than 4");
}

#[test]
fn images_that_are_none_or_too_large() {
    let kind = said(|json| json["images"][0]["bufferView"] = json!(1));
    assert_eq!(kind, "image 0: the image is neither PNG nor JPEG");
    let cut = said(|json| json["bufferViews"][0]["byteLength"] = json!(20));
    assert!(cut.starts_with("image 0: the image can't be decoded: "), "{cut}");
    // A PNG that says in its first chunk that it is 100,000 texels wide; the chunk's checksum is right.
    let mut lying = Builder::default();
    let header = [&b"IHDR"[..], &100_000u32.to_be_bytes(), &1u32.to_be_bytes(), &[8, 6, 0, 0, 0]].concat();
    let picture =
        [b"\x89PNG\r\n\x1a\n".as_slice(), &13u32.to_be_bytes(), &header, &crc32(&header).to_be_bytes()].concat();
    let texture =
        lying.texture("wide", "image/png", &[picture.as_slice(), b"\0\0\0\0IDAT\x35\xaf\x06\x1e"].concat(), json!({}));
    lying.material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}));
    let limit = limits::TEXTURE_SIDE;
    let expected = format!("image 0: texels along a side: 100000; at most {limit} is allowed");
    assert_eq!(verdict(&lying.finish()), expected);
}

/// The checksum of PNG chunks (ISO 3309).
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}

/// An accessor of positions that the file needn't hold, but for one.
fn zeros(count: u64) -> Value {
    let sparse = json!({"count": 1, "indices": {"bufferView": 4, "componentType": 5121}, "values": {"bufferView": 1}});
    json!({"componentType": 5126, "count": count, "type": "VEC3", "sparse": sparse})
}

#[test]
fn counts_that_multiply_are_bounded() {
    // Zeros that the file needn't hold, used again and again.
    let many = said(|json| {
        json["accessors"][0] = zeros(3_000_000);
        let primitive = json!({"attributes": {"POSITION": 0}, "mode": 6, "indices": 3});
        json["meshes"][0]["primitives"] = json!(vec![primitive; 3]);
    });
    let nothing = "there is nothing to draw: no triangle of the file has an area";
    assert_eq!(many, nothing, "flat shading leaves the corners only, and nearly all are one");
    let many = said(|json| {
        json["accessors"][0] = zeros(9_000_000);
        json["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": 0}, "mode": 5}]);
    });
    let expected = "vertices of all meshes up to here: 26999994; at most 16777216 is allowed";
    assert_eq!(many, format!("mesh 0, primitive 0: {expected}"));
    let lights = said(|json| {
        json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
        let lamp = json!({"extensions": {"KHR_lights_punctual": {"light": 0}}});
        let nodes = std::iter::once(json!({"mesh": 0})).chain(std::iter::repeat_n(lamp, 4097));
        json["nodes"] = nodes.collect();
        json["scenes"][0]["nodes"] = (0..4098).collect();
    });
    assert_eq!(lights, "point lights: 4097; at most 4096 is allowed");
}
