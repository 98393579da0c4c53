//! Uses that custom passes declare: each is of what its pass names, and can be.

use super::CheckContext;
use crate::base::{Code, Diagnostic};
use crate::frame::{Access, DeclaredUse, Draw, Effect, Image, Pass, Resource};
use crate::vulkan::access::StateSubject;
use crate::vulkan::states::words;
use crate::vulkan::{Accesses, Layout, Stages, State, name_of};

/// The stages of commands within a rendering scope.
const DRAWN: Stages = Stages::VERTEX_SHADER
    .union(Stages::FRAGMENT_SHADER)
    .union(Stages::VERTEX_INPUT)
    .union(Stages::DRAW_INDIRECT)
    .union(Stages::TASK_SHADER_EXT)
    .union(Stages::MESH_SHADER_EXT)
    .union(Stages::ALL_COMMANDS);

/// Reports what is wrong with the uses that a pass declares.
pub(crate) fn check(checked: &impl CheckContext, pass: &Pass, errors: &mut Vec<Diagnostic>) {
    if pass.uses.is_empty() && !pass.any_queue {
        return;
    }
    if !pass.is_custom() {
        let span = pass.uses.first().map_or(pass.span, |declared| declared.span);
        let message = "it says how a program's commands use what it names, and no program records it";
        errors.push(Diagnostic::new(Code::USE_UNFIT, span, message));
        return;
    }
    if pass.any_queue {
        queue(checked, pass, errors);
    }
    for (at, declared) in pass.uses.iter().enumerate() {
        let (name, image) = match declared.resource {
            Resource::Image(index) => match checked.image(index) {
                Some(image) => (&*image.name, Some(image)),
                None => continue,
            },
            Resource::Buffer(index) => match checked.buffer(index) {
                Some(buffer) => (&*buffer.name, None),
                None => continue,
            },
        };
        let check = Check { pass, declared, name, image };
        errors.extend(check.named(&pass.uses[..at]).or_else(|| check.possible()));
    }
}

/// Reports why a pass can't be on any queue, which it is to be.
fn queue(checked: &impl CheckContext, pass: &Pass, errors: &mut Vec<Diagnostic>) {
    if pass.work.is_draw() {
        let message = "it draws within a rendering scope, which the queue for graphics alone has";
        let help = "a pass without targets is recorded outside of rendering scopes";
        return errors.push(Diagnostic::new(Code::USE_UNFIT, pass.span, message).help(help));
    }
    for access in pass.accesses() {
        let (name, image) = match access.resource() {
            Resource::Image(index) => match checked.image(index) {
                Some(image) => (&image.name, Some(image)),
                None => continue,
            },
            Resource::Buffer(index) => match checked.buffer(index) {
                Some(buffer) => (&buffer.name, None),
                None => continue,
            },
        };
        let meets = |declared: &DeclaredUse| {
            let mut meets = false;
            access.for_each_effect(pass, image, |touched| meets |= declared.meets(&touched, image));
            declared.is_of(&access) && meets
        };
        if !pass.uses.iter().any(meets) {
            let message = format!("any queue may run the pass, and nothing says how it uses `{name}`");
            let help = "declare it in `uses`: what isn't declared needs the queue for graphics";
            errors.push(Diagnostic::new(Code::USE_UNFIT, access.span(), message).help(help));
        }
    }
}

/// The check of one use.
struct Check<'c> {
    pass: &'c Pass,
    declared: &'c DeclaredUse,
    /// The name of the image or buffer.
    name: &'c str,
    image: Option<&'c Image>,
}

impl Check<'_> {
    fn wrong(&self, message: String, help: impl Into<String>) -> Diagnostic {
        Diagnostic::new(Code::USE_UNFIT, self.declared.span, message).help(help)
    }

    /// What is wrong between a use and what its pass names. `earlier`: the uses before it.
    fn named(&self, earlier: &[DeclaredUse]) -> Option<Diagnostic> {
        let Check { pass, declared, name, image } = *self;
        let mut is_named = false;
        let [mut read, mut written] = [false; 2];
        let mut wrong = None;
        for access in pass.accesses().filter(|access| declared.is_of(access)) {
            access.for_each_effect(pass, image, |touched| {
                if !declared.meets(&touched, image) || wrong.is_some() {
                    return;
                }
                is_named = true;
                read |= touched.reads;
                written |= touched.writes;
                wrong = self.touched(&access, &touched, earlier);
            });
        }
        if wrong.is_some() {
            return wrong;
        }
        let attached = || pass.accesses().any(|access| access.attaches() && access.resource() == declared.resource);
        if !is_named && attached() {
            let message = format!("`{name}` is a target of the pass, which its rendering scope accesses");
            return Some(self.wrong(message, "leave this use out: the Plan knows what a scope does"));
        }
        if !is_named {
            let ago = if declared.frames_ago > 0 { " of that frame" } else { "" };
            let message = format!("the pass names no such part of `{name}`{ago}");
            let help = "name it in `reads`, `writes`, `sample`, `storage` or `uniform` too: they say whether it is read and written";
            return Some(self.wrong(message, help));
        }
        let accesses = declared.state.accesses;
        let (reads, writes) = (accesses - accesses.writes(), accesses.writes());
        if !reads.is_empty() && !read {
            let help = "name it in `reads` too, or in `storage` with `access: ReadWrite`, if it reads earlier contents. What it \
                wrote itself it may read without a word";
            return Some(self.wrong(format!("{} reads `{name}`, and the pass only writes it", words(reads)), help));
        }
        if !writes.is_empty() && !written {
            let help = "name it in `writes` too, or in `storage` with `access: ReadWrite`";
            return Some(self.wrong(format!("{} writes `{name}`, and the pass only reads it", words(writes)), help));
        }
        None
    }

    /// What is wrong between a use and one access to what it is of.
    fn touched(&self, access: &Access<'_>, touched: &Effect, earlier: &[DeclaredUse]) -> Option<Diagnostic> {
        let Check { declared, name, image, .. } = *self;
        if !declared.covers(touched, image) {
            let message = format!("it is of a part of `{name}`, and the pass names more in one");
            let wrong = self.wrong(message, "declare the use of all that is named, or name the parts one by one");
            return Some(wrong.label(access.span(), "named here"));
        }
        let other = earlier.iter().find(|other| other.is_of(access) && other.meets(touched, image));
        if let Some(other) = other {
            let wrong = self
                .wrong(format!("two uses are of one part of `{name}`"), "make them one, with all stages and accesses");
            return Some(wrong.remark("again here").label(other.span, "first here"));
        }
        let accesses = declared.state.accesses;
        let lacking = match (touched.writes, accesses.writes().is_empty(), (accesses - accesses.writes()).is_empty()) {
            (true, true, _) => "writes",
            (false, _, true) => "reads",
            _ => return None,
        };
        let message = format!("the pass {lacking} `{name}`, and no access of this use does");
        let wrong = self.wrong(message, format!("add the access that {lacking} it, or change how the pass names it"));
        Some(wrong.label(access.span(), "named here"))
    }

    /// Why no command can use an image or buffer so.
    fn possible(&self) -> Option<Diagnostic> {
        let Check { pass, declared, name, image } = *self;
        let State { stages, accesses, layout } = declared.state;
        if stages.is_empty() || accesses.is_empty() {
            let what = if stages.is_empty() { "stages" } else { "accesses" };
            return Some(self.wrong(format!("the use of `{name}` has no {what}"), "a use has one of each at least"));
        }
        if accesses.intersects(Accesses::MEMORY) {
            let message = format!("{} says nothing of how `{name}` is used", words(accesses & Accesses::MEMORY));
            return Some(self.wrong(message, "name the accesses. What isn't declared is waited for by all commands"));
        }
        if stages.intersects(Stages::HOST) || accesses.intersects(Accesses::HOST_READ | Accesses::HOST_WRITE) {
            let message = format!("`{name}` is used by commands, and the host is none");
            return Some(self.wrong(message, "leave HOST, HOST_READ and HOST_WRITE out"));
        }
        let drawn = pass.work.draws(Draw::is_custom);
        let rates = Accesses::FRAGMENT_SHADING_RATE_ATTACHMENT_READ_KHR;
        if drawn && (accesses.intersects(rates) || stages.intersects(Stages::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR)) {
            let message =
                format!("`{name}` is declared as the shading rates of the pass's rendering scope, which has none");
            let help =
                "a custom pass without targets begins a rendering scope of its own, and attaches the rates there";
            return Some(self.wrong(message, help));
        }
        let foreign = stages - DRAWN;
        if drawn && !foreign.is_empty() {
            let message = format!("the pass draws within a rendering scope, where no {} is", words(foreign));
            return Some(
                self.wrong(message, "stages of draws are possible there: VERTEX_SHADER, FRAGMENT_SHADER and others"),
            );
        }
        for access in accesses.iter() {
            if !stages.intersects(access.stages() | Stages::ALL_COMMANDS) {
                let core = access.stages() & Stages::CORE;
                let shown = if core.is_empty() || !Stages::CORE.contains(stages) { access.stages() } else { core };
                let message = format!("{} doesn't happen in {}", words(access), words(stages));
                return Some(self.wrong(message, format!("such an access happens in {}", words(shown))));
            }
        }
        let (subject, what) =
            if image.is_some() { (StateSubject::Buffer, "an image") } else { (StateSubject::Image, "a buffer") };
        let foreign = accesses.only_of(subject);
        if !foreign.is_empty() {
            return Some(self.wrong(format!("`{name}` is {what}, which sees no {}", words(foreign)), "leave it out"));
        }
        match image {
            Some(image) => self.layout(image),
            None if layout != Layout::Undefined => {
                Some(self.wrong(format!("`{name}` is a buffer and has no layout"), "leave `layout` out"))
            }
            None => None,
        }
    }

    /// Why the image can't be used so in the layout.
    fn layout(&self, image: &Image) -> Option<Diagnostic> {
        let Check { declared, name, .. } = *self;
        let State { accesses, layout, .. } = declared.state;
        let shown = name_of(&layout);
        let planes = image.part(declared.range).aspects;
        if !layout.is_of_planes(planes, image.format.aspects()) {
            let message =
                format!("{} of `{name}` ({}) can't be used in the layout {shown}", name_of(&planes), image.format);
            let help = if image.format.aspects().bits().count_ones() > 1 {
                "depth and stencil have a layout each: declare a use of each `plane`, or one in GENERAL"
            } else {
                "every image can be used in GENERAL"
            };
            return Some(self.wrong(message, help));
        }
        let allowed = layout.accesses();
        let odd = accesses - allowed;
        if layout != Layout::General && !odd.is_empty() {
            let message = format!("{} doesn't happen in the layout {shown}", words(odd));
            let help = format!("accesses in this layout are {}; in GENERAL all are possible", words(allowed));
            return Some(self.wrong(message, help));
        }
        let stored = accesses & (Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE);
        if image.samples > 1 && !stored.is_empty() {
            let message = format!("`{name}` has {} samples, and {} needs one", image.samples, words(stored));
            return Some(self.wrong(message, "give it one sample, or draw into it"));
        }
        None
    }
}
