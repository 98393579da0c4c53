#version 460
// The GLSL of what examples/hlsl/tint.hlsl draws.
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1) uniform Params { vec3 tint; float strength; float corners; } params;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

void main() {
    vec3 light = texture(source, uv).rgb;
    vec3 toned = dot(light, vec3(0.2126, 0.7152, 0.0722)) * params.tint;
    vec2 from_centre = uv - 0.5;
    float darker = 1.0 - params.corners * dot(from_centre, from_centre);
    color = vec4(mix(light, toned, params.strength) * darker, 1.0);
}
