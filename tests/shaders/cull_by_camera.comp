#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/scene.glsl"

layout(local_size_x = 4) in;

struct Place {
    vec4 clip;
};

layout(set = 0, binding = 0, std430) writeonly buffer Places {
    Place place[];
} places;

// Where the camera sees the origin of each object.
void main() {
    const uint number = gl_GlobalInvocationID.x;
    if (number < places.place.length()) {
        places.place[number].clip = view.world_to_clip * objects.object[number].object_to_world[3];
    }
}
