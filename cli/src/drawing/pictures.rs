//! The pictures that a run writes: outputs are chosen, read back and encoded.

use crate::command_line::args::RunArguments;
use crate::command_line::values::OutputFile;
use crate::error::Error;
use crate::picture::{self, FileFormat};
use crate::system::text;
use framewright_graph::frame::{Eye, EyeForm, Frame};
use framewright_graph::plan::{Output, Plan, Resource};
use framewright_graph::vulkan::Format;
use framewright_vulkan::{Executor, Texels};
use std::path::{Path, PathBuf};

/// A picture that is ready to be written.
pub(crate) struct EncodedPicture {
    pub(crate) path: PathBuf,
    pub(crate) contents: Vec<u8>,
}

/// A picture that the command line asks for.
pub(crate) struct PictureRequest<'a> {
    /// The output's number, or those of both eyes.
    outputs: Vec<usize>,
    /// Whether the image has a layer for each eye.
    in_layers: bool,
    /// The image's name.
    name: &'a str,
    /// The file to write.
    path: &'a Path,
    file_format: FileFormat,
}

impl PictureRequest<'_> {
    /// The name of the output, or of the image that is dumped.
    pub(crate) fn name(&self) -> &str {
        self.name
    }

    /// Reads the outputs back and encodes them, and says what the picture loses.
    ///
    /// # Errors
    /// Those of the device, and of the encoder.
    pub(crate) fn encode(&self, executor: &mut Executor, plan: &Plan) -> Result<EncodedPicture, Error> {
        let (contents, format) = self.encoded(executor, plan)?;
        if let Some(loss) = self.file_format.loss(format) {
            text::say(&format!("note: `{}` is {format}: in its picture {loss}", text::escape(self.name)));
        }
        Ok(EncodedPicture { path: self.path.to_owned(), contents })
    }

    /// Reads the outputs back and encodes them. Returns the file's contents, and the format of the image.
    ///
    /// # Errors
    /// Those of the device, and of the encoder.
    pub(crate) fn encoded(&self, executor: &mut Executor, plan: &Plan) -> Result<(Vec<u8>, Format), Error> {
        let texels = self.outputs.iter().map(|output| executor.read(*output)).collect::<Result<Vec<_>, _>>()?;
        let eyes = texels.into_iter().flat_map(|texels| if self.in_layers { layers(texels) } else { vec![texels] });
        let Texels { format, extent: [width, height, _], bytes, .. } = side_by_side(eyes.collect());
        let encoding = plan.outputs.get(self.outputs[0]).and_then(|output| output.encoding);
        let picture = picture::Picture { format, encoding, extent: [width, height], bytes: &bytes };
        let encoded = self.file_format.encode(&picture);
        let contents = encoded.map_err(|problem| Error::Picture { image: self.name.to_owned(), problem })?;
        Ok((contents, format))
    }
}

/// The pictures that the command line asks for. `frame` is the one that the Plan was made of, if there is one: it knows images
/// that the Plan does without.
///
/// # Errors
/// If there is no image to write, or the file's format can't hold it.
pub(crate) fn requests<'a>(
    arguments: &'a RunArguments,
    (plan, frame): (&'a Plan, Option<&Frame>),
) -> Result<Vec<PictureRequest<'a>>, Error> {
    let request = |outputs: Vec<usize>, path: &'a Path| {
        let Output { name, resource, .. } = &plan.outputs[outputs[0]];
        let Resource::Image(image) = *resource else { return Err(Error::NoPicture { output: name.to_string() }) };
        let file_format = FileFormat::of(path).unwrap_or(FileFormat::Png);
        let image = plan.image(image);
        if !file_format.holds(image.format) {
            return Err(Error::NotFloats { image: name.to_string(), format: image.format });
        }
        let in_layers = image.eyes == Some(EyeForm::Layers);
        Ok(PictureRequest { outputs, in_layers, name, path, file_format })
    };
    let no_output = |name: &str| Error::NoOutput {
        name: name.to_owned(),
        outputs: plan.outputs.iter().map(|output| output.name.to_string()).collect(),
        image: frame.is_some_and(|frame| frame.images.iter().any(|image| *image.name == *name)),
    };
    let mut requests = Vec::new();
    for OutputFile { output, file } in &arguments.output {
        let outputs = output.as_ref().map_or_else(|| of_both_eyes(plan, 0), |name| named(plan, name));
        if outputs.is_empty() {
            return Err(no_output(output.as_deref().unwrap_or_default()));
        }
        requests.push(request(outputs, file)?);
    }
    for dump in &arguments.dump {
        let outputs = named(plan, &dump.image);
        if !outputs.is_empty() {
            requests.push(request(outputs, &dump.file)?);
        }
    }
    Ok(requests)
}

/// The picture of the first output, those of both eyes side by side; `None` if it is no image. Floating-point images become OpenEXR
/// files, all others PNG files.
pub(crate) fn of_first_output(plan: &Plan) -> Option<PictureRequest<'_>> {
    let Output { name, resource: Resource::Image(image), .. } = plan.outputs.first()? else { return None };
    let image = plan.image(*image);
    let (file_format, path) = match FileFormat::OpenExr.holds(image.format) && !image.format.is_depth() {
        true => (FileFormat::OpenExr, "picture.exr"),
        false => (FileFormat::Png, "picture.png"),
    };
    let in_layers = image.eyes == Some(EyeForm::Layers);
    Some(PictureRequest { outputs: of_both_eyes(plan, 0), in_layers, name, path: Path::new(path), file_format })
}

/// PNG files of all images that leave the frame, those of both eyes side by side.
pub(crate) fn of_all_outputs(plan: &Plan) -> Vec<PictureRequest<'_>> {
    let mut requests = Vec::new();
    let mut next = 0;
    while next < plan.outputs.len() {
        let outputs = of_both_eyes(plan, next);
        let Output { name, resource, .. } = &plan.outputs[next];
        next += outputs.len();
        if let Resource::Image(image) = resource {
            let in_layers = plan.image(*image).eyes == Some(EyeForm::Layers);
            requests.push(PictureRequest { outputs, in_layers, name, path: Path::new(""), file_format: FileFormat::Png });
        }
    }
    requests
}

/// The output with the name, or else those of both eyes.
fn named(plan: &Plan, name: &str) -> Vec<usize> {
    let find = |name: &str| plan.outputs.iter().position(|output| *output.name == *name);
    let both = || Eye::BOTH.into_iter().filter_map(|eye| find(&eye.named(name))).collect();
    alike(plan, find(name).map_or_else(both, |one| vec![one]))
}

/// An output, with the right eye's behind it if it is the left one's; empty if there is none.
fn of_both_eyes(plan: &Plan, output: usize) -> Vec<usize> {
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

/// The layers of an image by themselves.
pub(super) fn layers(texels: Texels) -> Vec<Texels> {
    let bytes = texels.bytes.len() / texels.layers.max(1) as usize;
    let layer = |bytes: &[u8]| Texels { layers: 1, bytes: bytes.to_vec(), ..texels };
    texels.bytes.chunks(bytes.max(1)).map(layer).collect()
}

/// Pictures of the same size and format beside each other, the first one on the left.
pub(super) fn side_by_side(mut eyes: Vec<Texels>) -> Texels {
    let mut all = eyes.swap_remove(0);
    for other in eyes {
        let row = |texels: &Texels| texels.bytes.len() / texels.extent[1].max(1) as usize;
        let rows = all.bytes.chunks(row(&all)).zip(other.bytes.chunks(row(&other)));
        all.bytes = rows.flat_map(|(left, right)| [left, right].concat()).collect();
        all.extent[0] += other.extent[0];
    }
    all
}
