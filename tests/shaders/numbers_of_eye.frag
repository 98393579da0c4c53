#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/random.glsl"
#include "include/rotation.glsl"
#include "include/stereo.glsl"

layout(location = 0) out vec4 color;

// Numbers of each texel, sample and eye: 0 to 255, so that sums of them are exact in whatever order.
void main() {
    const uvec2 texel = uvec2(frag_coord().xy);
    const uint number = hash(texel.x + hash(texel.y + hash(uint(2 * gl_SampleID + eye_index))));
    color = vec4(number >> 24, (number >> 16) & 255u, (number >> 8) & 255u, eye_index);
}
