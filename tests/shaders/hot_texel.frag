#version 460

layout(location = 0) out vec4 color;

// For a target of 65 × 65: black, but for the middle, which is as bright as a half float can be.
void main() {
    const bool hot = ivec2(gl_FragCoord.xy) == ivec2(32);
    color = vec4(vec3(hot ? 65504.0 : 0.0), 1.0);
}
