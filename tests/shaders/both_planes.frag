#version 460

layout(set = 0, binding = 0) uniform sampler2D depths;
layout(set = 0, binding = 1) uniform usampler2D marks;
layout(location = 0) out vec2 seen;

// Depth and stencil of the texel.
void main() {
    const ivec2 texel = ivec2(gl_FragCoord.xy);
    seen = vec2(texelFetch(depths, texel, 0).r, texelFetch(marks, texel, 0).r);
}
