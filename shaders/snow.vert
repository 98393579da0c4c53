#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/snow.glsl"

// The flakes of this frame, 16 bytes each.
layout(set = 0, binding = 0, std430) readonly buffer Flakes {
    Flake flake[];
} flakes;
// Numbers of those that are seen, as `snow_gather` leaves them.
layout(set = 0, binding = 1, std430) readonly buffer Seen {
    uint number[];
} seen;

// −1 to 1 across the flake.
layout(location = 0) out vec2 across;
layout(location = 1) flat out float alpha;

// Two triangles a flake: it needs no vertex buffer.
void main() {
    const Flake flake = flakes.flake[seen.number[gl_InstanceIndex]];
    const uint corner = uint[](0u, 1u, 2u, 2u, 1u, 3u)[gl_VertexIndex % 6];
    across = vec2(corner & 1u, corner >> 1) * 2.0 - 1.0;
    // The farther, the fainter.
    alpha = apparent(0.9, flake.distance);
    gl_Position = rotate_clip(vec4(flake.position + apparent(NEAREST_SIZE, flake.distance) * across, 0.0, 1.0));
}
