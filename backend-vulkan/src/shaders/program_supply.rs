//! What a program supplies to all shaders, as far as reading them depends on it.

use framewright_graph::shader::DrawInterfaces;

/// What shaders may read beside what their pass gives.
#[derive(Debug, Default)]
pub(super) struct ProgramSupply {
    /// The numbers of the sets that the program binds itself.
    pub(super) sets: Vec<u32>,
    /// Whether draws of the program bring push constants.
    pub(super) pushes: bool,
    /// Whether it hands out addresses, which shaders may follow.
    pub(super) addresses: bool,
}

impl ProgramSupply {
    pub(super) fn of(draws: &DrawInterfaces) -> ProgramSupply {
        ProgramSupply {
            sets: draws.sets().iter().map(|set| set.set).collect(),
            pushes: draws.push_constants(),
            addresses: draws.addresses(),
        }
    }
}
