//! The functions of the module for browsers. A page asks for room, writes its question there, has it answered, and reads the answer.
#![expect(unsafe_code, reason = "functions that keep their names are unsafe, though nothing in them is")]

use crate::answer::answer;
use std::sync::{Mutex, PoisonError};

static QUESTION: Mutex<Vec<u8>> = Mutex::new(Vec::new());
static ANSWER: Mutex<Vec<u8>> = Mutex::new(Vec::new());

/// Room for a question of this many bytes, in UTF-8.
#[unsafe(no_mangle)]
extern "C" fn room(bytes: usize) -> *mut u8 {
    let mut question = QUESTION.lock().unwrap_or_else(PoisonError::into_inner);
    *question = vec![0; bytes];
    question.as_mut_ptr()
}

/// Answers the question. Returns the bytes of the answer.
#[unsafe(no_mangle)]
extern "C" fn ask() -> usize {
    let question = std::mem::take(&mut *QUESTION.lock().unwrap_or_else(PoisonError::into_inner));
    let told = answer(&String::from_utf8_lossy(&question)).into_bytes();
    let mut answer = ANSWER.lock().unwrap_or_else(PoisonError::into_inner);
    *answer = told;
    answer.len()
}

/// Where the answer stands.
#[unsafe(no_mangle)]
extern "C" fn told() -> *const u8 {
    ANSWER.lock().unwrap_or_else(PoisonError::into_inner).as_ptr()
}
