//! The trait that the embedding program implements to record the draws of objects, the sky and custom passes.

use super::custom::CustomRecorder;
use super::dispatch::DispatchRecorder;
use super::recorder::Recorder;
use super::secondary_recorder::SecondaryRecorder;
use crate::base::Error;
use framewright_graph::frame::Draw;

/// Draws the objects and the sky, and records custom passes. An engine supplies its own.
pub trait DrawSource {
    /// Records the draws of `draw` and returns how many draw calls it made.
    ///
    /// It is called in the frame's order: once for each pass that draws objects, the sky or something of its own ([`Draw::Custom`],
    /// where [`Recorder::shader`] says what). It is also called for full-screen draws whose shader reads what the draw source
    /// brings along, and for draws of a pass's own vertices ([`Draw::Vertices`], [`Draw::Indirect`]) whose shader does: then it only binds,
    /// and the draw follows by itself. Pipeline, viewport and the pass's own set, if it has bindings, are bound already; face
    /// culling is off and the front face is counter-clockwise. With several frames in flight, the device may still read what
    /// the frame before was drawn from.
    ///
    /// # Errors
    /// Any error that keeps the source from drawing; [`Error::DrawSource`] is for its own reasons.
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error>;

    /// Binds the draw source's sets for a compute pass, which is dispatched right after. It is called once for each compute pass
    /// whose shader reads what the draw source brings along to [`DrawKind::Compute`], in the frame's order among the calls of
    /// [`DrawSource::record`]. The pass's own set is bound already.
    ///
    /// # Errors
    /// Any error that keeps the source from binding. Unless this is overridden, that it binds nothing.
    ///
    /// [`DrawKind::Compute`]: framewright_graph::shader::DrawKind::Compute
    fn dispatch(&mut self, recorder: &mut DispatchRecorder<'_>) -> Result<(), Error> {
        let (pass, shader) = (recorder.pass(), recorder.shader());
        let what =
            format!("nobody binds what `{shader}` reads of the draw source, which the compute pass `{pass}` asks for");
        Err(Error::DrawSource { what })
    }

    /// Whether the draws of the custom pass that the pipeline knows as `callback`, and that stands within a rendering scope, come in secondary
    /// command buffers: then [`DrawSource::secondary`] is called for it in place of [`DrawSource::record`]. It is asked once for each such pass
    /// of a frame, when the pass's scope begins. Unless this is overridden: no.
    fn has_secondary(&mut self, _callback: &str) -> bool {
        false
    }

    /// Executes the secondary command buffers of the custom pass that the pipeline knows as `callback`, within its rendering scope. Returns
    /// how many draws they hold, for the report.
    ///
    /// # Errors
    /// Any error that keeps the source from drawing. Unless this is overridden, that it has none.
    fn secondary(&mut self, callback: &str, recorder: &mut SecondaryRecorder<'_>) -> Result<u32, Error> {
        let pass = recorder.pass();
        let what =
            format!("nobody has secondary command buffers of `{callback}`, which the custom pass `{pass}` asks for");
        Err(Error::DrawSource { what })
    }

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
