//! Chains from a seed.

use super::means::{MEANS, Means, On, PATTERNS};
use super::{Base, Chain, Kind, Life, Link};
use crate::random_pipelines::rng::Rng;

/// The chains of a seed, of those means that `allowed` says.
pub fn chains(seed: u64, allowed: impl Fn(&Means) -> bool) -> Vec<Chain> {
    let mut rng = Rng::new(seed);
    (0..1 + rng.below(3)).map(|_| chain(&mut rng, &allowed)).collect()
}

fn chain(rng: &mut Rng, allowed: &impl Fn(&Means) -> bool) -> Chain {
    let kind = rng.of([Kind::Picture(1), Kind::Picture(1), Kind::Picture(4), Kind::Picture(4), Kind::Words]);
    let life = rng.of([Life::Transient, Life::Transient, Life::Persistent, Life::History]);
    let possible: Vec<&'static Means> = MEANS.iter().filter(|means| fits(means, kind) && allowed(means)).collect();
    let mut links: Vec<Link> = (0..1 + rng.below(4)).filter_map(|_| link(rng, &possible)).collect();
    if let Some(last) = links.last_mut() {
        last.shown = true;
    }
    let base = (life != Life::Persistent || rng.one_in(3)).then(|| rng.of([Base::Covers, Base::Clears]));
    Chain { kind, life, base, links }
}

fn link(rng: &mut Rng, possible: &[&'static Means]) -> Option<Link> {
    let means = *rng.pick(possible)?;
    let pattern = rng.below(PATTERNS.len() as u32) as usize;
    Some(Link { means, pattern, value: rng.below(60) as u8, shown: rng.one_in(3) })
}

/// Whether means can be done to a kind of contents.
#[must_use]
pub fn fits(means: &Means, kind: Kind) -> bool {
    match means.on {
        On::Pictures => kind != Kind::Words,
        On::OneSample => kind == Kind::Picture(1),
        On::Words => kind == Kind::Words,
    }
}

/// Chains of one means alone, for every kind and lifetime that it can be done to.
#[must_use]
pub fn of_one(means: &'static Means, pattern: usize) -> Vec<Chain> {
    let kinds = [Kind::Picture(1), Kind::Picture(4), Kind::Words].into_iter().filter(|kind| fits(means, *kind));
    let lives = [
        (Life::Transient, Some(Base::Covers)),
        (Life::Transient, Some(Base::Clears)),
        (Life::Persistent, None),
        (Life::History, Some(Base::Covers)),
    ];
    // Nearer than every base.
    let links = vec![Link { means, pattern, value: 32, shown: true }];
    let all = kinds.flat_map(|kind| lives.map(|(life, base)| Chain { kind, life, base, links: links.clone() }));
    all.collect()
}
