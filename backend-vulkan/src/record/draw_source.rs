//! The trait that the embedding program implements to record the draws of objects, the sky and custom passes.

use super::custom::CustomRecorder;
use super::recorder::Recorder;
use crate::base::Error;
use framewright_graph::frame::Draw;

/// Draws the objects and the sky, and records custom passes. An engine supplies its own.
pub trait DrawSource {
    /// Records the draws of `draw` and returns how many draw calls it made.
    ///
    /// It is called once for each pass that draws objects, the sky or something of its own ([`Draw::Custom`], where
    /// [`Recorder::shader`] says what), and for full-screen draws whose shader reads what the draw source brings along; in
    /// the frame's order, never for others. Pipeline, viewport and the pass's
    /// own set, if it has bindings, are bound already; face culling is off and the front face is counter-clockwise. With several frames in
    /// flight the frame before may still be drawn from what it was drawn from.
    ///
    /// # Errors
    /// Any error that keeps the source from drawing; [`Error::DrawSource`] is for its own reasons.
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error>;

    /// Records the custom pass that the pipeline knows as `callback`, outside of rendering scopes. It must do what the
    /// pipeline says of it: write whole what it writes, and touch nothing else. If it writes anything, it is an error to record
    /// nothing.
    ///
    /// # Errors
    /// Any error that keeps the source from recording. Unless this is overridden, that it knows no custom passes.
    fn custom(&mut self, callback: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        let pass = recorder.pass();
        let what = format!("nobody records `{callback}`, which the custom pass `{pass}` asks for");
        Err(Error::DrawSource { what })
    }
}
