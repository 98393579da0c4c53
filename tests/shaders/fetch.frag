#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"

layout(set = 0, binding = 0) uniform sampler2D source;

layout(location = 0) out vec4 color;

// The texel of the image that lies where the fragment does.
void main() {
    color = texelFetch(source, ivec2(frag_coord().xy), 0);
}
