// The one place that makes numbers of images safe to use and to store. Every shipped shader guards each colour that it stores, and
// each number that it samples before it decides or counts by it: NaN becomes 0, what a half float can't hold the largest that it
// can. CPU twin: passes/src/twin/radiance.rs.
#ifndef FRAMEWRIGHT_RADIANCE
#define FRAMEWRIGHT_RADIANCE

// Bits of 65504, the largest finite half float.
const uint LARGEST_HALF_BITS = 0x477fe000u;
// Bits of +inf as a 32-bit float. Above lie, as unsigned integers, every NaN and every number with a sign bit.
const uint INFINITY_BITS = 0x7f800000u;
// The sign of a 32-bit float.
const uint SIGN_BIT = 0x80000000u;

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

// A number that may be negative (motion, normals) for a half-float store, in -65504…65504; NaN becomes 0.
float guard_signed(float number) {
    const uint bits = floatBitsToUint(number);
    const uint size = bits & ~SIGN_BIT;
    return size > INFINITY_BITS ? 0.0 : uintBitsToFloat(min(size, LARGEST_HALF_BITS) | (bits & SIGN_BIT));
}

vec2 guard_signed(vec2 numbers) {
    return vec2(guard_signed(numbers.x), guard_signed(numbers.y));
}

vec3 guard_signed(vec3 numbers) {
    return vec3(guard_signed(numbers.xy), guard_signed(numbers.z));
}

vec4 guard_signed(vec4 numbers) {
    return vec4(guard_signed(numbers.xyz), guard_signed(numbers.w));
}

// Whether none of the numbers is NaN or infinite.
bool all_finite(vec3 numbers) {
    return all(lessThan(floatBitsToUint(numbers) & ~SIGN_BIT, uvec3(INFINITY_BITS)));
}

bool all_finite(vec4 numbers) {
    return all_finite(numbers.xyz) && all_finite(numbers.yzw);
}

// Colour and alpha for a store.
vec4 guard_color(vec4 color) {
    return vec4(guard_radiance(color.rgb), guard_alpha(color.a));
}

#endif
