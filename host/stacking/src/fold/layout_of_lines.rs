//! How the JSON of a plan is broken into lines: one for each key of the file, so that a person finds a key and a diff
//! shows which one changed.

use serde_json::ser::Formatter;
use std::io;

/// A line for each key of the outermost object; everything within is compact.
#[derive(Default)]
pub(super) struct KeyALine {
    depth: usize,
}

impl KeyALine {
    fn breaks(&self) -> bool {
        self.depth == 1
    }

    fn line<W: ?Sized + io::Write>(&self, writer: &mut W) -> io::Result<()> {
        if self.breaks() { writer.write_all(b"\n") } else { Ok(()) }
    }
}

impl Formatter for KeyALine {
    fn begin_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth += 1;
        writer.write_all(b"{")
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.line(writer)?;
        self.depth -= 1;
        writer.write_all(b"}")
    }

    fn begin_object_key<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if !first {
            writer.write_all(b",")?;
        }
        self.line(writer)
    }
}
