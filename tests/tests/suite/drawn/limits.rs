//! Scenes that the draw source refuses.

use framewright_passes::draw::{MOST_POINT_LIGHTS, SceneDrawSource};
use framewright_passes::scene::PointLight;
use framewright_tests::render::device;
use framewright_tests::shapes::empty_scene;

#[test]
fn a_scene_with_more_point_lights_than_can_be_drawn_is_refused() {
    let Some(device) = device() else { return };
    let light = PointLight { position: [0.0; 3], color: [1.0; 3], intensity: 1.0, range: None, shadows: false };
    let mut scene = empty_scene();
    scene.point_lights = vec![light; MOST_POINT_LIGHTS];
    assert!(SceneDrawSource::new(device, &scene, [16, 16]).is_ok());
    scene.point_lights.push(light);
    let refusal = SceneDrawSource::new(device, &scene, [16, 16]).err().map(|error| error.to_string());
    assert_eq!(refusal.as_deref(), Some("the scene has 4097 point lights, and at most 4096 can be drawn"));
}
