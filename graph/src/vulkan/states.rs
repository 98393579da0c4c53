//! Contradictions in the state in which an image or buffer comes in or goes out.

use super::access::StateSubject;
use super::layout::LayoutImages;
use super::{Accesses, Aspects, Format, Layout, Stages, State};

impl State {
    /// The state of what comes after it, or before it, if a semaphore stands between: all stages and accesses, if it names no stages.
    pub(crate) fn or_everything(self) -> State {
        match self.stages.is_empty() {
            true => State { stages: Stages::ALL_COMMANDS, accesses: Accesses::MEMORY, layout: self.layout },
            false => self,
        }
    }
}

/// The time at which an image or buffer is in a state.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum StateTime {
    /// When it is handed in.
    Before,
    /// When it is left.
    After,
}

/// The image or buffer that is in a state.
#[derive(Clone, Copy)]
pub(crate) struct Subject<'a> {
    pub(crate) name: &'a str,
    /// The format of an image; `None`: a buffer.
    pub(crate) format: Option<Format>,
    pub(crate) samples: u32,
}

/// Why no image or buffer of this kind can be in this state, and the help.
pub(crate) fn contradiction(state: &State, of: Subject<'_>, when: StateTime) -> Option<(String, String)> {
    let name = of.name;
    for access in state.accesses.iter() {
        let stages = access.stages();
        if !state.stages.intersects(stages | Stages::ALL_COMMANDS) {
            let message = format!("`{name}` can't have seen {} in these stages", words(access));
            // Who names no stage of an extension is shown none.
            let core = stages & Stages::CORE;
            let shown = if core.is_empty() || !Stages::CORE.contains(state.stages) { stages } else { core };
            return Some((message, format!("such an access happens in {}", words(shown))));
        }
    }
    let Some(format) = of.format else {
        let foreign = state.accesses.only_of(StateSubject::Image);
        let message = format!("`{name}` is a buffer and can't have seen {}", words(foreign));
        return (!foreign.is_empty()).then(|| (message, "name accesses of buffers".to_owned()));
    };
    let foreign = state.accesses.only_of(StateSubject::Buffer);
    if !foreign.is_empty() {
        let message = format!("`{name}` is an image and can't have seen {}", words(foreign));
        return Some((message, "name accesses of images".to_owned()));
    }
    layout_contradiction(state, name, format, of.samples, when)
}

fn layout_contradiction(
    state: &State,
    name: &str,
    format: Format,
    samples: u32,
    when: StateTime,
) -> Option<(String, String)> {
    let shown = super::name_of(&state.layout);
    let (depth, stencil) = (format.is_depth(), format.aspects().contains(Aspects::STENCIL));
    if state.layout == Layout::Undefined {
        let message = format!("`{name}` can't be left in the layout UNDEFINED: its contents would be lost");
        return (when == StateTime::After)
            .then(|| (message, "leave `after` out to keep it as its last use leaves it".to_owned()));
    }
    if state.layout == Layout::General {
        return None;
    }
    let fits = match state.layout.row().holds {
        LayoutImages::Any => true,
        LayoutImages::Color => !depth,
        LayoutImages::ColorOfOneSample => !depth && samples == 1,
        LayoutImages::Depth => depth,
        LayoutImages::DepthAlone => depth && !stencil,
        LayoutImages::None => false,
    };
    let allowed = state.layout.accesses();
    if !fits {
        let planes = match (depth, stencil) {
            (true, true) => "depth and stencil",
            (true, false) => "depth",
            _ => "colour",
        };
        let several = if samples > 1 { format!(" with {samples} samples") } else { String::new() };
        let message = format!("`{name}` holds {planes} ({format}){several} and can't be in the layout {shown}");
        return Some((message, "a layout serves all planes of the image, and its samples".to_owned()));
    }
    let odd = state.accesses.difference(allowed | Accesses::MEMORY);
    if odd.is_empty() {
        return None;
    }
    let message = format!("`{name}` can't have seen {} in the layout {shown}", words(odd));
    let help = if allowed.is_empty() {
        "no access happens in this layout".to_owned()
    } else {
        format!("accesses in this layout are {}", words(allowed))
    };
    Some((message, help))
}

/// The names of flags.
pub(crate) fn words<F: bitflags::Flags + Copy>(flags: F) -> String {
    let names: Vec<&str> = flags.iter_names().map(|(name, _)| name).collect();
    names.join(", ")
}
