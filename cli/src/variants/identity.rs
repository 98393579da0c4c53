//! Whether two Plans are the same, or the same but for values, by hashes of all that they hold.

use framewright_graph::plan::{DeviceUsed, Plan};
use serde::ser::{
    Serialize, SerializeMap, SerializeSeq, SerializeStruct, SerializeStructVariant, SerializeTuple,
    SerializeTupleStruct, SerializeTupleVariant, Serializer,
};
use std::fmt;
use std::hash::{DefaultHasher, Hash, Hasher};

/// What a Plan is known by: hashes of all of it but what it is named for, the texts of settings and the device's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Identity {
    /// The same for the same Plan.
    pub(crate) plan: u64,
    /// The same for Plans that differ in [`VALUES`] alone.
    pub(crate) shape: u64,
}

/// Fields that say how much, and not what is done: parameters and what is filled in, clear values, counts of workgroups.
const VALUES: [&str; 3] = ["value", "clear", "groups"];

/// What a Plan is known by.
#[must_use]
pub(super) fn of(plan: &Plan) -> Identity {
    let Plan {
        format_version: _,
        device,
        settings: _,
        changes: _,
        stereo,
        views,
        images,
        buffers,
        heaps,
        steps,
        outputs,
        notes,
        totals,
    } = plan;
    let DeviceUsed { name: _, exact_memory } = device;
    let mut hashing = Hashing::default();
    // A Plan of which a part can't be written is known by the parts before it.
    let _ =
        (exact_memory, stereo, views, images, buffers, heaps, steps, outputs, notes, totals).serialize(&mut hashing);
    Identity { plan: hashing.whole.finish(), shape: hashing.shape.finish() }
}

/// Takes what is written into a hash. Names of fields are left out, since their order says the same; what has any number of
/// members ends with a mark, and what may be there or not begins with one.
#[derive(Default)]
struct Hashing {
    whole: DefaultHasher,
    /// Of all but values.
    shape: DefaultHasher,
    /// Whether a value is being written.
    in_value: bool,
}

const END: u8 = 0xfe;

impl Hashing {
    fn put(&mut self, value: impl Hash) -> Result<(), fmt::Error> {
        value.hash(&mut self.whole);
        if !self.in_value {
            value.hash(&mut self.shape);
        }
        Ok(())
    }
}

macro_rules! hashed {
    ($($name:ident: $type:ty),* $(,)?) => {
        $(fn $name(self, value: $type) -> Result<(), fmt::Error> {
            self.put(value)
        })*
    };
}

impl Serializer for &mut Hashing {
    type Ok = ();
    type Error = fmt::Error;
    type SerializeSeq = Self;
    type SerializeTuple = Self;
    type SerializeTupleStruct = Self;
    type SerializeTupleVariant = Self;
    type SerializeMap = Self;
    type SerializeStruct = Self;
    type SerializeStructVariant = Self;

    fn is_human_readable(&self) -> bool {
        false
    }

    hashed! {
        serialize_bool: bool, serialize_char: char, serialize_str: &str, serialize_bytes: &[u8],
        serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64, serialize_i128: i128,
        serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64, serialize_u128: u128,
    }

    fn serialize_f32(self, value: f32) -> Result<(), fmt::Error> {
        self.put(value.to_bits())
    }

    fn serialize_f64(self, value: f64) -> Result<(), fmt::Error> {
        self.put(value.to_bits())
    }

    fn serialize_none(self) -> Result<(), fmt::Error> {
        self.put(false)
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), fmt::Error> {
        self.put(true)?;
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<(), fmt::Error> {
        Ok(())
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<(), fmt::Error> {
        Ok(())
    }

    fn serialize_unit_variant(self, _: &'static str, variant: u32, _: &'static str) -> Result<(), fmt::Error> {
        self.put(variant)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Result<(), fmt::Error> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        variant: u32,
        _: &'static str,
        value: &T,
    ) -> Result<(), fmt::Error> {
        self.put(variant)?;
        value.serialize(self)
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Self, fmt::Error> {
        Ok(self)
    }

    fn serialize_tuple(self, _: usize) -> Result<Self, fmt::Error> {
        Ok(self)
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self, fmt::Error> {
        Ok(self)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        variant: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self, fmt::Error> {
        self.put(variant)?;
        Ok(self)
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Self, fmt::Error> {
        Ok(self)
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Self, fmt::Error> {
        Ok(self)
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        variant: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self, fmt::Error> {
        self.put(variant)?;
        Ok(self)
    }
}

impl SerializeSeq for &mut Hashing {
    type Ok = ();
    type Error = fmt::Error;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), fmt::Error> {
        // As before what may be there or not.
        self.put(true)?;
        value.serialize(&mut **self)
    }

    fn end(self) -> Result<(), fmt::Error> {
        self.put(END)
    }
}

impl SerializeMap for &mut Hashing {
    type Ok = ();
    type Error = fmt::Error;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), fmt::Error> {
        self.put(true)?;
        key.serialize(&mut **self)
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), fmt::Error> {
        value.serialize(&mut **self)
    }

    fn end(self) -> Result<(), fmt::Error> {
        self.put(END)
    }
}

macro_rules! members_alone {
    ($($trait:ident: $member:ident($($name:ident)?)),* $(,)?) => {
        $(impl $trait for &mut Hashing {
            type Ok = ();
            type Error = fmt::Error;

            fn $member<T: Serialize + ?Sized>(&mut self, $($name: &'static str,)? value: &T) -> Result<(), fmt::Error> {
                value.serialize(&mut **self)
            }

            fn end(self) -> Result<(), fmt::Error> {
                Ok(())
            }
        })*
    };
}

members_alone! {
    SerializeTuple: serialize_element(),
    SerializeTupleStruct: serialize_field(),
    SerializeTupleVariant: serialize_field(),
    SerializeStructVariant: serialize_field(_name),
}

impl SerializeStruct for &mut Hashing {
    type Ok = ();
    type Error = fmt::Error;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), fmt::Error> {
        let outside = self.in_value;
        self.in_value |= VALUES.contains(&name);
        value.serialize(&mut **self)?;
        self.in_value = outside;
        Ok(())
    }

    fn end(self) -> Result<(), fmt::Error> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hash(value: &impl Serialize) -> u64 {
        let mut hashing = Hashing::default();
        value.serialize(&mut hashing).expect("it can be written");
        assert_eq!(hashing.whole.finish(), hashing.shape.finish());
        hashing.whole.finish()
    }

    #[test]
    fn values_differ_and_leave_the_shape() {
        #[derive(serde::Serialize)]
        struct Param {
            name: &'static str,
            value: f32,
            after: u8,
        }
        let hashes = |name, value, after| {
            let mut hashing = Hashing::default();
            Param { name, value, after }.serialize(&mut hashing).expect("it can be written");
            (hashing.whole.finish(), hashing.shape.finish())
        };
        let (whole, shape) = hashes("a", 1.0, 1);
        assert!(hashes("a", 2.0, 1).0 != whole && hashes("a", 2.0, 1).1 == shape);
        assert!(hashes("b", 1.0, 1).1 != shape && hashes("a", 1.0, 2).1 != shape);
    }

    #[test]
    fn what_differs_has_another_hash_wherever_its_parts_end() {
        let lists =
            [vec![vec![1_u8], vec![2, 3]], vec![vec![1, 2], vec![3]], vec![vec![1, 2, 3]], vec![vec![], vec![1, 2, 3]]];
        let texts = [["a", "bc"], ["ab", "c"], ["", "abc"]];
        let options = [[Some(0_u8), None], [None, Some(0)], [None, None], [Some(0), Some(0)]];
        let mut all: Vec<u64> = lists.iter().map(hash).collect();
        all.extend(texts.iter().map(hash));
        all.extend(options.iter().map(hash));
        all.extend([hash(&0.0_f32), hash(&-0.0_f32), hash(&Ok::<u8, u8>(1)), hash(&Err::<u8, u8>(1))]);
        let distinct: std::collections::BTreeSet<u64> = all.iter().copied().collect();
        assert_eq!(distinct.len(), all.len());
        assert_eq!(hash(&lists[0]), hash(&lists[0].clone()));
    }
}
