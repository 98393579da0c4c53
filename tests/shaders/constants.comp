#version 460
// A shader of which the file says what its constants are, the size of its workgroups among them.
layout(local_size_x_id = 0, local_size_y = 1) in;
layout(constant_id = 1) const uint FACTOR = 1u;
layout(constant_id = 2) const bool DOUBLED = false;
layout(constant_id = 3) const float SHARE = 0.0;
layout(constant_id = 4) const int BIAS = 0;
layout(set = 0, binding = 0) buffer Numbers { uint numbers[]; };

void main() {
    numbers[gl_GlobalInvocationID.x] = gl_WorkGroupSize.x * FACTOR * (DOUBLED ? 2u : 1u) + uint(SHARE * 8.0) + uint(BIAS);
}
