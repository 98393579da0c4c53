#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/texture.glsl"

layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1) uniform sampler2D shared_by_eyes;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// A post effect: a look-up between texels, one of a texel, the size of the eye's picture, and what both eyes share.
void main() {
    const ivec2 texels = textureSize(source, 0);
    const vec4 smoothed = textureLod(source, uv_clamp(uv_adjust(uv + 0.3 / vec2(texels), source_st), source_st, texels), 0.0);
    const vec4 own = texelFetch(source, part_origin(texels, source_st) + ivec2(frag_coord().xy), 0);
    color = smoothed + 4.0 * own + vec4(part_extent(texels, source_st), 0.0, 0.0) + textureLod(shared_by_eyes, uv, 0.0);
}
