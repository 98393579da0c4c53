//! What is read of an entry now, and told where it is evaluated.

use crate::base::Diagnostic;
use crate::ron::Reader;

/// What was read of an entry, and what is wrong with it. Mistakes are told where the entry is evaluated, and so with the
/// uses of its fragment.
pub(crate) struct Told<T> {
    value: Option<T>,
    mistakes: Vec<Diagnostic>,
}

impl<T> Told<T> {
    /// Reads something, and keeps its mistakes.
    pub(crate) fn read(reader: &mut Reader, read: impl FnOnce(&mut Reader) -> Option<T>) -> Told<T> {
        let before = reader.errors.len();
        let value = read(reader);
        Told { value, mistakes: reader.errors.split_off(before) }
    }

    /// What was read, if anything was. Mistakes are reported to `reader`.
    pub(crate) fn get(&self, reader: &mut Reader) -> Option<&T> {
        self.mistakes.iter().for_each(|mistake| reader.report(mistake.clone()));
        self.value.as_ref()
    }
}
