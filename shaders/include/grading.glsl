// Colour grading by a table over colours as a display encodes them. CPU twin: passes/src/twin/grading.rs.
#ifndef FRAMEWRIGHT_GRADING
#define FRAMEWRIGHT_GRADING

// The curve of sRGB (IEC 61966-2-1), 0 to 1 both ways.
vec3 encode_srgb(vec3 linear) {
    const vec3 bent = 1.055 * pow(max(linear, 0.0031308), vec3(1.0 / 2.4)) - 0.055;
    return mix(bent, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

vec3 decode_srgb(vec3 encoded) {
    const vec3 bent = pow((max(encoded, 0.04045) + 0.055) / 1.055, vec3(2.4));
    return mix(bent, encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

#endif
