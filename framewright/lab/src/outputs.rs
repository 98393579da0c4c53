//! Pictures of a Plan's outputs: they are read back and encoded, those of both eyes side by side.

use crate::error::Error;
use crate::picture::{self, EncodingError, FileFormat};
use framewright_graph::base::escape;
use framewright_graph::frame::Eye;
use framewright_graph::plan::{Output, Plan, Resource};
use framewright_vulkan::{Executor, Texels};
use std::path::{Path, PathBuf};

/// A picture that is ready to be written.
#[derive(Debug)]
pub struct EncodedPicture {
    /// The file to write.
    pub path: PathBuf,
    /// What it holds.
    pub contents: Vec<u8>,
}

/// A picture of an output.
#[derive(Debug)]
pub struct PictureRequest<'a> {
    /// The output's number, or those of both eyes; at least one.
    pub outputs: Vec<usize>,
    /// The name of the output.
    pub name: &'a str,
    /// The file to write.
    pub path: &'a Path,
    /// Its format.
    pub file_format: FileFormat,
}

impl PictureRequest<'_> {
    /// Reads the outputs back and encodes them. `note` is told what the picture leaves out or changes.
    ///
    /// # Errors
    /// Those of the device, and of the encoder; [`framewright::Error::UnknownOutput`] without a number, or if the Plan has fewer outputs.
    pub fn encode(&self, executor: &mut Executor, plan: &Plan, note: &dyn Fn(&str)) -> Result<EncodedPicture, Error> {
        let unknown = || framewright::Error::UnknownOutput {
            name: self.name.to_owned(),
            known: plan.outputs.iter().map(|output| output.name.to_string()).collect(),
        };
        let first = self.outputs.first().and_then(|first| plan.outputs.get(*first)).ok_or_else(unknown)?;
        let texels = self.outputs.iter().map(|output| executor.read(*output)).collect::<Result<Vec<_>, _>>()?;
        let contents = encoded(self.file_format, (plan, first), texels, note)?;
        Ok(EncodedPicture { path: self.path.to_owned(), contents })
    }
}

/// The file of an output that was read back, of both eyes one after the other. `note` is told what the picture leaves out or changes.
///
/// # Errors
/// [`Error::Picture`], also of no texels.
pub fn encoded(
    file_format: FileFormat,
    (plan, output): (&Plan, &Output),
    texels: Vec<Texels>,
    note: &dyn Fn(&str),
) -> Result<Vec<u8>, Error> {
    let Output { name, resource, encoding, .. } = output;
    let problem = |problem| Error::Picture { image: name.to_string(), problem };
    let all = side_by_side(texels).ok_or(EncodingError::TooFew).map_err(problem)?;
    let Texels { format, extent: [width, height, _], bytes, .. } = all;
    let picture = picture::Picture { format, encoding: *encoding, extent: [width, height], bytes: &bytes };
    let mut losses: Vec<String> = file_format.losses(&picture).into_iter().map(str::to_owned).collect();
    let mips = if let Resource::Image(image) = *resource { plan.image(image).mips } else { 1 };
    if mips > 1 {
        losses.push(format!("of {mips} mip levels there is the first"));
    }
    if !losses.is_empty() {
        note(&format!("`{}` is {format}: in its picture {}", escape(name), losses.join(", and ")));
    }
    file_format.encode(&picture).map_err(problem)
}

/// The picture of the first output, those of both eyes side by side; `None` if it is no image. Floating-point images become OpenEXR
/// files, all others PNG files.
#[must_use]
pub fn of_first_output(plan: &Plan) -> Option<PictureRequest<'_>> {
    let Output { name, resource: Resource::Image(image), .. } = plan.outputs.first()? else { return None };
    let image = plan.image(*image);
    let (file_format, path) = match FileFormat::OpenExr.holds(image.format) && !image.format.is_depth() {
        true => (FileFormat::OpenExr, "picture.exr"),
        false => (FileFormat::Png, "picture.png"),
    };
    Some(PictureRequest { outputs: of_both_eyes(plan, 0), name, path: Path::new(path), file_format })
}

/// PNG files of all images that leave the frame, those of both eyes side by side.
#[must_use]
pub fn of_all_outputs(plan: &Plan) -> Vec<PictureRequest<'_>> {
    let mut requests = Vec::new();
    let mut next = 0;
    while next < plan.outputs.len() {
        let outputs = of_both_eyes(plan, next);
        let Output { name, resource, .. } = &plan.outputs[next];
        next += outputs.len();
        if let Resource::Image(_) = resource {
            requests.push(PictureRequest { outputs, name, path: Path::new(""), file_format: FileFormat::Png });
        }
    }
    requests
}

/// The output with the name, or else those of both eyes; empty if there is none.
#[must_use]
pub fn named(plan: &Plan, name: &str) -> Vec<usize> {
    let find = |name: &str| plan.outputs.iter().position(|output| *output.name == *name);
    let both = || Eye::BOTH.into_iter().filter_map(|eye| find(&eye.named(name))).collect();
    alike(plan, find(name).map_or_else(both, |one| vec![one]))
}

/// An output, with the right eye's behind it if it is the left one's; empty if there is none.
#[must_use]
pub fn of_both_eyes(plan: &Plan, output: usize) -> Vec<usize> {
    let eye = |at: usize| plan.outputs.get(at).and_then(|output| output.eye);
    let both = eye(output) == Some(Eye::Left) && eye(output + 1) == Some(Eye::Right);
    alike(plan, (output..plan.outputs.len()).take(if both { 2 } else { 1 }).collect())
}

/// The outputs, or only the first of them, if the others can't stand beside it in one picture.
fn alike(plan: &Plan, mut outputs: Vec<usize>) -> Vec<usize> {
    let image = |at: &usize| match plan.outputs[*at].resource {
        Resource::Image(image) => Some(plan.image(image)),
        Resource::Buffer(_) => None,
    };
    let form = |at: &usize| image(at).map(|it| (it.format, it.extent, it.rotation, it.eyes));
    let first = outputs.first().map(form);
    outputs.retain(|at| Some(form(at)) == first);
    outputs
}

/// All layers and slices of some images of the same size and format in one row, the first one on the left; `None` of no images.
#[must_use]
pub fn side_by_side(images: Vec<Texels>) -> Option<Texels> {
    let parts = |it: &Texels| it.layers.max(1) as usize * it.extent[2].max(1) as usize;
    let count = images.iter().map(parts).sum::<usize>();
    if count == 1 {
        return images.into_iter().next();
    }
    let first = images.first()?;
    let rows = first.extent[1].max(1) as usize;
    let mut all = Texels { bytes: Vec::new(), ..*first };
    let flat = images.iter().flat_map(|it| it.bytes.chunks((it.bytes.len() / parts(it)).max(1)));
    let flat: Vec<&[u8]> = flat.collect();
    for row in 0..rows {
        for part in &flat {
            let bytes = part.len() / rows;
            all.bytes.extend_from_slice(&part[row * bytes..(row + 1) * bytes]);
        }
    }
    let count = u32::try_from(count).unwrap_or(u32::MAX);
    (all.extent, all.layers) = ([all.extent[0].saturating_mul(count), all.extent[1], 1], 1);
    Some(all)
}
