// A snowflake between camera and scene. CPU twin: passes/src/twin/snow.rs.
#ifndef FRAMEWRIGHT_SNOW
#define FRAMEWRIGHT_SNOW

struct Flake {
    // In the picture, from −1 at its left and upper border to 1 at its right and lower.
    vec2 position;
    // From the camera, in units in which the nearest flakes are 1 away. 0 before the first frame.
    float distance;
    // Of its swaying, radians.
    float phase;
};

// Flakes leave the picture this far before they come in again at the other side.
const float EDGE = 1.25;
// Half the width and height of a flake at distance 1.
const float NEAREST_SIZE = 0.02;

// A thing twice as far away looks half as large, and half as fast.
float apparent(float size, float distance) {
    return size / distance;
}

#endif
