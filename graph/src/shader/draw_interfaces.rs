//! What a draw source brings along for every kind of draw, the sets that its program binds, and the custom passes that it records.

use super::{DrawInterface, DrawKind, InterfaceOf, ProgramSet, PushConstants, interface_file};
use crate::base::{Diagnostic, Sources};
use crate::frame::Draw;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The interfaces of a draw source for all kinds of draws. A file can hold them, so that pipelines are checked without the
/// program: [`DrawInterfaces::to_ron`] writes it, and [`DrawInterfaces::read`] reads it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DrawInterfaces {
    /// Without those that bring nothing.
    draws: BTreeMap<DrawKind, DrawInterface>,
    /// Of custom passes that have one of their own, by their names.
    of_custom: BTreeMap<Arc<str>, DrawInterface>,
    custom: Option<Vec<Arc<str>>>,
    /// In the order of their numbers.
    sets: Vec<ProgramSet>,
    addresses: bool,
}

impl DrawInterfaces {
    /// With the interface of another kind of draw, in place of the one that it had. What a kind can't have is left out: vertices of
    /// full-screen passes, vertices and push constants of compute passes and of draws whose vertices are the pass's own.
    #[must_use]
    pub fn with(mut self, kind: DrawKind, interface: DrawInterface) -> DrawInterfaces {
        let interface = match kind {
            DrawKind::Compute | DrawKind::Vertices => {
                DrawInterface { supplied: interface.supplied, ..DrawInterface::default() }
            }
            DrawKind::FullScreen => DrawInterface {
                push_constants: interface.push_constants,
                supplied: interface.supplied,
                ..DrawInterface::default()
            },
            _ => interface,
        };
        if interface == DrawInterface::default() {
            self.draws.remove(&kind);
        } else {
            self.draws.insert(kind, interface);
        }
        self
    }

    /// With an interface of its own for the draws of the custom pass `name`, in place of that of [`DrawKind::Custom`].
    #[must_use]
    pub fn with_custom(mut self, name: impl Into<Arc<str>>, interface: DrawInterface) -> DrawInterfaces {
        self.of_custom.insert(name.into(), interface);
        self
    }

    /// With the names of all custom passes that the program records: others are mistakes of a pipeline then. Names are those that a
    /// pipeline can ask for: letters, digits, `_` and `-`, which begin with a letter or `_`. If two are equal, the first counts.
    #[must_use]
    pub fn with_custom_passes(mut self, names: impl IntoIterator<Item = impl Into<Arc<str>>>) -> DrawInterfaces {
        let mut custom: Vec<Arc<str>> = Vec::new();
        for name in names.into_iter().map(Into::into) {
            if !custom.contains(&name) {
                custom.push(name);
            }
        }
        self.custom = Some(custom);
        self
    }

    /// With a set that the program makes and binds itself, in place of the one of its number. Passes of all kinds see it. In which stages
    /// they do, its bindings say. It is bound by `Executor::bind_set` of the backend.
    #[must_use]
    pub fn with_set(mut self, set: ProgramSet) -> DrawInterfaces {
        self.sets.retain(|known| known.set != set.set);
        self.sets.push(set);
        self.sets.sort_by_key(|set| set.set);
        self
    }

    /// With addresses of buffers, which the program puts into its sets, its push constants and its buffers, and which shaders may follow
    /// (`GL_EXT_buffer_reference`). Nothing bounds what is behind an address, `robustBufferAccess` neither: the program vouches for the
    /// shaders of all pipelines that it draws.
    #[must_use]
    pub const fn with_addresses(mut self) -> DrawInterfaces {
        self.addresses = true;
        self
    }

    /// The interface of a draw. Of a custom draw it is that of
    /// [`DrawKind::Custom`]: see [`DrawInterfaces::of_pass`].
    #[must_use]
    pub fn of(&self, draw: Draw) -> DrawInterface {
        self.of_kind(DrawKind::of(draw))
    }

    /// The interface of a pass that draws `draw` (`None`: a compute pass). `name` is the name of its shader; of a custom pass that by
    /// which the program knows it.
    #[must_use]
    pub fn of_pass(&self, draw: Option<Draw>, name: &str) -> DrawInterface {
        let Some(draw) = draw else { return self.of_kind(DrawKind::Compute) };
        let custom = if draw.is_custom() { self.of_custom.get(name) } else { None };
        custom.cloned().unwrap_or_else(|| self.of(draw))
    }

    /// The interface of a kind of draw, or of compute passes.
    #[must_use]
    pub fn of_kind(&self, kind: DrawKind) -> DrawInterface {
        self.draws.get(&kind).cloned().unwrap_or_default()
    }

    /// The kinds of draws that something is brought along for, with what that is.
    pub fn all(&self) -> impl Iterator<Item = (DrawKind, &DrawInterface)> {
        self.draws.iter().map(|(kind, interface)| (*kind, interface))
    }

    /// All that a file has an entry for, with what is brought along for it.
    pub(super) fn all_of_file(&self) -> impl Iterator<Item = (InterfaceOf, &DrawInterface)> {
        let kinds = self.all().map(|(kind, interface)| (InterfaceOf::Kind(kind), interface));
        let custom = self.of_custom.iter().map(|(name, interface)| (InterfaceOf::Custom(name.clone()), interface));
        kinds.chain(custom)
    }

    /// Whether any of its draws brings push constants.
    #[must_use]
    pub fn push_constants(&self) -> bool {
        self.all_of_file().any(|(_, interface)| !interface.push_constants.is_empty())
    }

    /// The push constants that shaders of a draw may see: of a custom draw those of all custom passes.
    #[must_use]
    pub fn pushed_for(&self, draw: Draw) -> Vec<PushConstants> {
        let mut pushed = self.of(draw).push_constants;
        if draw.is_custom() {
            pushed.extend(self.of_custom.values().flat_map(|it| &it.push_constants));
        }
        pushed
    }

    /// The sets that the program makes and binds itself, in the order of their numbers.
    #[must_use]
    pub fn sets(&self) -> &[ProgramSet] {
        &self.sets
    }

    /// Whether shaders may follow addresses of the program's.
    #[must_use]
    pub const fn addresses(&self) -> bool {
        self.addresses
    }

    /// The names of custom passes that the program records; `None` if they aren't known, and any may be right.
    #[must_use]
    pub fn custom_passes(&self) -> Option<&[Arc<str>]> {
        self.custom.as_deref()
    }

    /// The text of a file that holds it.
    #[must_use]
    pub fn to_ron(&self) -> String {
        interface_file::write(self)
    }

    /// Reads the text of a file, which is added to `sources`. `shown` is the path as the user named it, `relative` the
    /// file's name.
    ///
    /// # Errors
    /// Everything that is wrong with the file, in its order.
    pub fn read(
        sources: &mut Sources,
        shown: &str,
        relative: &str,
        text: String,
    ) -> Result<DrawInterfaces, Vec<Diagnostic>> {
        interface_file::read(sources, shown, relative, text)
    }
}

/// Those that a function tells. It is asked once for each kind of draw. Compute passes see nothing then: [`DrawInterfaces::with`] and
/// [`DrawKind::Compute`] say what they see.
impl<F: Fn(Draw) -> DrawInterface> From<F> for DrawInterfaces {
    fn from(draws: F) -> DrawInterfaces {
        let all = DrawInterfaces::default();
        let asked = DrawKind::ALL.into_iter().filter_map(|kind| Some((kind, kind.example()?)));
        asked.fold(all, |all, (kind, draw)| all.with(kind, draws(draw)))
    }
}
