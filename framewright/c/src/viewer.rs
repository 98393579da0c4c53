//! The page of a running program.

use crate::arguments::{free, handle, output, reference, text};
use crate::last_error::{self, call};
use crate::renderer::{FramewrightRenderer, with};
use crate::status::{FramewrightStatus, Problem};
use std::ffi::{CString, c_char};
use std::sync::{Mutex, PoisonError};

/// A page that shows a running program, as long as this handle is there. One thread at a time uses it.
pub struct FramewrightViewer {
    viewer: Mutex<Viewer>,
    url: CString,
}

#[cfg(feature = "viewer")]
use framewright_viewer::Viewer;

#[cfg(feature = "viewer")]
fn served(address: &str) -> Result<FramewrightViewer, Problem> {
    let cant = |error| Problem::Served { address: address.to_owned(), why: error };
    let viewer = Viewer::serve(address).map_err(cant)?;
    let url = last_error::text(&viewer.url());
    Ok(FramewrightViewer { viewer: Mutex::new(viewer), url })
}

/// A library without the feature `viewer` has none.
#[cfg(not(feature = "viewer"))]
enum Viewer {}

#[cfg(not(feature = "viewer"))]
impl Viewer {
    fn frame(&mut self, _: &mut framewright::Renderer) -> Result<(), framewright::Error> {
        match *self {}
    }
}

#[cfg(not(feature = "viewer"))]
fn served(_: &str) -> Result<FramewrightViewer, Problem> {
    Err(Problem::Misuse("this library was built without its feature `viewer`".to_owned()))
}

/// Serves a page of the running program at `address`, such as "127.0.0.1:7117"; with port 0 at a port that is free. The page is for those alone
/// who know its whole address: `framewright_viewer_url`. An address that other machines reach shows the program's files to them.
/// `FRAMEWRIGHT_STATUS_MACHINE`: the address can't be had.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_viewer_serve(
    address: *const c_char,
    viewer: *mut *mut FramewrightViewer,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe { handle(viewer, "viewer", || served(text(address, "address")?)) })
}

/// Shows the frame that a renderer drew last, and has it take the settings that were chosen in the page: the next frame has them. Called after
/// each frame, of each renderer that is to be seen. While no page is open it costs next to nothing. A setting that is refused is told in
/// the page. No frame that was recorded into the program's command buffers may wait to be submitted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_viewer_frame(
    viewer: *mut FramewrightViewer,
    renderer: *mut FramewrightRenderer,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let viewer = reference(viewer, "viewer")?;
            let mut viewer = viewer.viewer.lock().unwrap_or_else(PoisonError::into_inner);
            Ok(viewer.frame(&mut state.renderer)?)
        })
    }
}

/// Tells the address of the page, of which a part is secret. It lives as long as the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_viewer_url(
    viewer: *const FramewrightViewer,
    url: *mut *const c_char,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe { output(url, "url", reference(viewer, "viewer")?.url.as_ptr()) })
}

/// Ends a page, and its server.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_viewer_free(viewer: *mut FramewrightViewer) {
    // SAFETY: the caller's word.
    unsafe { free(viewer) };
}
