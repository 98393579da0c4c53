// The one place that makes untrusted radiance safe to store.
#ifndef FRAMEWRIGHT_RADIANCE
#define FRAMEWRIGHT_RADIANCE

// Bits of 65504, the largest finite half float.
const uint LARGEST_HALF_BITS = 0x477fe000u;
// Bits of +inf as a 32-bit float. Above lie, as unsigned integers, every NaN and every number with a sign bit.
const uint INFINITY_BITS = 0x7f800000u;

// Radiance for a half-float store, in 0…65504: negative numbers and NaN become 0, larger numbers and +inf 65504.
// Decided by bits alone: a compiler may fold comparisons as if there were no NaN, and drivers differ in what a half-float
// store makes of numbers that don't fit.
float guard_radiance(float radiance) {
    const uint bits = floatBitsToUint(radiance);
    return bits > INFINITY_BITS ? 0.0 : uintBitsToFloat(min(bits, LARGEST_HALF_BITS));
}

vec3 guard_radiance(vec3 radiance) {
    return vec3(guard_radiance(radiance.r), guard_radiance(radiance.g), guard_radiance(radiance.b));
}

// Alpha for a store, in 0…1; NaN becomes 0.
float guard_alpha(float alpha) {
    return min(guard_radiance(alpha), 1.0);
}

// Colour and alpha for a store.
vec4 guard_color(vec4 color) {
    return vec4(guard_radiance(color.rgb), guard_alpha(color.a));
}

#endif
