#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/part.glsl"
#include "include/stereo.glsl"

// Two halves, in several mip levels.
layout(set = 0, binding = 0) uniform sampler2D pair;
layout(set = 0, binding = 1) uniform Params {
    int level;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// What an eye finds in its half within and around it; beside that the place and the one that both halves of a vec4 become.
void main() {
    const vec4 st = vec4(0.5, 1.0, 0.5 * float(eye_index), 0.0);
    const vec2 asked = 1.6 * uv - 0.3;
    const ivec2 texels = textureSize(pair, params.level);
    const vec2 place = uv_clamp(uv_adjust(asked, st), st, texels);
    const vec4 places = uv_clamp(uv_adjust(vec4(asked, 1.0 - asked), st), st, texels);
    const vec2 other = uv_clamp(uv_adjust(1.0 - asked, st), st, texels);
    const bool alike = places.xy == place && places.zw == other;
    const vec4 found = textureLod(pair, place, float(params.level));
    color = vec4(found.rg, place.x, alike ? place.y : -1.0);
}
