#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/scan.glsl"
#include "include/snow.glsl"

// One workgroup for all flakes, 256 at a time.
layout(local_size_x = 256) in;

// The flakes of this frame, 16 bytes each.
layout(set = 0, binding = 0, std430) readonly buffer Flakes {
    Flake flake[];
} flakes;
// Numbers of the flakes that are seen, in their order; the rest is 0.
layout(set = 0, binding = 1, std430) writeonly buffer Seen {
    uint number[];
} seen;
// A VkDrawIndirectCommand.
layout(set = 0, binding = 2, std430) writeonly buffer Counts {
    uint vertices;
    uint instances;
    uint first_vertex;
    uint first_instance;
} counts;

bool is_seen(Flake flake) {
    const vec2 reach = abs(flake.position) - apparent(NEAREST_SIZE, flake.distance);
    return max(reach.x, reach.y) < 1.0;
}

// Gathers the flakes that are seen, in one workgroup. A place for each flake by a running sum and not by an atomic counter:
// so their order, and with it the picture, is always the same.
void main() {
    const uint all = uint(flakes.flake.length());
    uint found = 0u;
    for (uint first = 0u; first < all; first += SCANNED) {
        const uint index = first + gl_LocalInvocationIndex;
        const bool keeps = index < all && is_seen(flakes.flake[min(index, all - 1u)]);
        const uint place = found + running_sum(keeps ? 1u : 0u);
        if (keeps) {
            seen.number[place - 1u] = index;
        }
        found += whole_sum();
    }
    for (uint index = found + gl_LocalInvocationIndex; index < all; index += SCANNED) {
        seen.number[index] = 0u;
    }
    if (gl_LocalInvocationIndex == 0u) {
        counts.vertices = 6u;
        counts.instances = found;
        counts.first_vertex = 0u;
        counts.first_instance = 0u;
    }
}
