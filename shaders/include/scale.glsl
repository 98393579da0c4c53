// Images at another size. CPU twin: passes/src/twin/scale.rs. Places are counted in whole parts of a texel, so that they are
// exact at any size up to 32,768.
#ifndef FRAMEWRIGHT_SCALE
#define FRAMEWRIGHT_SCALE

#include "include/radiance.glsl"
#include "include/texture.glsl"

// The mean of the texels that one pixel of a target covers, of the part `st` of the source. `target` is the target's extent.
// Each texel counts by the area of it that the pixel covers.
vec4 area_mean(sampler2D source, vec4 st, ivec2 pixel, ivec2 target) {
    const uvec2 texels = uvec2(used_of(source, st));
    const uvec2 pixels = uvec2(target);
    // In parts of a texel, of which there are as many as the target has pixels.
    const uvec2 begin = uvec2(pixel) * texels;
    const uvec2 end = begin + texels;
    vec4 sum = vec4(0.0);
    for (uint y = begin.y / pixels.y; y * pixels.y < end.y; ++y) {
        vec4 row = vec4(0.0);
        for (uint x = begin.x / pixels.x; x * pixels.x < end.x; ++x) {
            const uint within = min(end.x, (x + 1u) * pixels.x) - max(begin.x, x * pixels.x);
            row += float(within) * guard_color(texel_in(source, st, ivec2(x, y)));
        }
        const uint within = min(end.y, (y + 1u) * pixels.y) - max(begin.y, y * pixels.y);
        sum += float(within) * (row / float(texels.x));
    }
    return sum / float(texels.y);
}

// E. Catmull, R. Rom, "A Class of Local Interpolating Splines", 1974, with a tension of 1/2: also the cubic convolution of
// R. Keys, 1981. 1 at 0, 0 at every other whole number, and nothing beyond 2.
float catmull_rom(float distance) {
    const float x = abs(distance);
    return x < 1.0 ? (1.5 * x - 2.5) * x * x + 1.0 : x < 2.0 ? ((-0.5 * x + 2.5) * x - 4.0) * x + 2.0 : 0.0;
}

// Catmull-Rom interpolation at a place of the part `st` of the source, 0 to 1 from the part's upper left corner, along rows and
// columns.
// Beyond the edges the outermost texels are repeated.
vec4 curve_at(sampler2D source, vec4 st, vec2 place) {
    const ivec2 texels = used_of(source, st);
    const vec2 from_first = place * vec2(texels) - 0.5;
    const ivec2 whole = ivec2(floor(from_first));
    const vec2 share = from_first - vec2(whole);
    vec4 sum = vec4(0.0);
    for (int y = -1; y <= 2; ++y) {
        vec4 row = vec4(0.0);
        for (int x = -1; x <= 2; ++x) {
            const ivec2 at = clamp(whole + ivec2(x, y), ivec2(0), texels - 1);
            row += catmull_rom(float(x) - share.x) * guard_color(texel_in(source, st, at));
        }
        sum += catmull_rom(float(y) - share.y) * row;
    }
    return sum;
}

// Catmull-Rom interpolation at the centre of a target pixel, of the part `st` of the source. `target` is the target's extent.
// Where the target is smaller, the curve is wider by the same factor, so that every texel counts. It is sharper than a mean and
// overshoots at edges: values below 0 are cut off.
vec4 sharpened(sampler2D source, vec4 st, ivec2 pixel, ivec2 target) {
    const ivec2 texels = used_of(source, st);
    // The middle of the pixel, in texels from the middle of the first one and half a texel: whole and share.
    const uvec2 place = (2u * uvec2(pixel) + 1u) * uvec2(texels);
    const ivec2 whole = ivec2(place / uvec2(2 * target));
    const vec2 share = vec2(place % uvec2(2 * target)) / vec2(2 * target) - 0.5;
    const vec2 wide = max(vec2(texels) / vec2(target), 1.0);
    const ivec2 first = ivec2(ceil(share - 2.0 * wide));
    const ivec2 last = ivec2(floor(share + 2.0 * wide));
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int y = first.y; y <= last.y; ++y) {
        vec4 row = vec4(0.0);
        float across = 0.0;
        for (int x = first.x; x <= last.x; ++x) {
            const float weight = catmull_rom((float(x) - share.x) / wide.x);
            row += weight * guard_color(texel_in(source, st, clamp(whole + ivec2(x, y), ivec2(0), texels - 1)));
            across += weight;
        }
        const float weight = catmull_rom((float(y) - share.y) / wide.y);
        sum += weight * row;
        weights += weight * across;
    }
    return sum / weights;
}

#endif
