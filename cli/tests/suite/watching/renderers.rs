//! Several renderers in one program (LV-1): one is shown, and the page chooses it.

use super::{Drawn, Page, extent, names, while_drawing};
use framewright_tests::render;
use framewright_viewer::Viewer;

#[test]
fn lv_1_one_of_several_renderers_is_shown_with_its_own_plan_outputs_and_settings() {
    let Some(device) = render::device() else { return };
    let mut viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let page = Page::of(&viewer);
    let mut left = Drawn::of(device, "forward", [64, 48]);
    let mut right = Drawn::of(device, "forward", [32, 24]);
    let begun = [left.renderer.id(), right.renderer.id()];
    assert_ne!(begun[0], begun[1]);
    let mut both = |viewer: &mut Viewer| {
        left.show(viewer);
        right.show(viewer);
    };

    let state = while_drawing(|| both(&mut viewer), || page.state(|state| names(state).len() == 2));
    assert_eq!(names(&state), ["forward", "forward (2)"], "{}", state["live"]["program"]);
    assert_eq!((extent(&state), state["live"]["program"]["renderer"].as_u64()), ([64, 48], Some(begun[0])));

    let chosen = format!("{{\"renderer\": {}}}", begun[1]);
    let state = while_drawing(
        || both(&mut viewer),
        || {
            assert_eq!(page.post("look", &chosen), 204);
            page.state(|state| extent(state) == [32, 24])
        },
    );
    assert_eq!(state["live"]["program"]["renderer"].as_u64(), Some(begun[1]));
    assert_eq!(state["page"]["plans"][0]["name"], "forward (2)");
    let png = while_drawing(
        || both(&mut viewer),
        || {
            let picture = |_| {
                let state = page.state(|_| true);
                let (status, png) = page.get(state["live"]["outputs"][0]["picture"].as_str()?);
                (status == 200).then_some(png)
            };
            (0..100).find_map(picture).expect("a picture")
        },
    );
    let picture = image::load_from_memory(&png).expect("a PNG file");
    assert_eq!([picture.width(), picture.height()], [32, 24]);

    // A setting is that of the renderer that is shown.
    let before = left.msaa();
    let value = if before == "4" { "2" } else { "4" };
    let mut both = |viewer: &mut Viewer| {
        left.show(viewer);
        right.show(viewer);
    };
    let state = while_drawing(
        || both(&mut viewer),
        || {
            assert_eq!(page.post("choose", &format!("{{\"set\": {{\"msaa\": \"{value}\"}}}}")), 204);
            page.state(|state| state["live"]["settings"][0]["value"] == value)
        },
    );
    assert_eq!(state["live"]["chosen"]["msaa"], value);
    assert_eq!((left.msaa(), right.msaa()), (before, value.to_owned()));

    // What nobody looks at costs nothing, while the page is open.
    left.draw().expect("drawn");
    let unseen = allocation_counter::measure(|| (0..10).for_each(|_| viewer.frame(&mut left.renderer).expect("fine")));
    assert_eq!(unseen.count_total, 0);

    // One that draws no more is forgotten, and the other is shown.
    drop(right);
    let state = while_drawing(|| left.show(&mut viewer), || page.state(|state| extent(state) == [64, 48]));
    assert_eq!(names(&state), ["forward"]);
    // One that never was changes nothing.
    let state = while_drawing(
        || left.show(&mut viewer),
        || {
            assert_eq!(page.post("look", "{\"renderer\": 18446744073709551615}"), 204);
            page.state(|_| true)
        },
    );
    assert_eq!(extent(&state), [64, 48]);
}
