// Luminance, and its histogram in eighths of a stop. CPU twin: passes/src/twin/exposure.rs.
#ifndef FRAMEWRIGHT_LUMINANCE
#define FRAMEWRIGHT_LUMINANCE

// From 2⁻¹⁶, which black counts as, to 2¹⁶, above the largest half float.
const uint BINS = 256u;
const float DARKEST_STOP = -16.0;
const float BINS_A_STOP = 8.0;

// Luminance of linear colour with the primaries of Rec. 709 (ITU-R BT.709-6, item 3.2).
float luminance(vec3 radiance) {
    return dot(radiance, vec3(0.2126, 0.7152, 0.0722));
}

// The bin of a luminance in 0…65504.
uint bin_of(float luminance) {
    const float stop = log2(max(luminance, exp2(DARKEST_STOP)));
    return min(uint(max((stop - DARKEST_STOP) * BINS_A_STOP, 0.0)), BINS - 1u);
}

// The logarithm to base 2 of the luminance in the middle of a bin.
float stop_of(uint bin) {
    return DARKEST_STOP + (float(bin) + 0.5) / BINS_A_STOP;
}

#endif
