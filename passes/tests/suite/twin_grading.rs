//! Claims about colour grading.

use framewright_passes::srgb::decode;
use framewright_passes::twin::grading::graded;

fn colours() -> impl Iterator<Item = [f64; 3]> {
    (0..1000).map(|at| [at % 10, at / 10 % 10, at / 100].map(|part| f64::from(part) / 9.0))
}

#[test]
fn a_table_of_the_colours_themselves_changes_nothing() {
    for size in [2, 3, 16, 32] {
        for shown in colours() {
            let found = graded(shown, size, |at| at.map(|place| place as f64 / (size - 1) as f64), 1.0);
            let near = found.iter().zip(shown).all(|(found, shown)| (found - shown).abs() < 1e-7);
            assert!(near, "{size} shades: {shown:?} became {found:?}");
        }
    }
}

#[test]
fn entries_are_found_where_a_strip_has_them() {
    let entry = |[red, green, blue]: [usize; 3]| [red as f64 / 4.0, green as f64 / 16.0, blue as f64 / 64.0];
    let shown = [1, 2, 3].map(|place| decode(f64::from(place) / 3.0));
    let found = graded(shown, 4, entry, 1.0);
    for (found, expected) in found.into_iter().zip([0.25, 2.0 / 16.0, 3.0 / 64.0]) {
        assert!((found - decode(expected)).abs() < 1e-9, "{found} instead of {}", decode(expected));
    }
}
