//! A pipeline that fails becomes a smaller one that fails alike.

use super::pipeline::{Count, Draw, Geometry, Groups, Life, Pass, Pipeline, Work};
use super::valid;
use framewright_graph::frame::Blend;
use framewright_graph::vulkan::{ColorComponents, Shape};

/// How often a smaller pipeline is tried.
const MOST_TRIES: u32 = 3000;

/// The smallest pipeline that is found by leaving out and simplifying, for which `fails` still holds.
pub fn shrink(pipeline: &Pipeline, mut fails: impl FnMut(&Pipeline) -> bool) -> Pipeline {
    let mut smallest = pipeline.clone();
    let mut tries = 0;
    let mut attempt = |smallest: &mut Pipeline, smaller: Pipeline| {
        if tries == MOST_TRIES || smaller == *smallest || !valid::is_valid(&smaller) {
            return false;
        }
        tries += 1;
        let still = fails(&smaller);
        if still {
            *smallest = smaller;
        }
        still
    };
    loop {
        let before = smallest.clone();
        drop_passes(&mut smallest, &mut attempt);
        for at in (0..smallest.outputs.len()).rev() {
            let mut smaller = smallest.clone();
            smaller.outputs.remove(at);
            attempt(&mut smallest, smaller);
        }
        for at in 0..smallest.passes.len() {
            // Simpler passes come one by one: each may be simplified again.
            while simpler(&smallest.passes[at]).into_iter().any(|pass| {
                let mut smaller = smallest.clone();
                smaller.passes[at] = pass;
                attempt(&mut smallest, smaller)
            }) {}
        }
        simplify_resources(&mut smallest, &mut attempt);
        if smallest == before {
            return smallest;
        }
    }
}

/// Leaves out runs of passes, long ones first.
fn drop_passes(smallest: &mut Pipeline, attempt: &mut impl FnMut(&mut Pipeline, Pipeline) -> bool) {
    let mut run = smallest.passes.len();
    while run > 0 {
        let mut end = smallest.passes.len();
        while end >= run {
            let mut smaller = smallest.clone();
            smaller.passes.drain(end - run..end);
            attempt(smallest, smaller);
            end -= run;
        }
        run /= 2;
    }
}

/// Passes that do a little less than this one.
fn simpler(pass: &Pass) -> Vec<Pass> {
    let mut all = Vec::new();
    if pass.side_effect {
        all.push(Pass { side_effect: false, ..pass.clone() });
    }
    match &pass.work {
        Work::Draw(draw) => {
            let mut add = |change: &dyn Fn(&mut Draw)| {
                let mut draw = draw.clone();
                change(&mut draw);
                all.push(Pass { work: Work::Draw(draw), ..pass.clone() });
            };
            (0..draw.reads.len()).for_each(|at| {
                add(&|draw| {
                    draw.reads.remove(at);
                    draw.vertex_reads -= usize::from(at < draw.vertex_reads);
                });
            });
            (0..draw.stores.len()).for_each(|at| {
                add(&|draw| {
                    draw.stores.remove(at);
                });
            });
            (0..draw.color.len()).for_each(|at| {
                add(&|draw| {
                    draw.color.remove(at);
                });
            });
            (0..draw.color.len()).for_each(|at| add(&|draw| draw.color[at].blend = Blend::Replace));
            (0..draw.color.len()).for_each(|at| add(&|draw| draw.color[at].write_mask = ColorComponents::RGBA));
            add(&|draw| draw.depth = None);
            add(&|draw| {
                if let Some(depth) = &mut draw.depth {
                    depth.stencil = None;
                }
            });
            add(&|draw| draw.custom = false);
            add(&|draw| draw.vertex_reads = 0);
            add(&|draw| draw.discards = false);
            add(&|draw| draw.per_sample = false);
            add(&|draw| {
                if let Geometry::Triangles { count, vertices, indices } = &mut draw.geometry {
                    (*count, *vertices, *indices) = (Count::Direct(1, 1), None, None);
                }
            });
            add(&|draw| (draw.geometry, draw.vertex_reads, draw.custom) = (Geometry::FullScreen, 0, false));
        }
        Work::Compute(compute) => {
            for at in 0..compute.reads.len() {
                let mut compute = compute.clone();
                compute.reads.remove(at);
                all.push(Pass { work: Work::Compute(compute), ..pass.clone() });
            }
            for at in 0..compute.stores.len() {
                let mut compute = compute.clone();
                compute.stores.remove(at);
                all.push(Pass { work: Work::Compute(compute), ..pass.clone() });
            }
            let mut compute = compute.clone();
            compute.groups = Groups::Cover;
            all.push(Pass { work: Work::Compute(compute), ..pass.clone() });
        }
        Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } | Work::Custom { .. } | Work::Forward { .. } => {}
    }
    all.retain(|simpler| simpler != pass);
    all
}

/// Makes resources short-lived and small, as far as passes allow.
fn simplify_resources(smallest: &mut Pipeline, attempt: &mut impl FnMut(&mut Pipeline, Pipeline) -> bool) {
    for at in 0..smallest.images.len() {
        let mut smaller = smallest.clone();
        let image = &mut smaller.images[at];
        image.life = Life::Transient;
        attempt(smallest, smaller);
        let mut smaller = smallest.clone();
        let image = &mut smaller.images[at];
        (image.mips, image.samples, image.resolve) = (1, 1, None);
        if image.shape == Shape::D2 {
            image.layers = 1;
        }
        attempt(smallest, smaller);
    }
    for at in 0..smallest.buffers.len() {
        let mut smaller = smallest.clone();
        smaller.buffers[at].life = Life::Transient;
        attempt(smallest, smaller);
    }
    let mut halved = smallest.clone();
    let even = halved.images.iter().all(|image| image.extent[..2].iter().all(|side| side % 2 == 0 && *side > 4));
    if even {
        for image in &mut halved.images {
            image.extent = [image.extent[0] / 2, image.extent[1] / 2, image.extent[2]];
        }
        for pass in &mut halved.passes {
            if let Work::Compute(compute) = &mut pass.work
                && compute.grid[1] > 1
            {
                compute.grid = [compute.grid[0] / 2, compute.grid[1] / 2, compute.grid[2]];
            }
        }
        attempt(smallest, halved);
    }
}
