#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

layout(set = 0, binding = 0) uniform Params {
    int width;
    int height;
    // The border: `slope_x` · x + `slope_y` · y = `offset`, in texels.
    float slope_x;
    float slope_y;
    float offset;
    // On the far side and on the near one.
    float bright;
    float dark;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Two halves with a hard border between them: a texel is what its middle is.
void main() {
    const vec2 middle = vec2(texel_at(uv, ivec2(params.width, params.height))) + 0.5;
    const bool far = dot(middle, vec2(params.slope_x, params.slope_y)) > params.offset;
    color = vec4(vec3(far ? params.bright : params.dark), 1.0);
}
