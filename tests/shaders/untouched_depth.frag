#version 460
// The colour, with blue where there is depth.
layout(set = 0, binding = 0) uniform sampler2D color;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(location = 0) out vec4 shown;
void main() {
    const ivec2 at = ivec2(gl_FragCoord.xy);
    shown = vec4(texelFetch(color, at, 0).rg, texelFetch(depth, at, 0).r > 0.0 ? 1.0 : 0.0, 1.0);
}
