//! Dispatches.

use super::frame::{Frame, unprepared};
use crate::base::Error;
use crate::prepare::{PreparedDispatch, WorkgroupCount};
use ash::vk;
use framewright_graph::plan;

impl Frame<'_> {
    pub(super) fn dispatch(
        &self,
        commands: vk::CommandBuffer,
        plan: &plan::Pass,
        pass: &PreparedDispatch,
    ) -> Result<(), Error> {
        self.tell_parts(commands, plan, pass.layout);
        let set = pass.sets.at(self.number).ok_or_else(unprepared)?;
        let device = &self.gpu.raw;
        // SAFETY: the command buffer is being recorded outside a scope, the set has the layout's only set layout, and counts
        // and the buffer behind them were checked.
        unsafe {
            let compute = vk::PipelineBindPoint::COMPUTE;
            device.cmd_bind_pipeline(commands, compute, pass.pipeline);
            device.cmd_bind_descriptor_sets(commands, compute, pass.layout, 0, &[set.set.raw], &[]);
            match pass.groups {
                WorkgroupCount::Direct([x, y, z]) => device.cmd_dispatch(commands, x, y, z),
                WorkgroupCount::Indirect(buffer, offset) => {
                    let buffer = self.prepared.physical.buffer(buffer, self.number);
                    device.cmd_dispatch_indirect(commands, buffer.raw, offset);
                }
            }
        }
        Ok(())
    }
}
