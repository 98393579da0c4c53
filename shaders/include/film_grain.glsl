// The grain of film. CPU twin: passes/src/twin/effects.rs.
#ifndef FRAMEWRIGHT_FILM_GRAIN
#define FRAMEWRIGHT_FILM_GRAIN

#include "include/random.glsl"

// −1 to 1, mostly near 0: another number for each pixel and frame, with a triangle for its distribution.
float grain(uvec2 pixel, uint frame) {
    const uint first = hash(pixel.x + hash(pixel.y + hash(frame)));
    return random(first) + random(first ^ 0x9e3779b9u) - 1.0;
}

#endif
