//! Which library a program runs with.

use std::ffi::{CStr, c_char};

/// The version of this interface. A program that was compiled with another one than `framewright_abi` returns must not call anything else.
pub const FRAMEWRIGHT_ABI: u32 = 2;

const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
    Ok(version) => version,
    Err(_) => c"",
};

/// The interface of the library that the program runs with: compare it with `FRAMEWRIGHT_ABI`.
#[unsafe(no_mangle)]
pub extern "C" fn framewright_abi() -> u32 {
    FRAMEWRIGHT_ABI
}

/// The version of the library that the program runs with, as a text such as `1.2.3`.
#[unsafe(no_mangle)]
pub extern "C" fn framewright_version() -> *const c_char {
    VERSION.as_ptr()
}
