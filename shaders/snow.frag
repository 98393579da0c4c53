#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"

layout(set = 0, binding = 2) uniform Params {
    // Radiance of a flake.
    float brightness;
} params;

layout(location = 0) in vec2 across;
layout(location = 1) flat in float alpha;

layout(location = 0) out vec4 color;

// Snowflakes, two triangles each. Round in the picture whatever its shape: distances are measured in pixels. For
// `Premultiplied` blending.
void main() {
    const vec2 half_size = 1.0 / max(fwidth(across), vec2(1e-6));
    const float radius = min(half_size.x, half_size.y);
    const float from_center = length(across * half_size) / radius;
    const float covered = alpha * (1.0 - smoothstep(0.3, 1.0, from_center));
    color = guard_color(vec4(vec3(covered * params.brightness), covered));
}
