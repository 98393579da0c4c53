#version 460
#extension GL_GOOGLE_include_directive : require
#include "include/scene.glsl"
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 0) uniform sampler2DArray shadow;
layout(set = 0, binding = 1, std430) readonly buffer EngineLights { vec4 light[]; } lights_of_engine;
layout(set = 0, binding = 2, std430) readonly buffer Grid { uvec2 range[]; } grid;
layout(set = 0, binding = 3, std430) readonly buffer Items { uint number[]; } items;
layout(set = 0, binding = 4, rgba16f) writeonly uniform image3D target;
void main() {
    const ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, imageSize(target)))) { return; }
    const uint cell = uint(at.x / 5 + 16 * (at.y / 5 + 9 * (at.z * 24 / 64)));
    vec3 sum = lights.sun_radiance * textureLod(shadow, vec3(vec2(at.xy) / vec2(80, 45), 0.0), 0.0).r * 1e-6 + 0.01;
    const uvec2 range = grid.range[cell];
    for (uint i = 0u; i < range.y; ++i) { sum += lights_of_engine.light[2u * items.number[range.x + i] + 1u].rgb; }
    imageStore(target, at, vec4(sum, 0.02));
}
