//! Shader stages, and what is known of each.

use ash::vk;
use framewright_graph::vulkan::Stages;
use rspirv::spirv::ExecutionModel;
use serde::{Deserialize, Serialize};

/// A shader stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(crate) enum ShaderStage {
    /// Vertex shading.
    Vertex,
    /// Fragment shading.
    Fragment,
    /// Compute shading.
    Compute,
}

/// What is known of a shader stage.
pub(crate) struct StageFacts {
    /// Its name in messages.
    pub(crate) name: &'static str,
    /// How the names of its files end.
    pub(crate) ending: &'static str,
    /// How a message about a shader names this stage of it; a compute shader has no other stage.
    pub(crate) subject: &'static str,
    /// The stage of a pipeline that runs it.
    pub(crate) pipeline: Stages,
    /// Vulkan's bit.
    pub(crate) flag: vk::ShaderStageFlags,
    /// SPIR-V's word.
    pub(crate) model: ExecutionModel,
    /// Whether it is a part of a draw: eyes and rotations are its concern.
    pub(crate) draws: bool,
    /// Whether it runs once for each vertex, reads attributes, and puts out positions.
    pub(crate) places_vertices: bool,
    /// Whether its outputs are attachments.
    pub(crate) writes_attachments: bool,
    /// Whether each device allows it to write to images and buffers.
    pub(crate) may_store: bool,
    /// Whether it runs in workgroups, whose size it says.
    pub(crate) has_workgroups: bool,
    /// The property that a device must have for subgroups in it; `None`: every device has it.
    pub(crate) subgroups: Option<&'static str>,
}

impl ShaderStage {
    /// All stages.
    pub(crate) const ALL: [ShaderStage; 3] = [ShaderStage::Vertex, ShaderStage::Fragment, ShaderStage::Compute];

    /// The bits of all stages.
    pub(crate) const FLAGS: vk::ShaderStageFlags = {
        let (mut raw, mut at) = (0, 0);
        while at < ShaderStage::ALL.len() {
            raw |= ShaderStage::ALL[at].facts().flag.as_raw();
            at += 1;
        }
        vk::ShaderStageFlags::from_raw(raw)
    };

    /// What is known of the stage.
    pub(crate) const fn facts(self) -> StageFacts {
        match self {
            ShaderStage::Vertex => StageFacts {
                name: "vertex",
                ending: ".vert",
                subject: "the vertex stage",
                pipeline: Stages::VERTEX_SHADER,
                flag: vk::ShaderStageFlags::VERTEX,
                model: ExecutionModel::Vertex,
                draws: true,
                places_vertices: true,
                writes_attachments: false,
                may_store: false,
                has_workgroups: false,
                subgroups: Some("subgroupSupportedStages.VERTEX"),
            },
            ShaderStage::Fragment => StageFacts {
                name: "fragment",
                ending: ".frag",
                subject: "the fragment stage",
                pipeline: Stages::FRAGMENT_SHADER,
                flag: vk::ShaderStageFlags::FRAGMENT,
                model: ExecutionModel::Fragment,
                draws: true,
                places_vertices: false,
                writes_attachments: true,
                may_store: true,
                has_workgroups: false,
                subgroups: Some("subgroupSupportedStages.FRAGMENT"),
            },
            ShaderStage::Compute => StageFacts {
                name: "compute",
                ending: ".comp",
                subject: "it",
                pipeline: Stages::COMPUTE_SHADER,
                flag: vk::ShaderStageFlags::COMPUTE,
                model: ExecutionModel::GLCompute,
                draws: false,
                places_vertices: false,
                writes_attachments: false,
                may_store: true,
                has_workgroups: true,
                subgroups: None,
            },
        }
    }

    /// The name of its file of the shader `name`.
    pub(crate) fn file_of(self, name: &str) -> String {
        format!("{name}{}", self.facts().ending)
    }
}

/// Vulkan's bits of the shader stages among stages of pipelines.
pub(crate) fn stage_flags(stages: Stages) -> vk::ShaderStageFlags {
    let facts = ShaderStage::ALL.map(ShaderStage::facts);
    let flags = facts.iter().filter(|it| stages.contains(it.pipeline)).map(|it| it.flag);
    flags.fold(vk::ShaderStageFlags::empty(), |all, flag| all | flag)
}
