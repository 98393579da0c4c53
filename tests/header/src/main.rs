//! Prints `framewright.h`, made of the crate in the folder that is named: `cargo run --manifest-path tests/header/Cargo.toml -- framewright/c`.

use std::error::Error;
use std::path::Path;

/// The files in the order in which the header has their contents.
const FILES: [&str; 20] = [
    "version",
    "status",
    "last_error",
    "arguments",
    "device",
    "adopt",
    "scene",
    "passes",
    "draws",
    "bind_groups",
    "draw_calls",
    "sets",
    "options",
    "renderer",
    "frames",
    "recorder",
    "images",
    "ahead",
    "texels",
    "viewer",
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("name the folder of the crate")?;
    let folder = Path::new(&folder);
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml"))?;
    let mut builder = cbindgen::Builder::new().with_config(config);
    for file in FILES {
        builder = builder.with_src(folder.join("src").join(file).with_extension("rs"));
    }
    let mut header = Vec::new();
    builder.generate()?.write(&mut header);
    println!("{}", String::from_utf8(header)?.trim());
    Ok(())
}
