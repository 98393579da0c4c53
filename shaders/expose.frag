#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"
#include "include/tone_mapping.glsl"

// Radiance.
layout(set = 0, binding = 0) uniform sampler2D source;
// As `adapt_exposure` leaves it.
layout(set = 0, binding = 1) uniform Exposure {
    float scale;
} exposure;
layout(set = 0, binding = 2) uniform Params {
    // The radiance after exposure that becomes white, at least 1.
    float white_point;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Tone mapping by the modified Reinhard curve, channel by channel, exposed as a buffer says.
void main() {
    const vec3 radiance = guard_radiance(guard_radiance(found_in(source, source_st, uv).rgb) * exposure.scale);
    color = vec4(guard_radiance(modified_reinhard(radiance, params.white_point)), 1.0);
}
