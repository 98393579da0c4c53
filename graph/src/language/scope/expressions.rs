//! The names in expressions at one level: their declarations and values.

use super::asked::Asked;
use super::evaluator::ScopeValues;
use super::level::Elements;
use super::lookup::Scope;
use super::parameter::{Parameter, ParameterKind};
use super::symbols::Symbols;
use crate::base::Span;
use crate::expression::{
    Decision, Declarations, MissingValue, NameMeaning, Origin, Property, Symbol, Type, Value, Values,
};
use crate::frame::{BufferIndex, ImageIndex};
use crate::language::inputs;
use crate::language::model::SettingKind;
use crate::ron::Names;

// An identifier is a kind and the number of a name of that kind.
const KIND: u32 = 0xF000_0000;

const PARAMETER: u32 = 0;

const IMAGE: u32 = 0x1000_0000;

const BUFFER: u32 = 0x2000_0000;

const INDEX: u32 = 0x3000_0000;

const SURROUNDINGS: u32 = 0x4000_0000;

fn number(at: usize) -> Option<u32> {
    u32::try_from(at).ok().filter(|at| at & KIND == 0)
}

const fn split(id: u32) -> (u32, usize) {
    (id & KIND, (id & !KIND) as usize)
}

impl Declarations for Scope<'_> {
    fn find(&self, name: &str) -> NameMeaning {
        let Symbols {
            names: parameter_names, parameters, images, image_lists, buffers, buffer_lists, settings, ..
        } = self.symbols;
        let found = |symbol: Option<Symbol>| symbol.map_or(NameMeaning::Reported, NameMeaning::Symbol);
        if let Some(index) = self.index.filter(|index| *index.text == *name) {
            let declared = index.span;
            let symbol = Symbol { id: INDEX, ty: Type::Integer, list: false, origin: Origin::Index, declared };
            return NameMeaning::Symbol(symbol);
        }
        if let Some(at) = parameter_names.at(name) {
            let origin = if *settings { Origin::Setting } else { Origin::Parameter };
            let declared = |parameter: &Parameter| {
                let (ty, declared) = (parameter.kind.ty(), parameter.name.span);
                Some(Symbol { id: PARAMETER | number(at)?, ty, list: false, origin, declared })
            };
            return found(parameters.get(at).and_then(Option::as_ref).and_then(declared));
        }
        let thing = |names: &Names, lists: &[bool], id: u32, ty: Type, origin: Origin| {
            let at = names.at(name)?;
            let declared = names.find_name(name).map_or(Span::NONE, |name| name.span);
            Some(found(
                number(at)
                    .and_then(|at| Some(Symbol { id: id | at, ty, list: *lists.get(at as usize)?, origin, declared })),
            ))
        };
        if let Some(image) = thing(images, image_lists, IMAGE, Type::Image, Origin::Image) {
            return image;
        }
        if let Some(buffer) = thing(buffers, buffer_lists, BUFFER, Type::Buffer, Origin::Buffer) {
            return buffer;
        }
        if let Some((at, ty, origin)) = inputs::find(name) {
            let declared = Span::NONE;
            return NameMeaning::Symbol(Symbol { id: SURROUNDINGS | at, ty, list: false, origin, declared });
        }
        // The name may be one that couldn't be read.
        if self.symbols.complete() { NameMeaning::Unknown } else { NameMeaning::Reported }
    }

    fn names(&self) -> Vec<&str> {
        let index = self.index.map(|index| &*index.text);
        let own =
            self.symbols.names.in_order().chain(self.symbols.images.in_order()).chain(self.symbols.buffers.in_order());
        let mut names: Vec<&str> = index.into_iter().chain(own).collect();
        for name in inputs::names() {
            names.push(name);
        }
        names
    }

    fn choices(&self, id: u32) -> Option<Vec<&str>> {
        let (PARAMETER, at) = split(id) else { return None };
        match &self.symbols.parameters.get(at)?.as_ref()?.kind {
            ParameterKind::Value(SettingKind::Choice { of, .. }) => Some(of.iter().map(|text| &**text).collect()),
            _ => None,
        }
    }
}

impl ScopeValues<'_> {
    fn block(&self, id: u32) -> Result<(u32, u32), MissingValue> {
        let (kind, at) = split(id);
        let (elements, names) = match kind {
            IMAGE => (self.images_of(at), &self.symbols.images),
            _ => (self.buffers_of(at), &self.symbols.buffers),
        };
        match elements {
            Some(Elements::At { first, count }) => Ok((first, count)),
            Some(Elements::Below) => Err(MissingValue::Below(names.span(at))),
            Some(Elements::Failed) | None => Err(MissingValue::Reported),
        }
    }
}

/// The image or buffer with this index.
const fn thing(id: u32, index: u32) -> Value {
    match split(id) {
        (IMAGE, _) => Value::Image(ImageIndex(index)),
        _ => Value::Buffer(BufferIndex(index)),
    }
}

impl Values for ScopeValues<'_> {
    fn value(&self, id: u32) -> Result<Value, MissingValue> {
        let (kind, at) = split(id);
        match kind {
            PARAMETER => match self.parameter(at) {
                Some(value) => Ok(value.value.clone()),
                None => Err(MissingValue::Reported),
            },
            INDEX => self.index.map(|at| Value::Integer(at.into())).ok_or(MissingValue::Reported),
            SURROUNDINGS => {
                let value = self.surroundings.value(id & !KIND);
                self.note(|| Asked::Surroundings(id & !KIND, value.clone()));
                value.ok_or(MissingValue::Reported)
            }
            _ => self.block(id).map(|(first, _)| thing(id, first)),
        }
    }

    fn length(&self, id: u32) -> Result<u64, MissingValue> {
        self.block(id).map(|(_, count)| count.into())
    }

    fn element(&self, id: u32, at: u64) -> Result<Value, MissingValue> {
        let (first, _) = self.block(id)?;
        let at = u32::try_from(at).ok().and_then(|at| first.checked_add(at));
        at.map(|index| thing(id, index)).ok_or(MissingValue::Reported)
    }

    fn property(&self, image: ImageIndex, property: Property) -> Result<i64, MissingValue> {
        let value = self.known_property(image, property);
        self.note(|| Asked::Property(image, property, value, self.property_decided_by(image, property).to_vec()));
        value
    }

    fn property_decided_by(&self, image: ImageIndex, property: Property) -> &[Decision] {
        let mut at = Some(image);
        // An image follows images above it, so this ends; a circle is a mistake that is reported elsewhere.
        for _ in 0..=image.0 {
            let image = at.and_then(|at| self.images.get(at.0 as usize)?.as_deref());
            let Some((by, follows)) = image.map(|image| image.decided(property)) else { break };
            if !by.is_empty() {
                return by.all();
            }
            at = follows.map(|of| of.index);
        }
        &[]
    }

    fn decided_by(&self, id: u32) -> &[Decision] {
        match split(id) {
            (PARAMETER, at) => self.values.get(at).and_then(Option::as_ref).map_or(&[], |value| &value.decided),
            _ => &[],
        }
    }
}

impl ScopeValues<'_> {
    /// A property of an image that was evaluated.
    pub(super) fn known_property(&self, image: ImageIndex, property: Property) -> Result<i64, MissingValue> {
        let Some(properties) = self.properties else { return Err(MissingValue::Reported) };
        let at = image.0 as usize;
        let below = || MissingValue::Below(self.symbols.images.span(self.declaration(image)));
        let Some(known) = properties.get(at) else { return Err(below()) };
        let Some(known) = known else { return Err(MissingValue::Reported) };
        let value = match property {
            Property::Width => known.area.map(|area| area.extent[0]),
            Property::Height => known.area.map(|area| area.extent[1]),
            Property::Mips => known.mips,
            Property::Layers => known.layers,
            Property::Samples => known.samples,
        };
        value.map(i64::from).ok_or_else(below)
    }

    /// The declaration of this level that an image comes from; an index beyond all for an image from elsewhere.
    fn declaration(&self, image: ImageIndex) -> usize {
        let within = |block: &Elements| matches!(block, Elements::At { first, count } if (*first..first.saturating_add(*count)).contains(&image.0));
        self.level.images.iter().position(within).unwrap_or(usize::MAX)
    }
}
