//! Graphs of a Plan whose names try to act: a Plan may come from a stranger's file. They are kept in `tests/formats`, where the tests of
//! the command give them to Graphviz and to Mermaid.

use super::{dot, mermaid};
use framewright_graph::dataflow::{Dataflow, Edge, Node, NodeKind};
use framewright_graph::plan::{ImageId, Plan, Resource, StepId};
use serde_json::json;
use std::path::Path;

const NAMES: [&str; 20] = [
    "\"double\" 'single' `tick`",
    "line\nbreak\r\tand tab",
    "]]></text><x/>",
    "</script><img src=x onerror=hacked=1>",
    "<script>hacked=1</script>",
    "\u{202e}evil\u{2066}",
    "\u{1b}[2J\u{0}\u{7f}\u{9b}",
    "a&amp;b &lt;b&gt; &#60; &quot;",
    "a#amp;b #lt; #35; ﬂ°°60¶ß",
    "\\N \\G \\n \\l \\\" \\",
    "end",
    "subgraph x",
    "class n0 evil",
    "click n0 href \"javascript:hacked=1\"",
    "%%{init: {\"securityLevel\": \"loose\"}}%% %% comment",
    "n0 -->|x| n1; graph LR",
    "**bold** _slanted_ ~~gone~~ $$x$$ fa:fa-ban 1. list",
    "n1@{ shape: circle } ::: evil",
    "שלום 漢字 😀 e\u{301} Größe",
    "http://example.org/?a=b&c=d#e",
];

/// The example Plan, with a pass and an image of each name, and its dataflow: each pass draws into the image that the next one reads.
fn hostile() -> (Plan, Dataflow) {
    let mut plan = Plan::from_json(include_str!("../../../../docs/plan-example.json")).expect("a Plan");
    let image = plan.images[0].clone();
    plan.images =
        NAMES.iter().map(|name| framewright_graph::plan::Image { name: (*name).into(), ..image.clone() }).collect();
    let names = NAMES.iter().zip(0_u32..);
    let node = |(name, at): (&&str, u32)| Node {
        step: StepId(at / 10),
        kind: if at % 2 == 0 { NodeKind::Draw } else { NodeKind::Resolve },
        name: (*name).to_owned(),
        because: None,
        at: None,
        uses: Vec::new(),
    };
    let count = NAMES.len() as u32;
    let edge = |at: u32| Edge {
        from: at.checked_sub(1),
        to: Some(at).filter(|at| *at < count),
        resource: Resource::Image(ImageId(at.min(count - 1))),
    };
    let flow = Dataflow { nodes: names.map(node).collect(), edges: (0..=count).map(edge).collect() };
    (plan, flow)
}

#[test]
fn graphs_with_hostile_names_are_those_that_are_given_to_the_judges() {
    let (plan, flow) = hostile();
    let names = serde_json::to_string_pretty(&json!(NAMES)).expect("JSON") + "\n";
    let (shown, notes) = mermaid(&plan, &flow);
    assert!(notes.is_empty(), "{notes:?}");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cli/tests/formats");
    for (name, text) in [("hostile.json", names), ("hostile.dot", dot(&plan, &flow)), ("hostile.mmd", shown)] {
        let path = folder.join(name);
        if std::env::var_os("FRAMEWRIGHT_UPDATE").is_some() {
            std::fs::write(&path, &text).expect("written");
        }
        let kept = std::fs::read_to_string(&path).unwrap_or_default();
        let update = "FRAMEWRIGHT_UPDATE=1 cargo test --package framewright-viewer hostile; git diff cli/tests/formats";
        assert!(kept == text, "{name} differs; see: {update}");
    }
}
