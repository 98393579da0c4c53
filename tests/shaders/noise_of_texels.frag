#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/random.glsl"
#include "include/texture.glsl"

layout(set = 0, binding = 0) uniform Params {
    int width;
    int height;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Numbers without pattern for a target of any size: 0 to 1 in red, a gentle slope in green, mostly dark with bright texels in
// blue.
void main() {
    const ivec2 extent = ivec2(params.width, params.height);
    const uvec2 texel = uvec2(texel_at(uv, extent));
    const float spark = random(hash(texel.x + 4096u * texel.y) + 7u);
    const vec2 slope = vec2(texel) / vec2(extent);
    color = vec4(random(texel.x + 4096u * texel.y), 0.5 * (slope.x + slope.y), spark > 0.9 ? 40.0 * spark : 0.1, 1.0);
}
