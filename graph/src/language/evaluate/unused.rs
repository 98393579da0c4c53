//! Fragments that nobody uses are checked too: what is wrong with them whatever they are given is said before anybody
//! uses them.

use super::lower::{Lowering, Place};
use super::{circles, previous};
use crate::base::Span;
use crate::expression::Value;
use crate::frame::{BufferIndex, ImageIndex, ViewIndex};
use crate::language::model::SettingKind;
use crate::language::scope::{Given, Level, Parameter, ParameterKind};
use crate::ron::{Name, Reader};
use crate::vulkan::Format;

impl Lowering<'_, '_> {
    /// Lowers the bodies of fragments that were never put in. Values of which nothing is known stand for what they would
    /// be given, so that only what is wrong with any is reported.
    pub(crate) fn unused(&mut self, reader: &mut Reader) {
        self.trying = true;
        let fragments = self.fragments;
        for (at, fragment) in fragments.list.iter().enumerate() {
            let Some(fragment) = fragment.as_ref().filter(|_| !self.used.contains(&at) && !self.is_full()) else {
                continue;
            };
            let mut stand_ins = StandIns::default();
            let parameters = fragment.body.known.parameters.iter();
            let given = parameters.map(|parameter| parameter.as_ref().map(|it| stand_ins.give(it))).collect();
            (self.images, self.properties) = (nothing_known(stand_ins.images), nothing_known(stand_ins.images));
            self.buffers = nothing_known(stand_ins.buffers);
            (self.passes, self.instances) = (Vec::new(), Vec::new());
            let unnamed = || Name { text: "".into(), span: Span::NONE };
            self.used.insert(at);
            self.path.push((at, fragment.name.clone().unwrap_or_else(unnamed)));
            let place = Place { prefix: "".into(), instance: None, view: ViewIndex::default() };
            self.body(reader, &fragment.body, &mut Level { given, ..Level::default() }, &place);
            self.path.pop();
            circles::find(&self.images, &self.buffers, &mut reader.errors);
            previous::check(&self.images, &self.buffers, &self.passes, &mut reader.errors);
        }
    }
}

/// `count` images or buffers of which nothing is known.
fn nothing_known<T>(count: u32) -> Vec<Option<T>> {
    (0..count).map(|_| None).collect()
}

/// Values for the parameters of one fragment. Each image and buffer parameter gets one of its own: a pass that draws into
/// two parameters draws into two images.
#[derive(Default)]
struct StandIns {
    images: u32,
    buffers: u32,
}

impl StandIns {
    /// A value that a parameter allows: its default, else a small one. Of images and buffers nothing is known.
    fn give(&mut self, parameter: &Parameter) -> Given {
        let next = |count: &mut u32| {
            *count += 1;
            *count - 1
        };
        let value = match &parameter.kind {
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
        };
        Given { value, decided: Vec::new() }
    }
}
