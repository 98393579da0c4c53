//! RenderDoc, where it is loaded into this process: it takes what a device is given into a file.

use crate::base::loaded_library;
use renderdoc_sys::{
    RENDERDOC_API_1_1_2, eRENDERDOC_API_Version_1_1_2, pRENDERDOC_EndFrameCapture, pRENDERDOC_GetAPI,
    pRENDERDOC_GetCapture, pRENDERDOC_GetNumCaptures, pRENDERDOC_StartFrameCapture,
};
use std::ffi::{c_char, c_void};
use std::path::PathBuf;
use std::ptr;

/// The library's name on Linux, and on Windows.
const LIBRARY: [&str; 2] = ["librenderdoc.so", "renderdoc.dll"];

/// RenderDoc's interface for the program that it is loaded into.
#[derive(Debug, Clone, Copy)]
pub struct RenderDoc {
    start: pRENDERDOC_StartFrameCapture,
    end: pRENDERDOC_EndFrameCapture,
    count: pRENDERDOC_GetNumCaptures,
    file: pRENDERDOC_GetCapture,
}

impl RenderDoc {
    /// RenderDoc, if it was loaded before this program opened a device. Nothing is loaded here: what loads it is RenderDoc itself, which starts
    /// the program (`renderdoccmd capture`).
    #[must_use]
    pub fn loaded() -> Option<RenderDoc> {
        let library = loaded_library(LIBRARY)?;
        // SAFETY: RenderDoc's library exports this function with this signature in every version.
        let get = unsafe { library.get::<pRENDERDOC_GetAPI>(b"RENDERDOC_GetAPI\0") }.ok()?.as_ref().copied()?;
        let mut interface: *mut c_void = ptr::null_mut();
        // SAFETY: the pointer is valid. Where the version is known, it is set to a table of that version, which lives as long as the library.
        let found = unsafe { get(eRENDERDOC_API_Version_1_1_2, &mut interface) };
        let table = interface.cast::<RENDERDOC_API_1_1_2>();
        if found != 1 || table.is_null() {
            return None;
        }
        // Its functions stay as long as the library does, and a program doesn't unload RenderDoc.
        std::mem::forget(library);
        // SAFETY: a table of this version has these four; they are read one by one, since later versions have more.
        let (start, end) = unsafe { ((*table).StartFrameCapture, (*table).EndFrameCapture) };
        // SAFETY: as before.
        let (count, file) = unsafe { ((*table).GetNumCaptures, (*table).GetCapture) };
        Some(RenderDoc { start, end, count, file })
    }

    /// Takes what the process's device is given from now on, until [`RenderDoc::end`].
    pub fn begin(&self) {
        if let Some(start) = self.start {
            // SAFETY: null stands for the device and the window that there are.
            unsafe { start(ptr::null_mut(), ptr::null_mut()) };
        }
    }

    /// Writes what was taken. The answer is its file; `None`: RenderDoc took nothing.
    #[must_use]
    pub fn end(&self) -> Option<PathBuf> {
        // SAFETY: as in `begin`.
        let taken = self.end.is_some_and(|end| unsafe { end(ptr::null_mut(), ptr::null_mut()) } == 1);
        if !taken {
            return None;
        }
        // SAFETY: RenderDoc's function takes nothing.
        let last = unsafe { (self.count?)() }.checked_sub(1)?;
        let mut length = 0_u32;
        // SAFETY: without room for the name it tells the length, the zero at its end included.
        let known = unsafe { (self.file?)(last, ptr::null_mut(), &mut length, ptr::null_mut()) };
        let mut name = vec![0_u8; length as usize];
        // SAFETY: there is room for as many bytes as it told.
        let told = unsafe { (self.file?)(last, name.as_mut_ptr().cast::<c_char>(), &mut length, ptr::null_mut()) };
        name.truncate(name.iter().position(|byte| *byte == 0).unwrap_or(name.len()));
        (known == 1 && told == 1).then(|| PathBuf::from(String::from_utf8_lossy(&name).into_owned()))
    }
}
