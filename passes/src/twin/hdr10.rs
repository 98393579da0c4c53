//! Twin of `shaders/include/hdr10.glsl`.
//!
//! Sources: ITU-R BT.2087-0, section 3, step 2 (primaries of Rec. 709 to Rec. 2020); SMPTE ST 2084 and ITU-R BT.2100-2, table
//! 4 (the signal).

/// Luminance that a share of 1 stands for, cd/m².
pub const PQ_PEAK: f64 = 10_000.0;

/// Rows of the matrix from Rec. 709 to Rec. 2020.
const TO_2020: [[f64; 3]; 3] = [[0.6274, 0.3293, 0.0433], [0.0691, 0.9195, 0.0114], [0.0164, 0.0880, 0.8956]];

const M1: f64 = 2610.0 / 16384.0;
const M2: f64 = 2523.0 / 4096.0 * 128.0;
const C1: f64 = 3424.0 / 4096.0;
const C2: f64 = 2413.0 / 4096.0 * 32.0;
const C3: f64 = 2392.0 / 4096.0 * 32.0;

/// A share of 10,000 cd/m², 0 to 1, as a signal, 0 to 1.
#[must_use]
pub fn encode_pq(luminance: f64) -> f64 {
    let powered = luminance.powf(M1);
    ((C1 + C2 * powered) / (1.0 + C3 * powered)).powf(M2)
}

/// The inverse of [`encode_pq`], as the standards state it (the electro-optical transfer function).
#[must_use]
pub fn decode_pq(signal: f64) -> f64 {
    let powered = signal.powf(1.0 / M2);
    ((powered - C1).max(0.0) / (C2 - C3 * powered)).powf(1.0 / M1)
}

/// Radiance with the primaries of Rec. 709, at least 0, as an HDR10 signal, 0 to 1. Radiance 1 is shown at
/// `reference_white` cd/m².
#[must_use]
pub fn encode_hdr10(radiance: [f64; 3], reference_white: f64) -> [f64; 3] {
    TO_2020.map(|row| {
        let wide: f64 = row.iter().zip(radiance).map(|(share, light)| share * light).sum();
        encode_pq((wide * reference_white / PQ_PEAK).clamp(0.0, 1.0))
    })
}
