//! Which images are turned together, since they are drawn in the same passes.

use crate::base::{Code, Diagnostic, Span};
use crate::frame::{Access, Frame, Image, ImageIndex, Lifetime, Output, Pass, ResolveWay, Resource};
use crate::shader::{FileLanguage, LanguageFacts};
use crate::vulkan::{Rotation, Shape};
use std::collections::BTreeSet;

/// Why an image can't be turned.
#[derive(Debug)]
pub(super) enum Hindrance {
    /// It must stay upright: why, and where that stands.
    Upright(String, Span),
    /// It is the user's mistake.
    Wrong(Box<Diagnostic>),
}

/// Whether an image that is still upright is forwarded to another by nothing but a resolve, once both are turned: a draw
/// would read it.
pub(super) fn becomes(from: &Image, to: &Image, rotation: Rotation) -> bool {
    let upright = |extent: [u32; 2]| if to.rotation.turns() { rotation.extent(extent) } else { extent };
    (from.format, from.shape, from.layers, from.mips) == (to.format, to.shape, to.layers, to.mips)
        && [from.extent[0], from.extent[1]] == upright([to.extent[0], to.extent[1]])
        && from.allocated == to.allocated.map(upright)
        && (to.samples == 1 || to.samples == from.samples)
}

/// The search for images that are turned together with an image.
pub(super) struct TurnSearch<'f> {
    pub(super) frame: &'f Frame,
    /// Passes that stay.
    pub(super) live: &'f [u32],
    pub(super) rotation: Rotation,
    /// The image that the search begins with.
    pub(super) start: ImageIndex,
    /// Whether the first image leaves the frame turned; else it only becomes an image that does.
    pub(super) is_output: bool,
}

impl TurnSearch<'_> {
    /// The image and all that must be turned with it. If anything keeps the image upright, mistakes don't matter: they are
    /// returned only where the whole search finds no such obstacle.
    pub(super) fn find(&self) -> Result<BTreeSet<ImageIndex>, Hindrance> {
        let (mut all, mut left) = (BTreeSet::from([self.start]), vec![self.start]);
        let mut mistake = None;
        while let Some(image) = left.pop() {
            if self.frame.images[image.0 as usize].rotation == self.rotation {
                continue;
            }
            self.may_turn(image)?;
            for pass in self.live.iter().map(|pass| &self.frame.passes[*pass as usize]) {
                self.is_only_drawn(pass, image, &all)?;
                let depth = pass.depth.as_ref().map(|depth| depth.image);
                if depth != Some(image) && pass.color.iter().all(|target| target.image != image) {
                    continue;
                }
                match self.may_draw(pass, image, &all) {
                    Err(Hindrance::Wrong(wrong)) => _ = mistake.get_or_insert(wrong),
                    may => may?,
                }
                let targets = pass.color.iter().map(|target| target.image).filter(|it| self.is_turned(*it, &all));
                let beside: Vec<ImageIndex> = depth.into_iter().chain(targets).collect();
                left.extend(beside.into_iter().filter(|image| all.insert(*image)));
            }
        }
        mistake.map_or(Ok(all), |wrong| Err(Hindrance::Wrong(wrong)))
    }

    fn name(&self, image: ImageIndex) -> &str {
        &self.frame.images[image.0 as usize].name
    }

    /// Whether an image can be turned, apart from its use by passes.
    fn may_turn(&self, image: ImageIndex) -> Result<(), Hindrance> {
        let declared = &self.frame.images[image.0 as usize];
        let upright = |what: &str| Err(Hindrance::Upright(format!("`{}` {what}", declared.name), declared.span));
        let weighted = declared.resolve.as_ref().is_some_and(|resolve| resolve.way == ResolveWay::Weighted);
        let mut outputs = self.frame.outputs.iter();
        match declared.lifetime {
            _ if declared.rotation.turns() => upright("is turned otherwise"),
            _ if declared.shape != Shape::D2 || declared.mips > 1 => upright("isn't flat, or has several mip levels"),
            _ if weighted && declared.samples > 1 => upright("is resolved by a draw, which reads it"),
            _ if outputs.any(|it| it.resource == Resource::Image(image) && it.rotation != self.rotation) => {
                upright("leaves the frame upright")
            }
            Lifetime::Imported { .. } if image != self.start || !self.is_output => upright("is handed in"),
            _ => Ok(()),
        }
    }

    /// Whether a pass leaves it free to turn: it may draw into it and replace it whole, but not read it.
    fn is_only_drawn(&self, pass: &Pass, image: ImageIndex, all: &BTreeSet<ImageIndex>) -> Result<(), Hindrance> {
        let whole = pass.work.fills();
        for access in pass.accesses().filter(|access| access.resource() == Resource::Image(image)) {
            let verb = match access {
                Access::Sampled(_) => "samples",
                Access::Storage(_) => "accesses as storage",
                Access::Transfer(used) if !whole || !used.write => "copies",
                Access::ForwardSource(..) if !self.passes_on_turned(pass, all) => "passes on",
                _ => continue,
            };
            let what = format!("`{}` {verb} `{}`", pass.name, self.name(image));
            return Err(Hindrance::Upright(what, access.span()));
        }
        Ok(())
    }

    /// Whether the image that a pass forwards becomes an image that is turned too, by nothing but a resolve.
    fn passes_on_turned(&self, pass: &Pass, all: &BTreeSet<ImageIndex>) -> bool {
        let Some([from, to]) = pass.work.forwarded() else { return true };
        let [source, target] = [from, to].map(|image| &self.frame.images[image.0 as usize]);
        let turned = all.contains(&to) || target.rotation == self.rotation;
        from == to || turned && becomes(source, target, self.rotation)
    }

    /// Whether a pass that draws into it can draw it turned.
    fn may_draw(&self, pass: &Pass, image: ImageIndex, all: &BTreeSet<ImageIndex>) -> Result<(), Hindrance> {
        if let Some(why) = &pass.no_rotation {
            return Err(self.wrong_shader(pass, image, why));
        }
        match pass.color.iter().find(|target| !self.is_turned(target.image, all)) {
            Some(other) => Err(self.several_targets(pass, image, other.image, other.span)),
            None => Ok(()),
        }
    }

    /// Whether a colour image is turned, or will be.
    fn is_turned(&self, image: ImageIndex, all: &BTreeSet<ImageIndex>) -> bool {
        let leaves = |it: &Output| it.resource == Resource::Image(image) && it.rotation == self.rotation;
        all.contains(&image)
            || self.frame.images[image.0 as usize].rotation == self.rotation
            || self.frame.outputs.iter().any(leaves)
    }

    fn wrong_shader(&self, pass: &Pass, image: ImageIndex, why: &str) -> Hindrance {
        let what = format!("`{}` {why}", pass.name);
        if !self.is_output {
            return Hindrance::Upright(what, pass.span);
        }
        let (name, degrees) = (self.name(image), degrees(self.rotation));
        let other = format!("draw into another image, and from that into `{name}`");
        let language = pass.work.draw().and_then(|(_, shader)| FileLanguage::of_shader(shader));
        let help = match language.map(FileLanguage::facts) {
            None => {
                format!(
                    "use `frag_coord()`, `ddx()`, `ddy()` and `rotate_clip()` of `include/rotation.glsl`; or {other}"
                )
            }
            Some(LanguageFacts { includes: Some(ending), .. }) => {
                format!("use `frag_coord()` and `rotate_clip()` of `include/rotation{ending}`; or {other}")
            }
            Some(_) => other,
        };
        Hindrance::Wrong(Box::new(
            Diagnostic::new(
                Code::SHADER_SEES_ROTATION,
                pass.span,
                format!("{what}; it draws into `{name}`, which is {degrees}"),
            )
            .help(help),
        ))
    }

    fn several_targets(&self, pass: &Pass, image: ImageIndex, other: ImageIndex, span: Span) -> Hindrance {
        let other = self.name(other);
        let own = pass.color.iter().find(|target| self.is_output && target.image == self.start);
        let Some(own) = own else {
            let what = format!("`{}` draws `{other}` beside `{}`", pass.name, self.name(image));
            return Hindrance::Upright(what, pass.span);
        };
        let (name, degrees) = (self.name(self.start), degrees(self.rotation));
        let message = format!(
            "`{}` draws into `{name}`, which leaves the frame {degrees}, and into `{other}`, which doesn't",
            pass.name
        );
        let wrong = Diagnostic::new(Code::ROTATION_UNFIT, own.span, message).label(span, "stays upright");
        Hindrance::Wrong(Box::new(wrong.help(format!(
            "let it draw into an image of its own in place of `{name}`, and another pass from that into `{name}`"
        ))))
    }
}

/// "rotated by 90°"
pub(super) fn degrees(rotation: Rotation) -> String {
    format!("rotated by {}°", rotation.degrees())
}
