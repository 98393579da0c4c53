//! What a viewer costs (LV-1): nothing while nobody looks.

use super::Drawn;
use framewright_tests::render;
use framewright_viewer::Viewer;

#[test]
fn lv_1_a_viewer_that_nobody_looks_at_allocates_and_reads_nothing() {
    let Some(device) = render::device() else { return };
    let mut viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let mut drawn = Drawn::of(device, "forward", [64, 48]);
    drawn.draw().expect("drawn");
    let frames = |viewer: &mut Viewer, drawn: &mut Drawn| {
        allocation_counter::measure(|| (0..100).for_each(|_| viewer.frame(&mut drawn.renderer).expect("fine")))
            .count_total
    };
    assert_eq!(frames(&mut viewer, &mut drawn), 0);
    // To read an output takes memory: the count sees it. A folder for what is lost is asked for, and so frames are kept.
    let folder = tempfile::tempdir().expect("a folder");
    viewer.save_when_lost(folder.path());
    assert!(frames(&mut viewer, &mut drawn) > 0);
}
