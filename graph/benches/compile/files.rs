//! Pipeline files of many passes, and their way to a frame.

use framewright_graph::base::Sources;
use framewright_graph::expand::{Expander, Inputs, expand};
use framewright_graph::frame::{Draw, Frame, Stereo};
use framewright_graph::language::{self, Document, Facts};
use framewright_graph::shader::{
    Binding, BindingKind, Block, DrawInterface, FragmentOutput, Member, ShaderInterface, ShaderInterfaces,
    ShaderProblem, Variant,
};
use framewright_graph::vulkan::{Component, Dimension, ImageShape, Rotation, Stages};
use std::sync::Arc;

/// Chains of ten images, each as half as large as the one before it, as often as it takes.
pub(crate) fn of_fragments(passes: u32) -> String {
    format!(
        "Pipeline(version: 1, fragments: [(name: \"chain\", parameters: [(name: \"source\", value: Image), \
         (name: \"levels\", value: Integer(default: 10, min: 1, max: 16))], \
         images: [(name: \"down\", repeat: (\"i\", \"levels\"), format: Like(\"source\"), \
         size: Scaled(\"exp2(-(i + 1))\", \"source\"))], \
         passes: [(name: \"shrink\", repeat: (\"i\", \"levels\"), draw: FullScreen(\"copy\"), \
         sample: {{\"source\": \"if(i == 0, source, down[i - 1])\"}}, color: [\"down[i]\"])])], \
         images: [(name: \"color\", format: Output, size: Output)], \
         passes: [(name: \"first\", draw: FullScreen(\"plain\"), color: [\"color\"]), \
         (use: \"chain\", name: \"chain\", repeat: (\"n\", {}), with: {{\"source\": \"color\"}})], outputs: [\"color\"])",
        passes / 10
    )
}

/// The same chains, the first of which begins with a value that a setting gives.
pub(crate) fn of_setting(passes: u32) -> String {
    let setting = "Pipeline(settings: [(name: \"gain\", value: Number(default: 1.0, min: 0.0, max: 2.0))], ";
    let first = "draw: FullScreen(\"scaled\"), params: {\"gain\": \"gain\"}, ";
    of_fragments(passes).replacen("Pipeline(", setting, 1).replacen("draw: FullScreen(\"plain\"), ", first, 1)
}

/// Each pass draws what the one before it drew.
pub(crate) fn written_out(passes: u32) -> String {
    let images = (0..=passes).map(|image| format!("(name: \"image{image}\", format: Output, size: Output),\n"));
    // A file has 16 MiB at most.
    let source_of = |source: u32| match passes {
        ..=10_000 => format!("(image: \"image{source}\", filter: Nearest)"),
        _ => format!("\"image{source}\""),
    };
    let first = "(name: \"first\", draw: FullScreen(\"plain\"), color: [\"image0\"]),\n".to_owned();
    let others = (1..=passes).map(|pass| {
        let source = source_of(pass - 1);
        format!(
            "(name: \"pass{pass}\", draw: FullScreen(\"copy\"), \
             sample: {{\"source\": {source}}}, color: [\"image{pass}\"]),\n"
        )
    });
    let (images, passes_text): (String, String) = (images.collect(), std::iter::once(first).chain(others).collect());
    format!("Pipeline(version: 1, images: [\n{images}], passes: [\n{passes_text}], outputs: [\"image{passes}\"])\n")
}

/// Reads a file, and puts it together with its shaders' interfaces.
pub(crate) fn frame(text: String) -> Frame {
    let (pipeline, sources) = document(text);
    expand(&pipeline, sources, &inputs(&[]), &mut FullScreen).expect("the pipeline fits its shaders")
}

/// Puts a pipeline together for one value of the setting `gain`, and returns what does so again for another one.
pub(crate) fn with_other_gains(text: String) -> impl FnMut(f32) -> Frame {
    let (pipeline, sources) = document(text);
    let mut expander = Expander::default();
    move |gain| {
        let set = [("gain".to_owned(), gain.to_string())];
        let frame = expander.expand(&pipeline, sources.clone(), &inputs(&set), &mut FullScreen);
        frame.expect("the pipeline fits its shaders")
    }
}

fn document(text: String) -> (Document, Arc<Sources>) {
    let mut sources = Sources::default();
    let pipeline = language::read(&mut sources, "many.ron", "many.ron", text).expect("the file is sound");
    (pipeline, Arc::new(sources))
}

const fn inputs(set: &[(String, String)]) -> Inputs<'_> {
    Inputs {
        set,
        facts: Facts::UNKNOWN,
        facts_known: false,
        output_extent: [1920, 1080],
        dump: &[],
        device: None,
        stereo: Stereo::Off,
        window: None,
        rotation: Rotation::Identity,
    }
}

/// Shaders that draw one colour, most of them from one image.
struct FullScreen;

impl ShaderInterfaces for FullScreen {
    fn draw_shader(&mut self, name: &str, _: Draw, _: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        let component = Component::Float;
        let shape = ImageShape { dimension: Dimension::D2, arrayed: false, multisampled: false, component };
        let source = Binding {
            set: 0,
            binding: 0,
            name: "source".to_owned(),
            kind: BindingKind::SampledImage(shape),
            length: None,
            adapts: false,
            separate: false,
            stages: Stages::FRAGMENT_SHADER,
        };
        let member = Member { name: "gain".to_owned(), ty: "float".to_owned(), ..Member::default() };
        let kind = BindingKind::UniformBlock(Block { bytes: 4, members: vec![member] });
        let params = Binding { binding: 1, name: "params".to_owned(), kind, ..source.clone() };
        let output = FragmentOutput { location: 0, name: "color".to_owned(), component, components: 4 };
        let bindings = match name {
            "plain" => Vec::new(),
            "scaled" => vec![params],
            _ => vec![source],
        };
        Ok(ShaderInterface { bindings, outputs: vec![output], ..ShaderInterface::default() })
    }

    fn compute_shader(&mut self, _: &str, _: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        Err(ShaderProblem::Unsupported { what: "no pass of the bench dispatches".to_owned() })
    }

    fn brought_along(&self, _: Option<Draw>, _: &str) -> DrawInterface {
        DrawInterface::default()
    }
}
