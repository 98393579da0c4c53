#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/overlay.glsl"
#include "include/radiance.glsl"
#include "include/scene.glsl"
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
    // Multiplies colours.
    float gain;
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
    const vec2 inside = (uv - vec2(params.offset_x, params.offset_y)) / max(params.scale, 1e-6);
    if (any(lessThan(inside, vec2(0.0))) || any(greaterThanEqual(inside, vec2(1.0)))) {
        color = vec4(0.0);
        return;
    }
    const vec4 found = found_in(shown, shown_st, inside, params.layer, 0);
    // The projection has no far plane: the near distance is the one number in its last column.
    const float near = view.world_to_clip[3].z;
    const vec3 shade = params.farthest > 0.0 ? vec3(shade_of_distance(found.r, near, params.farthest))
                                             : guard_radiance(guard_radiance(found.rgb) * params.gain);
    color = vec4(shade, 1.0);
}
