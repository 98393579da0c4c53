//! Shaders by name, for a kind of draw.

use super::PrecompiledShaders;
use super::colors;
use super::compilers::Compilers;
use super::constants;
use super::coverage::{DISCARDS, MASKS_SAMPLES};
use super::distances;
use super::eyes::{self, BothEyes};
use super::eyes_of_modules;
use super::file_stages::FileStage;
use super::files::{ShaderFiles, SourceFile};
use super::layers;
use super::macros::{Macros, both_eyes, in_layers, is_for_right_eye, macros, tells_parts};
use super::module_file::CutModule;
use super::needs::Needed;
use super::program_supply::ProgramSupply;
use super::push_constants::PushedBy;
use super::reflect::reflect;
use super::registers;
use super::set_layouts::SetLayouts;
use super::shader_compilers::ShaderCompilers;
use super::stage_sources::{StageCode, StageSource, StageSources, file_of};
use super::stages::{CompiledStage, Spirv, changes_nothing, join};
use super::text::{self, RefusedStage, Words};
use super::validator::judge;
use super::varyings::without_idle_inputs;
use crate::base::ShaderStage;
use crate::process::{CompileJob, CompilerAnswer, Finding, Helper, Verdict};
use framewright_graph::base::{FilePath, Root};
use framewright_graph::device::{Need, NeedKind};
use framewright_graph::frame::Draw;
use framewright_graph::shader::{
    Binding, ConstantValue, DrawInterface, DrawInterfaces, PASS_SET, ProgramSet, ShaderInterface, ShaderInterfaces,
    ShaderName, ShaderProblem, StageName, UnbindableResource, Variant,
};
use std::collections::HashMap;
use std::sync::Arc;

/// A shader, ready for a pipeline.
#[derive(Debug, Clone)]
pub struct CompiledShader {
    /// Vertex stage.
    pub vertex: Spirv,
    /// Fragment stage; `None` where nothing but depth is drawn and it would change nothing.
    pub fragment: Option<Spirv>,
    /// The interface of all stages.
    pub interface: ShaderInterface,
    /// Whether the vertex stage is the shipped one of its kind of draw.
    pub usual_vertices: bool,
    /// The fragment stage's input attachments by name, with their index among those of the shader.
    pub input_attachments: Vec<(String, u32)>,
}

/// A compute shader, ready for a pipeline.
#[derive(Debug, Clone)]
pub struct CompiledCompute {
    /// Its stage.
    pub compute: Spirv,
    /// The interface of the stage.
    pub interface: ShaderInterface,
}

/// Finds, compiles and reflects shaders. Compiling takes the feature `shader-compiler`: see [`ShaderLibrary::with_precompiled`].
///
/// The shader `NAME` of a draw is `NAME.frag` with `NAME.vert`, or without one with the
/// [vertex shader of its kind of draw](Draw::usual_vertex_shader). The compute shader `NAME` is `NAME.comp`.
///
/// A pipeline's file that names a shader has its own beside it: `NAME` in `effects/glow.ron` is the shader `effects/NAME`
/// if there is one. Else it is looked for in the folders in their order, then among the shipped texts; so is the usual
/// vertex shader, and what is `#include`d: beside the file that includes it, in the folders, among the shipped. What a
/// shipped file names is shipped: from there `NAME` is the shader `shipped:NAME`.
///
/// A [`Variant`] says how a pass has them compiled. The macro `TEXTURE_NAME` stands for the type of the image that the pass
/// gives as `NAME`. The shader's own stages have it if their text or an included file mentions it. Where a pass reads the image
/// `NAME` locally, as an input attachment of its own rendering scope, its fragment stage is compiled with the macro
/// `LOCAL_READ_NAME` and must declare it `subpassInput` then. Where a pass draws nothing but depth it is compiled with the
/// macro `DEPTH_ONLY`: what is left decides which fragments stay. Where its alpha says how many samples are covered, it is
/// compiled with the macro `ALPHA_TO_COVERAGE`. `NAME_st` in a stage that declares the sampler `NAME` stands
/// for the part in use of the image that the pass gives as `NAME`. A name that the stage itself declares is its own, and no
/// macro. What was once read or compiled is kept for the library's lifetime: changes on disk need a new library.
pub struct ShaderLibrary {
    sources: StageSources,
    draws: DrawInterfaces,
    /// What the program supplies to all shaders.
    program: ProgramSupply,
    /// Their layouts, as far as the program has made them.
    set_layouts: SetLayouts,
    compilers: Compilers,
    stages: HashMap<StageKey, StageResult>,
}

const VERTEX: ShaderStage = ShaderStage::Vertex;
const FRAGMENT: ShaderStage = ShaderStage::Fragment;
const COMPUTE: ShaderStage = ShaderStage::Compute;

/// A stage by its name, its macros, how it draws for both eyes, what it samples in layers, the values of its constants, and whose its push
/// constants are.
type StageKey = (StageName, ShaderStage, Macros, Option<BothEyes>, Vec<String>, ConstantValues, PushedBy);
type ConstantValues = Vec<(Arc<str>, ConstantValue)>;

/// A stage, `None` if it has no file.
type StageResult = Result<Option<Arc<CompiledStage>>, ShaderProblem>;

impl ShaderLibrary {
    /// A library over the folders `roots`, then `shipped` (file name, GLSL text). `draws` says what each kind of draw brings
    /// along: [`DrawInterfaces`], or a function from a draw to its interface.
    #[must_use]
    pub fn new(
        roots: Vec<Root>,
        shipped: &'static [(&'static str, &'static str)],
        draws: impl Into<DrawInterfaces>,
    ) -> ShaderLibrary {
        let draws = draws.into();
        let sources = StageSources::new(ShaderFiles { roots, shipped, modules: Vec::new() });
        let program = ProgramSupply::of(&draws);
        let (set_layouts, compilers) = (SetLayouts::default(), Compilers::new(None, None));
        ShaderLibrary { sources, draws, program, set_layouts, compilers, stages: HashMap::new() }
    }

    /// Has shaders compiled in a helper process, which bounds what they can take, and keeps them in its cache. Without a helper
    /// a shader can end this process, or keep it busy forever: see [`crate::helper`].
    #[must_use]
    pub fn with_helper(self, helper: &Helper) -> ShaderLibrary {
        let precompiled = self.compilers.precompiled.clone();
        let mut compilers = Compilers::new(Some(helper), precompiled);
        compilers.commands = self.compilers.commands;
        ShaderLibrary { compilers, ..self }
    }

    /// Takes compiled stages from a folder; `None`: from none. A program without the feature `shader-compiler`, and without a helper
    /// that has it, can use no others.
    #[must_use]
    pub fn with_precompiled(mut self, precompiled: Option<PrecompiledShaders>) -> ShaderLibrary {
        self.compilers.precompiled = precompiled;
        self
    }

    /// Has HLSL, Slang and WGSL compiled by commands.
    #[must_use]
    pub fn with_compilers(mut self, compilers: ShaderCompilers) -> ShaderLibrary {
        self.compilers.commands = compilers;
        self
    }

    /// Takes SPIR-V of the program's, by the names of files that no folder has: `post.spv`.
    #[must_use]
    pub fn with_spirv(mut self, modules: impl IntoIterator<Item = (Arc<str>, Arc<[u8]>)>) -> ShaderLibrary {
        self.sources.files.modules.extend(modules);
        self
    }

    /// Takes layouts of the program's own for the sets that it binds itself.
    #[must_use]
    pub fn with_set_layouts(mut self, layouts: SetLayouts) -> ShaderLibrary {
        self.set_layouts = layouts;
        self
    }

    /// The layouts of the program's own.
    pub(crate) fn set_layouts(&self) -> &SetLayouts {
        &self.set_layouts
    }

    /// What the program brings along for its draws, and binds itself.
    pub(crate) fn draws(&self) -> &DrawInterfaces {
        &self.draws
    }

    /// The shader `name` when it draws `draw`, compiled as `variant` says.
    ///
    /// # Errors
    /// [`ShaderProblem`] says whether it is missing, doesn't compile or can't be used.
    pub fn compiled(&mut self, name: &str, draw: Draw, variant: &Variant) -> Result<CompiledShader, ShaderProblem> {
        let shader = ShaderName::of_text(name);
        let main = shader.main();
        let pushed = PushedBy { draw: self.draws.pushed_for(draw), params: variant.given.params.clone() };
        let Some(fragment) = self.stage(main, FRAGMENT, variant, &pushed)? else {
            return Err(self.sources.lacking(main, FRAGMENT));
        };
        // The same vertex stage, word for word: it must meet the same depth.
        let own = Variant { local: Vec::new(), depth_only: false, alpha_to_coverage: false, ..variant.clone() };
        let (vertex, usual_vertices) = match self.own_vertex_stage(&shader, fragment.shipped, &own, &pushed)? {
            Some(own) => (own, false),
            None => {
                let usual = self.usual_vertex_stage(main, draw, variant)?;
                let shipped = usual.shipped;
                (usual, shipped)
            }
        };
        // Who writes GLSL says the bindings of both stages.
        let fragment = match ShaderName::has_file(name).then(|| registers::beside(&vertex, &fragment)) {
            Some(moved) => moved.map_err(|what| ShaderProblem::Unsupported { what })?.map_or(fragment, Arc::new),
            None => fragment,
        };
        let mut interface = match join(&vertex, &fragment) {
            Ok(interface) => interface,
            Err(refused) => {
                let source = self.sources.source(&file_of(main, FRAGMENT))?;
                let placed = source.map(|source| refused.placed(&self.sources.files, &source.found));
                return Err(ShaderProblem::Unsupported { what: placed.unwrap_or_default() });
            }
        };
        if ShaderName::has_file(name) {
            interface.take_names(&variant.given);
        }
        let fills = !draw.is_full_screen() || usual_vertices;
        interface.own_vertices = (!fills).then(|| vertex.file.clone());
        let spirv = vertex.spirv.clone();
        if variant.depth_only && changes_nothing(&fragment.reflected.interface) {
            let (mut interface, input_attachments) = (vertex.reflected.interface.clone(), Vec::new());
            if ShaderName::has_file(name) {
                interface.take_names(&variant.given);
            }
            // One driver takes no notice of clip distances where there is no fragment stage: docs/drivers.md.
            let cut = both_eyes(variant).is_some_and(BothEyes::cuts_at_seam)
                || interface.needs.iter().any(distances::is_need);
            let fragment = cut.then(|| eyes::empty_fragment_stage().into());
            return Ok(CompiledShader { vertex: spirv, fragment, interface, usual_vertices, input_attachments });
        }
        let drawn = match variant.depth_only {
            // Nobody takes its colours, and a layer would say so.
            true => colors::none(&fragment.spirv).map_err(|what| ShaderProblem::Unsupported { what })?.into(),
            false => fragment.spirv.clone(),
        };
        Ok(CompiledShader {
            vertex: spirv,
            fragment: Some(drawn),
            interface,
            usual_vertices,
            input_attachments: fragment.reflected.input_attachments.clone(),
        })
    }

    /// The compute shader `name`, compiled as `variant` says.
    ///
    /// # Errors
    /// [`ShaderProblem`] says whether it is missing, doesn't compile or can't be used.
    pub fn compute(&mut self, name: &str, variant: &Variant) -> Result<CompiledCompute, ShaderProblem> {
        let name = StageName::of_text(name);
        let stage = self.stage(&name, COMPUTE, variant, &PushedBy::default())?;
        let stage = stage.ok_or_else(|| self.sources.lacking(&name, COMPUTE))?;
        let mut interface = stage.reflected.interface.clone();
        if name.is_file() {
            interface.take_names(&variant.given);
        }
        Ok(CompiledCompute { compute: stage.spirv.clone(), interface })
    }

    /// A shader's own vertex stage; `None`: the usual one of what is drawn goes with it.
    fn own_vertex_stage(
        &mut self,
        shader: &ShaderName,
        shipped: bool,
        variant: &Variant,
        pushed: &PushedBy,
    ) -> StageResult {
        match shader {
            ShaderName::Stages { vertex: None, .. } => Ok(None),
            ShaderName::Stages { vertex: Some(vertex), .. } => match self.stage(vertex, VERTEX, variant, pushed)? {
                Some(stage) => Ok(Some(stage)),
                None => Err(self.sources.lacking(vertex, VERTEX)),
            },
            // A shipped vertex shader goes with the shipped fragment shader only.
            ShaderName::Whole(name @ StageName::Glsl(_)) => {
                Ok(self.stage(name, VERTEX, variant, pushed)?.filter(|own| own.shipped == shipped))
            }
            ShaderName::Whole(StageName::File { file, .. }) => {
                let source = self.sources.source(file)?;
                let has = source.is_some_and(|it| matches!(&it.code, StageCode::Module(module) if module.has(VERTEX)));
                match has {
                    true => self.stage(&StageName::File { file: file.clone(), entry: None }, VERTEX, variant, pushed),
                    false => Ok(None),
                }
            }
        }
    }

    /// The vertex stage of a kind of draw, for the shader `name`, which has none of its own.
    fn usual_vertex_stage(
        &mut self,
        name: &StageName,
        draw: Draw,
        variant: &Variant,
    ) -> Result<Arc<CompiledStage>, ShaderProblem> {
        let file = draw.usual_vertex_shader();
        let what = || match name {
            StageName::Glsl(name) => format!("no vertex shader: neither `{name}.vert` nor `{file}` was found"),
            StageName::File { .. } => format!("no vertex shader: `{file}` wasn't found"),
        };
        let usual = match FilePath::of_text(&name.to_string()) {
            FilePath::Own(_) => FilePath::Own(file.into()),
            FilePath::Shipped(_) => FilePath::Shipped(file.into()),
        };
        let usual = usual.to_string();
        let usual = StageName::Glsl(usual.strip_suffix(VERTEX.facts().ending).unwrap_or(&usual).into());
        let bare = Variant { eye: variant.eye, form: variant.form, ..Variant::default() };
        let stage = self.stage(&usual, VERTEX, &bare, &PushedBy::default())?;
        stage.ok_or_else(|| ShaderProblem::Unsupported { what: what() })
    }

    /// The user's own files that the shader `name`, which the file `from` names, may be made of: SPIR-V, or texts with lines as on
    /// Unix, those of all its stages, of vertex shaders that stand in for the usual ones, and of what they include. They are sorted,
    /// each once. Files that can't be read are left out.
    #[must_use]
    pub fn own_files(&self, from: &FilePath, name: &str) -> Vec<Vec<u8>> {
        self.sources.own_files(from, name)
    }

    /// One stage by its name; `None` if there is no such file.
    fn stage(&mut self, name: &StageName, stage: ShaderStage, variant: &Variant, pushed: &PushedBy) -> StageResult {
        let Some(source) = self.sources.source(&file_of(name, stage))? else { return Ok(None) };
        let both = both_eyes(variant);
        let (macros, constants) = (macros(&source.mentioned, variant, stage), variant.constants.clone());
        // GLSL says by itself which push constants there are.
        let decides = source.code.is_foreign() && !pushed.draw.is_empty();
        let pushed = if decides { pushed.clone() } else { PushedBy::default() };
        let key = (name.clone(), stage, macros, both, in_layers(variant, stage), constants, pushed);
        if let Some(known) = self.stages.get(&key) {
            return known.clone();
        }
        let result = self.compile_stage(&source, &key);
        self.stages.insert(key, result.clone());
        result
    }

    /// The SPIR-V of a stage, of the file's or compiled, and why its push constants aren't the draw's.
    fn spirv_of(
        &mut self,
        source: &StageSource,
        key: &StageKey,
    ) -> Result<(CompilerAnswer, Vec<String>), ShaderProblem> {
        let StageSource { found, .. } = source;
        let &(ref name, stage, ref macros, both, _, ref constants, ref pushed) = key;
        let (compilers, files, program) = (&mut self.compilers, &self.sources.files, &self.program);
        let unsupported = |refused: RefusedStage| ShaderProblem::Unsupported { what: refused.placed(files, found) };
        if let StageName::File { file, entry } = name {
            let entry = entry.as_deref();
            let wanted = FileStage { file, entry, stage, macros, constants, both: both.is_some(), pushed };
            let CutModule { spirv, pushed_misfits } = wanted.compiled(source, compilers, files)?;
            let verdict = judge(&spirv);
            return Ok((CompilerAnswer { spirv, verdict }, pushed_misfits));
        }
        let parts = tells_parts(macros);
        if both.is_some_and(BothEyes::cuts_at_seam)
            && text::place(files, found, |word| word == "gl_ClipDistance").is_some()
        {
            return Err(unsupported(RefusedStage::beginning(&["gl_ClipDistance"], eyes::NOT_AT_SEAM.to_owned())));
        }
        let text = both.map_or_else(|| found.text.clone(), |both| both.around(&found.text, stage));
        let job =
            CompileJob { stage, language: None, entry: None, shown: found.shown.clone(), text, macros: macros.clone() };
        let answer = compilers.compile(&job, found, files).map_err(|problem| {
            // A location of the library's own in the text is refused as in the modes in which it compiles.
            let both = both.filter(|both| both.counts_instances());
            let refused = both.and_then(|both| {
                let text = both.around_without_location(&found.text, stage);
                let compiled = compilers.compile(&CompileJob { text, ..job.clone() }, found, files).ok()?;
                reflect(stage, &compiled.spirv, parts, true, program).err()
            });
            refused.map_or(problem, unsupported)
        })?;
        if stage.facts().has_workgroups {
            sized(files, found).map_err(unsupported)?;
        }
        if constants.is_empty() {
            return Ok((answer, Vec::new()));
        }
        let spirv = constants::with_values(answer.spirv, constants).map_err(|what| unsupported(what.into()))?;
        let verdict = judge(&spirv);
        Ok((CompilerAnswer { spirv, verdict }, Vec::new()))
    }

    fn compile_stage(&mut self, source: &StageSource, key: &StageKey) -> StageResult {
        let (CompilerAnswer { spirv, verdict }, pushed_misfits) = self.spirv_of(source, key)?;
        let StageSource { found, mentioned, code } = source;
        let &(_, stage, ref macros, both, ref in_layers, ..) = key;
        let files = &self.sources.files;
        let unsupported = |refused: RefusedStage| ShaderProblem::Unsupported { what: refused.placed(files, found) };
        // A stranger's module is judged before anything is read off it.
        if let (true, Verdict::Invalid(finding)) = (code.is_foreign(), &verdict) {
            return Err(ShaderProblem::Unsupported { what: invalid(finding, files, found) });
        }
        let told = match both {
            Some(both) if code.is_foreign() => eyes_of_modules::for_both(&spirv, stage, both),
            both => eyes_of_modules::without_views(spirv, both, [mentioned.view, is_for_right_eye(macros)]),
        };
        let spirv = told.map_err(unsupported)?;
        let reflected = reflect(stage, &spirv, tells_parts(macros), both.is_some(), &self.program);
        let mut reflected = reflected.map_err(unsupported)?;
        // A resource that no pass can give is refused later, in better words.
        let is_refused = |binding: &Binding| binding.kind.unbindable().is_some();
        if let Verdict::Invalid(finding) = &verdict
            && !reflected.interface.bindings.iter().any(is_refused)
        {
            return Err(ShaderProblem::Unsupported { what: invalid(finding, files, found) });
        }
        reflected.interface.pushed_misfits = pushed_misfits;
        reflected.interface.needs = placed_needs(&reflected.needs, &verdict, files, found);
        let names: Vec<&str> = in_layers.iter().map(String::as_str).collect();
        let by_eye = |spirv: Vec<u32>| layers::by_eye(&spirv, &names).map_err(|what| unsupported(what.into()));
        let spirv = if names.is_empty() { spirv } else { by_eye(spirv)? };
        if both.is_some()
            && code.is_foreign()
            && let Verdict::Invalid(finding) = judge(&spirv)
        {
            return Err(unsupported(
                format!("it can't be made to draw for both eyes at once: {}", finding.words).into(),
            ));
        }
        if mentioned.eye || mentioned.view {
            reflected.interface.sees_alike.clear();
        }
        let spirv = if stage.facts().writes_attachments { without_idle_inputs(spirv) } else { spirv };
        for binding in &mut reflected.interface.bindings {
            if let Some(UnbindableResource { place, .. }) = binding.kind.unbindable_mut() {
                *place = text::place(files, found, |word| word == binding.name);
            }
        }
        for resource in &mut reflected.interface.program {
            resource.place = text::place(files, found, |word| word == resource.name);
        }
        if reflected.interface.discards || reflected.interface.masks_samples {
            let words = if reflected.interface.discards { DISCARDS } else { MASKS_SAMPLES };
            reflected.interface.leaves_out_at = text::place(files, found, |word| words.contains(&word));
        }
        let only_written = reflected.interface.bindings.iter().filter(|binding| binding.kind.is_only_written());
        let places = only_written.filter_map(|Binding { name, .. }| {
            let place = text::place(files, found, |word| word == name)?;
            Some((name.clone(), place))
        });
        reflected.interface.only_written_at = places.collect();
        for unset in &mut reflected.interface.unset {
            unset.place = text::place(files, found, |word| word == unset.name);
        }
        for binding in reflected.interface.bindings.iter_mut().filter(|binding| binding.set == PASS_SET) {
            // An array is declared as it is, and isn't told of parts.
            let alone = binding.length.is_none();
            binding.adapts = alone && binding.kind.is_sampled() && mentioned.adapting.contains(&binding.name);
            if alone && mentioned.parts.contains(&binding.name) {
                reflected.interface.asks_part.push(binding.name.clone());
            }
        }
        let (file, shipped) = (found.shown.clone(), matches!(found.path, FilePath::Shipped(_)));
        Ok(Some(Arc::new(CompiledStage { file, shipped, spirv: spirv.into(), reflected })))
    }
}

impl ShaderInterfaces for ShaderLibrary {
    fn find(&mut self, from: &FilePath, name: &Arc<str>, draw: Option<Draw>) -> Result<Arc<str>, ShaderProblem> {
        let mut located = |name: &StageName, stage: ShaderStage| {
            let found = self.sources.located(from, name, stage)?;
            found.ok_or_else(|| self.sources.missing(from, name, stage))
        };
        let found = match ShaderName::of_text(name) {
            ShaderName::Whole(main) => {
                ShaderName::Whole(located(&main, if draw.is_some() { FRAGMENT } else { COMPUTE })?)
            }
            ShaderName::Stages { vertex, fragment } => ShaderName::Stages {
                vertex: vertex.map(|vertex| located(&vertex, VERTEX)).transpose()?,
                fragment: located(&fragment, FRAGMENT)?,
            },
        };
        Ok(found.to_string().into())
    }

    fn draw_shader(&mut self, name: &str, draw: Draw, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.compiled(name, draw, variant).map(|shader| shader.interface)
    }

    fn compute_shader(&mut self, name: &str, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.compute(name, variant).map(|shader| shader.interface)
    }

    fn brought_along(&self, draw: Option<Draw>, name: &str) -> DrawInterface {
        self.draws.of_pass(draw, name)
    }

    fn program_sets(&self) -> Vec<ProgramSet> {
        self.draws.sets().to_vec()
    }

    fn custom_passes(&self) -> Option<Vec<Arc<str>>> {
        self.draws.custom_passes().map(<[Arc<str>]>::to_vec)
    }
}

/// A compute stage says how large its workgroups are. If it doesn't, GLSL makes them one invocation each, which hardly any shader
/// means.
fn sized(files: &ShaderFiles, stage: &SourceFile) -> Result<(), RefusedStage> {
    if text::place(files, stage, |word| word.starts_with("local_size_")).is_some() {
        return Ok(());
    }
    let what = "it doesn't say how large its workgroups are; write `layout(local_size_x = 8, local_size_y = 8) in;` for \
        workgroups of 8×8, or `layout(local_size_x = 1) in;` for single invocations";
    Err(RefusedStage::named("main", what.to_owned()))
}

/// That a stage is no valid SPIR-V, with the place.
fn invalid(finding: &Finding, files: &ShaderFiles, stage: &SourceFile) -> String {
    let what = format!("SPIR-V that Vulkan 1.3 doesn't allow: {}", finding.words);
    match &finding.place {
        Some((file, line)) => format!("{}: {what}", text::line_of(files, stage, file, *line)),
        None => RefusedStage::shown_by(Words::First(finding.named.clone()), what).placed(files, stage),
    }
}

/// What a stage asks of a device, with the places that show it in its text.
fn placed_needs(needs: &[Needed], verdict: &Verdict, files: &ShaderFiles, stage: &SourceFile) -> Vec<Need> {
    let placed =
        needs.iter().map(|Needed { kind, words }| Need { kind: kind.clone(), place: words.place(files, stage).into() });
    let unjudged = match verdict {
        Verdict::Unknown(words) => {
            Some(Need { kind: NeedKind::Unjudged(words.as_str().into()), place: stage.shown.as_str().into() })
        }
        Verdict::None | Verdict::Valid | Verdict::Invalid(_) => None,
    };
    placed.chain(unjudged).collect()
}
