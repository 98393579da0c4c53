//! The graphs that are judged, what their Plans say is in them, and the verdict of Graphviz.

use crate::page;
use crate::testing::{Place, repository, shipped_pipelines};
use framewright_graph::base::escape;
use framewright_graph::dataflow::Dataflow;
use framewright_graph::plan::{Plan, Resource, Work};
use framewright_tests::sweep;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// What a graph must hold.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Held {
    /// The names on its vertices, sorted.
    pub(super) names: Vec<String>,
    /// Its edges, sorted: the name that each comes from, those on it, and the one that it leads to.
    pub(super) along: Vec<[String; 3]>,
    /// Boxes around passes of a scope, where the form has them.
    pub(super) boxes: usize,
}

impl Held {
    /// What a Plan says, as its JSON form has it.
    fn of(json: &str) -> Held {
        let plan = Plan::from_json(json).expect("a Plan");
        let flow = Dataflow::of(&plan);
        let value: Value = serde_json::from_str(json).expect("JSON");
        assert_eq!(flow.nodes.len(), page::nodes(&value), "each piece of work of the Plan is a vertex");
        let name = |resource: Resource| match resource {
            Resource::Image(id) => plan.images[id.0 as usize].name.to_string(),
            Resource::Buffer(id) => plan.buffers[id.0 as usize].name.to_string(),
        };
        let before: BTreeSet<Resource> =
            flow.edges.iter().filter(|it| it.from.is_none()).map(|it| it.resource).collect();
        let after: BTreeSet<Resource> = flow.edges.iter().filter(|it| it.to.is_none()).map(|it| it.resource).collect();
        let beside = before.into_iter().chain(after).map(name);
        let names = flow.nodes.iter().map(|node| node.name.clone()).chain(beside);
        // What goes between the same two vertices goes along one edge.
        let ends = |edge: &framewright_graph::dataflow::Edge| {
            let outside = |end: Option<u32>| if end.is_none() { Some(edge.resource) } else { None };
            (edge.from, outside(edge.from), edge.to, outside(edge.to))
        };
        let pairs: BTreeSet<_> = flow.edges.iter().map(ends).collect();
        let end = |node: Option<u32>, outside: Option<Resource>| {
            node.map(|node| flow.nodes[node as usize].name.clone()).or(outside.map(name)).expect("an end")
        };
        let along = pairs.iter().map(|pair| {
            let edges = flow.edges.iter().filter(|edge| ends(edge) == *pair);
            let between = edges.map(|edge| name(edge.resource)).collect::<Vec<_>>().join(", ");
            [end(pair.0, pair.1), between, end(pair.2, pair.3)].map(|name| escape(&name))
        });
        let scopes = plan.steps.iter().filter(|step| matches!(step.work, Work::Render(_))).count();
        Held::sorted(names.map(|name| escape(&name)), along, scopes)
    }

    /// What the kept graphs with hostile names must hold.
    pub(super) fn hostile() -> Held {
        let names: Vec<String> = serde_json::from_str(&kept("hostile.json")).expect("JSON");
        let escaped: Vec<String> = names.iter().map(|name| escape(name)).collect();
        // The first image comes from before the frame, and the last one goes beyond it.
        let [first, last] = [&escaped[0], &escaped[escaped.len() - 1]].map(|name| [name.clone()]);
        let vertices = escaped.iter().cloned().chain(first).chain(last);
        // Each piece of work reads what the one before it wrote, which bears its own name.
        let at = |number: usize| escaped[number.min(escaped.len() - 1)].clone();
        let along = (0..=escaped.len()).map(|number| [at(number.saturating_sub(1)), at(number), at(number)]);
        Held::sorted(vertices, along, 2)
    }

    pub(super) fn sorted(
        names: impl Iterator<Item = String>,
        along: impl Iterator<Item = [String; 3]>,
        boxes: usize,
    ) -> Held {
        let (mut names, mut along): (Vec<String>, Vec<[String; 3]>) = (names.collect(), along.collect());
        names.sort_unstable();
        along.sort_unstable();
        Held { names, along, boxes }
    }
}

/// A file of the graphs that are kept.
pub(super) fn kept(name: &str) -> String {
    std::fs::read_to_string(repository("cli/tests/formats").join(name)).expect("a kept graph")
}

/// A pipeline whose names are words of Graphviz's and Mermaid's languages, or not of Latin letters.
fn words() -> String {
    let words = [
        "end", "subgraph", "graph", "digraph", "node", "edge", "strict", "click", "class", "style", "default", "o",
        "x", "שלום", "漢字",
    ];
    let mut text = String::from("Pipeline(version: 1, images: [\n");
    for word in words {
        text += &format!("(name: \"{word}\", format: Color(hdr: true), size: Output),\n");
    }
    text += "(name: \"screen\", format: Output, size: Output)], passes: [\n\
        (name: \"sky\", draw: Sky, color: [(image: \"end\", clear: (0.0, 0.0, 0.0, 1.0))]),\n";
    for (from, to) in words.iter().zip(&words[1..]) {
        let draw = format!("draw: FullScreen(\"downsample\"), sample: {{\"source\": \"{from}\"}}");
        text += &format!("(name: \"{to}\", {draw}, color: [\"{to}\"]),\n");
    }
    text + "(name: \"last\", draw: FullScreen(\"reinhard\"), sample: {\"source\": \"漢字\"}, color: [\"screen\"])], outputs: [\"screen\"])"
}

/// A pipeline whose fill is worth the waits for another queue.
const SEVERAL_QUEUES: &str = r#"Pipeline(version: 1, images: [
    (name: "wall", format: R16G16B16A16_SFLOAT, size: Fixed(4096, 4096)),
    (name: "color", format: Color(hdr: true), size: Output),
    (name: "mixed", format: Color(hdr: true), size: Output),
    (name: "screen", format: Output, size: Output)], passes: [
    (name: "filled", fill: (to: "wall", value: (0.5, 0.5, 0.5, 1.0))),
    (name: "opaque", draw: Objects(Opaque), shader: "lit", color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
    (name: "mix", draw: FullScreen("downsample"), sample: {"source": "wall"}, color: ["mixed"]),
    (name: "tone_map", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["screen"])],
    outputs: ["screen", "mixed"])"#;

/// The graphs of shipped pipelines, for one eye and for two, on one queue and on several, with what they must hold.
pub(super) fn graphs(place: &Place, format: &str) -> Vec<(String, String, Held)> {
    place.file("words.ron", words());
    place.file("queues.ron", SEVERAL_QUEUES);
    let shipped = sweep::of(&format!("graphs for {format}"), shipped_pipelines(), 4);
    let names = shipped.iter().map(String::as_str).chain(["words.ron", "queues.ron"]);
    let ways = [
        &[][..],
        &["--stereo", "multi-pass", "--device", "nvidia-rtx-2080"],
        &["--stereo", "auto", "--device", "meta-quest-3"],
    ];
    let mut graphs = Vec::new();
    let mut queues = 0;
    for name in names {
        for way in ways {
            let arguments = [&["inspect", name][..], way].concat();
            let in_form = |form: &str| place.run(&[&arguments[..], &["--format", form]].concat()).exits(0).out;
            let plan = in_form("json");
            let value: Value = serde_json::from_str(&plan).expect("JSON");
            let steps = value["steps"].as_array().expect("steps");
            queues += usize::from(steps.iter().any(|step| step["queue"] != steps[0]["queue"]));
            graphs.push((arguments.join(" "), in_form(format), Held::of(&plan)));
        }
    }
    assert!(queues > 0, "no Plan has several queues");
    graphs
}

/// The texts that Graphviz draws on a thing, a line each.
fn drawn(thing: &Value) -> Vec<String> {
    let operations = thing["_ldraw_"].as_array().into_iter().flatten();
    operations.filter(|it| it["op"] == "T").map(|it| it["text"].as_str().expect("a text").to_owned()).collect()
}

/// What Graphviz finds in a graph.
fn graphviz(place: &Place, dot: &str) -> Option<Held> {
    place.file("graph.dot", dot);
    let mut command = Command::new("dot");
    let Ok(output) = command.args(["-Tjson", "graph.dot"]).current_dir(place.path("")).output() else {
        assert!(std::env::var_os("CI").is_none(), "no Graphviz: install the package graphviz");
        println!("skipped: no Graphviz (package graphviz)");
        return None;
    };
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{said}\n{dot}");
    let graph: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let list = |name: &str| graph[name].as_array().into_iter().flatten();
    // Boxes stand among the nodes, and have nodes of their own.
    let [boxes, nodes]: [Vec<&Value>; 2] = {
        let (boxes, nodes) =
            list("objects").partition(|it| it["name"].as_str().expect("a name").starts_with("cluster_"));
        [boxes, nodes]
    };
    let name = |node: &&Value| {
        let lines = drawn(node);
        assert!(lines.len() <= 2, "{lines:?}");
        lines[0].clone()
    };
    let end = |edge: &Value, side: &str| {
        let found = nodes.iter().find(|node| node["_gvid"] == edge[side]);
        found.map_or_else(|| panic!("{edge} has no {side}"), name)
    };
    let along = list("edges").map(|edge| [end(edge, "tail"), drawn(edge).join("\n"), end(edge, "head")]);
    Some(Held::sorted(nodes.iter().map(name), along, boxes.len()))
}

#[test]
fn graphviz_draws_every_vertex_edge_and_scope_of_every_graph() {
    let place = Place::new();
    for (about, dot, held) in graphs(&place, "dot") {
        let Some(found) = graphviz(&place, &dot) else { return };
        assert_eq!(found, held, "{about}");
        assert!(!held.names.is_empty() && held.boxes > 0, "{about}");
    }
}

#[test]
fn hostile_names_are_text_to_graphviz() {
    let place = Place::new();
    let Some(found) = graphviz(&place, &kept("hostile.dot")) else { return };
    assert_eq!(found, Held::hostile());
    // The picture that it makes is XML, and nothing in it acts.
    let svg = crate::testing::outcome(Command::new("dot").args(["-Tsvg", "graph.dot"]).current_dir(place.path("")))
        .exits(0)
        .out;
    let svg = svg.to_lowercase();
    assert!(!svg.contains("<script") && !svg.contains("<img") && !svg.contains("xlink:href"), "{svg}");
    assert!(Path::new(&place.path("graph.dot")).exists());
}
