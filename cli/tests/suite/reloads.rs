//! Hundreds of edits of a file that is served: what the command keeps of them doesn't grow.

use crate::testing::server::Server;
use crate::testing::{Place, Vulkan, repository};
use framewright_tests::sweep;

/// Memory of a process that isn't shared with files, in MiB.
fn resident(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).expect("it runs");
    let line = status.lines().find_map(|line| line.strip_prefix("RssAnon:")).expect("a line");
    line.trim().trim_end_matches(" kB").parse::<u64>().expect("a number") / 1024
}

#[test]
fn lv_8_a_thousand_reloads_do_not_grow_the_server() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let reloads = if sweep::is_long() { 1000 } else { 60 };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let pipeline = std::fs::read_to_string(place.path("first.ron")).expect("a pipeline");
    let scene = std::fs::read_to_string(repository("examples/scenes/spheres_and_cubes.ron")).expect("a scene");
    place.file("scene.ron", scene);
    let server = Server::start(&place, &variables, &["first.ron", "--scene", "scene.ron", "--size", "64x36"]);
    let mut state = server.state_after(0);
    let mut early = 0;
    for reload in 0..reloads {
        // Each has a name that none before had, and as many letters.
        let sky = format!("sky{reload:04}");
        let text = pipeline.replace("\"sky\"", &format!("\"{sky}\""));
        assert_ne!(text, pipeline);
        std::fs::rename(place.file("beside.txt", text), place.path("first.ron")).expect("moved");
        state = server.state_after(state["live"]["version"].as_u64().expect("a number"));
        assert!(state["page"].to_string().contains(&sky), "{}", state["live"]["message"]);
        // By then all that is kept of a few states is there.
        if reload == 29 {
            early = resident(server.process.id());
        }
    }
    let late = resident(server.process.id());
    assert!(late <= early + 24, "{early} MiB after 30 reloads, {late} MiB after {reloads}");
}
