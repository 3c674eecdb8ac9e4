//! Where in a rig file a key stands, so that every refusal can name the line.

use std::{collections::BTreeMap, fmt, ops::Range};
use toml::de::{DeTable, DeValue};

/// A place in a rig file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file as the user named it.
    pub file: String,
    /// The line, from 1; `None` for a key that isn't in the file, so that its default holds.
    pub line: Option<usize>,
    /// The key, with the tables around it: `hinge[0].sma.target`. Empty for the whole file.
    pub key: String,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.line, self.key.as_str()) {
            (Some(line), "") => write!(f, "{}:{line}", self.file),
            (Some(line), key) => write!(f, "{}:{line}: {key}", self.file),
            (None, "") => write!(f, "{}", self.file),
            (None, key) => write!(f, "{}: {key}", self.file),
        }
    }
}

/// The line of every key of a rig file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Places {
    file: String,
    lines: BTreeMap<String, usize>,
}

impl Places {
    /// Notes where each key of `table`, parsed from `text`, stands.
    pub(super) fn new(file: &str, text: &str, table: &DeTable<'_>) -> Self {
        let mut lines = BTreeMap::new();
        note_table(&mut lines, text, "", table);
        Self { file: file.to_owned(), lines }
    }

    /// The place of a key.
    pub(super) fn of(&self, key: impl Into<String>) -> Place {
        let key = key.into();
        Place { file: self.file.clone(), line: self.lines.get(&key).copied(), key }
    }

    /// The place of the first of some keys that is in the file; else of the last, which then has its default.
    pub(super) fn of_first(&self, keys: &[String]) -> Place {
        let present = keys.iter().find(|key| self.lines.contains_key(*key));
        self.of(present.or(keys.last()).cloned().unwrap_or_default())
    }
}

/// The line, from 1, in which a span of `text` begins.
pub(super) fn line_of(text: &str, span: &Range<usize>) -> usize {
    1 + text.bytes().take(span.start).filter(|byte| *byte == b'\n').count()
}

fn note_table(lines: &mut BTreeMap<String, usize>, text: &str, prefix: &str, table: &DeTable<'_>) {
    for (key, value) in table {
        let path =
            if prefix.is_empty() { key.get_ref().to_string() } else { format!("{prefix}.{}", key.get_ref()) };
        lines.insert(path.clone(), line_of(text, &key.span()));
        match value.get_ref() {
            DeValue::Table(inner) => note_table(lines, text, &path, inner),
            DeValue::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    let path = format!("{path}[{index}]");
                    lines.insert(path.clone(), line_of(text, &item.span()));
                    if let DeValue::Table(inner) = item.get_ref() {
                        note_table(lines, text, &path, inner);
                    }
                }
            }
            _ => {}
        }
    }
}
