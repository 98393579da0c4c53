// One depth from the samples of a texel. CPU twin: passes/src/twin/depth_samples.rs.
//
// What the modes mean is what VkResolveModeFlagBits says of them (Vulkan 1.3, "Render Pass Resolve Operations").
#ifndef FRAMEWRIGHT_DEPTH_SAMPLES
#define FRAMEWRIGHT_DEPTH_SAMPLES

#include "include/radiance.glsl"
#include "include/texture.glsl"

// A sample of the texel around a place of the part `st`, 0 to 1 from its upper left corner.
float depth_of(sampler2DMS depth, vec4 st, vec2 uv, int number) {
    return guard_alpha(found_in(depth, st, uv, 0, number).r);
}

float least_depth(sampler2DMS depth, vec4 st, vec2 uv) {
    float least = depth_of(depth, st, uv, 0);
    for (int number = 1; number < textureSamples(depth); ++number) {
        least = min(least, depth_of(depth, st, uv, number));
    }
    return least;
}

float greatest_depth(sampler2DMS depth, vec4 st, vec2 uv) {
    float greatest = depth_of(depth, st, uv, 0);
    for (int number = 1; number < textureSamples(depth); ++number) {
        greatest = max(greatest, depth_of(depth, st, uv, number));
    }
    return greatest;
}

float mean_depth(sampler2DMS depth, vec4 st, vec2 uv) {
    float sum = 0.0;
    for (int number = 0; number < textureSamples(depth); ++number) {
        sum += depth_of(depth, st, uv, number);
    }
    return sum / float(textureSamples(depth));
}

#endif
