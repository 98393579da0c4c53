// Depth of field: how far a lens spreads a point by its distance. CPU twin: passes/src/twin/depth_of_field.rs.
#ifndef FRAMEWRIGHT_DEPTH_OF_FIELD
#define FRAMEWRIGHT_DEPTH_OF_FIELD

// The radius of the disc as which a point is seen, in texels and at most `largest`: that of a thin lens, |1 - focus / distance|, where
// `spread` is the radius of what is infinitely far. `nearness` is 1 / distance.
float disc_radius(float nearness, float focus, float spread, float largest) {
    return min(spread * abs(1.0 - focus * nearness), largest);
}

// How much of the light of a disc falls on a texel so many texels from its middle; discs of every size hold the same light.
float disc_share(float radius, float away) {
    const float wide = radius + 0.5;
    return clamp(radius + 1.0 - away, 0.0, 1.0) / (wide * wide);
}

#endif
