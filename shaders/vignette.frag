#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"

layout(set = 0, binding = 0) uniform Params {
    // The tangent of the angle at which a lens would see the corners; 0 is no vignette.
    float strength;
    // Width of the picture over its height.
    float aspect;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Corners that are darker than the middle. For a pass with `blend: Premultiplied` or `Alpha`: black that covers what a lens
// loses towards the corners. Of light that comes in at an angle θ it passes cos⁴ θ on, which is 1 / (1 + tan² θ)².
void main() {
    const vec2 half_size = 0.5 * vec2(params.aspect, 1.0);
    const vec2 tangent = params.strength * ((2.0 * uv - 1.0) * half_size) / length(half_size);
    const float falloff = 1.0 / (1.0 + dot(tangent, tangent));
    color = guard_color(vec4(0.0, 0.0, 0.0, 1.0 - falloff * falloff));
}
