#version 460

layout(local_size_x = 1) in;

layout(set = 0, binding = 0, std430) writeonly buffer Counts {
    uint count[4];
} counts;

// A VkDrawIndirectCommand: three vertices, one instance.
void main() {
    counts.count = uint[4](3, 1, 0, 0);
}
