//! Reads the text of a coded sequence. What it takes is a tree of hinges with every bridge at both ends, at most one hinge a
//! side; whether the shape it makes is free of overlaps is for `check` to say.

use super::error::{Place, SequenceError, SequenceProblem};
use super::{Column, Layer, Mounted, Sequence};
use crate::plan::Side;
use crate::sets::Sets;
use std::collections::BTreeMap;

/// A sequence with the places of its panels in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SequenceText {
    /// The sequence.
    pub sequence: Sequence,
    /// For each column the place of its cell.
    pub columns: Vec<Place>,
    /// For each panel of each column its place.
    pub layers: Vec<Vec<Place>>,
}

impl SequenceText {
    /// Reads a text.
    ///
    /// # Errors
    /// The first thing that is wrong, with its line and column.
    pub fn parse(text: &str) -> Result<Self, SequenceError> {
        let empty = Sequence { columns: Vec::new() };
        let mut read = Self { sequence: empty, columns: Vec::new(), layers: Vec::new() };
        for (index, line) in text.lines().enumerate() {
            let mut cursor = Cursor { rest: line, place: Place { line: index + 1, column: 1 } };
            cursor.skip_blanks();
            if !cursor.rest.is_empty() && !cursor.rest.starts_with('#') {
                read.push_line(&mut cursor)?;
            }
        }
        if read.columns.is_empty() {
            let line = text.lines().count().max(1);
            return Err(SequenceError { place: Place { line, column: 1 }, problem: SequenceProblem::Empty });
        }
        read.check_heights()?;
        read.check_root()?;
        read.check_sides()?;
        read.check_bridges()?;
        read.check_tree()?;
        Ok(read)
    }

    fn push_line(&mut self, cursor: &mut Cursor<'_>) -> Result<(), SequenceError> {
        let start = cursor.place;
        cursor.expect('(', "a cell such as `(0,0):`, or a comment after `#`")?;
        let i = cursor.coordinate()?;
        cursor.expect(',', "`,` and the cell's second number")?;
        let j = cursor.coordinate()?;
        cursor.expect(')', "`)` after the cell's numbers")?;
        cursor.expect(':', "`:` after the cell")?;
        let (mut layers, mut places) = (Vec::new(), Vec::new());
        let mut ended = false;
        cursor.skip_blanks();
        while !cursor.rest.is_empty() {
            if ended {
                return Err(SequenceError { place: cursor.place, problem: SequenceProblem::Top });
            }
            places.push(cursor.place);
            let (layer, top) = cursor.layer()?;
            layers.push(layer);
            ended = top;
        }
        if !ended {
            return Err(SequenceError { place: cursor.place, problem: SequenceProblem::Top });
        }
        self.sequence.columns.push(Column { cell: [i, j], layers });
        self.columns.push(start);
        self.layers.push(places);
        Ok(())
    }

    fn check_heights(&self) -> Result<(), SequenceError> {
        let expected = self.layers[0].len();
        let mut lines = BTreeMap::new();
        for (column, place) in self.sequence.columns.iter().zip(&self.columns) {
            let [i, j] = column.cell;
            let fail = |problem| Err(SequenceError { place: *place, problem });
            if let Some(first) = lines.insert(column.cell, place.line) {
                return fail(SequenceProblem::CellTwice { i, j, first });
            }
            if column.layers.len() != expected {
                return fail(SequenceProblem::Height { expected, found: column.layers.len() });
            }
        }
        Ok(())
    }

    fn check_root(&self) -> Result<(), SequenceError> {
        let all = self.sequence.columns.iter().flat_map(|column| &column.layers);
        let mut roots = all.zip(self.layers.iter().flatten()).filter(|(layer, _)| layer.root);
        match (roots.next(), roots.next()) {
            (Some((_, first)), Some((_, second))) => {
                Err(SequenceError { place: *second, problem: SequenceProblem::RootTwice { first: *first } })
            }
            _ => Ok(()),
        }
    }

    fn check_sides(&self) -> Result<(), SequenceError> {
        for (column, places) in self.sequence.columns.iter().zip(&self.layers) {
            let mut below = None;
            for (height, layer) in column.layers.iter().enumerate() {
                let mut taken = [false; 4];
                let hinges = below.iter().chain(&layer.bridges).chain(&layer.above);
                for Mounted { side, .. } in hinges {
                    if std::mem::replace(&mut taken[*side as usize], true) {
                        let problem = SequenceProblem::SideTwice { side: side.letter(), height };
                        return Err(SequenceError { place: places[height], problem });
                    }
                }
                below = layer.above;
            }
        }
        Ok(())
    }

    fn check_bridges(&self) -> Result<(), SequenceError> {
        let on_cell = self.sequence.on_cell();
        for (column, places) in self.sequence.columns.iter().zip(&self.layers) {
            for (height, layer) in column.layers.iter().enumerate() {
                for bridge in &layer.bridges {
                    let fail = |problem| Err(SequenceError { place: places[height], problem });
                    let [i, j] = super::walk::beyond(column.cell, bridge.side);
                    let Some(other) = on_cell.get(&[i, j]) else {
                        return fail(SequenceProblem::NoPile { i, j });
                    };
                    let expected = Mounted { side: bridge.side.opposite(), ..*bridge };
                    if !self.sequence.columns[*other].layers[height].bridges.contains(&expected) {
                        let (mounted, expected) = (bridge.to_string(), expected.to_string());
                        return fail(SequenceProblem::OneSided { mounted, i, j, height, expected });
                    }
                }
            }
        }
        Ok(())
    }

    fn check_tree(&self) -> Result<(), SequenceError> {
        let (height, panels) = (self.layers[0].len(), self.sequence.panels());
        let mut groups = Sets::new(panels);
        let place = |panel: usize| self.layers[panel / height][panel % height];
        for joint in self.sequence.joints() {
            let [a, b] = joint.panels;
            if !groups.join(a, b) {
                let place = place(joint.panels[0]);
                return Err(SequenceError { place, problem: SequenceProblem::Loop });
            }
        }
        let apart = (0..panels).find(|panel| groups.find(*panel) != groups.find(0));
        apart.map_or(Ok(()), |panel| {
            Err(SequenceError { place: place(panel), problem: SequenceProblem::Apart })
        })
    }
}

/// What is left of a line, and where it begins.
struct Cursor<'a> {
    rest: &'a str,
    place: Place,
}

impl Cursor<'_> {
    fn advance(&mut self, characters: usize) {
        let end = self.rest.char_indices().nth(characters).map_or(self.rest.len(), |(at, _)| at);
        self.rest = &self.rest[end..];
        self.place.column += characters;
    }

    fn skip_blanks(&mut self) {
        self.advance(self.rest.chars().take_while(|c| c.is_whitespace()).count());
    }

    fn take(&mut self, character: char) -> bool {
        let there = self.rest.starts_with(character);
        if there {
            self.advance(1);
        }
        there
    }

    fn expect(&mut self, character: char, expected: &'static str) -> Result<(), SequenceError> {
        if self.take(character) { Ok(()) } else { Err(self.syntax(expected)) }
    }

    fn syntax(&self, expected: &'static str) -> SequenceError {
        let word: String = self.rest.chars().take_while(|c| !c.is_whitespace()).take(12).collect();
        let found = if word.is_empty() { "the end of the line".into() } else { format!("`{word}`") };
        SequenceError { place: self.place, problem: SequenceProblem::Syntax { expected, found } }
    }

    fn coordinate(&mut self) -> Result<i32, SequenceError> {
        let count = self.rest.chars().take_while(|c| c.is_ascii_digit() || *c == '-').count();
        let number = self.rest[..count].parse().map_err(|_| self.syntax("a whole number"))?;
        self.advance(count);
        Ok(number)
    }

    /// One panel, and whether it is the top one.
    fn layer(&mut self) -> Result<(Layer, bool), SequenceError> {
        let mut layer = Layer { root: self.take('*'), ..Layer::default() };
        while self.take('[') {
            layer.bridges.push(self.mounted()?);
            self.expect(']', "`]` after a bridge")?;
        }
        layer.bridges.sort_unstable();
        let top = self.take('.');
        if !top && !self.take('/') {
            layer.above = Some(self.mounted()?);
        }
        if !self.rest.is_empty() && !self.rest.starts_with(char::is_whitespace) {
            return Err(self.syntax("a blank between panels"));
        }
        self.skip_blanks();
        Ok((layer, top))
    }

    fn mounted(&mut self) -> Result<Mounted, SequenceError> {
        const HINGE: &str = "a side E, N, W or S with an angle 90, 180 or 270, as in `N270`";
        let hinge =
            Side::ALL.into_iter().find(|side| self.rest.starts_with(side.letter())).and_then(|side| {
                let digits: String = self.rest.chars().skip(1).take_while(char::is_ascii_digit).collect();
                let opening_deg = digits.parse().ok().filter(|angle| matches!(angle, 90 | 180 | 270))?;
                Some((Mounted { side, opening_deg }, 1 + digits.len()))
            });
        let (mounted, length) = hinge.ok_or_else(|| self.syntax(HINGE))?;
        self.advance(length);
        Ok(mounted)
    }
}
