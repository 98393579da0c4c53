#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

// What is shown.
layout(set = 0, binding = 0) uniform sampler2D shown;
layout(set = 0, binding = 1) uniform Params {
    // Width of the picture, in texels.
    int width;
    // Height of the picture, in texels.
    int height;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// An image in the upper left corner of the picture, texel for texel. For a pass with `blend: Alpha`: around the image nothing
// changes.
void main() {
    const ivec2 texel = texel_at(uv, ivec2(params.width, params.height));
    const bool is_inside = all(lessThan(texel, used_of(shown, shown_st)));
    color = is_inside ? guard_color(texel_in(shown, shown_st, texel)) : vec4(0.0);
}
