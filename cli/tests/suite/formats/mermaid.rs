//! The verdict of Mermaid itself, in a browser.
//!
//! By default this is the Mermaid that a package of `tests/judges` brings along. `FRAMEWRIGHT_MERMAID` names the file
//! `mermaid.esm.min.mjs` of another one, such as the newest: `npm install mermaid` puts it into `node_modules/mermaid/dist`.

use super::graphs::{Held, graphs, kept};
use super::judge;
use crate::large::back_and_forth;
use crate::testing::Place;
use crate::testing::browser::Browser;
use serde_json::{Value, json};
use std::path::PathBuf;

/// What a graph holds, by Mermaid's parser, and in the picture that it draws.
const JUDGE: &str = "async (text) => {
    const diagram = await mermaid.mermaidAPI.getDiagramFromText(text);
    const vertices = diagram.db.getVertices();
    const edges = diagram.db.getEdges();
    const parsed = [vertices.size ?? Object.keys(vertices).length, edges.length];
    document.body.innerHTML = (await mermaid.render('graph', text)).svg;
    const texts = (selector) => [...document.querySelectorAll(selector)].map((label) => label.innerText);
    const nodes = new Map([...document.querySelectorAll('.nodes .node')].map((node) => [/^(?:.*-)?flowchart-(.*)-[0-9]+$/.exec(node.id)?.[1], node.querySelector('.nodeLabel').innerText]));
    const labels = texts('.edgeLabels .edgeLabel .edgeLabel').length ? texts('.edgeLabels .edgeLabel .edgeLabel') : texts('.edgeLabels .edgeLabel');
    return {
        parsed,
        names: [...nodes.values()],
        along: edges.map((edge, at) => [nodes.get(edge.start), labels[at], nodes.get(edge.end)]),
        active: document.querySelectorAll('script, img, a, [onerror], [onclick]').length,
        hacked: typeof hacked,
    };
}";

/// A browser with Mermaid.
struct Mermaid {
    browser: Browser,
    _place: Place,
}

impl Mermaid {
    fn start() -> Option<Mermaid> {
        let file = match std::env::var_os("FRAMEWRIGHT_MERMAID") {
            Some(file) => PathBuf::from(file),
            None => judge("aquamarine")?.join("doc/js/mermaid.esm.min.mjs"),
        };
        // Modules that lie on the disk are loaded by a page that lies there too.
        let mut browser = Browser::start_with(&["--allow-file-access-from-files"])?;
        let place = Place::new();
        let page = place.file("page.html", "<!doctype html><meta charset=\"utf-8\"><body>");
        browser.open_file(&page, "");
        let module = json!(format!("file://{}", file.display()));
        let load = format!(
            "import({module}).then((it) => {{ window.mermaid = it.default; return mermaid.initialize({{startOnLoad: false}}) ?? 1; }})"
        );
        browser.ask(&load);
        Some(Mermaid { browser, _place: place })
    }

    /// The verdict on a graph; an error is told in words.
    fn judge(&mut self, text: &str) -> Value {
        self.browser.ask(&format!("({JUDGE})({}).catch((error) => ({{error: String(error)}}))", json!(text)))
    }

    #[track_caller]
    fn finds(&mut self, about: &str, text: &str, held: &Held) {
        let verdict = self.judge(text);
        assert!(verdict["error"].is_null(), "{about}: {verdict}\n{text}");
        assert_eq!(verdict["parsed"], json!([held.names.len(), held.along.len()]), "{about}");
        let list = |name: &str| verdict[name].as_array().expect("a list");
        // Word joiners keep Mermaid from acting on a name, and can't be seen.
        let text = |value: &Value| value.as_str().unwrap_or("none").replace('\u{2060}', "");
        // The word below a name is no part of it.
        let name = |label: &Value| text(label).split('\n').next().unwrap_or_default().to_owned();
        let along = list("along").iter().map(|edge| [name(&edge[0]), text(&edge[1]), name(&edge[2])]);
        let found = Held::sorted(list("names").iter().map(name), along, held.boxes);
        assert_eq!(found, *held, "{about}");
        assert_eq!((&verdict["active"], &verdict["hacked"]), (&json!(0), &json!("undefined")), "{about}");
    }
}

#[test]
fn mermaid_reads_and_draws_every_vertex_and_edge_of_every_graph() {
    let Some(mut mermaid) = Mermaid::start() else { return };
    for (about, text, held) in graphs(&Place::new(), "mermaid") {
        mermaid.finds(&about, &text, &held);
    }
    mermaid.browser.has_no_errors();
}

#[test]
fn hostile_names_are_text_to_mermaid() {
    let Some(mut mermaid) = Mermaid::start() else { return };
    mermaid.finds("hostile names", &kept("hostile.mmd"), &Held::hostile());
    mermaid.browser.has_no_errors();
    // The judge refuses what is wrong.
    assert!(mermaid.judge("flowchart TB\n  n0[\"a\"\n").get("error").is_some());
}

#[test]
fn graphs_beyond_the_limits_of_mermaid_are_written_and_the_limits_are_said() {
    let place = Place::new();
    let inspect = |passes: usize| {
        place.file("p.ron", back_and_forth(passes));
        place.run(&["inspect", "p.ron", "--format", "mermaid"]).exits(0)
    };
    // An edge to each pass but the first, and one to the screen.
    let held = inspect(500);
    assert_eq!((held.out.matches("-->").count(), &*held.err), (500, ""));
    let beyond = inspect(501);
    assert_eq!(beyond.out.matches("-->").count(), 501);
    let said = "note: the graph has 501 edges, and Mermaid draws at most 500 unless its setting maxEdges is raised, which code hosts don't \
                do: SVG and DOT hold more";
    assert_eq!(beyond.err.trim_end(), said);
    let long = inspect(1500);
    let length = long.out.encode_utf16().count();
    let long = long.mentions(&format!(
        "the graph has {length} characters, and Mermaid draws at most 50000 unless its setting maxTextSize"
    ));
    // Mermaid 10.1.0 doesn't have this limit yet.
    if std::env::var_os("FRAMEWRIGHT_MERMAID").is_some()
        && let Some(mut mermaid) = Mermaid::start()
    {
        assert_eq!(mermaid.judge(&held.out)["parsed"][1], 500);
        assert!(
            mermaid.judge(&beyond.out)["error"].as_str().is_some_and(|error| error.contains("Edge limit exceeded"))
        );
    }
    // The other forms have no such limits.
    place.run(&["inspect", "p.ron", "--format", "dot"]).exits(0).says("");
    // Mermaid itself draws a graph of exactly as many characters, and instead of a longer one a message.
    let Some(mut mermaid) = Mermaid::start() else { return };
    let mut padded = |length: usize| {
        let text = "flowchart TB\n  n0[\"a\"]\n";
        let comment = format!("%%{}\n", "x".repeat(length - text.len() - 3));
        let text = comment + text;
        assert_eq!(text.len(), length);
        mermaid.judge(&text)["names"].to_string()
    };
    assert!(!padded(50_000).contains("Maximum text size"));
    assert!(padded(50_001).contains("Maximum text size"));
    drop((mermaid, long));
}
