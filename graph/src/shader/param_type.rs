//! The types of parameters: which values of a pipeline file they take.

use crate::frame::{FrameValue, ParamValue};
use std::fmt;

/// The type of a parameter: a scalar, a vector or a matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParamType {
    /// The type of its components.
    pub scalar: ParamScalar,
    /// Columns of a matrix, 2 to 4; 1 for all other types.
    pub columns: u32,
    /// Components of a vector, or of a column of a matrix, 2 to 4; 1 for scalars.
    pub rows: u32,
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
    /// The type that GLSL writes so; `None`: an array, a structure, or numbers of other than 32 bits.
    #[must_use]
    pub fn of(ty: &str) -> Option<ParamType> {
        use ParamScalar::{Bool, Float, Int, Uint};
        let count = |text: &str| match text {
            "2" => Some(2),
            "3" => Some(3),
            "4" => Some(4),
            _ => None,
        };
        let scalar = [("float", Float), ("int", Int), ("uint", Uint), ("bool", Bool)];
        if let Some((_, scalar)) = scalar.into_iter().find(|(name, _)| *name == ty) {
            return Some(ParamType { scalar, columns: 1, rows: 1 });
        }
        if let Some(sides) = ty.strip_prefix("mat") {
            let (columns, rows) = sides.split_once('x').unwrap_or((sides, sides));
            return Some(ParamType { scalar: Float, columns: count(columns)?, rows: count(rows)? });
        }
        let vectors = [("vec", Float), ("ivec", Int), ("uvec", Uint), ("bvec", Bool)];
        let mut vectors = vectors.into_iter().filter_map(|(name, scalar)| Some((ty.strip_prefix(name)?, scalar)));
        vectors.next().and_then(|(rows, scalar)| Some(ParamType { scalar, columns: 1, rows: count(rows)? }))
    }

    /// The form in which a pipeline file writes such values: `(…, …)`.
    #[must_use]
    pub fn form(self) -> String {
        let list = |count: u32, of: &str| format!("({})", vec![of; count as usize].join(", "));
        let column = if self.rows == 1 { "…".to_owned() } else { list(self.rows, "…") };
        if self.columns == 1 { column } else { list(self.columns, &column) }
    }

    /// The value as this type has it: whole numbers as numbers where those are wanted.
    ///
    /// # Errors
    /// [`ParamMisfit`] says why it can't be that.
    pub fn take(self, value: &ParamValue) -> Result<ParamValue, ParamMisfit> {
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

    /// The components of a value by column, where a vector is one column, and a scalar one of one component; `None` if it has
    /// another form.
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
        }
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
    fn types_are_named_as_glsl_names_them_and_arrays_are_none() {
        for name in
            ["float", "int", "uint", "bool", "vec2", "ivec3", "uvec4", "bvec2", "mat2", "mat4", "mat2x3", "mat4x2"]
        {
            assert_eq!(ty(name).to_string(), name);
        }
        for name in ["vec5", "vec", "mat", "mat1", "mat2x", "vec4[2]", "float[3]", "double", "dvec2", "Light", ""] {
            assert_eq!(ParamType::of(name), None, "{name}");
        }
        assert_eq!(ty("int").form(), "…");
        assert_eq!(ty("vec3").form(), "(…, …, …)");
        assert_eq!(ty("mat2x3").form(), "((…, …, …), (…, …, …))");
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
        assert_eq!(ty("mat2").take(&columns), Ok(ParamValue::list([column.clone(), column])));
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
        for (name, value) in [
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
