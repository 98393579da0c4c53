#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/random.glsl"
#include "include/snow.glsl"

layout(local_size_x = 64) in;

// The flakes of the frame before, 16 bytes each.
layout(set = 0, binding = 0, std430) readonly buffer Before {
    Flake flake[];
} before;
// The flakes of this frame; an invocation each.
layout(set = 0, binding = 1, std430) writeonly buffer Flakes {
    Flake flake[];
} flakes;
layout(set = 0, binding = 2) uniform Params {
    // Since the frame before.
    float seconds;
    // Towards the right, at distance 1, in halves of the picture a second.
    float wind;
} params;

const float FARTHEST = 4.0;
// At distance 1, in halves of the picture a second.
const float FALL = 0.9;
const float SWAY = 0.25;
// Radians a second.
const float SWAY_RATE = 2.5;
const float FULL_TURN = 6.28318530717958648;

// Anywhere at all.
Flake born(uint index) {
    const vec2 place = vec2(random(4u * index), random(4u * index + 1u));
    return Flake(EDGE * (2.0 * place - 1.0), mix(1.0, FARTHEST, random(4u * index + 2u)),
                 FULL_TURN * random(4u * index + 3u));
}

// What left at one side comes in at the other.
float around(float position) {
    return position > EDGE ? position - 2.0 * EDGE : position < -EDGE ? position + 2.0 * EDGE : position;
}

// Moves snowflakes on: steady fall, wind and swaying, one explicit Euler step a frame.
void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= flakes.flake.length()) {
        return;
    }
    Flake flake = before.flake[index];
    if (flake.distance == 0.0) {
        flake = born(index);
    } else {
        const vec2 velocity = vec2(params.wind + SWAY * sin(flake.phase), FALL);
        const vec2 moved = flake.position + params.seconds * apparent(1.0, flake.distance) * velocity;
        flake.position = vec2(around(moved.x), around(moved.y));
        flake.phase = mod(flake.phase + params.seconds * SWAY_RATE, FULL_TURN);
    }
    flakes.flake[index] = flake;
}
