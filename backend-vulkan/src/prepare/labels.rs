//! Labels of steps and passes.

use crate::gpu::Gpu;
use framewright_graph::plan::Cause;

/// The label of a step or a pass. Debuggers show with it why it is there, and the place that says so; messages of the validation layer
/// are led back to steps by their labels, which have nothing behind them there.
pub(super) fn labelled(gpu: &Gpu, title: &str, cause: Option<&Cause>) -> String {
    if gpu.instance.validation.is_some() { title.to_owned() } else { explained(title, cause) }
}

/// A title with a cause behind it.
fn explained(title: &str, cause: Option<&Cause>) -> String {
    let because = cause.and_then(Cause::because).map(str::to_owned);
    let at = cause.and_then(Cause::at).map(|place| format!("{}:{}", place.file, place.line));
    let words: Vec<String> = because.into_iter().chain(at).collect();
    if words.is_empty() { title.to_owned() } else { format!("{title} ({})", words.join("; ")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::base::Place;
    use framewright_graph::plan::InsertionCause;

    #[test]
    fn lv_10_a_label_says_why_its_work_is_there_and_where_that_stands() {
        let at = Some(Place { file: "first.ron".into(), line: 27, column: 3 });
        let written = Cause::Written(at.clone());
        assert_eq!(explained("sky", Some(&written)), "sky (first.ron:27)");
        let because = "pass `tone_map` samples `color`".to_owned();
        let inserted = Cause::Inserted(Box::new(InsertionCause { because, at }));
        let told = explained("step 1: resolve color", Some(&inserted));
        assert_eq!(told, "step 1: resolve color (pass `tone_map` samples `color`; first.ron:27)");
        assert_eq!(explained("step 0: opaque, sky", None), "step 0: opaque, sky");
        assert_eq!(explained("made", Some(&Cause::Written(None))), "made");
    }
}
