#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/g_buffer.glsl"

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Directions all over the sphere, there and back through two half floats; alpha is how far they went astray.
void main() {
    const float height = 1.0 - 2.0 * uv.y;
    const float around = 6.28318530717958648 * uv.x;
    const vec3 unit = normalize(vec3(sqrt(max(1.0 - height * height, 0.0)) * vec2(cos(around), sin(around)), height));
    const vec2 kept = unpackHalf2x16(packHalf2x16(octahedral(unit)));
    const vec3 found = from_octahedral(kept);
    color = vec4(octahedral(unit), unit.z, length(cross(unit, found)));
}
