//! Pipelines for shaders of which nothing is known but their interface.

use framewright_graph::shader::{Binding, BindingKind, FragmentOutput, PASS_SET, ShaderInterface};
use std::fmt::Write;

/// Width and height of everything that is drawn: that of the image of `extremes.frag`.
pub(crate) const EXTENT: [u32; 2] = [32, 16];

/// The images, buffers and passes of a pipeline file as they are added.
#[derive(Default)]
pub(crate) struct Pipeline {
    images: String,
    buffers: String,
    passes: String,
    outputs: Vec<String>,
}

impl Pipeline {
    /// One whose image `extremes` holds every kind of number.
    pub(crate) fn with_extremes() -> Pipeline {
        let mut new = Pipeline::default();
        new.image("extremes", "R32G32B32A32_SFLOAT");
        new.pass(r#"(name: "extremes", draw: FullScreen("extremes"), color: ["extremes"]),"#);
        new
    }

    pub(crate) fn image(&mut self, name: &str, format: &str) {
        writeln!(self.images, "(name: \"{name}\", format: {format}, size: Fixed({}, {})),", EXTENT[0], EXTENT[1])
            .expect("a string takes everything");
    }

    pub(crate) fn buffer(&mut self, text: &str) {
        self.buffers += text;
    }

    pub(crate) fn pass(&mut self, text: &str) {
        self.passes += text;
    }

    /// An image that is read back.
    pub(crate) fn output(&mut self, name: &str, format: &str) {
        self.image(name, format);
        self.outputs.push(format!("{name:?}"));
    }

    /// The outputs as a pass names them: one for each output of the shader. All have 32 bits, so that the texels that are read are the
    /// values that the shader stores.
    pub(crate) fn targets(&mut self, pass: &str, outputs: &[FragmentOutput]) -> String {
        let mut targets = String::new();
        for output in outputs {
            let format = ["R32_SFLOAT", "R32G32_SFLOAT", "", "R32G32B32A32_SFLOAT"][output.components as usize - 1];
            let name = format!("{pass}_{}", output.location);
            self.output(&name, format);
            write!(targets, "(image: \"{name}\", clear: (0.0, 0.0, 0.0, 0.0)), ").expect("a string takes everything");
        }
        targets
    }

    pub(crate) fn text(&self) -> String {
        let Pipeline { images, buffers, passes, .. } = self;
        let outputs = self.outputs.join(", ");
        format!(
            "Pipeline(version: 1,\nimages: [{images}],\nbuffers: [{buffers}],\npasses: [{passes}],\noutputs: [{outputs}])"
        )
    }
}

/// The bindings of a shader that its pass fills.
pub(crate) fn own(shader: &ShaderInterface) -> impl Iterator<Item = &Binding> {
    shader.bindings.iter().filter(|binding| binding.set == PASS_SET)
}

/// `params` of a pass, all of them the same number.
pub(crate) fn params(shader: &ShaderInterface, number: u32) -> String {
    let blocks = own(shader).filter_map(|binding| match &binding.kind {
        BindingKind::UniformBlock(block) if binding.name == "params" => Some(block),
        _ => None,
    });
    let told = blocks.flat_map(|block| &block.members).map(|member| {
        let value = match member.ty.as_str() {
            "float" => format!("{number}.0"),
            _ => number.to_string(),
        };
        format!("{:?}: {value}, ", member.name)
    });
    told.collect()
}
