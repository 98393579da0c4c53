// Numbers without pattern. CPU twin: passes/src/twin/random.rs.
#ifndef FRAMEWRIGHT_RANDOM
#define FRAMEWRIGHT_RANDOM

// An integer from an integer: "pcg" of M. Jarzynski, M. Olano, "Hash Functions for GPU Rendering", Journal of Computer
// Graphics Techniques 9 (3), 2020.
uint hash(uint value) {
    const uint state = value * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

// 0 to 1, without 1.
float random(uint value) {
    return float(hash(value) >> 8) / 16777216.0;
}

#endif
