//! History is kept as far back as a pass reads it that something needs.

use crate::testing::pipelines::{INPUTS, frame, set};
use crate::testing::plans::{on, shipped};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Frame, Lifetime};

/// A pipeline whose pass `mix` alone reads what the frame before left of `past`. `show` is what is shown.
fn mixed(settings: &[(&str, &str)], show: &str) -> Frame {
    let text = format!(
        r#"Pipeline(version: 1,
            settings: [(name: "mix", value: Bool(default: true))],
            images: [
                (name: "now", format: Color(hdr: true), size: Output),
                (name: "past", format: Like("now"), size: Like("now"), lifetime: History(frames: 2)),
                (name: "screen", format: Output, size: Output),
            ],
            passes: [
                (name: "draw", draw: FullScreen("plain"), color: ["now"]),
                (name: "mix", when: "mix", draw: FullScreen("soft_focus"), params: {{"strength": 0.5}},
                    sample: {{"sharp": "now", "soft": (image: "past", previous: 1)}}, color: ["past"],
                    otherwise: Forward(from: "now", to: "past")),
                (name: "show", draw: FullScreen("downsample"), sample: {{"source": "{show}"}}, color: ["screen"]),
            ],
            outputs: ["screen"])"#
    );
    let set = set(settings);
    frame(&text, &Inputs { set: &set, ..INPUTS }).unwrap_or_else(|answer| panic!("{answer}"))
}

/// The Plan's images, by name, and how many copies it makes.
fn planned(frame: &Frame) -> (Vec<String>, u64) {
    let plan = on(frame, &shipped("amd-rx-7800-xt")).expect("a Plan");
    (plan.images.iter().map(|image| image.name.to_string()).collect(), u64::from(plan.totals.copies))
}

#[test]
fn history_that_no_running_pass_reads_goes_with_its_images_and_copies() {
    let on = mixed(&[], "past");
    assert!(matches!(on.images[1].lifetime, Lifetime::History { frames: 1, .. }), "{:?}", on.images[1].lifetime);
    let (images, _) = planned(&on);
    assert!(images.contains(&"past (1 frame ago)".to_owned()), "{images:?}");
    // Without `mix` the shown image is `now` by another name.
    let off = mixed(&[("mix", "false")], "past");
    assert_eq!(off.images[1].lifetime, Lifetime::Transient);
    assert_eq!(planned(&off), (vec!["past".to_owned(), "screen".to_owned()], 0));
    let unseen = mixed(&[("mix", "false")], "now");
    assert_eq!(planned(&unseen), (vec!["now".to_owned(), "screen".to_owned()], 0));
}

#[test]
fn history_is_kept_no_further_back_than_it_is_read() {
    let Lifetime::History { frames, .. } = mixed(&[], "past").images[1].lifetime else { panic!("no history") };
    assert_eq!(frames, 1, "`History(frames: 2)` of which `previous: 1` is read");
}
