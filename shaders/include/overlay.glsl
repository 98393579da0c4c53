// How depth is shown. CPU twin: passes/src/twin/overlay.rs.
#ifndef FRAMEWRIGHT_OVERLAY
#define FRAMEWRIGHT_OVERLAY

// Distance along the camera's axis as a share of `farthest`, at most 1, from reversed depth without a far plane: near /
// distance. Depth 0 is infinitely far.
float shade_of_distance(float depth, float near, float farthest) {
    return depth * farthest > near ? near / (depth * farthest) : 1.0;
}

#endif
