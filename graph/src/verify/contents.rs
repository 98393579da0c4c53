//! Whether what is read was ever written, and not lost since.
//!
//! Whether a draw covers its attachment isn't judged, with one exception: where *contents that the frame had written* were
//! lost, be it to a `DONT_CARE` load, a barrier from `UNDEFINED` or another image, only a full-screen draw without blending
//! or depth test makes the image whole again, or what writes without attachments.

use super::cells::{Contents, Lost};
use super::violation::{Loss, Rule, StepName};
use super::walk::Walk;
use super::{Finding, scopes::PairSet};
use crate::frame::{Blend, Draw};
use crate::plan::{Attachment, ImageId, Pass, RenderScope, Side, Step, StepId, Subresources, Work};
use crate::vocabulary::{Accesses, CompareOp, LoadOp, StoreOp};

impl Walk<'_, '_> {
    /// What the work of a step reads and writes.
    pub(super) fn contents(&mut self, id: StepId, step: &Step) {
        match &step.work {
            Work::Render(scope) => self.render_contents(id, scope),
            Work::Dispatch(pass) | Work::Custom(pass) => self.pass_contents(id, pass, &[]),
            Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
                if let Side::Image { image, range, .. } = transfer.source {
                    self.read(id, image, range);
                }
                self.write_side(id, &transfer.target);
            }
            Work::Fill(fill) => self.write_side(id, &fill.target),
            Work::Export => {}
        }
    }

    fn render_contents(&mut self, id: StepId, scope: &RenderScope) {
        let attachments = || scope.color.iter().chain(&scope.depth).chain(&scope.stencil);
        for attachment in attachments() {
            match attachment.load {
                LoadOp::Load => self.read(id, attachment.image, attachment.range),
                LoadOp::Clear => self.fill(id, attachment.image, attachment.range),
                LoadOp::DontCare => self.lose(id, attachment, Lost::NotLoaded),
            }
        }
        for pass in &scope.passes {
            self.pass_contents(id, pass, &scope.color);
        }
        for attachment in attachments() {
            if let Some(resolve) = &attachment.resolve {
                self.read(id, attachment.image, attachment.range);
                self.fill(id, resolve.image, resolve.range);
            }
        }
        for attachment in attachments() {
            match attachment.store {
                StoreOp::Store => {}
                StoreOp::DontCare => self.lose(id, attachment, Lost::NotStored),
                StoreOp::None => self.lose_unstored(id, attachment),
            }
        }
    }

    fn pass_contents(&mut self, id: StepId, pass: &Pass, color: &[Attachment]) {
        for access in &pass.accesses {
            let pairs = PairSet::of(access.stages, access.accesses);
            if !pairs.reads().is_empty() {
                self.read(id, access.image, access.range);
            }
            if pairs.writes().is_empty() {
                continue;
            }
            let mut targets = color.iter().zip(&pass.blend);
            let replaces = targets.any(|(target, blend)| target.image == access.image && *blend == Blend::Replace);
            let untested = pass.depth.is_none_or(|depth| depth.test == CompareOp::Always);
            let shader = access.accesses.intersects(Accesses::SHADER_STORAGE_WRITE);
            let whole = shader || pass.draw == Some(Draw::FullScreen) && untested && replaces;
            let now = self.now(id);
            for index in self.cells.cover(access.image, access.range) {
                let cell = self.cells.at(index);
                if whole || !matches!(cell.contents, Contents::Lost(..)) {
                    cell.contents = Contents::Defined;
                    cell.filled = now;
                }
            }
        }
    }

    /// Something reads a part of an image.
    pub(super) fn read(&mut self, step: StepId, image: ImageId, range: Subresources) {
        for index in self.cells.cover(image, range) {
            let contents = std::mem::replace(&mut self.cells.at(index).contents, Contents::Defined);
            let (rule, other) = match contents {
                Contents::Defined => continue,
                Contents::Unwritten => {
                    let first = self.touched[image.0 as usize].map(|[first, _]| StepId(first));
                    let other = first.filter(|first| *first != step);
                    (Rule::Uninitialised, other.map(|first| StepName::new(self.plan, first, false)))
                }
                Contents::Lost(lost, time) => (Rule::LostWrite { loss: self.loss(lost) }, self.name_at(time, image)),
            };
            let range = Some(self.cells.range(self.plan.image(image), index));
            self.found.push(Finding { rule, step, other, image, range, bytes: None });
        }
    }

    fn loss(&self, lost: Lost) -> Loss {
        match lost {
            Lost::Forgotten => Loss::Forgotten,
            Lost::NotLoaded => Loss::NotLoaded,
            Lost::NotStored => Loss::NotStored,
            Lost::Taken(by) => Loss::Taken { by: self.plan.image(by).name.clone() },
        }
    }

    fn fill(&mut self, id: StepId, image: ImageId, range: Subresources) {
        let now = self.now(id);
        for index in self.cells.cover(image, range) {
            let cell = self.cells.at(index);
            cell.contents = Contents::Defined;
            cell.filled = now;
        }
    }

    fn lose(&mut self, id: StepId, attachment: &Attachment, lost: Lost) {
        let now = self.now(id);
        for index in self.cells.cover(attachment.image, attachment.range) {
            let cell = self.cells.at(index);
            if cell.contents == Contents::Defined {
                cell.contents = Contents::Lost(lost, now);
            }
        }
    }

    /// A store operation `NONE` keeps what was there before the scope, but not what the scope wrote.
    fn lose_unstored(&mut self, id: StepId, attachment: &Attachment) {
        let now = self.now(id);
        for index in self.cells.cover(attachment.image, attachment.range) {
            let cell = self.cells.at(index);
            if cell.contents == Contents::Defined && cell.filled == now {
                cell.contents = Contents::Lost(Lost::NotStored, now);
            }
        }
    }

    fn write_side(&mut self, id: StepId, side: &Side) {
        if let Side::Image { image, range, extent, .. } = *side {
            let whole = self.plan.image(image).extent.map(|texels| (texels >> range.base_mip.min(31)).max(1));
            if extent == whole {
                self.fill(id, image, range);
            }
        }
    }
}
