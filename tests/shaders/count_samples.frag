#version 460
#extension GL_GOOGLE_include_directive : require

layout(set = 0, binding = 0, std430) buffer Counted {
    uint number;
} counted;

layout(location = 0) out vec4 color;

#include "counted.glsl"

// The same, but once a sample, since it asks for which.
void main() {
    if (off_the_diagonals()) {
        atomicAdd(counted.number, 1u);
    }
    color = vec4(float(gl_SampleID));
}
