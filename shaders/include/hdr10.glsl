// HDR10: light as displays of high dynamic range are given it. CPU twin: passes/src/twin/hdr10.rs.
#ifndef FRAMEWRIGHT_HDR10
#define FRAMEWRIGHT_HDR10

// Luminance that 1 stands for, in candela per square metre.
const float PQ_PEAK = 10000.0;

// The inverse electro-optical transfer function of SMPTE ST 2084 (ITU-R BT.2100-2, table 4): a share of 10,000 cd/m², 0 to
// 1, as a signal, 0 to 1.
float encode_pq(float luminance) {
    const float m1 = 2610.0 / 16384.0;
    const float m2 = 2523.0 / 4096.0 * 128.0;
    const float c1 = 3424.0 / 4096.0;
    const float c2 = 2413.0 / 4096.0 * 32.0;
    const float c3 = 2392.0 / 4096.0 * 32.0;
    // What pow() makes of 0 is up to the driver.
    const float powered = luminance > 0.0 ? pow(luminance, m1) : 0.0;
    return pow((c1 + c2 * powered) / (1.0 + c3 * powered), m2);
}

// Radiance with the primaries of Rec. 709, 0 to 65504, as an HDR10 signal, 0 to 1: primaries of Rec. 2020 (ITU-R BT.2087-0,
// section 3, step 2), then PQ. Radiance 1 is shown at `reference_white` cd/m² (203 in ITU-R BT.2408); what is brighter than
// 10,000 cd/m² is cut off.
vec3 encode_hdr10(vec3 radiance, float reference_white) {
    const mat3 to_2020 = mat3(0.6274, 0.0691, 0.0164, 0.3293, 0.9195, 0.0880, 0.0433, 0.0114, 0.8956);
    const vec3 share = clamp(to_2020 * radiance * (reference_white / PQ_PEAK), 0.0, 1.0);
    return vec3(encode_pq(share.r), encode_pq(share.g), encode_pq(share.b));
}

#endif
