//! The features of the minimum device. One that a program made itself needs those alone that its Plans use.

/// What each Plan uses, by Vulkan's names: its barriers, memory, frames and times.
pub const EVERY_PLAN_USES: [&str; 4] = ["synchronization2", "maintenance4", "timelineSemaphore", "hostQueryReset"];

/// What a Plan uses where it does what the feature is for, by Vulkan's names.
pub const SOME_PLANS_USE: [&str; 7] = [
    DYNAMIC_RENDERING,
    SEPARATE_LAYOUTS,
    INDEPENDENT_BLEND,
    // Shaders say so.
    "shaderDemoteToHelperInvocation",
    "shaderTerminateInvocation",
    "fragmentStoresAndAtomics",
    "sampleRateShading",
];

/// Rendering scopes.
pub(crate) const DYNAMIC_RENDERING: &str = "dynamicRendering";
/// Depth and stencil in layouts of their own.
pub(crate) const SEPARATE_LAYOUTS: &str = "separateDepthStencilLayouts";
/// Colour attachments that aren't blended and masked alike.
pub(crate) const INDEPENDENT_BLEND: &str = "independentBlend";
