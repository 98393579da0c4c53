#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"

layout(set = 0, binding = 0) uniform Params {
    int width;
    int height;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Half of a step of a ramp to the right, half of one down, and whether the fragment lies where `uv` says.
void main() {
    const vec2 extent = vec2(params.width, params.height);
    const bool there = all(lessThan(abs(frag_coord().xy - uv * extent), vec2(0.01)));
    color = vec4(0.5 * ddx(uv.x * extent.x), 0.5 * ddy(uv.y * extent.y), there ? 1.0 : 0.0, 1.0);
}
