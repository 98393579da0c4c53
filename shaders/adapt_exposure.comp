#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/luminance.glsl"
#include "include/scan.glsl"

// One workgroup, an invocation a bin.
layout(local_size_x = 256) in;

// As `luminance_histogram` leaves it: 256 counts of 4 bytes.
layout(set = 0, binding = 0, std430) readonly buffer Bins {
    uint count[BINS];
} bins;
// What the eye has become used to, 12 bytes that begin at zero; from frame to frame.
layout(set = 0, binding = 1, std430) buffer Exposure {
    // What radiance is multiplied by.
    float scale;
    // Logarithm to base 2 of the luminance that it is used to.
    float stop;
    // 0 before the first frame.
    uint started;
} exposure;
layout(set = 0, binding = 2) uniform Params {
    // What the average luminance becomes.
    float key;
    // The share of the texels, the darkest, that the average leaves out; 0 to 0.49.
    float darkest;
    // And of the brightest.
    float brightest;
    // From frame to frame.
    float seconds;
    // Seconds until 1 − 1/e of a change is adapted to; 0 adapts at once.
    float adaptation;
} params;

shared float parts[BINS];

// Lets the exposure follow the picture, in one workgroup. The average logarithm of luminance, and what it is scaled to: E.
// Reinhard, M. Stark, P. Shirley, J. Ferwerda, "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, equations 1
// and 2. Adaptation decays exponentially as in G. Krawczyk, K. Myszkowski, H.-P. Seidel, "Perceptual Effects in Real-Time Tone
// Mapping", SCCG 2005; here of the logarithm, so that darkening and brightening take equally long.
void main() {
    const uint bin = gl_LocalInvocationIndex;
    const uint count = bins.count[bin];
    const uint until = running_sum(count);
    const uint all = whole_sum();
    // Of the texels in the order of their luminance those from `first` to before `last` count.
    const uint first = uint(clamp(params.darkest, 0.0, 0.49) * float(all));
    const uint last = all - uint(clamp(params.brightest, 0.0, 0.49) * float(all));
    const uint kept = clamp(until, first, last) - clamp(until - count, first, last);
    parts[bin] = float(kept) * stop_of(bin);
    barrier();
    for (uint half_of = BINS / 2u; half_of > 0u; half_of /= 2u) {
        if (bin < half_of) {
            parts[bin] += parts[bin + half_of];
        }
        barrier();
    }
    if (bin == 0u) {
        const float average = parts[0] / float(max(last - first, 1u));
        const float share = params.adaptation > 0.0 ? 1.0 - exp(-params.seconds / params.adaptation) : 1.0;
        const float stop = exposure.started != 0u ? mix(exposure.stop, average, share) : average;
        exposure.scale = params.key * exp2(-stop);
        exposure.stop = stop;
        exposure.started = 1u;
    }
}
