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

/// The smallest part of chains that is wrong, as files.
fn wrong(judge: &mut Judge, of: &str, chains: &[Chain], seed: u64) -> Option<String> {
    let may_be_refused = chains.iter().flat_map(|chain| &chain.links).any(|link| link.means.may_be_refused);
    let fault = judge.judge(chains, seed).err()?;
    if may_be_refused && matches!(fault, Fault::Refused(_)) {
        return None;
    }
    let (smallest, fault) = shrunk(judge, chains, &fault, seed);
    let text = text(&smallest);
    let shaders: String = text.shaders.iter().map(|(name, text)| format!("--- {name}\n{text}")).collect();
    Some(format!("{of}: {fault}\n{}\n{shaders}", text.pipeline))
}

fn demand(wrong: &[String]) {
    assert!(wrong.is_empty(), "{} are wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn each_means_of_leaving_texels_out_keeps_them() {
    let Some(mut judge) = Judge::new() else { return };
    let all = MEANS.iter().filter(|means| is_right(means)).collect();
    let all = sweep::of("means of leaving texels out", all, 12).into_iter().enumerate();
    let wrong: Vec<String> =
        all.filter_map(|(at, means)| wrong(&mut judge, means.name, &of_one(means, at % 4), at as u64)).collect();
    demand(&wrong);
}

#[test]
fn random_passes_that_leave_texels_out_keep_them() {
    let Some(mut judge) = Judge::new() else { return };
    let seeds = sweep::row("passes that leave texels out", 1..201, 16);
    let chains = |seed| chains(seed, |means| is_right(means) && !means.may_be_refused);
    let wrong: Vec<String> =
        seeds.filter_map(|seed| wrong(&mut judge, &format!("seed {seed}"), &chains(seed), seed)).collect();
    demand(&wrong);
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
        let covers =
            ["covers", "reads_the_mask", "own_vertices_that_cover", "depth_covers", "depth_tests", "depth_tests_early"];
        let promised = means.name.ends_with("_all_as_promised");
        assert_eq!(leaves, !promised && !covers.contains(&means.name), "{}", means.name);
    }
}
