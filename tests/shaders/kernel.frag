#version 460

struct Light {
    vec3 color;
    float gains[2];
};

layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1) uniform Params {
    float weights[5];
    vec2 offsets[5];
    mat2 turns[2];
    Light light;
} params;

layout(location = 0) out vec4 color;

// Five texels around each, at places that are turned, weighed and tinted.
void main() {
    vec3 sum = vec3(0.0);
    for (int tap = 0; tap < 5; tap++) {
        const ivec2 place = ivec2(gl_FragCoord.xy) + ivec2(params.turns[tap & 1] * params.offsets[tap]);
        sum += params.weights[tap] * texelFetch(source, clamp(place, ivec2(0), ivec2(7)), 0).rgb;
    }
    color = vec4(sum * params.light.color, params.light.gains[0] + 16.0 * params.light.gains[1]);
}
