//! What C hands in and gets back, checked as far as it can be.

use crate::status::Problem;
use std::ffi::{CStr, c_char, c_void};
use std::mem::MaybeUninit;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

/// Several texts.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightNames {
    /// The first of them; NULL if there are none.
    pub names: *const *const c_char,
    /// How many there are.
    pub count: usize,
}

/// A structure that begins with its own size, and for which 0 in each other field is the default.
///
/// # Safety
/// Its first field is a `usize`, and any bytes that are a value of a C structure of this layout are a value of it.
pub(crate) unsafe trait Structure: Copy {
    /// Its name in C.
    const NAME: &'static str;
    /// The default.
    const DEFAULT: Self;
}

fn null(what: &str) -> Problem {
    Problem::Misuse(format!("`{what}` is NULL"))
}

/// What a pointer leads to, which must not be NULL.
///
/// # Safety
/// It is NULL or valid for `'a`.
pub(crate) unsafe fn reference<'a, T>(pointer: *const T, what: &str) -> Result<&'a T, Problem> {
    aligned(pointer, what)?;
    // SAFETY: the caller's word.
    unsafe { pointer.as_ref() }.ok_or_else(|| null(what))
}

/// A text, which must not be NULL.
///
/// # Safety
/// It is NULL or ends with 0, and is valid for `'a`.
pub(crate) unsafe fn text<'a>(pointer: *const c_char, what: &str) -> Result<&'a str, Problem> {
    // SAFETY: the caller's word.
    unsafe { optional_text(pointer, what) }?.ok_or_else(|| null(what))
}

/// A text; `None` for NULL.
///
/// # Safety
/// That of [`text`].
pub(crate) unsafe fn optional_text<'a>(pointer: *const c_char, what: &str) -> Result<Option<&'a str>, Problem> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's word.
    let text = unsafe { CStr::from_ptr(pointer) };
    let text = text
        .to_str()
        .map_err(|error| Problem::Misuse(format!("`{what}` is no UTF-8: its byte {} is wrong", error.valid_up_to())))?;
    Ok(Some(text))
}

/// A list has at most this many values: a count beyond it was never set, or counts something else.
const MOST_VALUES: usize = 1 << 16;

/// `count` values; NULL is right if there are none.
///
/// # Safety
/// The pointer is NULL, or `count` values stand there for `'a`.
pub(crate) unsafe fn list<'a, T>(pointer: *const T, count: usize, what: &str) -> Result<&'a [T], Problem> {
    match (pointer.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(null(what)),
        (false, 1..=MOST_VALUES) => {
            aligned(pointer, what)?;
            // SAFETY: the caller's word.
            Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
        }
        (false, _) => Err(Problem::Misuse(format!("`{what}` has {count} values, and at most {MOST_VALUES} are taken"))),
    }
}

/// `count` bytes, at most `most`; NULL is right if there are none.
///
/// # Safety
/// The pointer is NULL, or `count` bytes stand there for `'a`.
pub(crate) unsafe fn bytes<'a>(
    pointer: *const c_void,
    count: usize,
    most: usize,
    what: &str,
) -> Result<&'a [u8], Problem> {
    match (pointer.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(null(what)),
        (false, count) if count > most => {
            Err(Problem::Misuse(format!("`{what}` has {count} bytes, and at most {most} are taken")))
        }
        // SAFETY: the caller's word.
        (false, _) => Ok(unsafe { std::slice::from_raw_parts(pointer.cast(), count) }),
    }
}

/// Makes sure that a value can stand where a pointer leads to.
fn aligned<T>(pointer: *const T, what: &str) -> Result<(), Problem> {
    if pointer.is_aligned() {
        return Ok(());
    }
    let of = align_of::<T>();
    Err(Problem::Misuse(format!("`{what}` is no pointer to such a value: its address is no multiple of {of}")))
}

/// The value of this number.
pub(crate) fn one_of<'v, T>(all: &'v [T], number: u32, what: &str) -> Result<&'v T, Problem> {
    let found = usize::try_from(number).ok().and_then(|number| all.get(number));
    found.ok_or_else(|| Problem::Misuse(format!("there is no `{what}` of the number {number}")))
}

/// A number from 0 on.
pub(crate) fn from_0(number: f64, what: &str) -> Result<f64, Problem> {
    if number.is_finite() && number >= 0.0 {
        return Ok(number);
    }
    Err(Problem::Misuse(format!("`{what}` is {number}: a number from 0 on is wanted, and not infinity")))
}

impl FramewrightNames {
    /// None.
    pub(crate) const NONE: FramewrightNames = FramewrightNames { names: ptr::null(), count: 0 };

    /// The texts.
    ///
    /// # Safety
    /// They are as the fields say, for `'a`.
    pub(crate) unsafe fn texts<'a>(&self, what: &str) -> Result<Vec<&'a str>, Problem> {
        // SAFETY: the caller's word.
        unsafe { list(self.names, self.count, what)?.iter().map(|name| text(*name, what)).collect() }
    }
}

/// A structure that begins with its size; the default for NULL.
///
/// # Safety
/// The pointer is NULL or leads to as many bytes as the first field says.
pub(crate) unsafe fn structure<T: Structure>(pointer: *const T, what: &str) -> Result<T, Problem> {
    if pointer.is_null() {
        return Ok(T::DEFAULT);
    }
    aligned(pointer, what)?;
    // SAFETY: the caller's word: it leads to its size at least.
    let size = unsafe { pointer.cast::<usize>().read() };
    if size != size_of::<T>() {
        let (name, own) = (T::NAME, size_of::<T>());
        return Err(Problem::Misuse(format!(
            "`struct_size` of `{what}` is {size}: set it to sizeof({name}), which is {own}, and compile with the header of this library"
        )));
    }
    // SAFETY: the caller's word: it leads to a whole structure.
    Ok(unsafe { *pointer })
}

/// Hands a value out.
///
/// # Safety
/// The pointer is NULL or leads to room for it.
pub(crate) unsafe fn output<T>(pointer: *mut T, what: &str, value: T) -> Result<(), Problem> {
    // SAFETY: the caller's word.
    unsafe { place(pointer, what)? }.write(value);
    Ok(())
}

/// Hands a value out that the caller may not want.
///
/// # Safety
/// That of [`output`].
pub(crate) unsafe fn optional_output<T>(pointer: *mut T, value: T) {
    // SAFETY: the caller's word.
    if let Some(place) = unsafe { pointer.cast::<MaybeUninit<T>>().as_mut() } {
        place.write(value);
    }
}

/// Makes a handle. What it is handed out to holds NULL until it is made.
///
/// # Safety
/// That of [`output`].
pub(crate) unsafe fn handle<T>(
    pointer: *mut *mut T,
    what: &str,
    make: impl FnOnce() -> Result<T, Problem>,
) -> Result<(), Problem> {
    // SAFETY: the caller's word.
    let place = unsafe { place(pointer, what)? };
    let place = place.write(ptr::null_mut());
    *place = Box::into_raw(Box::new(make()?));
    Ok(())
}

/// Frees a handle; NULL is none.
///
/// # Safety
/// It is NULL or comes from [`handle`], and nobody uses it any more.
pub(crate) unsafe fn free<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: the caller's word. Nobody sees what a panic leaves.
        let _ = catch_unwind(AssertUnwindSafe(|| drop(unsafe { Box::from_raw(handle) })));
    }
}

/// # Safety
/// That of [`output`].
unsafe fn place<'a, T>(pointer: *mut T, what: &str) -> Result<&'a mut MaybeUninit<T>, Problem> {
    aligned(pointer, what)?;
    // SAFETY: the caller's word; whatever stands there, it is no value yet.
    unsafe { pointer.cast::<MaybeUninit<T>>().as_mut() }.ok_or_else(|| null(what))
}
