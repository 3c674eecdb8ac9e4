//! What stands in the arrays of a plan file, as far as it can be told from one entry alone.

use super::column::{Item, plain_item};
use super::entry::{Entry, Number};
use super::object::{Keys, Object};
use crate::plan::{HingeKind, Pile, Side};
use serde_json::Value;

/// Coordinates farther out than this are none that a plan has.
const FAR: f64 = 1e9;

/// Four vertices of a face.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Face(pub(super) [usize; 4]);

/// Two vertices of an edge.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Edge(pub(super) [usize; 2]);

/// A point of the lattice.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LatticePoint(pub(super) [i32; 3]);

/// An angle in degrees.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Angle(pub(super) f64);

/// The letter of an assignment; 0 is none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Letter(pub(super) u8);

/// Upper panel, lower panel, side.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Order(pub(super) [i64; 3]);

/// The panels at an edge: two at a hinge, one at a cut edge.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct EdgeFaces {
    panels: [usize; 2],
    count: usize,
}

impl EdgeFaces {
    /// The panels.
    pub(crate) fn panels(&self) -> &[usize] {
        &self.panels[..self.count]
    }
}

plain_item! {
    Face: |entry| indices(entry).map(Face);
    Edge: |entry| indices(entry).map(Edge);
    LatticePoint: |entry| Some(LatticePoint(numbers(entry, whole)?));
    Angle: |entry| entry.number().map(|number| Angle(number.real()));
    Letter: |entry| if let Some([letter]) = entry.word() { Some(Letter(*letter)) } else { None };
    Order: |entry| numbers(entry, Number::integer).map(Order);
    EdgeFaces: |entry| match entry.row()? {
        [a, b] => Some(EdgeFaces { panels: [a.index()?, b.index()?], count: 2 }),
        [a] => Some(EdgeFaces { panels: [a.index()?, 0], count: 1 }),
        _ => None,
    };
}

/// Exactly so many numbers, each read in one way.
fn numbers<T: Copy + Default, const COUNT: usize>(
    entry: &Entry,
    read: impl Fn(Number) -> Option<T>,
) -> Option<[T; COUNT]> {
    let row: &[Number; COUNT] = entry.row()?.try_into().ok()?;
    let mut found = [T::default(); COUNT];
    for (place, number) in found.iter_mut().zip(row) {
        *place = read(*number)?;
    }
    Some(found)
}

fn indices<const COUNT: usize>(entry: &Entry) -> Option<[usize; COUNT]> {
    numbers(entry, Number::index)
}

/// A whole number, however it is written.
fn whole(number: Number) -> Option<i32> {
    let number = number.real();
    #[expect(clippy::cast_possible_truncation, reason = "whole and within +-1e9, as just tested")]
    let whole = (number.fract() == 0.0 && number.abs() < FAR).then_some(number as i32);
    whole
}

/// An entry of `zygote:hinges`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HingeEntry {
    pub(crate) kind: HingeKind,
    pub(crate) panels: [usize; 2],
    pub(crate) side: Side,
    pub(crate) opening_deg: u16,
}

impl Default for HingeEntry {
    fn default() -> Self {
        Self { kind: HingeKind::Fold, panels: [0; 2], side: Side::E, opening_deg: 180 }
    }
}

/// The keys of a hinge's entry.
pub(super) struct HingeKeys;

impl Keys for HingeKeys {
    const KEYS: &'static [&'static str] = &["kind", "panels", "side", "opening_deg"];
}

impl Item for HingeEntry {
    type Read = Object<HingeKeys>;

    fn of(read: &Self::Read) -> Option<Self> {
        let kind = match read.field(0)?.word()? {
            b"fold" => HingeKind::Fold,
            b"bridge" => HingeKind::Bridge,
            _ => return None,
        };
        let panels = indices(read.field(1)?)?;
        let letter = read.field(2)?.word()?;
        let side = Side::ALL.into_iter().find(|side| side.letter().as_bytes() == letter)?;
        let opening = read.field(3)?.number()?.real();
        let is_opening = |degrees: &u16| f64::from(*degrees).total_cmp(&opening).is_eq();
        let opening_deg = [90, 180, 270].into_iter().find(is_opening)?;
        Some(Self { kind, panels, side, opening_deg })
    }

    fn value(read: &Self::Read) -> Value {
        read.value()
    }
}

/// The keys of a pile's entry.
pub(super) struct PileKeys;

impl Keys for PileKeys {
    const KEYS: &'static [&'static str] = &["cell", "panels"];
}

impl Item for Pile {
    type Read = Object<PileKeys>;

    fn of(read: &Self::Read) -> Option<Self> {
        // Cells are written as integers, far from the limits of 32 bits.
        let near = |number: Number| {
            number.integer().and_then(|c| i32::try_from(c).ok()).filter(|c| f64::from(*c).abs() < FAR)
        };
        let cell = numbers(read.field(0)?, near)?;
        let panels = read.field(1)?.row()?.iter().map(|number| number.index()).collect::<Option<_>>()?;
        Some(Self { cell, panels })
    }

    fn value(read: &Self::Read) -> Value {
        read.value()
    }
}
