#version 460

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// What no rotation changes: depth, the sum of changes to both sides, and what is seen of the upright picture.
void main() {
    color = vec4(uv, fwidth(uv.x + 3.0 * uv.y), gl_FragCoord.z);
}
