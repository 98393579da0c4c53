//! Lying, truncated and absurd GLB files: each gives one sentence that names what is wrong, and nothing panics.

use crate::scene::fixtures::shapes::square;
use crate::scene::fixtures::{
    builder::{Builder, pack},
    png,
};
use framewright_passes::scene::{gltf, limits};
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

fn verdict(bytes: &[u8]) -> String {
    gltf::read_glb(bytes, None).map_or_else(|error| error.to_string(), |_| "it loads".to_owned())
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
    assert_eq!(nothing, "the file holds no triangles to draw");
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

#[test]
fn counts_that_multiply_are_bounded() {
    // Zeros that the file needn't hold, used again and again.
    let many = said(|json| {
        json["accessors"][0] = json!({"componentType": 5126, "count": 3_000_000, "type": "VEC3"});
        let primitive = json!({"attributes": {"POSITION": 0}, "mode": 6, "indices": 3});
        json["meshes"][0]["primitives"] = json!(vec![primitive; 3]);
    });
    assert_eq!(many, "it loads", "flat shading leaves the corners only");
    let many = said(|json| {
        json["accessors"][0] = json!({"componentType": 5126, "count": 9_000_000, "type": "VEC3"});
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
