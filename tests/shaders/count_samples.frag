#version 460

layout(set = 0, binding = 0, std430) buffer Counted {
    uint number;
} counted;

layout(location = 0) out vec4 color;

// The same, but once a sample, since it asks for which.
void main() {
    if (gl_FragCoord.x < 24.0 && gl_FragCoord.y < 18.0) {
        atomicAdd(counted.number, 1u);
    }
    color = vec4(float(gl_SampleID));
}
