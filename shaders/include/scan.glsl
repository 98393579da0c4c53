// Running sums over a workgroup of 256 invocations.
#ifndef FRAMEWRIGHT_SCAN
#define FRAMEWRIGHT_SCAN

const uint SCANNED = 256u;

shared uint scan_sums[SCANNED];

// The sum of `value` over all invocations of the workgroup up to and including this one (W. D. Hillis, G. L. Steele, "Data
// Parallel Algorithms", Communications of the ACM 29 (12), 1986). All of the workgroup must call it.
uint running_sum(uint value) {
    const uint at = gl_LocalInvocationIndex;
    barrier();
    scan_sums[at] = value;
    barrier();
    for (uint reach = 1u; reach < SCANNED; reach *= 2u) {
        const uint before = at >= reach ? scan_sums[at - reach] : 0u;
        barrier();
        scan_sums[at] += before;
        barrier();
    }
    return scan_sums[at];
}

// The sum over the whole workgroup, after `running_sum`.
uint whole_sum() {
    return scan_sums[SCANNED - 1u];
}

#endif
