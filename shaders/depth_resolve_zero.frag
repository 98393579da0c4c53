#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/depth_samples.glsl"

// Depth, of the size that is drawn.
layout(set = 0, binding = 0) uniform sampler2DMS source;

layout(location = 0) in vec2 uv;

// For a pass that draws depth alone (`clear: 0.0, test: Always`): sample zero, which lies in one place of the texel.
void main() {
    gl_FragDepth = depth_of(source, source_st, uv, 0);
}
