//! What storage writes may leave as it was. Nothing is proven of them: `writeonly` says that a shader doesn't read, not that it writes
//! all. So what was there is kept, if anything was, unless the file promises more.

use super::accesses;
use crate::expand::passes::State;
use crate::expand::resources::Resources;
use crate::expand::shader::storage::{self, KeptContents};
use crate::expand::shader::{CheckedShaders, coverage, variant};
use crate::frame::tracked_parts::Parts;
use crate::frame::{NoteKind, Remark};
use crate::language;
use crate::shader::declared_name;

/// Lets storage writes that nobody promises to be whole keep what earlier passes, or earlier frames, left. `states` are those of
/// the pipeline's passes. Returns remarks that say so.
pub(in crate::expand) fn keep(
    resources: &Resources<'_>,
    states: &mut [State],
    parts: &Parts<'_>,
    shaders: &mut CheckedShaders<'_>,
) -> Vec<Remark> {
    let mut remarks = Vec::new();
    let described = &resources.pipeline.passes;
    if described.iter().flat_map(|pass| &pass.storage).all(|storage| storage.access.is_some()) {
        return remarks;
    }
    let mut contents = accesses::contents(resources, parts);
    for ((state, described), number) in states.iter_mut().zip(described).zip(1..) {
        if let State::On(pass) = state {
            for KeptContents { of, span, binding } in
                storage::keep(described, pass, |of, range| contents.holds_any(of, range))
            {
                let declared = declaration(resources, described, &binding, shaders);
                let text = format!(
                    "keeps what it doesn't write of `{}`: its shader doesn't read it{}, which doesn't say that it writes all of it; \
                     `access: Write` promises that",
                    resources.name(of).text,
                    coverage::at(declared.as_deref())
                );
                remarks.push(Remark { kind: NoteKind::Kept, subject: pass.name.clone(), span, text });
            }
        }
        state.runs().iter().for_each(|pass| contents.write(pass, number));
    }
    remarks
}

/// File and line where the shader of a pass declares what it only writes.
fn declaration(
    resources: &Resources<'_>,
    pass: &language::Pass,
    binding: &str,
    shaders: &mut CheckedShaders<'_>,
) -> Option<String> {
    // What is wrong with the shader was reported when the pass was lowered.
    let interface = shaders.interface(pass, &variant::of(resources, pass), &mut Vec::new())?;
    let mut places = interface.only_written_at.into_iter();
    places.find(|(name, _)| name == declared_name(binding)).map(|(_, place)| place)
}
