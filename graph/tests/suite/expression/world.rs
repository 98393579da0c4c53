//! A small pipeline's worth of names, with values that a test may change.

use framewright_graph::base::{self, Sources, Span};
use framewright_graph::expression::{
    Decision, Declarations, Expression, MissingValue, NameMeaning, Origin, Outcome, Property, Symbol, Type, Value,
    Values, WantedTypes,
};
use framewright_graph::frame::{BufferIndex, ImageIndex};

/// Any type does.
pub(crate) const ANY: WantedTypes<'static> = WantedTypes {
    types: &[Type::Bool, Type::Integer, Type::Number, Type::Text, Type::Format, Type::Image, Type::Buffer],
    words: "a value",
};

struct Entry {
    name: &'static str,
    ty: Type,
    list: bool,
    origin: Origin,
    /// One, or the elements of a list; none if it stands below.
    values: Vec<Value>,
    choices: Option<Vec<&'static str>>,
}

/// Names and values.
pub(crate) struct World {
    entries: Vec<Entry>,
    broken: Vec<&'static str>,
    strength_decided_by: Vec<Decision>,
}

impl World {
    pub(crate) fn new() -> World {
        let mut world = World { entries: Vec::new(), broken: vec!["broken"], strength_decided_by: Vec::new() };
        let image = |index| Value::Image(ImageIndex(index));
        world.add("levels", Origin::Setting, Value::Integer(5));
        world.add("none", Origin::Setting, Value::Integer(0));
        world.add("hdr", Origin::Setting, Value::Bool(true));
        world.add("bloom", Origin::Setting, Value::Bool(false));
        world.add("radius", Origin::Setting, Value::Number(1.5));
        world.add("quality", Origin::Setting, Value::Text("high".into()));
        world.entries[5].choices = Some(vec!["low", "high"]);
        world.add("scene.has_opaque", Origin::Fact, Value::Bool(true));
        world.add("scene.has_transparent", Origin::Fact, Value::Bool(false));
        world.add("view.width", Origin::View, Value::Integer(1920));
        world.add("device.local_read", Origin::Device, Value::Bool(false));
        world.add("strength", Origin::Parameter, Value::Number(0.25));
        world.add("i", Origin::Index, Value::Integer(1));
        world.add("source", Origin::Image, image(0));
        world.add("later", Origin::Image, image(9));
        world.add("lights", Origin::Buffer, Value::Buffer(BufferIndex(3)));
        world.list("down", Origin::Image, Type::Image, vec![image(1), image(2), image(3)]);
        world.list("lone", Origin::Image, Type::Image, vec![image(7)]);
        world.list("empty", Origin::Image, Type::Image, Vec::new());
        world.list("weights", Origin::Setting, Type::Number, vec![Value::Number(0.5), Value::Integer(2)]);
        world.strength_decided_by.push(Decision {
            name: "glow".into(),
            origin: Origin::Setting,
            value: Value::Integer(25),
        });
        world
    }

    pub(crate) fn add(&mut self, name: &'static str, origin: Origin, value: Value) {
        let ty = value.ty();
        self.entries.push(Entry { name, ty, list: false, origin, values: vec![value], choices: None });
    }

    fn list(&mut self, name: &'static str, origin: Origin, ty: Type, values: Vec<Value>) {
        self.entries.push(Entry { name, ty, list: true, origin, values, choices: None });
    }

    /// Gives a name another value.
    pub(crate) fn with(mut self, name: &str, value: Value) -> World {
        let entry = self.entries.iter_mut().find(|entry| entry.name == name).expect("a name");
        entry.values = vec![value];
        self
    }

    /// The outcome of `text`.
    pub(crate) fn outcome(&self, text: &str) -> Outcome {
        let place = Placed::new(text, self);
        let evaluated = place.read(text, self, ANY).and_then(|expression| expression.evaluate(self));
        evaluated.unwrap_or_else(|errors| panic!("{}", base::render(&place.sources, &errors)))
    }

    /// The answer to `text`, which is wrong or has no value.
    pub(crate) fn answer(&self, text: &str, wanted: WantedTypes<'_>) -> String {
        let place = Placed::new(text, self);
        match place.read(text, self, wanted).and_then(|expression| expression.evaluate(self)) {
            Ok(outcome) => panic!("{text} is {}", outcome.value),
            Err(errors) => base::render(&place.sources, &errors),
        }
    }

    fn symbol(&self, at: usize) -> Symbol {
        let Entry { name, ty, list, origin, .. } = self.entries[at];
        let declared = match origin {
            Origin::Fact | Origin::View | Origin::Device => Span::NONE,
            _ => declaration(name, &self.file()),
        };
        Symbol { id: u32::try_from(at).expect("few"), ty, list, origin, declared }
    }

    /// A file that declares every name on a line of its own.
    fn file(&self) -> String {
        self.entries.iter().map(|entry| format!("{}\n", entry.name)).collect()
    }
}

/// Where the line of `name` stands in a file of names.
fn declaration(name: &str, file: &str) -> Span {
    let at = file.find(&format!("{name}\n")).expect("its line");
    Span::new(0, u32::try_from(at).expect("short"), u32::try_from(at + name.len()).expect("short"))
}

/// An expression that stands in a file, below the names.
struct Placed {
    sources: Sources,
    span: Span,
}

impl Placed {
    fn new(text: &str, world: &World) -> Placed {
        let mut file = world.file();
        file.push_str("value: \"");
        let start = u32::try_from(file.len()).expect("short");
        file.push_str(text);
        let end = u32::try_from(file.len()).expect("short");
        file.push('"');
        let mut sources = Sources::default();
        sources.add("p.ron", "p.ron", file);
        Placed { sources, span: Span::new(0, start, end) }
    }

    fn read(&self, text: &str, world: &World, wanted: WantedTypes<'_>) -> Result<Expression, Vec<base::Diagnostic>> {
        Expression::new(text, self.span, world, wanted)
    }
}

impl Declarations for World {
    fn find(&self, name: &str) -> NameMeaning {
        match self.entries.iter().position(|entry| entry.name == name) {
            Some(at) => NameMeaning::Symbol(self.symbol(at)),
            None if self.broken.contains(&name) => NameMeaning::Reported,
            None => NameMeaning::Unknown,
        }
    }

    fn names(&self) -> Vec<&str> {
        self.entries.iter().map(|entry| entry.name).collect()
    }

    fn choices(&self, id: u32) -> Option<Vec<&str>> {
        self.entries[id as usize].choices.clone()
    }
}

impl Values for World {
    fn value(&self, id: u32) -> Result<Value, MissingValue> {
        Ok(self.entries[id as usize].values[0].clone())
    }

    fn length(&self, id: u32) -> Result<u64, MissingValue> {
        Ok(self.entries[id as usize].values.len() as u64)
    }

    fn element(&self, id: u32, at: u64) -> Result<Value, MissingValue> {
        Ok(self.entries[id as usize].values[usize::try_from(at).expect("few")].clone())
    }

    /// Images are half as wide as the one before and a quarter as high; number 7 was reported, number 9 stands below.
    fn property(&self, image: ImageIndex, property: Property) -> Result<i64, MissingValue> {
        Ok(match (image.0, property) {
            (7, _) => return Err(MissingValue::Reported),
            (9, _) => return Err(MissingValue::Below(declaration("later", &self.file()))),
            (at, Property::Width) => 1920 >> at,
            (at, Property::Height) => 1024 >> (2 * at),
            (at, Property::Mips) => i64::from(at) + 1,
            (_, Property::Layers) => 6,
            (_, Property::Samples) => 4,
        })
    }

    fn decided_by(&self, id: u32) -> &[Decision] {
        if self.entries[id as usize].name == "strength" { &self.strength_decided_by } else { &[] }
    }

    fn property_decided_by(&self, _: ImageIndex, property: Property) -> &[Decision] {
        if property == Property::Samples { &self.strength_decided_by } else { &[] }
    }
}
