//! A compiler that remembers the last frame.

use super::difference::{self, Difference};
use crate::base::Diagnostic;
use crate::compile::emit::{self, StageResults};
use crate::compile::model::OpKind;
use crate::compile::options::Options;
use crate::compile::structure::{Settled, Settling, Structure};
use crate::compile::{retain, rotate, validate};
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
/// - Other values (clear and fill values, parameters, counts of workgroups, texts of settings): they replace the old ones.
/// - Other sizes (of images and buffers): memory is placed anew, and order and scopes are reused. If alias edges are the
///   same, barriers are reused too, else they are found again. The frame is compiled anew if another order might score best,
///   if scopes might differ, if passes that are off forward between images of other proportions, or if alias edges differ on
///   several queues.
/// - Anything else: the frame is compiled anew.
#[derive(Debug, Default)]
pub struct Compiler {
    last: Option<Box<Last>>,
}

/// How much of the last frame's compilation served for this one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reuse {
    /// None.
    Nothing,
    /// Order, scopes and all that follows from these alone.
    Structure,
    /// That and the barriers: memory was placed anew, with the same alias edges.
    Barriers,
    /// That and the places in memory: only values were replaced.
    Placement,
    /// All.
    Everything,
}

/// The last frame and its results.
#[derive(Debug)]
struct Last {
    /// As it was given.
    given: Arc<Frame>,
    /// The same with images that are turned.
    frame: Arc<Frame>,
    device: Arc<Profile>,
    options: Options,
    exact_memory: bool,
    structure: Structure,
    settled: Settled,
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
            same_device && last.options == *options && last.exact_memory == memory.exact()
        });
        let last = match known {
            Some(last) => last.follow(frame, memory)?,
            None => {
                let last = Last::new(&turned(frame)?, device, memory, options)?;
                Box::new(Last { given: frame.clone(), ..last })
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

impl Last {
    /// Of a frame with images that are turned.
    fn new(
        frame: &Arc<Frame>,
        device: &Arc<Profile>,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Last, Vec<Diagnostic>> {
        let (structure, substitute) = Structure::find_with_fallback(frame, device, options, true)?;
        let barriers = structure.timeline.barriers.clone();
        let settled = structure.settle(barriers, device, memory, options)?;
        let planned = substitute.as_ref().unwrap_or(frame);
        let plan = emit::emit(planned, device, &structure, &settled);
        Ok(Last {
            given: frame.clone(),
            frame: frame.clone(),
            device: device.clone(),
            options: *options,
            exact_memory: memory.exact(),
            structure,
            settled,
            plan,
            reuse: Reuse::Nothing,
            fell_back: substitute.is_some(),
        })
    }

    /// The next frame on the same device.
    fn follow(
        mut self: Box<Last>,
        frame: &Arc<Frame>,
        memory: &mut dyn MemoryProvider,
    ) -> Result<Box<Last>, Vec<Diagnostic>> {
        self.reuse = Reuse::Everything;
        if Arc::ptr_eq(&self.given, frame) {
            return Ok(self);
        }
        let given = frame;
        let frame = &turned(given)?;
        let reuse = match difference::between(&self.frame, frame) {
            Difference::None => Reuse::Everything,
            _ if self.fell_back => Reuse::Nothing,
            Difference::Values => Reuse::Placement,
            Difference::Sizes => Reuse::Structure,
            Difference::Structure => Reuse::Nothing,
        };
        self.reuse = reuse;
        let done = match reuse {
            Reuse::Everything => true,
            Reuse::Placement => self.put_in_values(frame),
            Reuse::Structure | Reuse::Barriers => self.put_in_sizes(frame, memory)?,
            Reuse::Nothing => false,
        };
        if !done {
            *self = Last::new(frame, &self.device, memory, &self.options)?;
        }
        (self.given, self.frame) = (given.clone(), frame.clone());
        Ok(self)
    }

    /// Whether order, scopes and places served again.
    fn put_in_values(&mut self, frame: &Frame) -> bool {
        if !validate::values_still_hold(frame) {
            return false;
        }
        let Last { structure, settled, device, plan, .. } = self;
        retain::renew_clear_values(frame, &structure.adapted, &mut structure.load_store);
        emit::values(&StageResults::new(frame, device, structure, settled), plan);
        true
    }

    /// Whether the structure served again.
    fn put_in_sizes(&mut self, frame: &Frame, memory: &mut dyn MemoryProvider) -> Result<bool, Vec<Diagnostic>> {
        let Last { frame: before, device, options, structure, settled, plan, .. } = self;
        let forwards = structure.adapted.ops.iter().any(|op| matches!(op.kind, OpKind::ForwardDraw { .. }));
        let forwards = forwards || difference::forwards(frame);
        if forwards && !difference::keeps_proportions(before, frame) {
            return Ok(false);
        }
        if !validate::still_holds(frame) || !structure.still_holds(frame, device, options) {
            return Ok(false);
        }
        retain::renew_clear_values(frame, &structure.adapted, &mut structure.load_store);
        let settling = structure.settle_again(settled, device, memory, options)?;
        let results = || StageResults::new(frame, device, structure, settled);
        match settling {
            Settling::Same => {
                self.reuse = Reuse::Barriers;
                emit::sizes(&results(), plan);
            }
            Settling::OtherBarriers if settled.barriers.steps as usize == plan.steps.len() => {
                emit::barriers(&results(), plan);
                emit::sizes(&results(), plan);
            }
            Settling::OtherBarriers | Settling::Nothing => return Ok(false),
        }
        Ok(true)
    }
}
