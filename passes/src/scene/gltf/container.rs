//! The GLB container (glTF 2.0, section 4): a header, a JSON chunk, perhaps a binary chunk.

use super::problem::{GltfError, Problem, at_most};
use crate::scene::limits;

/// The two chunks that matter.
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    pub(super) binary: Option<&'a [u8]>,
}

pub(super) fn split(bytes: &[u8]) -> Result<Container<'_>, GltfError> {
    if !bytes.starts_with(b"glTF") {
        return Err(Problem::NotGlb.at(""));
    }
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(Problem::CutShort { has: bytes.len(), says: HEADER as u64 }.at(""));
    };
    if version != 2 {
        return Err(Problem::Version(version).at(""));
    }
    // Bytes after the announced length are not part of the file.
    let Some(bytes) = bytes.get(..length as usize) else {
        return Err(Problem::CutShort { has: bytes.len(), says: length.into() }.at(""));
    };
    let (json, rest) =
        chunk(bytes.get(HEADER..).unwrap_or(&[]), "JSON chunk")?.ok_or_else(|| Problem::NoJson.at(""))?;
    if json.kind != *b"JSON" {
        return Err(Problem::NoJson.at(""));
    }
    at_most("bytes", json.data.len() as u64, limits::JSON_BYTES as u64, "JSON chunk")?;
    let binary = chunk(rest, "binary chunk")?.filter(|(chunk, _)| chunk.kind == *b"BIN\0").map(|(chunk, _)| chunk.data);
    Ok(Container { json: without_zeros(json.data), binary })
}

/// JSON without zeros behind it: the specification asks for blanks as padding, and some writers take zeros.
fn without_zeros(json: &[u8]) -> &[u8] {
    let end = json.iter().rposition(|byte| !matches!(byte, 0 | b' ')).map_or(0, |last| last + 1);
    if json[end..].contains(&0) { &json[..end] } else { json }
}

const HEADER: usize = 12;

struct Chunk<'a> {
    kind: [u8; 4],
    data: &'a [u8],
}

/// The first chunk and what follows it; `None` at the end.
fn chunk<'a>(bytes: &'a [u8], name: &str) -> Result<Option<(Chunk<'a>, &'a [u8])>, GltfError> {
    let (Some(says), Some(kind), Some(rest)) = (word(bytes, 0), word(bytes, 4), bytes.get(8..)) else {
        return Ok(None);
    };
    match rest.split_at_checked(says as usize) {
        Some((data, rest)) => Ok(Some((Chunk { kind: kind.to_le_bytes(), data }, rest))),
        None => Err(Problem::ChunkCutShort { has: rest.len(), says }.at(name)),
    }
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes)
}
