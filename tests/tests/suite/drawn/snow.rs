//! The shipped snow is held against its twin: flakes move on from where the frame before left them, and those that are seen
//! are drawn, in their order (NU-5).

use framewright_graph::compile::Options;
use framewright_passes::twin::snow::Flake;
use framewright_tests::render::{Setup, device, draw, silent};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// As in `tests/pipelines/snow.ron`.
const SECONDS: f64 = 0.05;
const WIND: f64 = -0.7;

/// The contents that some frames leave.
struct Left {
    flakes: Vec<Flake>,
    seen: Vec<u32>,
    counts: Vec<u32>,
}

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word)).collect()
}

fn left(flakes: &str, frames: u32) -> Result<Option<Left>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let scene = empty_scene();
    let set = [("flakes", flakes)];
    let setup = Setup { pipeline: "tests/pipelines/snow.ron", set: &set, scene: &scene, extent: [8, 8] };
    let (_, mut executor) = draw(device, &setup, &Options::default(), frames)?;
    let numbers: Vec<f64> =
        words(&executor.read_buffer("flakes")?).into_iter().map(|bits| f64::from(f32::from_bits(bits))).collect();
    let flake = |&[x, y, distance, phase]: &[f64; 4]| Flake { position: [x, y], distance, phase };
    let left = Left {
        flakes: numbers.as_chunks::<4>().0.iter().map(flake).collect(),
        seen: words(&executor.read_buffer("seen")?),
        counts: words(&executor.read_buffer("counts")?),
    };
    silent(device)?;
    Ok(Some(left))
}

#[test]
fn flakes_move_on_from_where_the_frame_before_left_them() -> Result<(), Box<dyn Error>> {
    for frames in [1, 2, 3, 60] {
        let Some(Left { flakes, .. }) = left("1000", frames)? else { return Ok(()) };
        assert_eq!(flakes.len(), 1000);
        for (index, flake) in (0..).zip(flakes) {
            let expected = (1..frames).fold(Flake::born(index), |flake, _| flake.later(SECONDS, WIND));
            assert!((flake.distance - expected.distance).abs() < 1e-6, "{flake:?} instead of {expected:?}");
            // Sixty steps, each rounded by 2⁻²³ at most.
            assert!(
                flake.apart(expected) < 1e-4,
                "flake {index} after {frames} frames: {flake:?} instead of {expected:?}"
            );
        }
    }
    Ok(())
}

#[test]
fn exactly_those_that_are_seen_are_drawn_in_their_order() -> Result<(), Box<dyn Error>> {
    for flakes in ["1", "256", "257", "3000"] {
        let Some(Left { flakes, seen, counts }) = left(flakes, 5)? else { return Ok(()) };
        let [vertices, drawn, first_vertex, first_instance] = counts[..] else { return Err("four counts".into()) };
        assert_eq!([vertices, first_vertex, first_instance], [6, 0, 0]);
        let (drawn, rest) = seen.split_at(drawn as usize);
        assert!(drawn.is_sorted_by(|one, next| one < next), "{drawn:?}");
        assert!(rest.iter().all(|number| *number == 0), "{rest:?}");
        for (index, flake) in (0..).zip(&flakes) {
            // So close to the border, rounding decides.
            let sure = flake.within().abs() > 1e-6;
            let wanted = flake.within() > 0.0;
            assert!(!sure || drawn.contains(&index) == wanted, "flake {index}, {} within", flake.within());
        }
        assert!(flakes.len() < 3000 || (1000..2900).contains(&drawn.len()), "{} are seen", drawn.len());
    }
    Ok(())
}
