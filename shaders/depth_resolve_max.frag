#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/depth_samples.glsl"

// Depth, of the size that is drawn.
layout(set = 0, binding = 0) uniform sampler2DMS source;

layout(location = 0) in vec2 uv;

// For a pass that draws depth alone (`clear: 0.0, test: Always`): the greatest number of all samples, with reversed depth the
// nearest.
void main() {
    gl_FragDepth = greatest_depth(source, source_st, uv);
}
