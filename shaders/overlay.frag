#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/distance.glsl"
#include "include/overlay.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// What is shown.
layout(set = 0, binding = 0) uniform TEXTURE_shown shown;
layout(set = 0, binding = 1) uniform Params {
    // Width and height of the rectangle, as a share of the picture's.
    float scale;
    // Its left side, from 0 to 1 across the picture.
    float offset_x;
    // Its upper side, from 0 to 1 down the picture.
    float offset_y;
    // Multiplies colours. One component is shown as grey, and two as red and green.
    float gain;
    // For colours that may be negative, like normals: shows value · gain / 2 + 0.5.
    bool is_signed;
    // Above 0 the image is depth, of which the red channel is taken, and what is this far away is white; metres along the
    // camera's axis. At 0 it is colour.
    float farthest;
    // Which of its layers is shown, from 0.
    int layer;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// An image in a rectangle of the picture. For a pass with `blend: Premultiplied` or `Alpha`: around the rectangle nothing
// changes. Shows flat images and those with layers, integers too, and of samples the first.
void main() {
    // 1/256 of a texel above and to the left of the pixel's middle. Where that lies on an edge of the rectangle or between two
    // texels, it is on the same side then, whichever way the picture is turned and `uv` is rounded. A sampler moves places to the
    // nearest of 256 in a texel (`subTexelPrecisionBits`), and less than half of that would be lost.
    const vec2 place = (uv - vec2(params.offset_x, params.offset_y)) / max(params.scale, 1e-6);
    const vec2 inside = place - 1.0 / (256.0 * vec2(used_of(shown, shown_st)));
    if (any(lessThan(inside, vec2(0.0))) || any(greaterThanEqual(inside, vec2(1.0)))) {
        color = vec4(0.0);
        return;
    }
    const vec4 found = found_in(shown, shown_st, inside, params.layer, 0);
    const vec3 channels = COMPONENTS_shown == 1 ? vec3(found.r) : vec3(found.rgb);
    vec3 shade;
    if (params.farthest > 0.0) {
        shade = vec3(shade_of_distance(infinite_depth(guard_alpha(found.r)), near_distance(), params.farthest));
    } else if (params.is_signed) {
        shade = shade_of_signed(channels, params.gain);
    } else {
        shade = guard_radiance(guard_radiance(channels) * params.gain);
    }
    color = guard_color(vec4(shade, 1.0));
}
