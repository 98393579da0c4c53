#version 460

layout(local_size_x = 1) in;

// How many frames there were, in the first four bytes; it persists, and begins with 0.
layout(set = 0, binding = 0, std430) buffer Frame {
    uint number;
} frame;

// Counts the frames, for what shall differ from one to the next. One workgroup does it.
void main() {
    frame.number += 1u;
}
