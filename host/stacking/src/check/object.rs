//! An object that stands in an array of a plan file: the keys that it should have, without a map, and the rest for the
//! message.

use super::entry::Entry;
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};
use std::fmt;
use std::marker::PhantomData;

/// Most keys that any of the objects has.
const MOST: usize = 4;

/// The keys of one kind of object, [`MOST`] at most.
pub(super) trait Keys {
    /// The keys.
    const KEYS: &'static [&'static str];
}

/// An object, or what stands in its place.
pub(super) struct Object<K> {
    fields: [Option<Entry>; MOST],
    rest: Map<String, Value>,
    other: Option<Value>,
    keys: PhantomData<K>,
}

impl<K: Keys> Object<K> {
    fn of(fields: [Option<Entry>; MOST], rest: Map<String, Value>, other: Option<Value>) -> Self {
        Self { fields, rest, other, keys: PhantomData }
    }

    fn no_object(value: Value) -> Self {
        Self::of([const { None }; MOST], Map::new(), Some(value))
    }

    /// What stands under a key, by the key's place among the keys.
    pub(super) fn field(&self, key: usize) -> Option<&Entry> {
        self.fields[key].as_ref()
    }

    /// The object as JSON has it.
    pub(super) fn value(&self) -> Value {
        self.other.clone().unwrap_or_else(|| {
            let mut object = self.rest.clone();
            for (key, field) in K::KEYS.iter().zip(&self.fields) {
                object.extend(field.iter().map(|entry| ((*key).to_owned(), entry.value())));
            }
            object.into()
        })
    }
}

impl<'de, K: Keys> Deserialize<'de> for Object<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ObjectVisitor(PhantomData))
    }
}

/// A key: its place among the known ones, or its name.
struct Key<K>(Result<usize, String>, PhantomData<K>);

impl<'de, K: Keys> Deserialize<'de> for Key<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_str(KeyVisitor(PhantomData))
    }
}

struct KeyVisitor<K>(PhantomData<K>);

impl<K: Keys> Visitor<'_> for KeyVisitor<K> {
    type Value = Key<K>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E>(self, name: &str) -> Result<Key<K>, E> {
        let place = K::KEYS.iter().position(|key| *key == name);
        Ok(Key(place.ok_or_else(|| name.to_owned()), PhantomData))
    }
}

struct ObjectVisitor<K>(PhantomData<K>);

impl<'de, K: Keys> Visitor<'de> for ObjectVisitor<K> {
    type Value = Object<K>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Object<K>, A::Error> {
        let mut fields = [const { None }; MOST];
        let mut rest = Map::new();
        while let Some(Key(key, _)) = map.next_key::<Key<K>>()? {
            match key {
                Ok(place) => fields[place] = Some(map.next_value()?),
                Err(name) => {
                    rest.insert(name, map.next_value()?);
                }
            }
        }
        Ok(Object::of(fields, rest, None))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Object<K>, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = list.next_element::<Value>()? {
            values.push(value);
        }
        Ok(Object::no_object(values.into()))
    }

    fn visit_bool<E>(self, truth: bool) -> Result<Object<K>, E> {
        Ok(Object::no_object(truth.into()))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Object<K>, E> {
        Ok(Object::no_object(number.into()))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Object<K>, E> {
        Ok(Object::no_object(number.into()))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Object<K>, E> {
        Ok(Object::no_object(number.into()))
    }

    fn visit_str<E>(self, text: &str) -> Result<Object<K>, E> {
        Ok(Object::no_object(text.into()))
    }

    fn visit_unit<E>(self) -> Result<Object<K>, E> {
        Ok(Object::no_object(Value::Null))
    }
}
