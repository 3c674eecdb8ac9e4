//! An array of a plan file as a column of one type: entries that fit, and the text of those that don't, by index.

use serde::de::{Deserialize, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;

/// What was found is told in so many characters.
const LONGEST_TEXT: usize = 60;

/// What a visitor makes of a plain value where an array should be.
macro_rules! no_array {
    ($none:expr) => {
        fn visit_bool<E>(self, _: bool) -> Result<Self::Value, E> {
            Ok($none)
        }

        fn visit_u64<E>(self, _: u64) -> Result<Self::Value, E> {
            Ok($none)
        }

        fn visit_i64<E>(self, _: i64) -> Result<Self::Value, E> {
            Ok($none)
        }

        fn visit_f64<E>(self, _: f64) -> Result<Self::Value, E> {
            Ok($none)
        }

        fn visit_str<E>(self, _: &str) -> Result<Self::Value, E> {
            Ok($none)
        }

        fn visit_unit<E>(self) -> Result<Self::Value, E> {
            Ok($none)
        }
    };
}
pub(super) use no_array;

/// Something that stands in an array of a plan file.
pub(super) trait Item: Default {
    /// What is read from the file.
    type Read: for<'de> Deserialize<'de>;

    /// The item, unless what was read is none.
    fn of(read: &Self::Read) -> Option<Self>;

    /// What was read, as JSON has it.
    fn value(read: &Self::Read) -> Value;
}

/// The entries of an array, in order.
pub(crate) struct Column<T> {
    /// Those that fit; a default stands in the place of another.
    pub(super) entries: Vec<T>,
    /// What stands in place of the others.
    pub(super) odd: BTreeMap<usize, String>,
}

/// The value under a key: the column, or none where it is no array.
pub(super) struct Listed<T>(pub(super) Option<Column<T>>);

impl<T> Default for Listed<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<'de, T: Item> Deserialize<'de> for Listed<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ListVisitor(PhantomData))
    }
}

struct ListVisitor<T>(PhantomData<T>);

impl<'de, T: Item> Visitor<'de> for ListVisitor<T> {
    type Value = Listed<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Listed<T>, A::Error> {
        let mut column = Column { entries: Vec::new(), odd: BTreeMap::new() };
        while let Some(read) = list.next_element::<T::Read>()? {
            let item = T::of(&read);
            if item.is_none() {
                column.odd.insert(column.entries.len(), shortened(&T::value(&read)));
            }
            column.entries.push(item.unwrap_or_default());
        }
        Ok(Listed(Some(column)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Listed<T>, A::Error> {
        while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(Listed(None))
    }

    no_array!(Listed(None));
}

/// What was found, short enough for a message.
pub(super) fn shortened(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= LONGEST_TEXT {
        text
    } else {
        text.chars().take(LONGEST_TEXT).chain("...".chars()).collect()
    }
}

/// Items that are read as one plain entry.
macro_rules! plain_item {
    ($($item:ty: $of:expr;)*) => {
        $(impl Item for $item {
            type Read = Entry;

            fn of(read: &Entry) -> Option<Self> {
                let of: fn(&Entry) -> Option<$item> = $of;
                of(read)
            }

            fn value(read: &Entry) -> Value {
                read.value()
            }
        })*
    };
}
pub(super) use plain_item;
