//! What a page carries so that it compiles its pipeline anew: the compiler, as a module of WebAssembly, and the pipeline.

use crate::page::{Page, page_of_compiler};
use crate::server::Controls;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use framewright_what_if::Subject;
use serde::Serialize;
use std::io::Write;

/// A compiler and the pipeline that it compiles, packed for a page.
#[derive(Serialize)]
pub struct WhatIf {
    /// The version of the command, which is that of the compiler.
    version: &'static str,
    /// The module, packed.
    module: String,
    /// The [`Subject`], as JSON, packed.
    subject: String,
    /// The settings that can be chosen.
    controls: Controls,
    /// The names of the devices that can be chosen.
    devices: Vec<String>,
    /// The names of the passes and uses of fragments that can be left out.
    passes: Vec<String>,
}

/// Bytes that are no module of WebAssembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BadModule;

impl WhatIf {
    /// Packs them. `module`: what `framewright-what-if` was built to.
    ///
    /// # Errors
    /// [`BadModule`] if it is none.
    pub fn new(module: &[u8], subject: &Subject, controls: Controls, passes: Vec<String>) -> Result<WhatIf, BadModule> {
        if !module.starts_with(b"\0asm\x01\0\0\0") {
            return Err(BadModule);
        }
        let text = serde_json::to_vec(subject).unwrap_or_default();
        Ok(WhatIf {
            version: env!("CARGO_PKG_VERSION"),
            module: packed(module),
            subject: packed(&text),
            controls,
            devices: subject.devices().into_iter().map(str::to_owned).collect(),
            passes,
        })
    }
}

/// The page of a Plan, in which its pipeline is compiled anew for other choices and texts.
///
/// # Errors
/// If a Plan has no JSON form.
pub fn page_with_what_if(page: &Page<'_>, what_if: &WhatIf) -> serde_json::Result<String> {
    page_of_compiler(page, what_if)
}

/// Bytes as the page unpacks them: in base64, compressed by zlib.
fn packed(bytes: &[u8]) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Writing to memory can't fail.
    let packed = encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default();
    BASE64_STANDARD.encode(packed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    #[test]
    fn what_is_packed_is_unpacked_again() {
        let bytes: Vec<u8> = (0..10_000_u32).map(|number| (number % 251) as u8).collect();
        let text = packed(&bytes);
        assert!(text.len() < 1000, "{}", text.len());
        let mut unpacked = Vec::new();
        let decoded = BASE64_STANDARD.decode(text).expect("base64");
        ZlibDecoder::new(&*decoded).read_to_end(&mut unpacked).expect("unpacked");
        assert_eq!(unpacked, bytes);
    }
}
