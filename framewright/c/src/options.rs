//! What a renderer is made with.

use crate::arguments::{FramewrightNames, Structure, bytes, list, optional_text, text};
use crate::device::FramewrightDevice;
use crate::draws::{FramewrightDrawInterface, ProgramDraws};
use crate::sets::{FramewrightSet, program_sets};
use crate::status::Problem;
use framewright::graph::base::Root;
use framewright::vulkan::LARGEST_SPIRV;
use framewright::{PrecompiledShaders, RendererOptions};
use std::ffi::{c_char, c_void};
use std::ptr;
use std::sync::Arc;

/// A file that the program carries within itself.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightFile {
    /// Its name.
    pub name: *const c_char,
    /// What it holds.
    pub bytes: *const c_void,
    /// How many bytes, at most 16 MiB.
    pub byte_count: usize,
}

/// What a renderer is made with, and keeps. 0 in a field is its default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightRendererOptions {
    /// sizeof(FramewrightRendererOptions).
    pub struct_size: usize,
    /// How many frames may be on their way before a new one waits for the oldest, at most 16; 0 counts as 1.
    pub frames_in_flight: u32,
    /// Folders of shaders beside that of the pipeline.
    pub shaders: FramewrightNames,
    /// Settings files, of which later ones are stronger.
    pub settings: FramewrightNames,
    /// Extensions that are applied to the pipeline: files, or paths of shipped ones.
    pub extensions: FramewrightNames,
    /// What the program's draws bring along, for each kind of draws at most once; the kinds that aren't listed bring nothing. If there are
    /// none, all kinds bring what a scene does.
    pub draws: *const FramewrightDrawInterface,
    /// How many there are.
    pub draw_count: usize,
    /// With `draws`: whether the kinds that aren't listed bring what a scene does, which then draws them. 0 is false.
    pub scene_draws: u32,
    /// The names of all custom passes that the program records: others are mistakes of a pipeline. If there are none, any name is right.
    pub custom_passes: FramewrightNames,
    /// Descriptor sets that the program makes itself, and binds by `framewright_renderer_bind_set`.
    pub sets: *const FramewrightSet,
    /// How many there are.
    pub set_count: usize,
    /// Commands that compile shaders in HLSL, Slang and WGSL, each with its language: `hlsl=dxc`, `slang=slangc -O0`. Later ones are
    /// stronger. docs/hlsl.md has more.
    pub shader_compilers: FramewrightNames,
    /// Modules of SPIR-V, by the names of files that no folder has: a pipeline says `FullScreen("post.spv")`.
    pub spirv: *const FramewrightFile,
    /// How many there are.
    pub spirv_count: usize,
    /// A folder of shaders that were compiled ahead; NULL: none. Others are compiled, where the library has a compiler.
    pub precompiled: *const c_char,
    /// Whether shaders that are compiled are added to that folder. 0 is false.
    pub precompiled_adds: u32,
    /// In place of such a folder its files, by their names without folder.
    pub precompiled_files: *const FramewrightFile,
    /// How many there are.
    pub precompiled_file_count: usize,
    /// The program hands addresses of buffers out in its sets, and vouches for the shaders that follow them. 0 is false.
    pub addresses: u32,
    /// Whether what custom passes do is held against what the pipeline says of them, to look for mistakes: 1. A broken promise fails the call
    /// that waits for the frame, or for room for another one, and the frame is done all the same. docs/embedding.md has more.
    pub check_uses: u32,
    /// Whether Plans are for the queue for graphics alone, as `framewright_renderer_record_into` needs it of a device with several. 0 is false.
    pub one_queue: u32,
    /// Whether the device notes each step that it begins: an error of a device that stopped names the step. It takes time. 0 is false.
    pub breadcrumbs: u32,
    /// Whether each step is waited for before the next, to the same end. 0 is false.
    pub step_by_step: u32,
}

// SAFETY: it begins with its size, and has integers and pointers alone.
unsafe impl Structure for FramewrightRendererOptions {
    const NAME: &'static str = "FramewrightRendererOptions";
    const DEFAULT: Self = FramewrightRendererOptions {
        struct_size: 0,
        frames_in_flight: 0,
        shaders: FramewrightNames::NONE,
        settings: FramewrightNames::NONE,
        extensions: FramewrightNames::NONE,
        draws: ptr::null(),
        draw_count: 0,
        scene_draws: 0,
        custom_passes: FramewrightNames::NONE,
        sets: ptr::null(),
        set_count: 0,
        shader_compilers: FramewrightNames::NONE,
        spirv: ptr::null(),
        spirv_count: 0,
        precompiled: ptr::null(),
        precompiled_adds: 0,
        precompiled_files: ptr::null(),
        precompiled_file_count: 0,
        addresses: 0,
        check_uses: 0,
        one_queue: 0,
        breadcrumbs: 0,
        step_by_step: 0,
    };
}

/// Frames that may be on their way: each has memory of its own.
const MOST_FRAMES: u32 = 16;

impl FramewrightRendererOptions {
    /// The same in Rust, for a renderer of `device`, and who draws what.
    ///
    /// # Safety
    /// The fields are as they say.
    pub(crate) unsafe fn read(&self, device: &FramewrightDevice) -> Result<(RendererOptions, ProgramDraws), Problem> {
        let mut options = RendererOptions::default();
        options.executor.frames_in_flight = match self.frames_in_flight {
            frames @ ..=MOST_FRAMES => frames.max(1),
            frames => {
                let what = format!("`frames_in_flight` is {frames}, and at most {MOST_FRAMES} may be on their way");
                return Err(Problem::Misuse(what));
            }
        };
        options.executor.check_uses = self.check_uses != 0;
        options.executor.breadcrumbs = self.breadcrumbs != 0;
        options.executor.step_by_step = self.step_by_step != 0;
        options.compile.queues &= self.one_queue == 0;
        options.helper.clone_from(&device.helper);
        // SAFETY: the caller's word.
        unsafe {
            let folders = self.shaders.texts("shaders")?;
            options.shaders = folders.into_iter().map(|folder| Root::new(folder.into())).collect();
            options.settings = self.settings.texts("settings")?.into_iter().map(Into::into).collect();
            let draws = list(self.draws, self.draw_count, "draws")?;
            let custom = self.custom_passes.texts("custom_passes")?;
            let mut draws = ProgramDraws::read(draws, self.scene_draws != 0, &custom)?;
            (draws.interfaces, options.set_layouts) = program_sets(self.sets, self.set_count, draws.interfaces)?;
            if self.addresses != 0 {
                draws.interfaces = draws.interfaces.with_addresses();
            }
            options.draws.clone_from(&draws.interfaces);
            options.files.extensions = self.extensions.texts("extensions")?.into_iter().map(Into::into).collect();
            for compiler in self.shader_compilers.texts("shader_compilers")? {
                let named = options.shader_compilers.set_named(compiler);
                named.map_err(|bad| Problem::Misuse(format!("`shader_compilers`: {bad}")))?;
            }
            options.spirv = files(self.spirv, self.spirv_count, "spirv")?;
            options.precompiled = self.precompiled()?;
            Ok((options, draws))
        }
    }

    /// # Safety
    /// The fields are as they say.
    unsafe fn precompiled(&self) -> Result<Option<PrecompiledShaders>, Problem> {
        // SAFETY: the caller's word.
        let (folder, files) = unsafe {
            let folder = optional_text(self.precompiled, "precompiled")?;
            (folder, files(self.precompiled_files, self.precompiled_file_count, "precompiled_files")?)
        };
        match folder {
            Some(_) if !files.is_empty() => {
                Err(Problem::Misuse("`precompiled` names a folder, and `precompiled_files` are in memory".to_owned()))
            }
            Some(folder) => {
                let folder = PrecompiledShaders::in_folder(folder);
                Ok(Some(if self.precompiled_adds == 0 { folder } else { folder.adding() }))
            }
            None if self.precompiled_adds != 0 => {
                Err(Problem::Misuse("`precompiled_adds` takes a folder, and `precompiled` is NULL".to_owned()))
            }
            None if files.is_empty() => Ok(None),
            None => Ok(Some(PrecompiledShaders::in_memory(files))),
        }
    }
}

/// A file in memory: its name, and what it holds.
type NamedBytes = (Arc<str>, Arc<[u8]>);

/// # Safety
/// The pointer is NULL, or `count` files stand there.
unsafe fn files(files: *const FramewrightFile, count: usize, what: &str) -> Result<Vec<NamedBytes>, Problem> {
    // SAFETY: the caller's word.
    let files = unsafe { list(files, count, what)? };
    let file = |(number, file): (usize, &FramewrightFile)| {
        // SAFETY: the caller's word.
        unsafe {
            let name = text(file.name, &format!("{what}[{number}].name"))?;
            let bytes = bytes(file.bytes, file.byte_count, LARGEST_SPIRV, &format!("{what}[{number}].bytes"))?;
            Ok((name.into(), bytes.into()))
        }
    };
    files.iter().enumerate().map(file).collect()
}
