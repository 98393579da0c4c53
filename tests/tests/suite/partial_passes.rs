//! Passes that leave texels out, by every means that a file or its shader has: whatever the compiler makes of them, what they leave
//! stays as it was.

use framewright_tests::partial_passes::Chain;
use framewright_tests::partial_passes::generate::{chains, of_one};
use framewright_tests::partial_passes::judge::{Fault, Judge, shrunk};
use framewright_tests::partial_passes::meaning::{At, INITIAL};
use framewright_tests::partial_passes::means::{MEANS, Means, PATTERNS};
use framewright_tests::partial_passes::text::text;
use framewright_tests::sweep;
use std::collections::BTreeSet;

/// Means of which the compiler believes that they cover, and they don't.
const KNOWN_WRONG: &[&str] = &[];

fn is_right(means: &Means) -> bool {
    !KNOWN_WRONG.contains(&means.name)
}

/// Fails with the smallest part of chains that is wrong, as files.
fn demand(judge: &mut Judge, of: &str, chains: &[Chain], seed: u64) {
    let may_be_refused = chains.iter().flat_map(|chain| &chain.links).any(|link| link.means.may_be_refused);
    match judge.judge(chains, seed) {
        Ok(()) => {}
        Err(Fault::Refused(_)) if may_be_refused => {}
        Err(fault) => {
            let (smallest, fault) = shrunk(judge, chains, &fault, seed);
            let text = text(&smallest);
            let shaders: String = text.shaders.iter().map(|(name, text)| format!("--- {name}\n{text}")).collect();
            panic!("{of}: {fault}\n{}\n{shaders}", text.pipeline);
        }
    }
}

#[test]
fn each_means_of_leaving_texels_out_keeps_them() {
    let Some(mut judge) = Judge::new() else { return };
    let all = MEANS.iter().filter(|means| is_right(means)).collect();
    for (number, means) in sweep::of("means of leaving texels out", all, 12).into_iter().enumerate() {
        demand(&mut judge, means.name, &of_one(means, number % 4), number as u64);
    }
}

#[test]
fn random_passes_that_leave_texels_out_keep_them() {
    let Some(mut judge) = Judge::new() else { return };
    for seed in sweep::row("passes that leave texels out", 1..401, 16) {
        let chains = chains(seed, |means| is_right(means) && !means.may_be_refused);
        demand(&mut judge, &format!("seed {seed}"), &chains, seed);
    }
}

#[test]
fn every_means_and_pattern_turns_up_in_some_seed() {
    let all: Vec<Chain> = (1..401).flat_map(|seed| chains(seed, |means| !means.may_be_refused)).collect();
    let links = || all.iter().flat_map(|chain| &chain.links);
    let names: BTreeSet<&str> = links().map(|link| link.means.name).collect();
    for means in MEANS.iter().filter(|means| !means.may_be_refused) {
        assert!(names.contains(means.name), "no {}", means.name);
    }
    let patterns: BTreeSet<usize> = links().map(|link| link.pattern).collect();
    assert_eq!(patterns.len(), PATTERNS.len());
}

/// A means that wrote every texel would prove nothing; those whose names say so are there to be told from the others.
#[test]
fn all_means_but_those_that_cover_leave_something_out() {
    let names: BTreeSet<&str> = MEANS.iter().map(|means| means.name).collect();
    assert_eq!(names.len(), MEANS.len());
    for means in MEANS {
        let leaves = [false, true].into_iter().any(|kept| {
            let mut texel = INITIAL;
            (means.effect)(&mut texel, &At { x: 12, sample: 1, samples: 4, kept, value: 3 });
            texel == INITIAL
        });
        let covers = ["covers", "reads_the_mask", "own_vertices_that_cover", "depth_covers", "depth_tests", "depth_tests_early"];
        let promised = means.name.ends_with("_all_as_promised");
        assert_eq!(leaves, !promised && !covers.contains(&means.name), "{}", means.name);
    }
}
