//! Claims about the guard that radiance passes through before it is stored.

use framewright_passes::twin::radiance::{LARGEST_HALF, guard_alpha, guard_radiance, guard_signed};

#[test]
fn what_a_half_float_can_hold_passes_unchanged() {
    for radiance in [0.0, f64::from(f32::from_bits(1)), 5.960_464_5e-8, 1.0, 12.5, 65503.0, LARGEST_HALF] {
        assert_eq!(guard_radiance(radiance), radiance);
    }
}

#[test]
fn nan_of_either_sign_and_negative_radiance_become_zero() {
    for radiance in [f64::NAN, -f64::NAN, -f64::from(f32::from_bits(1)), -1.0, f64::NEG_INFINITY, -0.0] {
        let guarded = guard_radiance(radiance);
        assert!(guarded == 0.0 && guarded.is_sign_positive(), "{radiance} became {guarded}");
    }
}

#[test]
fn infinity_and_finite_overflow_become_the_largest_half() {
    for radiance in [65504.01, 65520.0, 1e6, f64::from(f32::MAX), f64::INFINITY] {
        assert_eq!(guard_radiance(radiance), LARGEST_HALF);
    }
}

#[test]
fn alpha_ends_between_zero_and_one() {
    for (alpha, guarded) in [(f64::NAN, 0.0), (-1.0, 0.0), (0.25, 0.25), (1.0, 1.0), (1.5, 1.0), (f64::INFINITY, 1.0)] {
        assert_eq!(guard_alpha(alpha), guarded);
    }
}

#[test]
fn numbers_that_may_be_negative_keep_their_sign_and_end_where_half_floats_end() {
    for number in [0.0, -1.0, 12.5, -LARGEST_HALF, LARGEST_HALF, -f64::from(f32::from_bits(1))] {
        assert_eq!(guard_signed(number), number);
    }
    for (number, guarded) in [(f64::NAN, 0.0), (1e30, LARGEST_HALF), (f64::NEG_INFINITY, -LARGEST_HALF)] {
        assert_eq!(guard_signed(number), guarded);
    }
}
