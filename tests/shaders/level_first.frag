#version 460

layout(set = 0, binding = 0) uniform Params {
    int layer;
} params;

layout(location = 0) out vec4 color;

// Small whole numbers that differ from texel to texel and from layer to layer.
void main() {
    const ivec2 here = ivec2(gl_FragCoord.xy);
    color = vec4((here * ivec2(7, 13) + 5 * params.layer) % 64, (here.x + here.y) % 2, 1.0);
}
