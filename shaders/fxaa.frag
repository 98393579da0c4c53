#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/luminance.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// What is shown, 0 to 1, in linear values: after tone mapping.
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1) uniform Params {
    // How much is done against details smaller than a pixel, 0 to 1; edges are smoothed in any case.
    float subpixel;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Texels that differ by less from their neighbours are left alone: in any case, and as a share of the brightest of them.
const float LEAST_CONTRAST = 1.0 / 24.0;
const float LEAST_SHARE = 1.0 / 8.0;
// What bends differ by if they are the same.
const float EVEN = 1e-4;
// How far the ends of an edge are looked for, in texels.
const int REACH = 16;

vec4 texel(ivec2 at) {
    return guard_color(texel_in(source, source_st, clamp(at, ivec2(0), used_of(source, source_st) - 1)));
}

// Brightness as it is seen: about evenly spaced to the eye, 0 to 1.
float brightness(ivec2 at) {
    return sqrt(luminance(min(texel(at).rgb, 1.0)));
}

// Fast approximate anti-aliasing after the description in T. Lottes, "FXAA", NVIDIA white paper, 2009: where brightness changes
// an edge is assumed, along a row or a column; from where its two ends lie follows how much of the texel it cuts off, and that
// much of the texel beyond is mixed in. CPU twin: passes/src/twin/fxaa.rs.
void main() {
    const ivec2 at = texel_at(uv, used_of(source, source_st));
    const vec4 own = texel(at);
    const float middle = brightness(at);
    const float north = brightness(at + ivec2(0, -1));
    const float south = brightness(at + ivec2(0, 1));
    const float west = brightness(at + ivec2(-1, 0));
    const float east = brightness(at + ivec2(1, 0));
    const float brightest = max(middle, max(max(north, south), max(west, east)));
    const float contrast = brightest - min(middle, min(min(north, south), min(west, east)));
    if (contrast < max(LEAST_CONTRAST, LEAST_SHARE * brightest)) {
        color = own;
        return;
    }
    const float north_west = brightness(at + ivec2(-1, -1));
    const float north_east = brightness(at + ivec2(1, -1));
    const float south_west = brightness(at + ivec2(-1, 1));
    const float south_east = brightness(at + ivec2(1, 1));

    // The edge lies along rows if brightness bends more from row to row than from column to column. Where the middle stands out
    // on all sides both are the same sum: that counts as rows, however it is rounded.
    const float down = abs(north_west + south_west - 2.0 * west) + 2.0 * abs(north + south - 2.0 * middle)
        + abs(north_east + south_east - 2.0 * east);
    const float across = abs(north_west + north_east - 2.0 * north) + 2.0 * abs(west + east - 2.0 * middle)
        + abs(south_west + south_east - 2.0 * south);
    const bool along_rows = down + EVEN >= across;
    const ivec2 along = along_rows ? ivec2(1, 0) : ivec2(0, 1);
    const float before = along_rows ? north : west;
    const float after = along_rows ? south : east;
    // It lies between this texel and the one beyond.
    const bool towards_before = abs(before - middle) >= abs(after - middle);
    const ivec2 beyond = towards_before ? -along.yx : along.yx;
    const float other = towards_before ? before : after;
    const float edge = 0.5 * (middle + other);
    const float step_height = abs(other - middle);

    // Both ways until brightness on the edge is another.
    int steps[2];
    float change[2];
    for (int way = 0; way < 2; ++way) {
        const ivec2 direction = way == 0 ? -along : along;
        steps[way] = 0;
        change[way] = 0.0;
        while (steps[way] < REACH && abs(change[way]) < 0.25 * step_height) {
            ++steps[way];
            const ivec2 place = at + steps[way] * direction;
            change[way] = 0.5 * (brightness(place) + brightness(place + beyond)) - edge;
        }
    }
    const int nearer = steps[0] <= steps[1] ? 0 : 1;
    // At its nearer end the edge leaves to the side of this texel only if brightness there becomes that of the other one.
    const bool cuts = (change[nearer] < 0.0) != (middle < edge);
    const float cut_off = cuts ? 0.5 - float(steps[nearer]) / float(steps[0] + steps[1]) : 0.0;

    // How far the texel stands out from those around it.
    const float around = (2.0 * (north + south + west + east) + north_west + north_east + south_west + south_east) / 12.0;
    const float alone = smoothstep(0.0, 1.0, abs(around - middle) / contrast);
    const float smoothed = alone * alone * clamp(params.subpixel, 0.0, 1.0);
    color = guard_color(mix(own, texel(at + beyond), max(cut_off, smoothed)));
}
