//! The JSON form: writing it, and reading it with enough checks that indexing a Plan can't fail afterwards.

use super::{BufferId, FORMAT_VERSION, FirstContents, ImageId, Plan, Resource, Role, Step, StepId, ViewId, Work};
use crate::plan::names::ShownText;
use crate::vulkan::FillValue;
use serde::Deserialize;

/// Why a text is not a Plan, or a Plan has no text. Whether a Plan is *right* is for [`crate::verify`] to say.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// Not JSON, or fields are missing, unknown or of the wrong kind.
    #[error("not a Plan: {0}")]
    Syntax(#[from] serde_json::Error),
    /// Another version of the form.
    #[error("the Plan has format version {found}, this program reads version {FORMAT_VERSION}: compile it again")]
    Version {
        /// Its `format_version`.
        found: u64,
    },
    /// An index points behind the end of its list.
    #[error("{place} names {list}[{index}], but there are only {length}")]
    OutOfRange {
        /// Where the index stands, as a path into the JSON form.
        place: String,
        /// The list it points into: `images`, `buffers`, `steps` or `heaps`.
        list: &'static str,
        /// The index.
        index: u32,
        /// Length of the list.
        length: usize,
    },
    /// An image's or buffer's `id` is not its own index.
    #[error("{list}[{index}] has the id {id}: ids are indices")]
    WrongId {
        /// `images` or `buffers`.
        list: &'static str,
        /// Index in the list.
        index: usize,
        /// The id.
        id: u32,
    },
    /// A number that JSON can't hold.
    #[error("{place} is not a finite number")]
    NotFinite {
        /// Where it stands, as a path into the JSON form.
        place: String,
    },
}

/// The one field that every version has.
#[derive(Deserialize)]
#[serde(expecting = "a Plan")]
struct VersionField {
    format_version: u64,
}

impl Plan {
    /// The stable JSON form, indented, with a final line break. `docs/plan-format.md` describes it.
    ///
    /// # Errors
    /// [`PlanError::NotFinite`] if a clear value or parameter has no JSON form.
    pub fn to_json(&self) -> Result<String, PlanError> {
        self.check_numbers()?;
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// Reads the JSON form. Every index in the result is in range.
    ///
    /// # Errors
    /// Not JSON, another version, unknown or missing fields, or an index that points nowhere.
    pub fn from_json(text: &str) -> Result<Plan, PlanError> {
        let version: VersionField = serde_json::from_str(text)?;
        if version.format_version != u64::from(FORMAT_VERSION) {
            return Err(PlanError::Version { found: version.format_version });
        }
        let plan: Plan = serde_json::from_str(text)?;
        plan.check_references()?;
        Ok(plan)
    }

    /// Whether every index points into its list.
    pub(crate) fn check_references(&self) -> Result<(), PlanError> {
        for (index, image) in self.images.iter().enumerate() {
            self.check_resource("images", index, image.id.0, &image.role, &image.name)?;
        }
        for (index, buffer) in self.buffers.iter().enumerate() {
            self.check_resource("buffers", index, buffer.id.0, &buffer.role, &buffer.name)?;
        }
        for output in &self.outputs {
            self.check_named(output.resource, || "outputs".to_owned())?;
        }
        for (index, step) in self.steps.iter().enumerate() {
            self.check_step(index, step)?;
        }
        Ok(())
    }

    fn check_resource(
        &self,
        list: &'static str,
        index: usize,
        id: u32,
        role: &Role,
        name: &str,
    ) -> Result<(), PlanError> {
        if id as usize != index {
            return Err(PlanError::WrongId { list, index, id });
        }
        let place = || format!("{list}[{index}] `{}`", ShownText(name));
        match role {
            Role::Transient(placement) => {
                in_range("heaps", placement.heap, self.heaps.len(), place)?;
                placement.lifetime.iter().try_for_each(|step| in_range("steps", step.0, self.steps.len(), place))
            }
            Role::Persistent { becomes, .. } => {
                let length = if list == "images" { self.images.len() } else { self.buffers.len() };
                in_range(list, *becomes, length, place)
            }
            Role::External { .. } => Ok(()),
        }
    }

    fn check_named(&self, resource: Resource, place: impl FnOnce() -> String) -> Result<(), PlanError> {
        match resource {
            Resource::Image(ImageId(id)) => in_range("images", id, self.images.len(), place),
            Resource::Buffer(BufferId(id)) => in_range("buffers", id, self.buffers.len(), place),
        }
    }

    fn check_step(&self, index: usize, step: &Step) -> Result<(), PlanError> {
        let place = |part: &str| format!("steps[{index}].{part}");
        let image =
            |part: &'static str, ImageId(id): ImageId| in_range("images", id, self.images.len(), || place(part));
        let buffer =
            |part: &'static str, BufferId(id): BufferId| in_range("buffers", id, self.buffers.len(), || place(part));
        let step_of = |part: &'static str, step: Option<StepId>| match step {
            Some(StepId(id)) => in_range("steps", id, self.steps.len(), || place(part)),
            None => Ok(()),
        };
        for wait in &step.waits {
            step_of("waits", Some(wait.step))?;
        }
        for barrier in &step.memory_barriers {
            for resource in barrier.hand_overs.iter().flatten() {
                self.check_named(*resource, || place("memory_barriers"))?;
            }
            for hazard in &barrier.buffers {
                buffer("memory_barriers", hazard.buffer)?;
                step_of("memory_barriers", hazard.after)?;
                step_of("memory_barriers", hazard.needed_by)?;
            }
        }
        for (part, barriers) in [("image_barriers", &step.image_barriers), ("releases", &step.releases)] {
            for barrier in barriers {
                image(part, barrier.image)?;
                step_of(part, barrier.after)?;
                step_of(part, barrier.needed_by)?;
            }
        }
        step.outside.iter().try_for_each(|it| self.check_named(it.resource, || place("outside")))?;
        let (attachments, passes) = (step.work.attachments(), step.work.passes().iter());
        for attachment in attachments {
            image("work", attachment.image)?;
            attachment.resolve.as_ref().map_or(Ok(()), |resolve| image("work", resolve.image))?;
        }
        for pass in passes {
            let view = pass.view.map(|ViewId(id)| in_range("views", id, self.views.len(), || place("work")));
            view.unwrap_or(Ok(()))?;
            pass.accesses.iter().try_for_each(|access| image("work", access.image))?;
            pass.buffers.iter().try_for_each(|access| buffer("work", access.buffer))?;
        }
        step.work.sides().try_for_each(|side| self.check_named(side.resource(), || place("work")))
    }

    fn check_numbers(&self) -> Result<(), PlanError> {
        let initial = self.images.iter().map(|image| &image.role).chain(self.buffers.iter().map(|buffer| &buffer.role));
        for role in initial {
            if let Role::Persistent { initial: FirstContents::Value(initial), .. } = role
                && !is_finite_fill(initial)
            {
                return Err(PlanError::NotFinite { place: "an initial value".to_owned() });
            }
        }
        for (index, step) in self.steps.iter().enumerate() {
            if let Work::Fill(fill) = &step.work
                && !is_finite_fill(&fill.value)
            {
                return Err(PlanError::NotFinite { place: format!("the value of steps[{index}]") });
            }
            let (attachments, passes) = (step.work.attachments(), step.work.passes().iter());
            for attachment in attachments {
                #[allow(clippy::cast_possible_truncation, reason = "no format holds more")]
                let is_finite = |value: &f64| (*value as f32).is_finite();
                if !attachment.clear.iter().flatten().all(is_finite) {
                    return Err(PlanError::NotFinite { place: format!("a clear value in steps[{index}]") });
                }
            }
            for (pass, param) in
                passes.flat_map(|pass| pass.params.iter().chain(&pass.constants).map(move |param| (pass, param)))
            {
                if !param.value.is_finite() {
                    let place =
                        format!("`{}` of pass `{}` in steps[{index}]", ShownText(&param.name), ShownText(&pass.name));
                    return Err(PlanError::NotFinite { place });
                }
            }
        }
        Ok(())
    }
}

fn is_finite_fill(value: &FillValue) -> bool {
    match value {
        FillValue::Color(color) => color.iter().all(|value| value.is_finite()),
        FillValue::Depth(depth, _) => depth.is_finite(),
        FillValue::Bits(_) => true,
    }
}

#[inline]
fn in_range(list: &'static str, index: u32, length: usize, place: impl FnOnce() -> String) -> Result<(), PlanError> {
    if (index as usize) < length { Ok(()) } else { out_of_range(list, index, length, place) }
}

#[cold]
fn out_of_range(
    list: &'static str,
    index: u32,
    length: usize,
    place: impl FnOnce() -> String,
) -> Result<(), PlanError> {
    Err(PlanError::OutOfRange { place: place(), list, index, length })
}
