//! Mistakes of glTF files.

use super::notes::Notes;
use framewright_graph::base::NoFile;
use std::fmt;
use std::ops::RangeBounds;

/// A mistake in a glTF file. Written `accessor 3: …`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GltfError {
    /// The place in the file: "accessor 3". Empty for the file as a whole.
    pub at: String,
    /// The mistake.
    pub problem: Problem,
    /// Whether it makes the file useless; else the part that it is in can be left out.
    pub of_whole: bool,
}

impl GltfError {
    /// Whether nothing is wrong with the files: the machine doesn't let one be read.
    #[must_use]
    pub fn is_of_machine(&self) -> bool {
        matches!(&self.problem, Problem::File { problem, .. } if problem.is_of_machine())
    }

    /// The same, of the file as a whole.
    pub(super) fn of_whole(self) -> GltfError {
        GltfError { of_whole: true, ..self }
    }
}

impl fmt::Display for GltfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.at.is_empty() { self.problem.fmt(f) } else { write!(f, "{}: {}", self.at, self.problem) }
    }
}

impl std::error::Error for GltfError {}

/// Notes that `what` is left out because of a mistake.
///
/// # Errors
/// The mistake itself, where it is one of the whole file.
pub(super) fn leave_out(error: GltfError, what: &str, notes: &mut Notes) -> Result<(), GltfError> {
    if error.of_whole {
        return Err(error);
    }
    let what = if error.at == what { "it" } else { what };
    notes.mistake(format!("{error}, so {what} is left out"));
    Ok(())
}

/// Makes sure that there is no more than is allowed of what all parts of the file share.
pub(super) fn at_most_in_all(what: &'static str, is: u64, limit: u64, at: &str) -> Result<(), GltfError> {
    at_most(what, is, limit, at).map_err(GltfError::of_whole)
}

/// Makes sure that there is no more than is allowed.
pub(super) fn at_most(what: &'static str, is: u64, limit: u64, at: &str) -> Result<(), GltfError> {
    if is > limit { Err(Problem::TooMuch { what, is, limit }.at(at)) } else { Ok(()) }
}

/// Makes sure that a number is in its range, which `expected` tells.
pub(super) fn within(
    what: &'static str,
    is: f64,
    range: impl RangeBounds<f64>,
    expected: &'static str,
    at: &str,
) -> Result<f64, GltfError> {
    if range.contains(&is) { Ok(is) } else { Err(Problem::OutOfRange { what, is: is.to_string(), expected }.at(at)) }
}

impl Problem {
    /// The problem of an element of the file, such as "accessor 3"; of the file as a whole without a name.
    pub(super) fn at(self, element: &str) -> GltfError {
        GltfError { at: element.into(), problem: self, of_whole: false }
    }
}

/// A mistake, without its place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Problem {
    /// The first four bytes aren't `glTF`.
    #[error("this is not a GLB file: it doesn't begin with `glTF`")]
    NotGlb,
    /// A container version other than 2.
    #[error("version {0} of GLB is not supported; only version 2 is")]
    Version(u32),
    /// The file is shorter than it says.
    #[error("the file is cut short: it has {has} bytes and says that it has {says}")]
    CutShort {
        /// Bytes that are there.
        has: usize,
        /// Bytes that the header announces.
        says: u64,
    },
    /// A chunk is longer than the file.
    #[error("says that it has {says} bytes, but only {has} are left in the file")]
    ChunkCutShort {
        /// Bytes that are left.
        has: usize,
        /// Bytes that the chunk announces.
        says: u32,
    },
    /// There is no JSON chunk at the start.
    #[error("the first chunk is not JSON")]
    NoJson,
    /// Something is larger than the loader takes.
    #[error("{what}: {is}; at most {limit} is allowed")]
    TooMuch {
        /// The thing that is counted.
        what: &'static str,
        /// The amount in the file.
        is: u64,
        /// The amount that is allowed.
        limit: u64,
    },
    /// The JSON is not what the specification says; the parser's words, escaped.
    #[error("{0}")]
    Json(String),
    /// An asset version other than 2.x; escaped.
    #[error("glTF version `{0}` is not supported; only 2.x is")]
    AssetVersion(String),
    /// A required extension that isn't known; escaped.
    #[error("the file requires the extension `{0}`, which is not supported")]
    Extension(String),
    /// Something refers to a thing that isn't there.
    #[error("refers to {kind} {index}, but there are only {count}")]
    Missing {
        /// The kind of thing.
        kind: &'static str,
        /// Its number.
        index: u64,
        /// How many there are.
        count: usize,
    },
    /// Something refers to a thing that was left out.
    #[error("refers to {kind} {index}, which is left out")]
    LeftOut {
        /// The kind of thing.
        kind: &'static str,
        /// Its number.
        index: u64,
    },
    /// Positions or indices that are all 0.
    #[error("it has neither a buffer view nor sparse values: they may stand in an extension that is not supported")]
    NoValues,
    /// Data stands in another file, and there is no folder to read it from; the URI's beginning, escaped.
    #[error("its data stands in another file (`{0}`), and only this one is read")]
    External(String),
    /// Data stands somewhere else altogether; the URI's beginning, escaped.
    #[error("its data stands at `{0}`; only `data:` URIs and files beside this one are read")]
    Scheme(String),
    /// A data URI that isn't one.
    #[error("its data URI `{uri}…` can't be read: {reason}")]
    DataUri {
        /// Its beginning; escaped.
        uri: String,
        /// The mistake in it.
        reason: String,
    },
    /// A file beside this one that can't be read.
    #[error("its file `{path}` {}", .problem.to_string().escape_debug())]
    File {
        /// Its path after percent-decoding, as it is counted from this file's folder; escaped.
        path: String,
        /// Why it can't.
        problem: NoFile,
    },
    /// A buffer that has no data.
    #[error(
        "it has no data: it names no file, and only the first buffer can be the file's binary chunk, and only if there is one"
    )]
    NoData,
    /// A range reaches beyond what holds it.
    #[error("bytes {start} to {end} are outside {holder}, which has {has}")]
    Range {
        /// First byte.
        start: u64,
        /// One past the last byte, saturating.
        end: u64,
        /// The thing that should hold them.
        holder: String,
        /// Bytes that it has.
        has: u64,
    },
    /// A count of 0.
    #[error("it holds no elements")]
    NoElements,
    /// A byte stride that the specification forbids.
    #[error("a stride of {stride} bytes doesn't fit elements of {size} bytes; 4 to 252, and no less than an element")]
    Stride {
        /// The stride.
        stride: u64,
        /// Bytes of an element.
        size: u64,
    },
    /// An accessor of the wrong type.
    #[error("{role} are {found}, which is not supported; expected {expected}")]
    ElementType {
        /// Its use.
        role: &'static str,
        /// Its type; escaped.
        found: String,
        /// The type that its use needs.
        expected: &'static str,
    },
    /// An accessor with another number of elements than the positions.
    #[error("it has {count} elements for {vertices} vertices")]
    Count {
        /// Elements.
        count: usize,
        /// Vertices.
        vertices: usize,
    },
    /// An index beyond the vertices.
    #[error("index number {at} is {index}, but there are only {vertices} vertices")]
    Index {
        /// Its place among the indices.
        at: usize,
        /// Its value.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A sparse accessor's indices don't ascend or are too large.
    #[error("sparse index number {at} is {index}; they must ascend and be less than {count}")]
    SparseIndex {
        /// Its place among the sparse indices.
        at: usize,
        /// Its value.
        index: u32,
        /// Elements of the accessor.
        count: usize,
    },
    /// A primitive without positions.
    #[error("it has no POSITION attribute")]
    NoPositions,
    /// Corners that don't make whole triangles.
    #[error("{0} corners don't make whole triangles")]
    Corners(usize),
    /// A number is NaN or infinite.
    #[error("{0} hold a number that is not finite")]
    NotFinite(&'static str),
    /// A number is outside its range.
    #[error("{what} is {is}; expected {expected}")]
    OutOfRange {
        /// The number's meaning.
        what: &'static str,
        /// Its value.
        is: String,
        /// Its range.
        expected: &'static str,
    },
    /// A word that the specification doesn't know; escaped.
    #[error("{what} `{is}` is not known; expected {expected}")]
    Word {
        /// The word's meaning.
        what: &'static str,
        /// The word.
        is: String,
        /// The words that it may be.
        expected: &'static str,
    },
    /// An image that can't be decoded; the decoder's words, escaped.
    #[error("the image can't be decoded: {0}")]
    Image(String),
    /// An image that is neither PNG nor JPEG.
    #[error("the image is neither PNG nor JPEG")]
    ImageKind,
    /// Both a matrix and a translation, rotation or scale.
    #[error("it has both a matrix and a translation, rotation or scale")]
    MatrixAndParts,
    /// A matrix whose last row isn't 0 0 0 1.
    #[error("its matrix is not affine: the last row must be 0 0 0 1")]
    NotAffine,
    /// A node below itself.
    #[error("it is its own ancestor")]
    Loop,
    /// A node in two places.
    #[error("it is a child of both node {0} and node {1}")]
    TwoParents(usize, usize),
    /// Nothing in the scene has triangles.
    #[error("there is nothing to draw: no triangle of the file has an area")]
    Nothing,
}
