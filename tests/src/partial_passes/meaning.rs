//! What chains mean, texel after texel on the CPU.

use super::means::PATTERNS;
use super::{Base, Chain, EXTENT, Kind, Life, Link};

/// One texel, or one sample of it. Of a buffer's word, its first component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Texel {
    /// Colour, 8 bits each.
    pub color: [u8; 4],
    /// Depth in quarters.
    pub depth: u8,
    /// Stencil.
    pub stencil: u8,
}

/// Where a pass is done, and with what.
#[derive(Debug, Clone, Copy)]
pub struct At {
    /// Column.
    pub x: u32,
    /// Which sample.
    pub sample: u32,
    /// Of how many.
    pub samples: u32,
    /// Whether the pattern has it.
    pub kept: bool,
    /// The pass's value.
    pub value: u8,
}

impl At {
    /// The pass's colour. A multiple of four, so that the mean of four samples is exact.
    #[must_use]
    pub const fn color(&self) -> [u8; 4] {
        color(self.value)
    }

    /// The pass's depth in quarters.
    #[must_use]
    pub const fn near(&self) -> u8 {
        near(self.value)
    }

    /// Whether a mask of 5, or of 2 where the pattern isn't, has this sample.
    #[must_use]
    pub const fn masks_sample(&self) -> bool {
        let mask = if self.kept { 5 } else { 2 };
        mask >> self.sample & 1 == 1
    }
}

/// The colour of a value.
#[must_use]
pub const fn color(value: u8) -> [u8; 4] {
    [4 * value, 252 - 4 * value, 0, 255]
}

/// The depth of a value in quarters.
#[must_use]
pub const fn near(value: u8) -> u8 {
    1 + value % 3
}

/// The value of images before the first frame.
pub const INITIAL: Texel = Texel { color: [40, 80, 0, 255], depth: 1, stencil: 1 };
/// The value of a base.
pub const BASE: u8 = 11;

/// What is shown of a texel after a link: its colour, and its depth.
pub type Shown = Vec<([u8; 4], u8)>;

/// A chain's texels, sample by sample.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct State(Vec<Texel>);

impl State {
    /// Before the first frame.
    #[must_use]
    pub fn new(chain: &Chain) -> State {
        State(vec![INITIAL; (EXTENT[0] * EXTENT[1] * samples(chain)) as usize])
    }

    /// The same with other colours, to see whether they matter.
    #[must_use]
    pub fn changed(&self) -> State {
        State(self.0.iter().map(|texel| Texel { color: texel.color.map(|byte| byte ^ 0x10), ..*texel }).collect())
    }

    /// As passes that sample it see it: the mean colour, and the depth of the first sample, which depth that is drawn again has.
    #[must_use]
    pub fn shown(&self, chain: &Chain) -> Shown {
        let samples = samples(chain) as usize;
        let mean = |texels: &[Texel], at: usize| {
            let sum: usize = texels.iter().map(|texel| usize::from(texel.color[at])).sum();
            (sum / samples) as u8
        };
        self.0.chunks(samples).map(|texels| ([0, 1, 2, 3].map(|at| mean(texels, at)), texels[0].depth)).collect()
    }
}

/// A frame: what is shown at each shown link, and what stays.
#[must_use]
pub fn frame(chain: &Chain, before: &State) -> (Vec<Shown>, State) {
    let mut state = before.clone();
    if let Some(base) = chain.base {
        let depth = if base == Base::Clears { 2 } else { 1 };
        state.0.fill(Texel { color: color(BASE), depth, stencil: 1 });
    }
    let mut shown = Vec::new();
    for link in &chain.links {
        done(link, samples(chain), &mut state);
        if link.shown {
            shown.push(state.shown(chain));
        }
    }
    if chain.life == Life::History {
        shown.push(before.shown(chain));
    }
    (shown, state)
}

fn done(link: &Link, samples: u32, state: &mut State) {
    for (number, texel) in (0..).zip(&mut state.0) {
        let (x, y) = (number / samples % EXTENT[0], number / samples / EXTENT[0]);
        let kept = PATTERNS[link.pattern].1(x, y);
        (link.means.effect)(texel, &At { x, sample: number % samples, samples, kept, value: link.value });
    }
}

/// The samples of a chain.
#[must_use]
pub const fn samples(chain: &Chain) -> u32 {
    match chain.kind {
        Kind::Picture(samples) => samples,
        Kind::Words => 1,
    }
}
