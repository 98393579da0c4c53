#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/hdr10.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// Radiance.
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1) uniform Params {
    // Luminance that radiance 1 is shown at, cd/m², more than 0.
    float reference_white;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Encodes radiance as HDR10, for a target of 10 bits or more that is shown as it is: UNORM, not SRGB.
void main() {
    const vec3 radiance = guard_radiance(found_in(source, source_st, uv).rgb);
    color = vec4(guard_radiance(encode_hdr10(radiance, guard_radiance(params.reference_white))), 1.0);
}
