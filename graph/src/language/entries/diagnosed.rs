//! Values of an entry that are read now, and mistakes in them that are told where the entry is evaluated.

use crate::base::Diagnostic;
use crate::ron::Reader;

/// A value of an entry, and the mistakes in it. Mistakes are told where the entry is evaluated, and so with the uses of
/// its fragment.
pub(crate) struct Diagnosed<T> {
    value: Option<T>,
    mistakes: Vec<Diagnostic>,
}

impl<T> Diagnosed<T> {
    /// Reads something, and keeps its mistakes.
    pub(crate) fn read(reader: &mut Reader, read: impl FnOnce(&mut Reader) -> Option<T>) -> Diagnosed<T> {
        let before = reader.errors.len();
        let value = read(reader);
        Diagnosed { value, mistakes: reader.errors.split_off(before) }
    }

    /// The value, if it could be read. Mistakes are reported to `reader`.
    pub(crate) fn get(&self, reader: &mut Reader) -> Option<&T> {
        self.mistakes.iter().for_each(|mistake| reader.report(mistake.clone()));
        self.value.as_ref()
    }
}
