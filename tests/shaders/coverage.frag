#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/alpha_coverage.glsl"

layout(location = 0) out vec4 color;

// What is covered, and of which alpha, cutoff and width: all that bytes may hold, each over its range.
void main() {
    const uvec2 pixel = uvec2(gl_FragCoord.xy);
    const float alpha = float(pixel.x % 256u) / 255.0;
    const float cutoff = float(pixel.y % 17u) / 16.0;
    const float width = pixel.y / 17u == 0u ? 0.0 : exp2(-float(pixel.y / 17u - 1u));
    color = vec4(covered_by(alpha, cutoff, width), alpha, cutoff, width);
}
