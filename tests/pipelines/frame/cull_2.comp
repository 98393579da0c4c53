#version 460
#extension GL_GOOGLE_include_directive : require
#include "include/scene.glsl"
#include "camera.glsl"
#include "cull.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform sampler2D hzb_left;
layout(set = 0, binding = 2, std430) readonly buffer Instances { Instance instance[]; } instances;
layout(set = 0, binding = 3, std430) buffer List { uint number[]; } list;
layout(set = 0, binding = 4, std430) buffer Args { uint vertices; uint count; uint first_vertex; uint first_instance; } args;
layout(set = 0, binding = 5, std430) readonly buffer Rest { uint number[]; } rest;
layout(set = 0, binding = 6, std430) readonly buffer RestCount { uint count; uint pad[3]; } rest_count;
layout(set = 0, binding = 7) uniform sampler2D hzb_right;
void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i == 0u) { args.vertices = 36u; }
    if (i >= rest_count.count) { return; }
    if (may_be_seen(view.world_to_clip, view.camera_position, instances.instance[rest.number[i]].sphere, hzb_left, hzb_left_st) || may_be_seen(view.world_to_clip, view.camera_position, instances.instance[rest.number[i]].sphere, hzb_right, hzb_right_st)) {
        list.number[atomicAdd(args.count, 1u)] = rest.number[i];
    }
}
