//! A compiler that remembers the last frame.

use super::difference::{self, Difference};
use crate::base::Diagnostic;
use crate::compile::options::Options;
use crate::compile::stages::{self, Decisions};
use crate::compile::{emit, retain, rotate, validate};
use crate::device::{MemoryProvider, Profile};
use crate::frame::Frame;
use crate::plan::Plan;
use std::sync::Arc;

/// A compiler that remembers the last frame.
///
/// Its Plan is always that of [`compile`](crate::compile::compile) for the same input, byte for byte. Only the time that it
/// takes depends on the last frame:
///
/// - The very same frame (by its `Arc`), device and options: nothing is compared but these three, and nothing is allocated.
///   A frame behind an `Arc` doesn't change, and the last one is kept, so no other frame can have its address.
/// - An equal frame: it is compared, pass by pass.
/// - Other values (clear values of colour, depth and stencil, fill values, parameters, counts of workgroups, shifts of views, texts of
///   settings): they replace the old ones.
/// - Anything else, other sizes among it: the frame is compiled anew.
#[derive(Debug, Default)]
pub struct Compiler {
    last: Option<Box<LastFrame>>,
}

/// How much of the last frame's compilation served for this one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reuse {
    /// None.
    Nothing,
    /// All that was decided: only values were replaced.
    Decisions,
    /// All.
    Everything,
}

/// The last frame and its results.
#[derive(Debug)]
struct LastFrame {
    /// As it was given.
    given: Arc<Frame>,
    /// The same with images that are turned.
    frame: Arc<Frame>,
    device: Arc<Profile>,
    options: Options,
    decisions: Decisions,
    plan: Plan,
    reuse: Reuse,
    /// Whether the Plan has other formats than the frame: then nothing of it fits another frame.
    fell_back: bool,
}

impl Compiler {
    /// One that remembers nothing yet.
    #[must_use]
    pub fn new() -> Compiler {
        Compiler::default()
    }

    /// Finds out how `frame` is made on `device`, as [`compile`](crate::compile::compile) does.
    ///
    /// `memory` must give the same needs as before for the same device, unless [`MemoryProvider::exact`] gives another
    /// answer.
    ///
    /// # Errors
    /// As [`compile`](crate::compile::compile). The next frame is compiled anew then.
    pub fn compile(
        &mut self,
        frame: &Arc<Frame>,
        device: &Arc<Profile>,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<&Plan, Vec<Diagnostic>> {
        let known = self.last.take().filter(|last| {
            let same_device = Arc::ptr_eq(&last.device, device) || last.device == *device;
            same_device && last.options == *options && last.decisions.exact_memory == memory.exact()
        });
        let last = match known {
            Some(last) => last.follow(frame, memory)?,
            None => {
                let last = LastFrame::new(&turned(frame)?, device, memory, options)?;
                Box::new(LastFrame { given: frame.clone(), ..last })
            }
        };
        Ok(&self.last.insert(last).plan)
    }

    /// How much of the last compilation but one served for the last.
    #[must_use]
    pub fn reuse(&self) -> Reuse {
        self.last.as_ref().map_or(Reuse::Nothing, |last| last.reuse)
    }
}

/// The frame with images that are turned.
fn turned(frame: &Arc<Frame>) -> Result<Arc<Frame>, Vec<Diagnostic>> {
    Ok(rotate::rotate(frame)?.map_or_else(|| frame.clone(), Arc::new))
}

impl LastFrame {
    /// Compiles a frame whose images are turned already.
    fn new(
        frame: &Arc<Frame>,
        device: &Arc<Profile>,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<LastFrame, Vec<Diagnostic>> {
        let (decisions, substitute) = stages::decide(frame, device, memory, options)?;
        let plan = emit::emit(substitute.as_ref().unwrap_or(frame), device, &decisions);
        Ok(LastFrame {
            given: frame.clone(),
            frame: frame.clone(),
            device: device.clone(),
            options: *options,
            decisions,
            plan,
            reuse: Reuse::Nothing,
            fell_back: substitute.is_some(),
        })
    }

    /// The next frame on the same device.
    fn follow(
        mut self: Box<LastFrame>,
        frame: &Arc<Frame>,
        memory: &mut dyn MemoryProvider,
    ) -> Result<Box<LastFrame>, Vec<Diagnostic>> {
        self.reuse = Reuse::Everything;
        if Arc::ptr_eq(&self.given, frame) {
            return Ok(self);
        }
        let given = frame;
        let frame = &turned(given)?;
        match difference::between(&self.frame, frame) {
            Difference::None => {}
            Difference::Values if !self.fell_back && validate::still_holds(frame) => {
                self.reuse = Reuse::Decisions;
                self.put_in_values(frame);
            }
            Difference::Values | Difference::Structure => {
                *self = LastFrame::new(frame, &self.device, memory, &self.options)?;
            }
        }
        (self.given, self.frame) = (given.clone(), frame.clone());
        Ok(self)
    }

    fn put_in_values(&mut self, frame: &Frame) {
        let LastFrame { decisions, plan, .. } = self;
        retain::renew_clear_values(frame, &decisions.adapted, &mut decisions.load_store);
        emit::put_in_values(frame, decisions, plan);
    }
}
