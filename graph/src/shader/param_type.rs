//! The types of parameters: which values of a pipeline file they take.

use crate::frame::{FrameValue, ParamValue};
use std::fmt;

/// The type of a parameter: a scalar, a vector or a matrix, or an array of those.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParamType {
    /// The type of its components.
    pub scalar: ParamScalar,
    /// Columns of a matrix, 2 to 4; 1 for all other types.
    pub columns: u32,
    /// Components of a vector, or of a column of a matrix, 2 to 4; 1 for scalars.
    pub rows: u32,
    /// How many elements an array has; `None`: it is none.
    pub length: Option<u32>,
}

/// The type of a component, of 32 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParamScalar {
    /// A number.
    Float,
    /// A whole number.
    Int,
    /// A whole number from 0 on.
    Uint,
    /// A truth value.
    Bool,
}

/// Why a value has another type.
#[derive(Debug, Clone, PartialEq)]
pub enum ParamMisfit {
    /// It has another form: a single number in place of a vector, or too few components.
    Form,
    /// An array has another number of elements: this one.
    Length(usize),
    /// An element of an array has another type: its number, from 0 as shaders count, and why.
    Element(usize, Box<ParamMisfit>),
    /// A component has another type: the numbers of its column and of itself, from 1, and its value. Vectors have no column.
    Component {
        /// The column, of a matrix.
        column: Option<usize>,
        /// The component; `None`: the value is a scalar.
        row: Option<usize>,
        /// The value.
        value: ParamValue,
    },
}

impl ParamType {
    /// The type that GLSL writes so; `None`: a structure, an array of arrays, one whose length isn't written, or numbers of other than 32 bits.
    #[must_use]
    pub fn of(ty: &str) -> Option<ParamType> {
        use ParamScalar::{Bool, Float, Int, Uint};
        if let Some((element, length)) = ty.strip_suffix(']').and_then(|ty| ty.split_once('[')) {
            let length = length.parse().ok().filter(|length| *length > 0)?;
            return Some(ParamType { length: Some(length), ..ParamType::of(element)? });
        }
        let alone = |scalar, columns, rows| ParamType { scalar, columns, rows, length: None };
        let count = |text: &str| match text {
            "2" => Some(2),
            "3" => Some(3),
            "4" => Some(4),
            _ => None,
        };
        let scalar = [("float", Float), ("int", Int), ("uint", Uint), ("bool", Bool)];
        if let Some((_, scalar)) = scalar.into_iter().find(|(name, _)| *name == ty) {
            return Some(alone(scalar, 1, 1));
        }
        if let Some(sides) = ty.strip_prefix("mat") {
            let (columns, rows) = sides.split_once('x').unwrap_or((sides, sides));
            return Some(alone(Float, count(columns)?, count(rows)?));
        }
        let vectors = [("vec", Float), ("ivec", Int), ("uvec", Uint), ("bvec", Bool)];
        let mut vectors = vectors.into_iter().filter_map(|(name, scalar)| Some((ty.strip_prefix(name)?, scalar)));
        vectors.next().and_then(|(rows, scalar)| Some(alone(scalar, 1, count(rows)?)))
    }

    /// The type of an array's elements; of another type itself.
    #[must_use]
    pub const fn element(self) -> ParamType {
        ParamType { length: None, ..self }
    }

    /// The form in which a pipeline file writes such values: `(…, …)`, and arrays `[…, …]`.
    #[must_use]
    pub fn form(self) -> String {
        if let Some(length) = self.length {
            let element = self.element().form();
            return match length {
                1 => format!("[{element}]"),
                2 => format!("[{element}, {element}]"),
                _ => format!("[{element}, {element}, …]"),
            };
        }
        let list = |count: u32, of: &str| format!("({})", vec![of; count as usize].join(", "));
        let column = if self.rows == 1 { "…".to_owned() } else { list(self.rows, "…") };
        if self.columns == 1 { column } else { list(self.columns, &column) }
    }

    /// The value as this type has it: whole numbers as numbers where those are wanted.
    ///
    /// # Errors
    /// [`ParamMisfit`] says why it can't be that.
    pub fn take(self, value: &ParamValue) -> Result<ParamValue, ParamMisfit> {
        if let Some(length) = self.length {
            let ParamValue::List(elements) = value else { return Err(ParamMisfit::Form) };
            if elements.len() != length as usize {
                return Err(ParamMisfit::Length(elements.len()));
            }
            let element = |(at, value)| {
                let taken = self.element().take(value);
                taken.map_err(|misfit| ParamMisfit::Element(at, Box::new(misfit)))
            };
            let taken: Result<Vec<_>, _> = elements.iter().enumerate().map(element).collect();
            return taken.map(ParamValue::list);
        }
        let columns = self.columns_of(value).ok_or(ParamMisfit::Form)?;
        let mut taken = Vec::with_capacity(columns.len());
        for (column, components) in columns.iter().enumerate() {
            let mut list = Vec::with_capacity(components.len());
            for (row, component) in components.iter().enumerate() {
                let misfit = || ParamMisfit::Component {
                    column: (self.columns > 1).then_some(column + 1),
                    row: (self.rows > 1).then_some(row + 1),
                    value: component.clone(),
                };
                list.push(self.scalar.take(component).ok_or_else(misfit)?);
            }
            taken.push(list);
        }
        let vector = |mut list: Vec<ParamValue>| match list.pop() {
            Some(scalar) if self.rows == 1 => scalar,
            last => ParamValue::list(list.into_iter().chain(last)),
        };
        let mut vectors: Vec<ParamValue> = taken.into_iter().map(vector).collect();
        Ok(match vectors.pop() {
            Some(vector) if self.columns == 1 => vector,
            last => ParamValue::list(vectors.into_iter().chain(last)),
        })
    }

    /// The elements of an array's value, and of another one itself; `None` if it has another form.
    #[must_use]
    pub fn elements_of(self, value: &ParamValue) -> Option<&[ParamValue]> {
        match (self.length, value) {
            (None, one) => Some(std::slice::from_ref(one)),
            (Some(length), ParamValue::List(elements)) => Some(&**elements).filter(|it| it.len() == length as usize),
            (Some(_), _) => None,
        }
    }

    /// The components of an element's value by column, where a vector is one column, and a scalar one of one component; `None` if it
    /// has another form.
    #[must_use]
    pub fn columns_of(self, value: &ParamValue) -> Option<Vec<&[ParamValue]>> {
        let columns: &[ParamValue] = match value {
            ParamValue::List(columns) if self.columns > 1 => columns,
            _ if self.columns > 1 => return None,
            one => std::slice::from_ref(one),
        };
        let columns: Option<Vec<_>> = columns.iter().map(|column| column_of(column, self.rows)).collect();
        columns.filter(|columns| columns.len() == self.columns as usize)
    }
}

/// The components of a vector of so many, or the scalar as one.
fn column_of(value: &ParamValue, rows: u32) -> Option<&[ParamValue]> {
    let components: &[ParamValue] = match value {
        ParamValue::List(components) if rows > 1 => components,
        scalar => std::slice::from_ref(scalar),
    };
    (components.len() == rows as usize && !components.iter().any(|it| matches!(it, ParamValue::List(_))))
        .then_some(components)
}

impl ParamScalar {
    /// The value as this type has it; `None` if it doesn't fit.
    fn take(self, value: &ParamValue) -> Option<ParamValue> {
        #[allow(clippy::cast_possible_truncation, reason = "the test is whether single precision can hold it")]
        let finite = |number: f64| (number as f32).is_finite().then_some(ParamValue::Number(number));
        match (self, value) {
            (ParamScalar::Float, ParamValue::Number(number)) => finite(*number),
            #[allow(clippy::cast_precision_loss, reason = "the shader's number has fewer bits anyway")]
            (ParamScalar::Float, ParamValue::Integer(number)) => finite(*number as f64),
            (ParamScalar::Int, ParamValue::Integer(number)) => i32::try_from(*number).ok().map(|_| value.clone()),
            (ParamScalar::Uint, ParamValue::Integer(number)) => u32::try_from(*number).ok().map(|_| value.clone()),
            (ParamScalar::Int | ParamScalar::Uint | ParamScalar::Bool, ParamValue::Bool(_)) => Some(value.clone()),
            (scalar, ParamValue::OfFrame(of)) => of.fits(scalar).then(|| value.clone()),
            _ => None,
        }
    }
}

impl FrameValue {
    /// Whether it is of this type.
    #[must_use]
    pub const fn fits(self, scalar: ParamScalar) -> bool {
        match self {
            FrameValue::Frame => matches!(scalar, ParamScalar::Uint),
            FrameValue::Time => matches!(scalar, ParamScalar::Float),
        }
    }
}

/// As GLSL writes it.
impl fmt::Display for ParamType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (scalar, prefix) = match self.scalar {
            ParamScalar::Float => ("float", ""),
            ParamScalar::Int => ("int", "i"),
            ParamScalar::Uint => ("uint", "u"),
            ParamScalar::Bool => ("bool", "b"),
        };
        match (self.columns, self.rows) {
            (1, 1) => f.write_str(scalar),
            (1, rows) => write!(f, "{prefix}vec{rows}"),
            (columns, rows) if columns == rows => write!(f, "mat{columns}"),
            (columns, rows) => write!(f, "mat{columns}x{rows}"),
        }?;
        self.length.map_or(Ok(()), |length| write!(f, "[{length}]"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ParamValue::{Bool, Integer, Number};

    fn ty(name: &str) -> ParamType {
        ParamType::of(name).expect("a type")
    }

    #[test]
    fn types_are_named_as_glsl_names_them() {
        for name in [
            "float",
            "int",
            "uint",
            "bool",
            "vec2",
            "ivec3",
            "uvec4",
            "bvec2",
            "mat2",
            "mat4",
            "mat2x3",
            "mat4x2",
            "float[9]",
            "mat2x3[1]",
        ] {
            assert_eq!(ty(name).to_string(), name);
        }
        for name in [
            "vec5",
            "vec",
            "mat",
            "mat1",
            "mat2x",
            "vec4[2][3]",
            "float[0]",
            "float[]",
            "float]",
            "Light[2]",
            "double",
            "dvec2",
            "Light",
            "",
        ] {
            assert_eq!(ParamType::of(name), None, "{name}");
        }
        assert_eq!(ty("int").form(), "…");
        assert_eq!(ty("vec3").form(), "(…, …, …)");
        assert_eq!(ty("mat2x3").form(), "((…, …, …), (…, …, …))");
        assert_eq!(ty("float[1]").form(), "[…]");
        assert_eq!(ty("vec2[2]").form(), "[(…, …), (…, …)]");
        assert_eq!(ty("float[9]").form(), "[…, …, …]");
    }

    #[test]
    fn a_value_is_taken_as_its_type_has_it() {
        assert_eq!(ty("float").take(&Integer(3)), Ok(Number(3.0)));
        let mixed = ParamValue::list([Integer(1), Number(0.5)]);
        assert_eq!(ty("vec2").take(&mixed), Ok(ParamValue::list([Number(1.0), Number(0.5)])));
        let truths = ParamValue::list([Bool(true), Integer(7)]);
        assert_eq!(ty("uvec2").take(&truths), Ok(truths.clone()));
        let columns = ParamValue::list([mixed.clone(), mixed.clone()]);
        let column = ParamValue::list([Number(1.0), Number(0.5)]);
        let taken = ParamValue::list([column.clone(), column]);
        assert_eq!(ty("mat2").take(&columns), Ok(taken.clone()));
        assert_eq!(ty("vec2[2]").take(&columns), Ok(taken));
    }

    #[test]
    fn a_value_of_another_type_says_where() {
        let component = |column, row, value| Err(ParamMisfit::Component { column, row, value });
        assert_eq!(ty("int").take(&Number(0.5)), component(None, None, Number(0.5)));
        let numbers = ParamValue::list([Integer(1), Number(0.5)]);
        assert_eq!(ty("ivec2").take(&numbers), component(None, Some(2), Number(0.5)));
        let nested = ParamValue::list([
            ParamValue::list([Integer(1), Integer(2)]),
            ParamValue::list([Number(1e99), Integer(2)]),
        ]);
        assert_eq!(ty("mat2").take(&nested), component(Some(2), Some(1), Number(1e99)));
        assert_eq!(ty("float[3]").take(&numbers), Err(ParamMisfit::Length(2)));
        let second = |misfit| Err(ParamMisfit::Element(1, Box::new(misfit)));
        let wrong = ParamMisfit::Component { column: None, row: None, value: Number(0.5) };
        assert_eq!(ty("int[2]").take(&numbers), second(wrong));
        let pairs = ParamValue::list([numbers.clone(), Integer(2)]);
        assert_eq!(ty("vec2[2]").take(&pairs), second(ParamMisfit::Form));
        for (name, value) in [
            ("float[1]", Integer(1)),
            ("vec2", Integer(1)),
            ("vec3", numbers.clone()),
            ("float", numbers.clone()),
            ("mat2", numbers.clone()),
            ("vec2", nested.clone()),
            ("mat3x2", nested),
        ] {
            assert_eq!(ty(name).take(&value), Err(ParamMisfit::Form), "{name}: {value}");
        }
    }
}
