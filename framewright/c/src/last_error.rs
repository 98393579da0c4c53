//! Errors become a status, and a text that the thread keeps.

use crate::status::{FramewrightStatus, Problem};
use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

/// One mistake in the user's files or choices.
#[repr(C)]
pub struct FramewrightMistake {
    /// The mistake, in one sentence.
    pub message: *const c_char,
    /// The file, relative to the folder of the pipeline; NULL if no file is to blame, and the numbers are 0.
    pub file: *const c_char,
    /// The line, from 1.
    pub line: u32,
    /// The column in characters, from 1.
    pub column: u32,
    /// The stable code of the rule that is broken, such as "E0207": docs/codes.md explains it.
    pub code: *const c_char,
}

/// The last error of a thread. The mistakes point into the texts.
#[derive(Default)]
struct LastError {
    text: CString,
    mistakes: Vec<FramewrightMistake>,
    texts: Vec<CString>,
}

thread_local! {
    static LAST: RefCell<LastError> = RefCell::default();
}

/// Runs what a function does. No panic leaves it.
pub(crate) fn call(body: impl FnOnce() -> Result<(), Problem>) -> FramewrightStatus {
    let problem = match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => return FramewrightStatus::Ok,
        Ok(Err(problem)) => problem,
        Err(panic) => Problem::of_panic(&*panic),
    };
    // A thread that ends may have no place for words any more.
    let keep = || LAST.try_with(|last| last.replace(LastError::of(&problem))).map(drop);
    let _ = catch_unwind(AssertUnwindSafe(keep));
    problem.status()
}

/// A text for C, whose texts hold no zero.
pub(crate) fn text(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default()
}

impl LastError {
    fn of(problem: &Problem) -> LastError {
        let mut last = LastError { text: text(&problem.text()), ..LastError::default() };
        let diagnostics = if let Problem::Library(error) = problem { error.diagnostics() } else { None };
        let Some((sources, diagnostics)) = diagnostics else { return last };
        for diagnostic in diagnostics {
            let message = text(&diagnostic.message);
            let code = text(&diagnostic.code.to_string());
            let mut mistake = FramewrightMistake {
                message: message.as_ptr(),
                file: ptr::null(),
                line: 0,
                column: 0,
                code: code.as_ptr(),
            };
            last.texts.extend([message, code]);
            if let Some(place) = diagnostic.labels.first().and_then(|label| sources.place(label.span)) {
                let file = text(&place.file);
                mistake = FramewrightMistake { file: file.as_ptr(), line: place.line, column: place.column, ..mistake };
                last.texts.push(file);
            }
            last.mistakes.push(mistake);
        }
        last
    }
}

/// What the last call of this thread that failed said, with file, line and column where a file is wrong; never NULL. It lives until
/// another call of this thread fails, or the thread ends.
#[unsafe(no_mangle)]
pub extern "C" fn framewright_last_error() -> *const c_char {
    LAST.try_with(|last| last.borrow().text.as_ptr()).unwrap_or(c"".as_ptr())
}

/// The mistakes in files and choices that this error consists of, by their numbers from 0; NULL behind the last one, and if it is
/// another error. They live as long as its text.
#[unsafe(no_mangle)]
pub extern "C" fn framewright_last_mistake(number: usize) -> *const FramewrightMistake {
    let found = |last: &RefCell<LastError>| last.borrow().mistakes.get(number).map_or(ptr::null(), ptr::from_ref);
    LAST.try_with(found).unwrap_or(ptr::null())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::CStr;

    #[test]
    fn a_panic_becomes_a_status_and_leaves_its_words() {
        let status = call(|| panic!("a number {} that can't be", 7));
        // SAFETY: it is a text, and no call fails meanwhile.
        let said = unsafe { CStr::from_ptr(framewright_last_error()) };
        assert_eq!(status, FramewrightStatus::Panic);
        assert_eq!(said, c"the library panicked: a number 7 that can't be");
        assert_eq!(call(|| Ok(())), FramewrightStatus::Ok);
    }

    #[test]
    fn a_text_for_c_ends_at_its_end() {
        assert_eq!(text("one\0two").to_str(), Ok("one\u{fffd}two"));
    }

    #[test]
    fn each_thread_has_an_error_of_its_own() {
        call(|| Err(Problem::Misuse("mine".to_owned())));
        std::thread::spawn(|| call(|| Err(Problem::Misuse("another one".to_owned())))).join().expect("it ends");
        assert_eq!(LAST.with_borrow(|last| last.text.clone()).to_str(), Ok("mine"));
    }
}
