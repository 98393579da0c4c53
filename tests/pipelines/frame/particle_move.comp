#version 460
layout(local_size_x = 64) in;
struct Particle { vec4 place; vec4 speed; };
layout(set = 0, binding = 0, std430) writeonly buffer State { Particle particle[]; } state;
layout(set = 0, binding = 1, std430) readonly buffer Before { Particle particle[]; } before;
layout(set = 0, binding = 2) uniform Params { uint count; uint frame; float seconds; } params;
void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) { return; }
    Particle p = before.particle[i];
    if (p.place.w <= 0.0) {
        const uint h = (i + params.frame * 977u) * 2654435761u;
        p.place = vec4(vec3(h & 1023u, (h >> 10) & 1023u, (h >> 20) & 1023u) / 1023.0 * vec3(8, 4, 8) - vec3(4, 0, 4), 1.0);
        p.speed = vec4(0.0, 0.3, 0.0, 0.0);
    }
    p.place += vec4(p.speed.xyz * params.seconds, -params.seconds * 0.2);
    state.particle[i] = p;
}
