#version 460
// The engine's own simulation; sparks.spv is made of it by:  glslangValidator -V --target-env vulkan1.3 -o sparks.spv sparks.comp
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) writeonly buffer Sparks { vec4 spark[]; } sparks;
layout(push_constant) uniform Time { float seconds; } time;

void main() {
    uint i = gl_GlobalInvocationID.x;
    float start = fract(float(i) * 0.61803);
    float age = fract(time.seconds * 0.7 + start);
    float side = fract(float(i) * 0.75488) - 0.5;
    sparks.spark[i] = vec4(0.5 + side * age * 0.9, 0.95 - age * 1.5 + age * age * 0.8, 0.006, 1.0 - age);
}
