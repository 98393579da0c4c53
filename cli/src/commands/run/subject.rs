//! What is drawn: a pipeline, or a Plan from a file.

use crate::command_line::args::RunArguments;
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::planning::{self, plan_file};
use crate::system::{interrupt, text};
use framewright::{Assets, Helper, Pipeline};
use framewright_graph::base::ReadFiles;
use framewright_graph::frame::Frame;
use framewright_graph::plan::{Plan, Totals};
use framewright_passes::scene::Scene;
use framewright_vulkan::Device;

/// What is drawn.
pub(super) enum Subject {
    /// A pipeline.
    Pipeline(Box<Pipeline>),
    /// A Plan, verified, and the files that it names.
    Plan(Box<(Plan, Assets)>),
}

impl Subject {
    /// Records the files that the command line names, before any is read.
    pub(super) fn expect(arguments: &RunArguments, read: &ReadFiles) {
        if arguments.plan {
            read.expect(FileRole::PLAN.recorded, &arguments.pipeline.file);
        } else {
            inputs::expect(&arguments.pipeline, read);
        }
    }

    /// Reads it.
    ///
    /// # Errors
    /// If it can't be read, or is wrong in itself.
    pub(super) fn read(arguments: &RunArguments, helper: &Helper, read: &ReadFiles) -> Result<Subject, Error> {
        let helper = helper.clone();
        Ok(if arguments.plan {
            Subject::Plan(Box::new(plan_file::load(&arguments.pipeline, helper, read)?))
        } else {
            Subject::Pipeline(Box::new(planning::load_with(&arguments.pipeline, read, helper)?))
        })
    }

    /// The files that it names.
    pub(super) fn assets(&mut self) -> &mut Assets {
        match self {
            Subject::Pipeline(pipeline) => &mut pipeline.assets,
            Subject::Plan(plan) => &mut plan.1,
        }
    }

    /// The note about a Plan from a file that was made for another device than this one.
    pub(super) fn made_elsewhere(&self, device: &str) -> Option<String> {
        let Subject::Plan(plan) = self else { return None };
        let made_for = &plan.0.device.name;
        (made_for != device).then(|| {
            let [made_for, device] = [made_for, device].map(text::escape);
            format!("note: the Plan was made for {made_for}, and is drawn on {device}: a Plan of its own may take less")
        })
    }

    /// The Plan for the device, with the frame that it was made of. Says what dumping changes. A Plan from a file is as it is.
    ///
    /// # Errors
    /// Those of planning; Ctrl-C.
    pub(super) fn planned(
        &mut self,
        arguments: &RunArguments,
        scene: &Scene,
        device: &Device,
    ) -> Result<(Plan, Option<Frame>), Error> {
        let pipeline = match self {
            Subject::Pipeline(pipeline) => pipeline,
            Subject::Plan(plan) => return Ok((plan.0.clone(), None)),
        };
        let mut without = planning::choices(&arguments.pipeline, arguments.size, arguments.planning.rotate);
        without.facts = Some(scene.facts());
        let mut choices = without.clone();
        choices.dump = arguments.dump.iter().map(|dump| dump.image.clone()).collect();
        let options = arguments.planning.options();
        let (profile, mut memory) = (device.profile(), device.memory());
        if interrupt::asked() {
            // The device may not have been tested.
            return Err(Error::Interrupted { frames: 0, wanted: arguments.frames });
        }
        let planned = pipeline.planned(&choices, &profile, &mut memory, &options)?;
        if !choices.dump.is_empty() {
            let without = pipeline.planned(&without, &profile, &mut memory, &options)?;
            text::say(&format!("note: dumping {}", difference(&without.plan.totals, &planned.plan.totals)));
        }
        Ok((planned.plan, Some(planned.frame)))
    }
}

/// How the totals of two Plans differ, in words.
fn difference(before: &Totals, after: &Totals) -> String {
    let count = |name: &str, before: u32, after: u32| (before != after).then(|| format!("{name} {before} → {after}"));
    let bytes = |name: &str, before: u64, after: u64| {
        (before != after).then(|| format!("{name} {} → {}", text::bytes(before), text::bytes(after)))
    };
    let changes: Vec<String> = [
        count("passes", before.passes + before.inserted_passes, after.passes + after.inserted_passes),
        count("rendering scopes", before.scopes, after.scopes),
        count("resolves", before.resolves, after.resolves),
        count("copies", before.copies, after.copies),
        count("barriers", before.image_barriers + before.memory_barriers, after.image_barriers + after.memory_barriers),
        bytes("transient memory", before.placed_bytes, after.placed_bytes),
        bytes("kept memory", before.kept_bytes, after.kept_bytes),
    ]
    .into_iter()
    .flatten()
    .collect();
    if changes.is_empty() {
        "changes no sum of the Plan".to_owned()
    } else {
        format!("changes the Plan: {}", changes.join(", "))
    }
}
