#version 460

layout(set = 0, binding = 0, std430) readonly buffer Texels {
    uint number;
} texels;
layout(set = 0, binding = 1, std430) readonly buffer Samples {
    uint number;
} samples;

layout(location = 0) out vec4 color;

// Two counts as numbers.
void main() {
    color = vec4(float(texels.number), float(samples.number), 0.0, 1.0);
}
