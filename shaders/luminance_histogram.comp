#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/luminance.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

// Radiance; each texel of it an invocation.
layout(set = 0, binding = 0) uniform sampler2D source;
// 256 counts of 4 bytes; adds to what is there.
layout(set = 0, binding = 1, std430) buffer Bins {
    uint count[BINS];
} bins;

// As many as invocations: each brings one bin to zero, and takes it to the others' sum.
shared uint counted[BINS];

// Counts each texel in the bin of its luminance. A workgroup counts by itself first: it has fewer to wait for.
void main() {
    counted[gl_LocalInvocationIndex] = 0u;
    barrier();
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, used_of(source, source_st)))) {
        const vec3 radiance = guard_radiance(texel_in(source, source_st, texel).rgb);
        atomicAdd(counted[bin_of(luminance(radiance))], 1u);
    }
    barrier();
    const uint found = counted[gl_LocalInvocationIndex];
    if (found > 0u) {
        atomicAdd(bins.count[gl_LocalInvocationIndex], found);
    }
}
