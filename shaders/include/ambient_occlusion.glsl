// How much of the light that comes from everywhere alike reaches a place past the surfaces around it, judged by the depth that
// a picture shows: M. McGuire, M. Mara, D. Luebke, "Scalable Ambient Obscurance", High Performance Graphics 2012, with the
// smooth falloff of its published implementation; lengths are taken as shares of the radius, so that a scene may have any
// size. CPU twin: passes/src/twin/ambient_occlusion.rs.
#ifndef FRAMEWRIGHT_AMBIENT_OCCLUSION
#define FRAMEWRIGHT_AMBIENT_OCCLUSION

// The number of samples, on a spiral of this many turns.
const int OCCLUDERS = 16;
const float TURNS = 7.0;
// A smaller rise above the surface than this counts as rounding: a share of the radius and of the distance.
const float RISE_OF_RADIUS = 0.012;
const float RISE_OF_DISTANCE = 0.001;
// Bounds how much a very near surface counts: a share of the radius, squared.
const float NEARLY_TOUCHING = 0.0001;

// By how much each texel of a square of 4 × 4 turns its spiral, in sixteenths of a full turn: B. E. Bayer, "An optimum method
// for two-level rendition of continuous-tone pictures", ICC 1973. The mean of any such square has all of them.
float spiral_turn(ivec2 texel) {
    const int x = texel.x & 3;
    const int y = texel.y & 3;
    const int z = x ^ y;
    return float(((z & 1) << 3) | ((y & 1) << 2) | (z & 2) | (y >> 1)) / 16.0;
}

// Place number `i` of the spiral: how far out from 0 to 1, and the angle.
vec2 spiral_place(int i, float turn) {
    const float out_to = (float(i) + 0.5) / float(OCCLUDERS);
    return vec2(out_to, 6.28318530717958648 * (out_to * TURNS + turn));
}

// What an occluder counts, at `towards` from a surface with the unit normal `normal` that is `away` from the camera; 0 beyond
// the radius and below the surface.
float occlusion_by(vec3 towards, vec3 normal, float away, float radius) {
    const float squared = dot(towards, towards) / (radius * radius);
    const float share = max(1.0 - squared, 0.0);
    const float rise = dot(towards, normal) / radius - max(RISE_OF_RADIUS, RISE_OF_DISTANCE * away / radius);
    return share * share * share * max(rise, 0.0) / (squared + NEARLY_TOUCHING);
}

// The share of light that arrives, of the sum over all occluders.
float openness(float sum, float strength) {
    return clamp(1.0 - strength * sum * 5.0 / float(OCCLUDERS), 0.0, 1.0);
}

#endif
