#version 460
layout(local_size_x = 16, local_size_y = 4, local_size_x_id = 3, local_size_y_id = 4) in;
layout(set = 0, binding = 0) buffer To { uint to[]; };

void main() {
    to[gl_LocalInvocationIndex] = 100u * gl_WorkGroupSize.x + gl_WorkGroupSize.y;
}
