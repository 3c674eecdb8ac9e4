//! The most torque that a hinge lifts or holds: one figure, or several by its opening angle.

use super::quantity::{Degrees, NewtonMetres};
use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};
use std::fmt;

/// A table of ratings has at most so many angles.
pub const MOST_POINTS: usize = 10;

/// A torque by opening angle: straight lines between the points, level before the first and beyond the last.
#[derive(Debug, Clone, Copy)]
pub struct Rating {
    points: [(Degrees, NewtonMetres); MOST_POINTS],
    count: usize,
}

impl Rating {
    /// The same at all angles.
    pub const fn constant(torque: NewtonMetres) -> Self {
        Self { points: [(Degrees(0.0), torque); MOST_POINTS], count: 1 }
    }

    /// The points, by rising angle; one or more.
    pub fn points(&self) -> &[(Degrees, NewtonMetres)] {
        &self.points[..self.count]
    }

    /// The rating at an opening angle.
    pub fn at(&self, opening: Degrees) -> NewtonMetres {
        let points = self.points();
        let next = points.iter().position(|(angle, _)| opening < *angle).unwrap_or(points.len());
        match (next.checked_sub(1).and_then(|last| points.get(last)), points.get(next)) {
            (Some((low, from)), Some((high, to))) => {
                NewtonMetres(from.0 + (to.0 - from.0) * (opening.0 - low.0) / (high.0 - low.0))
            }
            (Some((_, torque)), None) | (None, Some((_, torque))) => *torque,
            // There is at least one point; no rating would be none to trust.
            (None, None) => NewtonMetres(0.0),
        }
    }
}

impl PartialEq for Rating {
    fn eq(&self, other: &Self) -> bool {
        self.points() == other.points()
    }
}

impl<'de> Deserialize<'de> for Rating {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = Rating;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "a torque with its unit, as in \"34 mNm\", or torques by opening angle, as in \
                     [[\"0 deg\", \"40 mNm\"], [\"180 deg\", \"20 mNm\"]]",
                )
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Rating, E> {
                text.parse().map(Rating::constant).map_err(E::custom)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Rating, A::Error> {
                let mut rating = Rating { count: 0, ..Rating::constant(NewtonMetres(0.0)) };
                while let Some(point) = items.next_element()? {
                    let Some(slot) = rating.points.get_mut(rating.count) else {
                        return Err(de::Error::custom(format!("expected at most {MOST_POINTS} angles")));
                    };
                    *slot = point;
                    rating.count += 1;
                }
                if rating.count == 0 { Err(de::Error::invalid_length(0, &self)) } else { Ok(rating) }
            }
        }
        deserializer.deserialize_any(Either)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_its_points_a_rating_is_straight_and_beyond_them_level() {
        let text = "torque = [[\"90 deg\", \"40 mNm\"], [\"180 deg\", \"10 mNm\"]]";
        let table: std::collections::BTreeMap<String, Rating> = toml::from_str(text).expect("a rating");
        let at = |angle| table["torque"].at(Degrees(angle)).0;
        assert!((at(120.0) - 0.030).abs() < 1e-12);
        for (angle, torque) in [(0.0, 0.04), (90.0, 0.04), (180.0, 0.01), (270.0, 0.01)] {
            assert!((at(angle) - torque).abs() < 1e-12, "at {angle} deg: {}", at(angle));
        }
    }
}
