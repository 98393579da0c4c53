//! The pictures that a run writes: outputs are chosen, read back and encoded.

use crate::command_line::args::RunArguments;
use crate::command_line::values::OutputFile;
use crate::error::Error;
use crate::picture::{self, FileFormat};
use crate::planning::Planned;
use crate::system::text;
use framewright_graph::base::Span;
use framewright_graph::frame::{Eye, EyeForm, Frame, Resource};
use framewright_graph::plan::{self, Plan};
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

/// The pictures that the command line asks for.
///
/// # Errors
/// If there is no image to write, or the file's format can't hold it.
pub(crate) fn requests<'a>(
    arguments: &'a RunArguments,
    planned: &'a Planned,
) -> Result<Vec<PictureRequest<'a>>, Error> {
    let (frame, plan) = (&planned.frame, &planned.plan);
    let image = |output: usize| match frame.outputs.get(output)?.resource {
        Resource::Image(image) => frame.images.get(image.0 as usize).map(|image| &*image.name),
        Resource::Buffer(_) => None,
    };
    let request = |outputs: Vec<usize>, name: &'a str, path: &'a Path| {
        let file_format = FileFormat::of(path).unwrap_or(FileFormat::Png);
        let planned = match plan.outputs.get(outputs[0]).map(|output| output.resource) {
            Some(plan::Resource::Image(image)) => Some(plan.image(image)),
            _ => None,
        };
        match planned {
            Some(image) if !file_format.holds(image.format) => {
                Err(Error::NotFloats { image: name.to_owned(), format: image.format })
            }
            image => {
                let in_layers = image.is_some_and(|image| image.eyes == Some(EyeForm::Layers));
                Ok(PictureRequest { outputs, in_layers, name, path, file_format })
            }
        }
    };
    let all = 0..frame.outputs.len();
    let mut requests = Vec::new();
    for OutputFile { output, file } in &arguments.output {
        let at = match output {
            Some(name) => outputs_named(frame, name, declared(frame)),
            None => of_both_eyes(frame, 0),
        };
        let first = at.first().copied().ok_or_else(|| no_output(frame, output.as_deref().unwrap_or_default()))?;
        let name = image(first).ok_or_else(|| Error::NoPicture { output: output_name(frame, first) })?;
        requests.push(request(at, name, file)?);
    }
    for dump in &arguments.dump {
        let outputs = outputs_named(frame, &dump.image, all.clone());
        if let Some(name) = outputs.first().and_then(|at| image(*at)) {
            requests.push(request(outputs, name, &dump.file)?);
        }
    }
    Ok(requests)
}

/// The picture of the first output, those of both eyes side by side; `None` if it is no image. Floating-point images become OpenEXR
/// files, all others PNG files.
pub(crate) fn of_first_output(planned: &Planned) -> Option<PictureRequest<'_>> {
    let plan::Resource::Image(image) = planned.plan.outputs.first()?.resource else { return None };
    let image = planned.plan.image(image);
    let (file_format, path) = match FileFormat::OpenExr.holds(image.format) && !image.format.is_depth() {
        true => (FileFormat::OpenExr, "picture.exr"),
        false => (FileFormat::Png, "picture.png"),
    };
    let in_layers = image.eyes == Some(EyeForm::Layers);
    let (outputs, path) = (of_both_eyes(&planned.frame, 0), Path::new(path));
    Some(PictureRequest { outputs, in_layers, name: &image.name, path, file_format })
}

/// PNG files of all images that the pipeline names as outputs, those of both eyes side by side.
pub(crate) fn of_all_outputs(planned: &Planned) -> Vec<PictureRequest<'_>> {
    let mut requests = Vec::new();
    let mut outputs = declared(&planned.frame).peekable();
    while let Some(first) = outputs.next() {
        let both = of_both_eyes(&planned.frame, first);
        for _ in &both[1..] {
            outputs.next();
        }
        let Some(plan::Resource::Image(image)) = planned.plan.outputs.get(first).map(|output| output.resource) else {
            continue;
        };
        let Resource::Image(declared) = planned.frame.outputs[first].resource else { continue };
        let name = &planned.frame.images[declared.0 as usize].name;
        let in_layers = planned.plan.image(image).eyes == Some(EyeForm::Layers);
        requests.push(PictureRequest {
            outputs: both,
            in_layers,
            name,
            path: Path::new(""),
            file_format: FileFormat::Png,
        });
    }
    requests
}

/// The output with the name, or else those of both eyes.
fn outputs_named(frame: &Frame, name: &str, among: impl Iterator<Item = usize> + Clone) -> Vec<usize> {
    let has_name = |at: &usize, name: &str| output_name(frame, *at) == name;
    let one = among.clone().find(|at| has_name(at, name));
    let of_eye = |eye: Eye| among.clone().find(|at| has_name(at, &eye.named(name)));
    one.map_or_else(|| Eye::BOTH.into_iter().filter_map(of_eye).collect(), |one| vec![one])
}

/// An output, with the right eye's behind it if it is the left one's.
fn of_both_eyes(frame: &Frame, output: usize) -> Vec<usize> {
    let eye = |at: usize| frame.outputs.get(at).and_then(|output| output.eye);
    let both = eye(output) == Some(Eye::Left) && eye(output + 1) == Some(Eye::Right);
    (output..frame.outputs.len()).take(if both { 2 } else { 1 }).collect()
}

/// The name of an output.
fn output_name(frame: &Frame, output: usize) -> String {
    let name = match frame.outputs.get(output).map(|output| output.resource) {
        Some(Resource::Image(image)) => frame.images.get(image.0 as usize).map(|image| &image.name),
        Some(Resource::Buffer(buffer)) => frame.buffers.get(buffer.0 as usize).map(|buffer| &buffer.name),
        None => None,
    };
    name.map_or_else(String::new, ToString::to_string)
}

/// Numbers of the outputs that the pipeline names; dumped images stand in no file.
fn declared(frame: &Frame) -> impl Iterator<Item = usize> + Clone {
    (0..frame.outputs.len()).filter(|at| frame.outputs[*at].span != Span::NONE)
}

fn no_output(frame: &Frame, name: &str) -> Error {
    Error::NoOutput {
        name: name.to_owned(),
        outputs: declared(frame).map(|at| output_name(frame, at)).collect(),
        image: frame.images.iter().any(|image| *image.name == *name),
    }
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
