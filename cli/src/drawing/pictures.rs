//! The pictures that a run writes: outputs are chosen.

use crate::command_line::args::RunArguments;
use crate::command_line::values::OutputFile;
use crate::error::Error;
use framewright_graph::frame::Frame;
use framewright_graph::plan::{Output, Plan, Resource};
use framewright_lab::outputs::{self, PictureRequest};
use framewright_lab::picture::FileFormat;
use std::path::Path;

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
        Ok(PictureRequest { outputs, name, path, file_format })
    };
    let no_output = |name: &str| Error::NoOutput {
        name: name.to_owned(),
        outputs: plan.outputs.iter().map(|output| output.name.to_string()).collect(),
        image: frame.is_some_and(|frame| frame.images.iter().any(|image| *image.name == *name)),
    };
    let mut requests = Vec::new();
    for OutputFile { output, file } in &arguments.output {
        let outputs = output.as_ref().map_or_else(|| outputs::of_both_eyes(plan, 0), |name| outputs::named(plan, name));
        if outputs.is_empty() {
            return Err(no_output(output.as_deref().unwrap_or_default()));
        }
        requests.push(request(outputs, file)?);
    }
    for dump in &arguments.dump {
        let outputs = outputs::named(plan, &dump.image);
        if !outputs.is_empty() {
            requests.push(request(outputs, &dump.file)?);
        }
    }
    Ok(requests)
}
