//! A small generator of random numbers, the same on every machine: SplitMix64 (Steele, Lea, Flood 2014).

/// Random numbers from a seed.
#[derive(Debug, Clone)]
pub struct Rng(u64);

impl Rng {
    /// The numbers that follow from `seed`.
    #[must_use]
    pub const fn new(seed: u64) -> Rng {
        Rng(seed)
    }

    /// The next 64 bits.
    pub const fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^ (bits >> 31)
    }

    /// The next 32 bits.
    pub const fn word(&mut self) -> u32 {
        (self.bits() >> 32) as u32
    }

    /// A number from 0 to `below` − 1; 0 if `below` is 0.
    pub fn below(&mut self, below: u32) -> u32 {
        self.word().checked_rem(below).unwrap_or(0)
    }

    /// True once in `of` times.
    pub fn one_in(&mut self, of: u32) -> bool {
        self.below(of) == 0
    }

    /// One of `among`, `None` if there is none.
    pub fn pick<'a, T>(&mut self, among: &'a [T]) -> Option<&'a T> {
        let at = self.below(u32::try_from(among.len()).unwrap_or(u32::MAX));
        among.get(at as usize)
    }

    /// One of `among`, which is not empty.
    pub fn of<T: Copy, const N: usize>(&mut self, among: [T; N]) -> T {
        among[self.below(N as u32) as usize]
    }
}
