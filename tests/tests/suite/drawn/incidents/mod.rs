//! Mistakes of other render graphs that users reported, made impossible here: each test carries the name of the report that
//! tells of it.
//!
//! Reports that concern no graph have no test here:
//! - o3de#11730, #12601 (hot reload loses passes that were injected): nothing is injected into a loaded pipeline; passes
//!   are what the files say, and a file that is read again is read whole.
//! - filament#8721 and the single-pass stereo of bevy#15864 (no anti-aliasing with multiview): stereo isn't built yet.
//! - renderdoc#196 (a view of the pass graph): the viewer's. `framewright inspect` prints the Plan, pass by pass.

mod pictures;
mod resolves;
mod schedule;
mod synchronisation;

use framewright_graph::compile::{Options, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::Frame;
use framewright_graph::plan::{Attachment, Image, ImageId, Plan, RenderScope, Work};
use framewright_graph::verify::verify;
use framewright_tests::frames::device;
use framewright_tests::happens_before::judge;

/// The Plan of a frame, found right by the checker and by the brute-force judge.
#[track_caller]
fn right(frame: &Frame, options: &Options) -> Plan {
    let device = device();
    let plan = compile(frame, &device, &mut MemoryEstimate(&device), options)
        .unwrap_or_else(|wrong| panic!("the frame is valid: {wrong:?}"));
    assert_eq!(verify(&plan), [], "{}", plan.tree());
    assert_eq!(judge(&plan).harms, [], "{}", plan.tree());
    plan
}

/// The rendering scopes of a Plan.
fn scopes(plan: &Plan) -> impl Iterator<Item = &RenderScope> {
    plan.steps.iter().filter_map(|step| if let Work::Render(scope) = &step.work { Some(&**scope) } else { None })
}

/// All attachments of a Plan.
fn attachments(plan: &Plan) -> impl Iterator<Item = &Attachment> {
    scopes(plan).flat_map(|scope| &scope.attachments)
}

/// The resolves of a Plan, by scopes or steps: each image with the one that it is resolved to.
fn resolves(plan: &Plan) -> Vec<(ImageId, ImageId)> {
    let folded = attachments(plan)
        .filter_map(|attachment| attachment.resolve.as_ref().map(|resolve| (attachment.image, resolve.image)));
    let standalone = plan.steps.iter().filter_map(|step| match &step.work {
        Work::Resolve(transfer) => match (transfer.source.resource(), transfer.target.resource()) {
            (framewright_graph::plan::Resource::Image(from), framewright_graph::plan::Resource::Image(to)) => {
                Some((from, to))
            }
            _ => None,
        },
        _ => None,
    });
    folded.chain(standalone).collect()
}

/// The image that a pass binds under a name.
fn bound<'p>(plan: &'p Plan, pass: &str, name: &str) -> &'p Image {
    let scoped = scopes(plan).flat_map(|scope| &scope.passes);
    let dispatched =
        plan.steps.iter().filter_map(|step| if let Work::Dispatch(pass) = &step.work { Some(pass) } else { None });
    let found = scoped.chain(dispatched).find(|one| &*one.name == pass).and_then(|pass| {
        pass.accesses.iter().find(|access| access.binding.as_ref().is_some_and(|binding| &*binding.name == name))
    });
    plan.image(found.unwrap_or_else(|| panic!("`{pass}` binds `{name}`:\n{}", plan.tree())).image)
}
