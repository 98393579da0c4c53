#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/depth_samples.glsl"

// Depth, of the size that is drawn.
layout(set = 0, binding = 0) uniform sampler2DMS source;

layout(location = 0) in vec2 uv;

// For a pass that draws depth alone (`clear: 0.0, test: Always`): the mean of all samples, a depth that nothing may have.
void main() {
    gl_FragDepth = mean_depth(source, source_st, uv);
}
