#version 460

layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1) uniform Params {
    vec2 scale;
    vec2 offset;
    // Below 0: as the derivatives say.
    float level;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// One lookup somewhere else.
void main() {
    const vec2 place = uv * params.scale + params.offset;
    color = params.level < 0.0 ? texture(source, place) : textureLod(source, place, params.level);
}
