//! One entry of an array of a plan file, read without a tree of values: numbers, short rows of numbers and short words
//! take no memory of their own. Whatever else stands there is kept as it is, for the message.

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::Value;
use std::fmt;

/// The longest row of numbers that needs no memory of its own: the vertices of a face.
const SHORT_ROW: usize = 4;
/// The longest word that an entry of a plan has: `bridge`.
const LONGEST_WORD: usize = 6;

/// A number as it was written.
#[derive(Debug, Clone, Copy)]
pub(super) enum Number {
    Natural(u64),
    Negative(i64),
    Real(f64),
}

impl Number {
    /// A number below a limit.
    pub(super) fn index(self) -> Option<usize> {
        match self {
            Self::Natural(number) => usize::try_from(number).ok(),
            Self::Negative(_) | Self::Real(_) => None,
        }
    }

    /// An integer, written as one.
    pub(super) fn integer(self) -> Option<i64> {
        match self {
            Self::Natural(number) => i64::try_from(number).ok(),
            Self::Negative(number) => Some(number),
            Self::Real(_) => None,
        }
    }

    /// The value, however it is written.
    pub(super) fn real(self) -> f64 {
        match self {
            Self::Natural(number) => number as f64,
            Self::Negative(number) => number as f64,
            Self::Real(number) => number,
        }
    }

    fn value(self) -> Value {
        match self {
            Self::Natural(number) => number.into(),
            Self::Negative(number) => number.into(),
            Self::Real(number) => number.into(),
        }
    }
}

/// An entry.
#[derive(Debug, Clone)]
pub(super) enum Entry {
    Number(Number),
    Row([Number; SHORT_ROW], usize),
    LongRow(Vec<Number>),
    Word([u8; LONGEST_WORD], usize),
    Other(Value),
}

impl Entry {
    /// The number, where it is one.
    pub(super) fn number(&self) -> Option<Number> {
        if let Self::Number(number) = self { Some(*number) } else { None }
    }

    /// The row of numbers, where it is one.
    pub(super) fn row(&self) -> Option<&[Number]> {
        match self {
            Self::Row(numbers, length) => Some(&numbers[..*length]),
            Self::LongRow(numbers) => Some(numbers),
            Self::Number(_) | Self::Word(..) | Self::Other(_) => None,
        }
    }

    /// The word, where it is a short one.
    pub(super) fn word(&self) -> Option<&[u8]> {
        if let Self::Word(bytes, length) = self { Some(&bytes[..*length]) } else { None }
    }

    /// The entry as JSON has it.
    pub(super) fn value(&self) -> Value {
        match self {
            Self::Number(number) => number.value(),
            Self::Row(numbers, length) => numbers[..*length].iter().map(|number| number.value()).collect(),
            Self::LongRow(numbers) => numbers.iter().map(|number| number.value()).collect(),
            Self::Word(bytes, length) => String::from_utf8_lossy(&bytes[..*length]).into(),
            Self::Other(value) => value.clone(),
        }
    }
}

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EntryVisitor)
    }
}

struct EntryVisitor;

impl<'de> Visitor<'de> for EntryVisitor {
    type Value = Entry;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_u64<E>(self, number: u64) -> Result<Entry, E> {
        Ok(Entry::Number(Number::Natural(number)))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Entry, E> {
        Ok(Entry::Number(Number::Negative(number)))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Entry, E> {
        Ok(Entry::Number(Number::Real(number)))
    }

    fn visit_bool<E>(self, truth: bool) -> Result<Entry, E> {
        Ok(Entry::Other(truth.into()))
    }

    fn visit_unit<E>(self) -> Result<Entry, E> {
        Ok(Entry::Other(Value::Null))
    }

    fn visit_str<E>(self, text: &str) -> Result<Entry, E> {
        let mut bytes = [0; LONGEST_WORD];
        Ok(match bytes.get_mut(..text.len()) {
            Some(place) => {
                place.copy_from_slice(text.as_bytes());
                Entry::Word(bytes, text.len())
            }
            None => Entry::Other(text.into()),
        })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Entry, A::Error> {
        let mut short = [Number::Natural(0); SHORT_ROW];
        let mut length = 0;
        let mut long = Vec::new();
        while let Some(entry) = list.next_element::<Entry>()? {
            let Some(number) = entry.number() else {
                let before = if long.is_empty() { &short[..length] } else { &long[..] };
                let mut values: Vec<Value> = before.iter().map(|number| number.value()).collect();
                values.push(entry.value());
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                return Ok(Entry::Other(values.into()));
            };
            if let Some(place) = short.get_mut(length) {
                *place = number;
                length += 1;
            } else {
                if long.is_empty() {
                    long.extend_from_slice(&short);
                }
                long.push(number);
            }
        }
        Ok(if long.is_empty() { Entry::Row(short, length) } else { Entry::LongRow(long) })
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entry, A::Error> {
        let mut object = serde_json::Map::new();
        while let Some((key, value)) = map.next_entry()? {
            object.insert(key, value);
        }
        Ok(Entry::Other(object.into()))
    }
}
