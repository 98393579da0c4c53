#version 460

layout(set = 0, binding = 0) uniform sampler3D volume;
layout(location = 0) out vec4 color;

// Of the last level, a texel of the only layer in depth.
void main() {
    const int last = textureQueryLevels(volume) - 1;
    const ivec3 extent = textureSize(volume, last);
    color = extent.z == 1 ? texelFetch(volume, ivec3(ivec2(gl_FragCoord.xy) % extent.xy, 0), last) : vec4(0.0);
}
