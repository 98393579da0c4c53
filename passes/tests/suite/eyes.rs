//! Claims about what two eyes see, held against angles.

use framewright_graph::frame::Eye;
use framewright_passes::draw::{EyeSight, Eyes};
use framewright_passes::scene::Camera;
use glam::{DMat3, DVec3};

/// Numbers without rhyme or reason, from 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.next()
    }

    fn vector(&mut self, reach: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.between(-reach, reach)))
    }
}

fn axes(camera: &Camera) -> DMat3 {
    DMat3::from_mat4(camera.transform)
}

#[test]
fn one_camera_sees_all_that_either_eye_sees() {
    let mut random = Random(1);
    let mut looked = 0;
    for _ in 0..300 {
        let far = if random.next() < 0.2 { 1e6 } else { 10.0 };
        let (at, to) = (random.vector(far), random.vector(1.0));
        let (fov, near) = (random.between(0.3, 2.4) as f32, random.between(0.01, 1.0) as f32);
        let Some(camera) = Camera::look_at(at, at + to, DVec3::new(0.1, 1.0, 0.2), fov, near) else { continue };
        let camera = Camera { far: (random.next() < 0.5).then_some(near * 100.0), ..camera };
        let aspect = random.between(0.5, 2.0);
        let mut sight = |x| {
            let place = DVec3::new(x, random.between(-0.02, 0.02), random.between(-0.02, 0.02));
            let tangents = (random.next() < 0.7).then(|| [(); 4].map(|()| random.between(0.2, 1.6)));
            EyeSight { place, tangents }
        };
        let eyes = Eyes { left: sight(-0.032), right: sight(0.034) };
        let around = eyes.around(&camera, aspect);
        let up = (f64::from(camera.vertical_fov) * 0.5).tan();
        let widest = (f64::from(around.vertical_fov) * 0.5).tan();
        for eye in Eye::BOTH.map(|eye| eyes.of(eye)) {
            let [left, right, above, below] = eye.tangents.unwrap_or([up * aspect, up * aspect, up, up]);
            for _ in 0..50 {
                // On a border more often than not.
                let mut edge =
                    |before: f64, after: f64| random.between(-before * 1.2, after * 1.2).clamp(-before, after);
                let (x, y) = (edge(left, right), edge(below, above));
                let distance = f64::from(camera.near) * 10_f64.powf(random.between(0.0, 4.0));
                // On the far plane more often than not.
                let distance = distance.min(camera.far.map_or(f64::INFINITY, f64::from));
                let place = eye.place + DVec3::new(x * distance, y * distance, -distance);
                let world = camera.position() + axes(&camera) * place;
                let seen = axes(&around).transpose() * (world - around.position());
                let ahead = -seen.z;
                assert!(around.far.is_none_or(|far| ahead <= f64::from(far)), "{ahead} is beyond {:?}", around.far);
                assert!(ahead >= f64::from(around.near) * (1.0 - 1e-6), "{ahead} is before {}", around.near);
                assert!(seen.x.abs() <= ahead * widest * aspect, "{seen} lies beside {}", widest * aspect);
                assert!(seen.y.abs() <= ahead * widest, "{seen} lies above or below {widest}");
                looked += 1;
            }
        }
    }
    assert!(looked > 20_000, "{looked}");
}

#[test]
fn pictures_of_converging_eyes_lie_on_each_other_at_that_distance() {
    let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 1.0, 0.1).expect("a direction");
    let (aspect, distance) = (1.5, 4.0);
    let eyes = Eyes::converging(0.064, distance, &camera, aspect);
    for eye in Eye::BOTH.map(|eye| eyes.of(eye)) {
        let [left, right, up, down] = eye.tangents.expect("they are told");
        let half = 0.5_f64.tan() * distance;
        assert!((eye.place.x - left * distance + half * aspect).abs() < 1e-12);
        assert!((eye.place.x + right * distance - half * aspect).abs() < 1e-12);
        assert!((up * distance - half).abs() < 1e-12 && up == down);
    }
}
