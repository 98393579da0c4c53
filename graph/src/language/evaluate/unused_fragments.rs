//! Unused fragments are checked too: mistakes that don't depend on arguments are reported before a fragment is used.

use super::evaluation::{Evaluation, Level, Purpose};
use super::lists::FlatLists;
use super::{circles, previous};
use crate::base::Span;
use crate::expression::Value;
use crate::frame::{BufferIndex, ImageIndex};
use crate::language::model::SettingKind;
use crate::language::scope::{Parameter, ParameterKind};
use crate::ron::{Name, Reader};
use crate::vulkan::Format;

impl Evaluation<'_> {
    /// Evaluates the bodies of fragments that were never put in. Their arguments are images and buffers of which nothing is
    /// known, and default values, so that only mistakes are reported that don't depend on arguments.
    pub(super) fn unused(&mut self, reader: &mut Reader) {
        self.purpose = Purpose::CheckUnused;
        let fragments = self.fragments;
        for (at, fragment) in fragments.list.iter().enumerate() {
            let Some(fragment) = fragment.as_ref().filter(|_| !self.used.contains(&at) && !self.is_full) else {
                continue;
            };
            let mut stand_ins = StandIns::default();
            let parameters = fragment.symbols.parameters.iter();
            let values = parameters.map(|parameter| parameter.as_ref().map(|it| stand_ins.give(it).into())).collect();
            self.flat = FlatLists::nothing_known(stand_ins.images, stand_ins.buffers);
            let unnamed = || Name { text: "".into(), span: Span::NONE };
            self.used.insert(at);
            self.path.push((at, fragments.names.get(at).cloned().unwrap_or_else(unnamed)));
            self.level(reader, &mut Level::top(fragment, values));
            self.path.pop();
            circles::find(&self.flat.images, &self.flat.buffers, &mut reader.errors);
            previous::check(&self.flat.images, &self.flat.buffers, &self.flat.passes, &mut reader.errors);
        }
    }
}

/// Values for the parameters of one fragment. Each image and buffer parameter gets one of its own: a pass that draws into
/// two parameters draws into two images.
#[derive(Default)]
struct StandIns {
    images: u32,
    buffers: u32,
}

impl StandIns {
    /// A value that a parameter allows: its default, else a small one. Nothing is known of images and buffers.
    fn give(&mut self, parameter: &Parameter) -> Value {
        let next = |count: &mut u32| {
            *count += 1;
            *count - 1
        };
        match &parameter.kind {
            ParameterKind::Image => Value::Image(ImageIndex(next(&mut self.images))),
            ParameterKind::Buffer => Value::Buffer(BufferIndex(next(&mut self.buffers))),
            ParameterKind::Format { default } => Value::Format(default.unwrap_or(Format::R8G8B8A8_UNORM)),
            ParameterKind::Value(SettingKind::Integer { min, max, .. }) if parameter.required => {
                Value::Integer(1.clamp(*min, *max))
            }
            ParameterKind::Value(SettingKind::Number { min, max, .. }) if parameter.required => {
                Value::Number(1.0_f64.clamp(*min, *max))
            }
            ParameterKind::Value(kind) => kind.default(),
        }
    }
}
