#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"

// Twice the size of what is drawn; needs a linear filter.
layout(set = 0, binding = 0) uniform sampler2D source;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Half the size. Each texel's centre is the corner that four texels of the source share: the filter's weights are a quarter
// each, and the one tap is their exact mean.
void main() {
    color = guard_color(found_in(source, source_st, uv));
}
