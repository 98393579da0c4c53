//! Shaders by name, for a kind of draw.

use super::compile::{Stage, compile};
use super::files::ShaderFiles;
use super::reflect::{StageInterface, reflect};
use framewright_graph::frame::Draw;
use framewright_graph::interface::{DrawInterface, ShaderInterface, ShaderInterfaces, ShaderProblem};
use shaderc::Compiler;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// SPIR-V of one stage, with the entry point `main`.
pub type Spirv = Arc<[u32]>;

/// A shader, ready for a pipeline.
#[derive(Debug, Clone)]
pub struct CompiledShader {
    /// Vertex stage.
    pub vertex: Spirv,
    /// Fragment stage.
    pub fragment: Spirv,
    /// What both stages use.
    pub interface: ShaderInterface,
    /// The fragment stage's input attachments by name, with their index among those of the shader.
    pub input_attachments: Vec<(String, u32)>,
}

/// A compute shader, ready for a pipeline.
#[derive(Debug, Clone)]
pub struct CompiledCompute {
    /// Its stage.
    pub compute: Spirv,
    /// What it uses.
    pub interface: ShaderInterface,
}

/// Finds, compiles and reflects shaders.
///
/// The shader `NAME` of a draw is `NAME.frag` with `NAME.vert`, or without one with the vertex shader of its kind of
/// draw: `objects.vert`, `sky.vert`, `full_screen.vert` (custom draws too) or `vertices.vert` (indirect draws too). The
/// compute shader `NAME` is `NAME.comp`. Every file is looked for in the folders in their order, then among the shipped
/// texts; so is every `#include "x.glsl"`, whose name is never relative to the including file. Where a pass reads the
/// image `NAME` locally, as an input attachment of its own rendering scope, its fragment stage is compiled with the macro
/// `LOCAL_READ_NAME` and must declare it `subpassInput` then, and `sampler2D` otherwise. What was once compiled is kept for
/// the library's lifetime: changes on disk need a new library.
pub struct ShaderLibrary {
    files: ShaderFiles,
    draws: fn(Draw) -> DrawInterface,
    compiler: Option<Compiler>,
    stages: HashMap<StageKey, StageResult>,
}

/// A stage by its file and macros.
type StageKey = (String, Stage, Vec<String>);

/// A stage, `None` if it has no file.
type StageResult = Result<Option<Arc<CompiledStage>>, ShaderProblem>;

/// One stage of a shader.
struct CompiledStage {
    file: String,
    spirv: Spirv,
    reflected: StageInterface,
}

impl ShaderLibrary {
    /// A library over `folders`, then `shipped` (file name, GLSL text). `draws` says what each kind of draw brings along.
    #[must_use]
    pub fn new(
        folders: Vec<PathBuf>,
        shipped: &'static [(&'static str, &'static str)],
        draws: fn(Draw) -> DrawInterface,
    ) -> ShaderLibrary {
        ShaderLibrary { files: ShaderFiles { folders, shipped }, draws, compiler: None, stages: HashMap::new() }
    }

    /// The shader `name` when it draws `draw` and reads the images `local` locally.
    ///
    /// # Errors
    /// [`ShaderProblem`] says whether it is missing, doesn't compile or can't be used.
    pub fn compiled(&mut self, name: &str, draw: Draw, local: &[&str]) -> Result<CompiledShader, ShaderProblem> {
        let defined = local.iter().map(|image| format!("LOCAL_READ_{image}")).collect();
        let Some(fragment) = self.stage(format!("{name}.frag"), Stage::Fragment, defined)? else {
            return Err(self.missing(".frag"));
        };
        let vertex = match self.stage(format!("{name}.vert"), Stage::Vertex, Vec::new())? {
            Some(own) => own,
            None => self.stage(vertex_shader_of(draw).to_owned(), Stage::Vertex, Vec::new())?.ok_or_else(|| {
                ShaderProblem::Unsupported {
                    what: format!("no vertex shader: neither `{name}.vert` nor `{}` was found", vertex_shader_of(draw)),
                }
            })?,
        };
        let interface = join(&vertex, &fragment).map_err(|what| ShaderProblem::Unsupported { what })?;
        Ok(CompiledShader {
            vertex: vertex.spirv.clone(),
            fragment: fragment.spirv.clone(),
            interface,
            input_attachments: fragment.reflected.input_attachments.clone(),
        })
    }

    /// The compute shader `name`.
    ///
    /// # Errors
    /// [`ShaderProblem`] says whether it is missing, doesn't compile or can't be used.
    pub fn compute(&mut self, name: &str) -> Result<CompiledCompute, ShaderProblem> {
        let stage = self.stage(format!("{name}.comp"), Stage::Compute, Vec::new())?;
        let stage = stage.ok_or_else(|| self.missing(".comp"))?;
        Ok(CompiledCompute { compute: stage.spirv.clone(), interface: stage.reflected.interface.clone() })
    }

    /// One stage by its file name and macros; `None` if there is no such file.
    fn stage(&mut self, file: String, stage: Stage, defined: Vec<String>) -> StageResult {
        let key = (file, stage, defined);
        if let Some(known) = self.stages.get(&key) {
            return known.clone();
        }
        let result = self.compile_stage(&key);
        self.stages.insert(key, result.clone());
        result
    }

    fn compile_stage(&mut self, (file, stage, defined): &StageKey) -> StageResult {
        let stage = *stage;
        let found = self.files.find(file).map_err(|what| ShaderProblem::Unsupported { what })?;
        let Some(source) = found else { return Ok(None) };
        let compiler = match &mut self.compiler {
            Some(compiler) => compiler,
            none => none.insert(Compiler::new().map_err(|error| ShaderProblem::Unsupported {
                what: format!("the shader compiler doesn't start: {error}"),
            })?),
        };
        let spirv = compile(compiler, stage, &source, &self.files, defined)
            .map_err(|messages| ShaderProblem::DoesNotCompile { messages })?;
        let reflected = reflect(stage, &spirv)
            .map_err(|what| ShaderProblem::Unsupported { what: format!("{}: {what}", source.shown) })?;
        Ok(Some(Arc::new(CompiledStage { file: source.shown, spirv: spirv.into(), reflected })))
    }

    fn missing(&self, ending: &str) -> ShaderProblem {
        ShaderProblem::Missing { looked_in: self.files.places(), known: self.files.known_shaders(ending) }
    }
}

impl ShaderInterfaces for ShaderLibrary {
    fn draw_shader(&mut self, name: &str, draw: Draw) -> Result<ShaderInterface, ShaderProblem> {
        self.compiled(name, draw, &[]).map(|shader| shader.interface)
    }

    fn local_draw_shader(
        &mut self,
        name: &str,
        draw: Draw,
        local: &[&str],
    ) -> Result<Option<ShaderInterface>, ShaderProblem> {
        self.compiled(name, draw, local).map(|shader| Some(shader.interface))
    }

    fn compute_shader(&mut self, name: &str) -> Result<ShaderInterface, ShaderProblem> {
        self.compute(name).map(|shader| shader.interface)
    }

    fn brought_along(&self, draw: Draw) -> DrawInterface {
        (self.draws)(draw)
    }
}

/// The vertex shader of a kind of draw, for shaders without one of their own.
fn vertex_shader_of(draw: Draw) -> &'static str {
    match draw {
        Draw::Objects(_) => "objects.vert",
        Draw::Sky => "sky.vert",
        Draw::FullScreen | Draw::Custom => "full_screen.vert",
        Draw::Vertices { .. } | Draw::Indirect => "vertices.vert",
    }
}

/// The interface of both stages together.
///
/// # Errors
/// In words: where the stages don't fit together.
fn join(vertex: &CompiledStage, fragment: &CompiledStage) -> Result<ShaderInterface, String> {
    for input in &fragment.reflected.inputs {
        let handed = vertex.reflected.outputs.iter().find(|output| output.location == input.location);
        if handed.is_none_or(|output| output.ty != input.ty) {
            let found = handed.map_or("nothing".to_owned(), |output| format!("`{} {}`", output.ty, output.name));
            return Err(format!(
                "{} reads `{} {}` at location {}, where {} hands over {found}",
                fragment.file, input.ty, input.name, input.location, vertex.file
            ));
        }
    }
    let mut joined = fragment.reflected.interface.clone();
    joined.vertex_inputs.clone_from(&vertex.reflected.interface.vertex_inputs);
    for binding in &vertex.reflected.interface.bindings {
        match joined.bindings.iter_mut().find(|it| (it.set, it.binding) == (binding.set, binding.binding)) {
            None => joined.bindings.push(binding.clone()),
            Some(same) if same.name == binding.name && same.kind == binding.kind => same.stages |= binding.stages,
            Some(other) => {
                return Err(format!(
                    "{} declares `{}` at set {}, binding {}, where {} declares `{}`, or the same in another form",
                    vertex.file, binding.name, binding.set, binding.binding, fragment.file, other.name
                ));
            }
        }
    }
    joined.bindings.sort_by_key(|it| (it.set, it.binding));
    Ok(joined)
}
