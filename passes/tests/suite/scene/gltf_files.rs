//! glTF whose data lie in other files or in URIs: the same scene as with everything in one file, and nothing from elsewhere.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use framewright_passes::scene::{Scene, load};
use percent_encoding::{NON_ALPHANUMERIC, utf8_percent_encode};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The fixtures, and the models where they are.
fn files() -> Vec<PathBuf> {
    let of = |folder: &str| fs::read_dir(repository(folder)).into_iter().flatten();
    let paths = of("tests/glb").chain(of("../shared/models")).map(|entry| entry.expect("an entry").path());
    paths.filter(|path| path.extension().is_some_and(|end| end == "glb")).collect()
}

/// The JSON and the binary chunk of a GLB file.
fn unpack(glb: &[u8]) -> (Value, Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().expect("four bytes")) as usize;
    let end = 20 + word(12);
    (serde_json::from_slice(&glb[20..end]).expect("JSON"), glb[end + 8..end + 8 + word(end)].to_vec())
}

/// The JSON with its binary chunk as buffer `uri`, and each picture behind an URI of its own, as `to_uri` gives one to bytes.
fn split(json: &mut Value, binary: &[u8], to_uri: &dyn Fn(&str, &[u8]) -> String) {
    json["buffers"][0]["uri"] = to_uri("geometry data.bin", binary).into();
    let views = json["bufferViews"].clone();
    for (number, image) in json.get_mut("images").and_then(Value::as_array_mut).into_iter().flatten().enumerate() {
        let view = &views[image["bufferView"].as_u64().expect("a view") as usize];
        let start = view["byteOffset"].as_u64().unwrap_or(0) as usize;
        let bytes = &binary[start..start + view["byteLength"].as_u64().expect("a length") as usize];
        let uri = to_uri(&format!("pictures/50% größe {number}.bin"), bytes);
        let image = image.as_object_mut().expect("an object");
        image.remove("bufferView");
        image.insert("uri".to_owned(), uri.into());
    }
}

fn loaded(path: &Path) -> Scene {
    load(path).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn what_is_split_into_files_is_the_same_scene() {
    let files = files();
    assert!(files.len() >= 8);
    for file in files {
        let (mut json, binary) = unpack(&fs::read(&file).expect("readable"));
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("pictures")).expect("a folder in it");
        split(&mut json, &binary, &|name, bytes| {
            fs::write(folder.path().join(name), bytes).expect("a file");
            utf8_percent_encode(name, NON_ALPHANUMERIC).to_string().replace("%2F", "/")
        });
        let path = folder.path().join("scene.gltf");
        fs::write(&path, json.to_string()).expect("a file");
        assert!(loaded(&path) == loaded(&file), "{} is another scene in pieces", file.display());
    }
}

#[test]
fn data_in_uris_are_the_same_scene() {
    for file in files() {
        let (mut json, binary) = unpack(&fs::read(&file).expect("readable"));
        split(&mut json, &binary, &|_, bytes| {
            // Without the padding at the end too, and in lines.
            let encoded = BASE64_STANDARD.encode(bytes);
            let lines: Vec<String> =
                encoded.as_bytes().chunks(76).map(|line| String::from_utf8_lossy(line).into()).collect();
            format!("data:application/octet-stream;base64,{}", lines.join("\n").trim_end_matches('='))
        });
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("scene.gltf");
        fs::write(&path, json.to_string()).expect("a file");
        assert!(loaded(&path) == loaded(&file), "{} is another scene in URIs", file.display());
    }
}

#[test]
fn a_glb_file_may_name_files_too_and_data_need_not_be_base64() {
    let triangle = "data:,%00%00%00%00%00%00%00%00%00%00%00%00%00%00%80%3F%00%00%00%00%00%00%00%00%00%00%00%00%00%00%80%3F%00%00%00%00";
    let folder = folder(&json!(triangle));
    assert_eq!(loaded(&folder.path().join("scene.gltf")).meshes[0].positions[1], [1.0, 0.0, 0.0]);
    let json = fs::read_to_string(folder.path().join("scene.gltf")).expect("readable");
    let glb = crate::scene::fixtures::builder::pack(&json.replace(triangle, "triangle.bin"), &[]);
    fs::write(folder.path().join("scene.glb"), glb).expect("a file");
    assert_eq!(loaded(&folder.path().join("scene.glb")).meshes[0].positions[2], [0.0, 1.0, 0.0]);
}

/// A folder with a scene of one triangle, whose buffer has this URI; and `triangle.bin`, which holds it.
fn folder(uri: &Value) -> tempfile::TempDir {
    let json = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 36, "uri": uri}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}],
    });
    let folder = tempfile::tempdir().expect("a folder");
    let floats = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = floats.into_iter().flat_map(f32::to_le_bytes).collect();
    fs::write(folder.path().join("triangle.bin"), &bytes).expect("a file");
    fs::write(folder.path().join("short.bin"), &bytes[..20]).expect("a file");
    fs::create_dir(folder.path().join("inner")).expect("a folder");
    fs::write(folder.path().join("scene.gltf"), json.to_string()).expect("a file");
    folder
}

/// The message about a buffer with this URI, its folder called `FOLDER`.
fn said(uri: &str) -> String {
    let folder = folder(&json!(uri));
    let answer = load(&folder.path().join("scene.gltf"));
    let shown = folder.path().display().to_string();
    let of_scene = |scene: Scene| scene.mistakes.first().cloned().unwrap_or_else(|| "it loads".to_owned());
    answer.map_or_else(|error| error.to_string().replace(&shown, "FOLDER"), of_scene)
}

#[test]
fn uris_that_lead_to_no_data() {
    let loads = ["triangle.bin", "./triangle.bin", "inner/../triangle.bin", "%74riangle.bin"];
    for uri in loads {
        assert_eq!(said(uri), "it loads", "{uri}");
    }
    let cases = [
        ("missing.bin", "its file `missing.bin` is not there"),
        ("../triangle.bin", "its file `../triangle.bin` leads out of `FOLDER`"),
        ("%2e%2e/%2e%2e/etc/passwd", "its file `../../etc/passwd` leads out of `FOLDER`"),
        ("/etc/passwd", "its file `/etc/passwd` leads out of `FOLDER`"),
        ("inner", "its file `inner` is not a regular file"),
        ("", "its file `` is no path of a file: names are divided by `/`, without `\\\\` and `:`"),
        ("a\\b.bin", "its file `a\\\\b.bin` is not there"),
        ("%ff.bin", "its file `\u{fffd}.bin` is no path of a file: names are divided by `/`, without `\\\\` and `:`"),
        ("%00.bin", "its file `\\0.bin` is no path of a file: names are divided by `/`, without `\\\\` and `:`"),
        ("\u{1b}[31m", "its file `\\u{1b}[31m` is not there"),
        ("short.bin", "bytes 0 to 36 are outside its data, which has 20"),
        (
            "https://example.org/triangle.bin",
            "its data stands at `https://example.org/triangle.bin`; only `data:` URIs and files beside this one are read",
        ),
        (
            "file:///etc/passwd",
            "its data stands at `file:///etc/passwd`; only `data:` URIs and files beside this one are read",
        ),
        ("data:base64", "its data URI `data:base64…` can't be read: it has no comma before its data"),
        ("data:;base64,A*AA", "its data URI `data:;base64,A*AA…` can't be read: Invalid symbol 42, offset 1."),
        ("data:;base64,AAAA", "bytes 0 to 36 are outside its data, which has 3"),
    ];
    for (uri, expected) in cases {
        assert_eq!(said(uri), format!("FOLDER/scene.gltf: buffer 0: {expected}"));
    }
}

#[test]
fn backslashes_divide_the_names_of_a_path_and_are_told() {
    for (uri, read) in [("inner\\..\\triangle.bin", "inner/../triangle.bin"), (".%5Ctriangle.bin", "./triangle.bin")] {
        let folder = folder(&json!(uri));
        let scene = loaded(&folder.path().join("scene.gltf"));
        assert_eq!(scene.objects.len(), 1);
        let named = read.replace('/', "\\\\");
        let said = format!("buffer 0: its file `{named}` is named with backslashes, so it is taken as `{read}`");
        assert_eq!(scene.mistakes, [said]);
    }
    assert!(said("..\\triangle.bin").ends_with("leads out of `FOLDER`"), "{}", said("..\\triangle.bin"));
}

#[cfg(unix)]
#[test]
fn no_pipe_is_waited_for() {
    let folder = folder(&json!("pipe.bin"));
    let made = std::process::Command::new("mkfifo").arg(folder.path().join("pipe.bin")).status().expect("mkfifo");
    assert!(made.success());
    let said = load(&folder.path().join("scene.gltf")).expect_err("no file").to_string();
    assert!(said.ends_with("buffer 0: its file `pipe.bin` is not a regular file"), "{said}");
    fs::remove_file(folder.path().join("scene.gltf")).expect("removed");
    fs::rename(folder.path().join("pipe.bin"), folder.path().join("scene.gltf")).expect("renamed");
    let said = load(&folder.path().join("scene.gltf")).expect_err("no file").to_string();
    assert!(said.ends_with("it is a pipe or a device, not a regular file"), "{said}");
}

#[cfg(unix)]
#[test]
fn no_link_leads_out_of_the_folder() {
    let (other, folder) = (folder(&json!("")), folder(&json!("link.bin")));
    let link = |to: &Path| std::os::unix::fs::symlink(to, folder.path().join("link.bin")).expect("a link");
    link(&other.path().join("triangle.bin"));
    let path = folder.path().join("scene.gltf");
    let said = load(&path).expect_err("it leads out").to_string();
    assert!(said.contains("buffer 0: its file `link.bin` leads out of"), "{said}");
    fs::remove_file(folder.path().join("link.bin")).expect("removed");
    link(Path::new("triangle.bin"));
    assert_eq!(loaded(&path).objects.len(), 1);
}

#[test]
fn a_picture_beside_the_scene_is_no_other_kind_of_file() {
    let material = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}});
    for (uri, expected) in [
        ("triangle.bin", "image 0: the image is neither PNG nor JPEG"),
        ("none.png", "image 0: its file `none.png` is not there"),
        ("data:image/png;base64,AAAA", "image 0: the image is neither PNG nor JPEG"),
    ] {
        let folder = folder(&json!("triangle.bin"));
        let path = folder.path().join("scene.gltf");
        let mut json: Value = serde_json::from_slice(&fs::read(&path).expect("readable")).expect("JSON");
        (json["materials"], json["textures"]) = (json!([material]), json!([{"source": 0}]));
        json["images"] = json!([{"uri": uri}]);
        fs::write(&path, json.to_string()).expect("a file");
        let scene = loaded(&path);
        assert_eq!((scene.objects.len(), scene.textures.len()), (1, 0));
        let left_out = "so the base colour texture of material 0 is left out";
        assert_eq!(scene.mistakes, [format!("{expected}, {left_out}")]);
    }
}
