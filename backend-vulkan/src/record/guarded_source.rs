//! A draw source whose panics are errors of the pass that it recorded.

use super::custom::CustomRecorder;
use super::dispatch::DispatchRecorder;
use super::draw_source::DrawSource;
use super::recorder::Recorder;
use super::secondary_recorder::SecondaryRecorder;
use crate::base::Error;
use framewright_graph::frame::Draw;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A draw source of the program's. After a panic the frame isn't submitted, and the next one is recorded anew.
pub(crate) struct GuardedSource<'s>(pub(crate) &'s mut dyn DrawSource);

impl DrawSource for GuardedSource<'_> {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let recorded = catch_unwind(AssertUnwindSafe(|| self.0.record(draw, recorder)));
        recorded.unwrap_or_else(|payload| Err(panicked(recorder.pass(), &*payload)))
    }

    fn dispatch(&mut self, recorder: &mut DispatchRecorder<'_>) -> Result<(), Error> {
        let recorded = catch_unwind(AssertUnwindSafe(|| self.0.dispatch(recorder)));
        recorded.unwrap_or_else(|payload| Err(panicked(recorder.pass(), &*payload)))
    }

    fn has_secondary(&mut self, callback: &str) -> bool {
        // A panic goes on to the function `has_secondary` below, which knows the pass and makes an error of it.
        self.0.has_secondary(callback)
    }

    fn secondary(&mut self, callback: &str, recorder: &mut SecondaryRecorder<'_>) -> Result<u32, Error> {
        let recorded = catch_unwind(AssertUnwindSafe(|| self.0.secondary(callback, recorder)));
        recorded.unwrap_or_else(|payload| Err(panicked(recorder.pass(), &*payload)))
    }

    fn custom(&mut self, callback: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        let recorded = catch_unwind(AssertUnwindSafe(|| self.0.custom(callback, recorder)));
        recorded.unwrap_or_else(|payload| Err(panicked(recorder.pass(), &*payload)))
    }
}

/// Asks whether a pass has secondary command buffers. A panic is an error of the pass.
pub(super) fn has_secondary(source: &mut dyn DrawSource, pass: &str, callback: &str) -> Result<bool, Error> {
    catch_unwind(AssertUnwindSafe(|| source.has_secondary(callback))).map_err(|payload| panicked(pass, &*payload))
}

fn panicked(pass: &str, payload: &(dyn Any + Send)) -> Error {
    let words = payload.downcast_ref::<String>().map(String::as_str).or(payload.downcast_ref::<&str>().copied());
    let what = format!("the program panicked: {}", words.unwrap_or("without words"));
    Error::Recording { pass: pass.to_owned(), what }
}
