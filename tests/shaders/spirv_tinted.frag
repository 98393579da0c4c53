#version 460
// The GLSL of what `post.hlsl` and `post.wgsl` draw.
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 2) uniform Params { float factor; vec3 tint; } params;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(texture(source, uv).rgb * params.factor * params.tint, 1.0);
}
