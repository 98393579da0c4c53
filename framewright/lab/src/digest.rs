//! Digests: texts are equal where theirs are. They are the same on every machine.

use fnv::FnvHasher;
use std::fmt::{self, Write};
use std::hash::Hasher;

/// A digest of text that is written to it.
#[derive(Default)]
pub struct Digest(FnvHasher);

impl Digest {
    /// The digest of some texts, in hexadecimal digits.
    pub fn of<'t>(texts: impl IntoIterator<Item = &'t str>) -> String {
        let mut digest = Digest::default();
        for text in texts {
            digest.0.write(text.as_bytes());
            digest.0.write_u8(0);
        }
        digest.shown()
    }

    /// The digest of some bytes, in hexadecimal digits.
    pub fn of_bytes<'b>(parts: impl IntoIterator<Item = &'b [u8]>) -> String {
        let mut digest = Digest::default();
        for part in parts {
            digest.0.write(part);
            digest.0.write(&(part.len() as u64).to_le_bytes());
        }
        digest.shown()
    }

    /// The digest of a value's debug form.
    pub fn of_value(value: &impl fmt::Debug) -> String {
        let mut digest = Digest::default();
        // Writing to it can't fail.
        let _ = write!(digest, "{value:?}");
        digest.shown()
    }

    fn shown(&self) -> String {
        format!("{:016x}", self.0.finish())
    }
}

impl Write for Digest {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}
