//! Pipelines, one for each description, made on several threads.

use super::graphics;
use super::shader_module::ShaderModule;
use crate::base::Error;
use crate::gpu::{Gpu, PipelineDescriptor};
use crate::shaders::Spirv;
use ash::vk;
use std::collections::HashSet;
use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// At most this many threads make pipelines, so that a large machine starts no thread for each pipeline.
const MOST_THREADS: usize = 16;
/// The stack of a thread: as large as that of a program's first thread usually is, since drivers compile on it.
const STACK_BYTES: usize = 8 << 20;

impl Gpu {
    /// The pipeline of this description. It bears the name of who first asked for it: others may be using it
    /// already.
    pub(crate) fn pipeline(&self, name: &str, descriptor: &PipelineDescriptor) -> Result<vk::Pipeline, Error> {
        self.caches.pipelines.get(descriptor, |descriptor| {
            let (pipeline, found) = self.create_pipeline(name, descriptor)?;
            self.pipeline_cache.count(found);
            Ok(pipeline)
        })
    }

    /// A new pipeline, and whether the driver found it in its cache.
    fn create_pipeline(&self, name: &str, descriptor: &PipelineDescriptor) -> Result<(vk::Pipeline, bool), Error> {
        let created = match descriptor {
            PipelineDescriptor::Graphics(descriptor) => graphics::create(self, descriptor)?,
            PipelineDescriptor::Compute { shader, layout } => create_compute(self, shader, *layout)?,
        };
        self.name(created.0, name);
        Ok(created)
    }

    /// The pipelines of these descriptions with their names. Those that there aren't yet are made on as many threads as the machine
    /// runs at once.
    ///
    /// # Errors
    /// The error of the first one that can't be made.
    pub(crate) fn pipelines(&self, wanted: &[(&str, &PipelineDescriptor)]) -> Result<Vec<vk::Pipeline>, Error> {
        let mut seen = HashSet::new();
        let missing = wanted
            .iter()
            .copied()
            .filter(|(_, descriptor)| self.caches.pipelines.find(descriptor).is_none() && seen.insert(*descriptor));
        let missing: Vec<_> = missing.collect();
        let threads = thread::available_parallelism().map_or(1, NonZero::get).min(MOST_THREADS).min(missing.len());
        let next = AtomicUsize::new(0);
        let make = || {
            let mut failed = Vec::new();
            while let Some((at, (name, descriptor))) =
                missing.iter().enumerate().nth(next.fetch_add(1, Ordering::Relaxed))
            {
                if let Err(error) = self.pipeline(name, descriptor) {
                    failed.push((at, error));
                }
            }
            failed
        };
        let failed = thread::scope(|scope| {
            let start = |_| thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, make).ok();
            // This thread makes pipelines too, so that all are made where no other can be started.
            let started: Vec<_> = (1..threads).map_while(start).collect();
            let mut failed = make();
            for thread in started {
                failed.extend(thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
            }
            failed
        });
        match failed.into_iter().min_by_key(|(at, _)| *at) {
            Some((_, error)) => Err(error),
            None => wanted.iter().map(|(name, descriptor)| self.pipeline(name, descriptor)).collect(),
        }
    }
}

fn create_compute(gpu: &Gpu, shader: &Spirv, layout: vk::PipelineLayout) -> Result<(vk::Pipeline, bool), Error> {
    let module = ShaderModule::new(gpu, shader)?;
    let mut feedback = vk::PipelineCreationFeedback::default();
    let mut told = vk::PipelineCreationFeedbackCreateInfo::default().pipeline_creation_feedback(&mut feedback);
    let info = vk::ComputePipelineCreateInfo::default()
        .stage(module.stage(vk::ShaderStageFlags::COMPUTE))
        .layout(layout)
        .push_next(&mut told);
    // SAFETY: everything that `info` points to outlives the call; the interface was matched with the layout.
    let made = unsafe { gpu.raw.create_compute_pipelines(gpu.pipeline_cache.raw, &[info], None) };
    created(made, feedback)
}

/// The one pipeline that was created with `feedback`, and whether the driver found it in its cache.
pub(super) fn created(
    made: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    feedback: vk::PipelineCreationFeedback,
) -> Result<(vk::Pipeline, bool), Error> {
    let doing = "creating a pipeline";
    let made = made.map_err(|(_, result)| Error::vulkan(doing)(result))?;
    let pipeline = made.first().copied().ok_or(Error::Vulkan { doing, result: vk::Result::ERROR_UNKNOWN })?;
    let found =
        vk::PipelineCreationFeedbackFlags::VALID | vk::PipelineCreationFeedbackFlags::APPLICATION_PIPELINE_CACHE_HIT;
    Ok((pipeline, feedback.flags.contains(found)))
}
