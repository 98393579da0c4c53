//! A pipeline that was read: a frame is made of it, and a Plan of the frame.

use crate::assets::Assets;
use crate::choices::Choices;
use crate::error::Error;
use crate::files::{self, PipelineFile};
use crate::options::RendererOptions;
use framewright_graph::base::{Diagnostic, FilePath, ReadFiles, SourceFile, Sources};
use framewright_graph::compile::{self, Compiler, Options, heap_size};
use framewright_graph::device::{MemoryProvider, Profile};
use framewright_graph::expand::{self, Expander, Inputs};
use framewright_graph::frame::{Frame, TextureFile, TextureInfo, TextureProblem, Textures};
use framewright_graph::language::{self, Document, Files, FoundFile, PipelineFiles, ReadFailure, SettingsFile};
use framewright_graph::plan::{Plan, UsedFeature};
use framewright_graph::verify;
use framewright_passes::texture_files::TextureFiles;
use framewright_vulkan::Device;
use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A pipeline that was read.
#[non_exhaustive]
pub struct Pipeline {
    /// Its entries, with values not yet chosen.
    pub document: Document,
    /// The texts that it was read from.
    pub sources: Arc<Sources>,
    /// Its shaders and pictures. What a frame found out about a shader is kept for the next frames: a program that changes its shaders opens
    /// the pipeline anew.
    pub assets: Assets,
    /// The paths of the pictures that it names.
    pub pictures: BTreeSet<Arc<str>>,
    /// What its files led to.
    pub links: FileLinks,
    settings: Vec<SettingsFile>,
    /// What frames have in common.
    expander: Expander,
    shipped: bool,
}

impl fmt::Debug for Pipeline {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.debug_struct("Pipeline").field("document", &self.document).finish_non_exhaustive()
    }
}

/// What the files of a pipeline led to: with its sources enough to read it anew where there is no disk.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct FileLinks {
    /// The extensions that the program applied to it, in their order.
    pub extensions: Vec<FilePath>,
    /// Paths of other files: the file in which a path stands, the path, and the file that it led to.
    pub paths: Vec<(FilePath, String, FilePath)>,
    /// Pictures, with what is known of each.
    pub pictures: Vec<(TextureFile, TextureInfo)>,
}

/// Where a pipeline comes from.
#[derive(Debug, Clone)]
pub(crate) enum Origin {
    /// A file, or a shipped pipeline.
    File(PathBuf),
    /// The program itself.
    Text {
        /// What messages call it.
        name: String,
        /// The pipeline.
        text: String,
    },
}

/// A frame, and its Plan.
#[derive(Debug)]
pub struct PlannedFrame {
    /// The frame.
    pub frame: Frame,
    /// Its Plan, verified.
    pub plan: Plan,
}

impl PlannedFrame {
    /// The Plan, with the frame that it was made of.
    #[must_use]
    pub fn parts(&self) -> (&Plan, Option<&Frame>) {
        (&self.plan, Some(&self.frame))
    }
}

/// The files that a pipeline names: of its language, and pictures.
struct NamedFiles<'t> {
    files: PipelineFiles,
    textures: &'t mut TextureFiles,
    /// The paths of pictures that are named.
    pictures: BTreeSet<Arc<str>>,
    links: FileLinks,
}

impl Files for NamedFiles<'_> {
    fn read(&mut self, from: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        let found = self.files.read(from, path)?;
        self.links.paths.push((from.clone(), path.to_owned(), found.relative.clone()));
        Ok(found)
    }

    fn picture(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        self.pictures.insert(file.path.clone());
        let info = self.textures.info(file)?;
        self.links.pictures.push((file.clone(), info));
        Ok(info)
    }
}

impl PipelineFile {
    /// Reads it, its extensions, settings files, and the files that it names. The preset of the settings files is in force, if they name
    /// one.
    ///
    /// # Errors
    /// [`Error::Mistakes`] with all mistakes that don't depend on settings, scene or device; settings files that can't be read.
    pub fn read(self, options: &RendererOptions) -> Result<Pipeline, Error> {
        let read = self.read.clone();
        let mut assets = Assets::new(self.root(), options, &read);
        let extensions = self.extensions.iter().map(|extension| extension.relative.clone()).collect();
        let links = FileLinks { extensions, ..FileLinks::default() };
        let pictures = BTreeSet::new();
        let mut named = NamedFiles { files: self.files, textures: &mut assets.textures, pictures, links };
        let mut sources = Sources::default();
        let document = language::read_extended(&mut sources, &mut named, self.own, self.extensions);
        let NamedFiles { pictures, links, .. } = named;
        let document = document.map_err(|diagnostics| Error::mistakes(&sources, diagnostics))?;
        let (sources, shipped) = (Arc::new(sources), self.shipped);
        let mut pipeline = Pipeline {
            document,
            sources,
            assets,
            pictures,
            links,
            settings: Vec::new(),
            shipped,
            expander: Expander::default(),
        };
        pipeline.read_settings(&options.settings, &read)?;
        pipeline.choose(None)?;
        Ok(pipeline)
    }
}

impl Pipeline {
    /// Reads the pipeline in the file `path`; where there is none, the shipped one of that name. All files that are read, now or
    /// later, are recorded in `read`.
    ///
    /// # Errors
    /// If there is neither, or it is wrong in itself.
    pub fn open(path: impl AsRef<Path>, options: &RendererOptions, read: &ReadFiles) -> Result<Pipeline, Error> {
        Pipeline::of(&Origin::File(path.as_ref().to_owned()), options, read)
    }

    /// Reads the pipeline of `origin`.
    pub(crate) fn of(origin: &Origin, options: &RendererOptions, read: &ReadFiles) -> Result<Pipeline, Error> {
        let file = match origin {
            Origin::File(path) => PipelineFile::find(path, &options.files, read)?,
            Origin::Text { name, text } => PipelineFile::carried(name, text, &options.files, read)?,
        };
        file.read(options)
    }

    /// Whether it is a shipped one, since there is no file of that name.
    #[must_use]
    pub fn is_shipped(&self) -> bool {
        self.shipped
    }

    /// The texts of its language, the pipeline first; then those of its settings files.
    #[must_use]
    pub fn texts(&self) -> [Vec<&SourceFile>; 2] {
        let mut files: Vec<&SourceFile> = (0..).map_while(|file| self.sources.file(file)).collect();
        // They were read last.
        let settings = files.split_off(files.len().saturating_sub(self.settings.len()));
        [files, settings]
    }

    /// Reads settings files, one after the other.
    fn read_settings(&mut self, paths: &[PathBuf], read: &ReadFiles) -> Result<(), Error> {
        let sources = Arc::make_mut(&mut self.sources);
        let mut mistakes = Vec::new();
        for path in paths {
            let text = files::settings(path, read)?;
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
            match self.document.read_settings(sources, &path.to_string_lossy(), &name, text) {
                Ok(file) => self.settings.push(file),
                Err(diagnostics) => mistakes.extend(diagnostics),
            }
        }
        if mistakes.is_empty() { Ok(()) } else { Err(self.wrong(mistakes)) }
    }

    /// Puts settings files and a preset in force; `None`: the preset of the settings files, if they name one.
    ///
    /// # Errors
    /// [`Error::Mistakes`] if the pipeline has no such preset.
    pub fn choose(&mut self, preset: Option<&str>) -> Result<(), Error> {
        let chosen = self.document.choose(preset, &self.settings);
        chosen.map_err(|unknown| Error::of_choices(&self.sources, vec![unknown]))
    }

    /// Makes sure that choices are right by themselves.
    ///
    /// # Errors
    /// [`Error::Mistakes`] with settings that the pipeline doesn't have, values that it doesn't allow, a size that no frame has, and
    /// names of no image.
    pub fn check<'c>(&self, choices: impl IntoIterator<Item = &'c Choices>) -> Result<(), Error> {
        let wrong = |choices: &Choices| expand::check_inputs(&self.document, &choices.on_any_device());
        let wrong: Vec<Diagnostic> = choices.into_iter().flat_map(wrong).collect();
        if wrong.is_empty() { Ok(()) } else { Err(Error::of_choices(&self.sources, wrong)) }
    }

    /// The frame of these choices on a device.
    ///
    /// # Errors
    /// Those of [`Pipeline::check`] and [`Choices::stereo_on`]; the mistakes of the pipeline and its shaders.
    pub fn frame(&mut self, choices: &Choices, device: &Profile) -> Result<Frame, Error> {
        self.check([choices])?;
        self.expand(&choices.inputs(choices.stereo_on(device)?, Some(device)))
    }

    /// The frame of these inputs.
    ///
    /// # Errors
    /// [`Error::Mistakes`] with those of the inputs, the pipeline and its shaders.
    pub fn expand(&mut self, inputs: &Inputs<'_>) -> Result<Frame, Error> {
        let (sources, shaders) = (Arc::clone(&self.sources), &mut self.assets.shaders);
        let frame = self.expander.expand(&self.document, sources, inputs, shaders);
        frame.map_err(|diagnostics| self.wrong(diagnostics))
    }

    /// Compiles a frame for a device, has the Plan verified, and its shaders compiled as its passes are drawn.
    ///
    /// # Errors
    /// The mistakes of the frame and its shaders, features that the device lacks, and the violations that `verify` found.
    pub fn compile(
        &mut self,
        frame: &Frame,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Plan, Error> {
        #[cfg(feature = "tracing")]
        let _span = tracing::info_span!("compile").entered();
        let plan = compile::compile(frame, device, memory, options).map_err(|wrong| self.wrong(wrong))?;
        let violations = verify::verify(&plan);
        if !violations.is_empty() {
            return Err(framewright_vulkan::Error::Violations { violations }.into());
        }
        let wrong = compile::shaders::wrong(&plan, frame, &mut self.assets.shaders);
        if wrong.is_empty() { Ok(plan) } else { Err(self.wrong(wrong)) }
    }

    /// The frame of these choices on a device, and its Plan.
    ///
    /// # Errors
    /// Those of [`Pipeline::frame`] and [`Pipeline::compile`].
    pub fn planned(
        &mut self,
        choices: &Choices,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<PlannedFrame, Error> {
        let frame = self.frame(choices, device)?;
        let plan = self.compile(&frame, device, memory, options)?;
        Ok(PlannedFrame { frame, plan })
    }

    /// Makes sure that a device has the memory that a Plan takes.
    ///
    /// # Errors
    /// [`Error::Mistakes`] with the memory that it takes, and the images that take most.
    pub fn fits(&self, plan: &Plan, frame: &Frame, device: &Profile) -> Result<(), Error> {
        heap_size::too_large(plan, frame, device).map_or(Ok(()), |large| Err(self.wrong(vec![large])))
    }

    /// The features of a device that a Plan of its uses: see [`Plan::features`]. It needs no device.
    ///
    /// # Errors
    /// A shader that can't be used.
    pub fn features(&mut self, plan: &Plan) -> Result<Vec<UsedFeature>, Error> {
        let used = plan.features(&mut self.assets.shaders);
        used.map_err(|(name, problem)| framewright_vulkan::Error::Shader { name: name.to_string(), problem }.into())
    }

    /// The Plan of a frame of these choices, made by `compiler`. Shaders are compiled when it is executed.
    pub(crate) fn plan<'c>(
        &mut self,
        compiler: &'c mut Compiler,
        device: &Device,
        profile: &Arc<Profile>,
        choices: &Choices,
        options: &Options,
    ) -> Result<&'c Plan, Error> {
        #[cfg(feature = "tracing")]
        let _span = tracing::info_span!("compile").entered();
        let frame = Arc::new(self.expand(&choices.inputs(choices.stereo_on(profile)?, Some(profile)))?);
        let plan = compiler.compile(&frame, profile, &mut device.memory(), options);
        let plan = plan.map_err(|diagnostics| self.wrong(diagnostics))?;
        self.fits(plan, &frame, profile)?;
        Ok(plan)
    }

    fn wrong(&self, diagnostics: Vec<Diagnostic>) -> Error {
        Error::mistakes(&self.sources, diagnostics)
    }
}
