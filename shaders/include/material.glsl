// The material of the object being drawn.
#ifndef FRAMEWRIGHT_MATERIAL
#define FRAMEWRIGHT_MATERIAL

#include "include/scene.glsl"

layout(set = 2, binding = 0) uniform sampler2D base_color_texture;

// Linear base colour with alpha, not multiplied by it.
vec4 base_color(uint object_index, vec2 uv) {
    return objects.object[object_index].base_color * texture(base_color_texture, uv);
}

#endif
