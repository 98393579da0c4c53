//! The JSON form: writing it, and reading it with enough checks that indexing a Plan can't fail afterwards.

use super::{Attachment, FORMAT_VERSION, ImageId, Param, Pass, Plan, Role, Step, StepId, Work};
use crate::frame::ParamValue;
use crate::plan::names::Shown;
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
        /// The list it points into: `images`, `steps` or `heaps`.
        list: &'static str,
        /// The index.
        index: u32,
        /// Length of the list.
        length: usize,
    },
    /// An image's `id` is not its own index.
    #[error("images[{index}] has the id {id}: ids are indices")]
    WrongId {
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
struct Versioned {
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
        let version: Versioned = serde_json::from_str(text)?;
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
            if image.id.0 as usize != index {
                return Err(PlanError::WrongId { index, id: image.id.0 });
            }
            if let Role::Transient(placement) = &image.role {
                let place = || format!("images[{index}] `{}`", Shown(&image.name));
                in_range("heaps", placement.heap, self.heaps.len(), place)?;
                for StepId(step) in placement.lifetime {
                    in_range("steps", step, self.steps.len(), place)?;
                }
            }
        }
        for image in &self.outputs {
            in_range("images", image.0, self.images.len(), || "outputs".to_owned())?;
        }
        for (index, step) in self.steps.iter().enumerate() {
            self.check_step(index, step)?;
        }
        Ok(())
    }

    fn check_step(&self, index: usize, step: &Step) -> Result<(), PlanError> {
        let place = |part: &str| format!("steps[{index}].{part}");
        let image =
            |part: &'static str, ImageId(id): ImageId| in_range("images", id, self.images.len(), || place(part));
        for id in step.memory_barriers.iter().flat_map(|barrier| &barrier.hand_overs).flatten() {
            image("memory_barriers", *id)?;
        }
        for barrier in &step.image_barriers {
            image("image_barriers", barrier.image)?;
            if let Some(StepId(after)) = barrier.after {
                in_range("steps", after, self.steps.len(), || place("image_barriers"))?;
            }
        }
        let (attachments, passes) = attachments_and_passes(&step.work);
        for attachment in attachments {
            image("work", attachment.image)?;
            attachment.resolve.as_ref().map_or(Ok(()), |resolve| image("work", resolve.image))?;
        }
        for pass in passes {
            let accessed = pass.accesses.iter().map(|access| access.image);
            accessed.chain(pass.bindings.iter().map(|binding| binding.image)).try_for_each(|id| image("work", id))?;
        }
        if let Work::Resolve(transfer) | Work::Copy(transfer) = &step.work {
            image("work", transfer.source)?;
            image("work", transfer.target)?;
        }
        Ok(())
    }

    fn check_numbers(&self) -> Result<(), PlanError> {
        for (index, step) in self.steps.iter().enumerate() {
            let (attachments, passes) = attachments_and_passes(&step.work);
            for attachment in attachments {
                if attachment.clear.iter().flatten().any(|value| !value.is_finite()) {
                    return Err(PlanError::NotFinite { place: format!("a clear value in steps[{index}]") });
                }
            }
            for (pass, param) in passes.flat_map(|pass| pass.params.iter().map(move |param| (pass, param))) {
                if !is_finite(param) {
                    let place = format!("`{}` of pass `{}` in steps[{index}]", Shown(&param.name), Shown(&pass.name));
                    return Err(PlanError::NotFinite { place });
                }
            }
        }
        Ok(())
    }
}

fn attachments_and_passes(work: &Work) -> (impl Iterator<Item = &Attachment>, std::slice::Iter<'_, Pass>) {
    let (color, depth, passes): (&[Attachment], &Option<Attachment>, &[Pass]) = match work {
        Work::Render(scope) => (&scope.color, &scope.depth, &scope.passes),
        Work::Dispatch(pass) => (&[], &None, std::slice::from_ref(pass)),
        Work::Resolve(_) | Work::Copy(_) | Work::Export => (&[], &None, &[]),
    };
    (color.iter().chain(depth), passes.iter())
}

fn is_finite(param: &Param) -> bool {
    match param.value {
        ParamValue::Bool(_) | ParamValue::Integer(_) => true,
        ParamValue::Number(number) => number.is_finite(),
    }
}

fn in_range(list: &'static str, index: u32, length: usize, place: impl FnOnce() -> String) -> Result<(), PlanError> {
    if (index as usize) < length { Ok(()) } else { Err(PlanError::OutOfRange { place: place(), list, index, length }) }
}
