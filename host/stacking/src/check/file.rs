//! A plan file as it is read: the long arrays as columns, whatever else stands in it as plain JSON. The same from bytes,
//! which are read once and never become a tree of values, and from a tree that somebody has.

use super::column::{Listed, no_array};
use super::items::{Angle, Edge, EdgeFaces, Face, HingeEntry, LatticePoint, Letter, Order};
use crate::plan::Pile;
use serde::de::{Deserialize, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};
use std::fmt;
use std::marker::PhantomData;

/// What a value is that is no object.
pub(crate) type NoObject = &'static str;

/// An object of the file that has columns.
pub(super) trait Parts: Default {
    /// Reads the value under a key; false where the key is none of the columns', and nothing was read.
    fn read<'de, A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<bool, A::Error>;

    /// Keeps a value under a key that is none of the columns'.
    fn keep(&mut self, key: String, value: Value);
}

/// The arrays that both frames have of their own, and the rest of the frame.
#[derive(Default)]
pub(crate) struct FrameColumns {
    pub(super) points: Listed<LatticePoint>,
    pub(super) angles: Listed<Angle>,
    pub(super) letters: Listed<Letter>,
    pub(super) face_orders: Listed<Order>,
    pub(super) rest: Map<String, Value>,
}

/// The file.
#[derive(Default)]
pub(crate) struct PlanFile {
    pub(super) target: FrameColumns,
    pub(super) faces: Listed<Face>,
    pub(super) edges: Listed<Edge>,
    pub(super) edge_faces: Listed<EdgeFaces>,
    pub(super) hinges: Listed<HingeEntry>,
    pub(super) piles: Listed<Pile>,
    /// The first of the frames, where that is an object.
    pub(super) zygote: Option<FrameColumns>,
}

impl Parts for FrameColumns {
    fn read<'de, A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<bool, A::Error> {
        match key {
            "vertices_coords" => self.points = map.next_value()?,
            "edges_foldAngle" => self.angles = map.next_value()?,
            "edges_assignment" => self.letters = map.next_value()?,
            "faceOrders" => self.face_orders = map.next_value()?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn keep(&mut self, key: String, value: Value) {
        self.rest.insert(key, value);
    }
}

impl Parts for PlanFile {
    fn read<'de, A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<bool, A::Error> {
        match key {
            "faces_vertices" => self.faces = map.next_value()?,
            "edges_vertices" => self.edges = map.next_value()?,
            "edges_faces" => self.edge_faces = map.next_value()?,
            "zygote:hinges" => self.hinges = map.next_value()?,
            "zygote:piles" => self.piles = map.next_value()?,
            "file_frames" => self.zygote = map.next_value::<FirstFrame>()?.0,
            _ => return self.target.read(key, map),
        }
        Ok(true)
    }

    fn keep(&mut self, key: String, value: Value) {
        self.target.keep(key, value);
    }
}

/// An object with columns, or what it is instead.
pub(crate) struct Parsed<P>(pub(crate) Result<P, NoObject>);

impl<'de, P: Parts> Deserialize<'de> for Parsed<P> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ParsedVisitor(PhantomData))
    }
}

struct ParsedVisitor<P>(PhantomData<P>);

impl<'de, P: Parts> Visitor<'de> for ParsedVisitor<P> {
    type Value = Parsed<P>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Parsed<P>, A::Error> {
        let mut parts = P::default();
        while let Some(key) = map.next_key::<String>()? {
            if !parts.read(&key, &mut map)? {
                let value = map.next_value()?;
                parts.keep(key, value);
            }
        }
        Ok(Parsed(Ok(parts)))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Parsed<P>, A::Error> {
        while list.next_element::<IgnoredAny>()?.is_some() {}
        Ok(Parsed(Err("an array")))
    }

    fn visit_str<E>(self, _: &str) -> Result<Parsed<P>, E> {
        Ok(Parsed(Err("a string")))
    }

    fn visit_u64<E>(self, _: u64) -> Result<Parsed<P>, E> {
        Ok(Parsed(Err("a number")))
    }

    fn visit_i64<E>(self, _: i64) -> Result<Parsed<P>, E> {
        Ok(Parsed(Err("a number")))
    }

    fn visit_f64<E>(self, _: f64) -> Result<Parsed<P>, E> {
        Ok(Parsed(Err("a number")))
    }

    fn visit_bool<E>(self, _: bool) -> Result<Parsed<P>, E> {
        Ok(Parsed(Err("a truth value")))
    }

    fn visit_unit<E>(self) -> Result<Parsed<P>, E> {
        Ok(Parsed(Err("null")))
    }
}

/// The first entry of an array of frames, where it is an object.
struct FirstFrame(Option<FrameColumns>);

impl<'de> Deserialize<'de> for FirstFrame {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(FramesVisitor)
    }
}

struct FramesVisitor;

impl<'de> Visitor<'de> for FramesVisitor {
    type Value = FirstFrame;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<FirstFrame, A::Error> {
        let first = list.next_element::<Parsed<FrameColumns>>()?;
        while list.next_element::<IgnoredAny>()?.is_some() {}
        Ok(FirstFrame(first.and_then(|object| object.0.ok())))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FirstFrame, A::Error> {
        while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(FirstFrame(None))
    }

    no_array!(FirstFrame(None));
}
