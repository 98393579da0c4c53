// Filters that bloom is made of. CPU twin: passes/src/twin/bloom.rs. All of them need linear filtering.
#ifndef FRAMEWRIGHT_BLOOM
#define FRAMEWRIGHT_BLOOM

#include "include/luminance.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// Light at `offset` texels of the image from `uv`, both in its part `st`.
vec3 tap(sampler2D image, vec4 st, vec2 uv, vec2 offset) {
    return guard_radiance(found_in(image, st, uv + offset / vec2(used_of(image, st))).rgb);
}

// The light around `uv` for a texel of an image of half the size: five overlapping boxes of 4 × 4 texels, of which the middle
// one counts half and each of the others an eighth (J. Jimenez, "Next Generation Post Processing in Call of Duty: Advanced
// Warfare", SIGGRAPH 2014). With `partial` each box counts the less the brighter it is, by 1 / (1 + luminance), so that one
// bright texel doesn't flicker as it moves (B. Karis, "Tone mapping", 2013; by box as Jimenez has it).
vec3 shrunk(sampler2D image, vec4 st, vec2 uv, bool partial) {
    vec3 around[9];
    for (int index = 0; index < 9; ++index) {
        around[index] = tap(image, st, uv, 2.0 * vec2(index % 3 - 1, index / 3 - 1));
    }
    vec3 boxes[5];
    boxes[0] = tap(image, st, uv, vec2(-1.0, -1.0)) + tap(image, st, uv, vec2(1.0, -1.0))
        + tap(image, st, uv, vec2(-1.0, 1.0)) + tap(image, st, uv, vec2(1.0, 1.0));
    for (int index = 0; index < 4; ++index) {
        const int corner = index % 2 + 3 * (index / 2);
        boxes[index + 1] = around[corner] + around[corner + 1] + around[corner + 3] + around[corner + 4];
    }
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int index = 0; index < 5; ++index) {
        const vec3 mean = 0.25 * boxes[index];
        const float weight = (index == 0 ? 0.5 : 0.125) / (partial ? 1.0 + luminance(mean) : 1.0);
        sum += weight * mean;
        weights += weight;
    }
    return sum / weights;
}

// The light around `uv` under a tent of 3 × 3 taps that lie `radius` texels of the image apart.
vec3 tent(sampler2D image, vec4 st, vec2 uv, float radius) {
    vec3 sum = vec3(0.0);
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            sum += float((2 - abs(x)) * (2 - abs(y))) * tap(image, st, uv, radius * vec2(x, y));
        }
    }
    return sum / 16.0;
}

#endif
