//! A number that tells one plan from another, so that a schedule is never run with a plan that it wasn't made for.

use super::Step;
use crc::{CRC_64_XZ, Crc, Digest};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::fmt;
use zygote_stacking::{HingeKind, Plan, Side};

/// CRC-64, of a plan over all that a deployment depends on: target, zygote, hinges, piles and root.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Fingerprint(pub u64);

const ALGORITHM: Crc<u64> = Crc::<u64>::new(&CRC_64_XZ);

impl Fingerprint {
    /// The fingerprint of a plan.
    pub fn of(plan: &Plan) -> Self {
        let mut bytes = Bytes(ALGORITHM.digest());
        bytes.size(plan.target.len());
        plan.target.as_flattened().as_flattened().iter().for_each(|coordinate| bytes.signed(*coordinate));
        bytes.size(plan.zygote.len());
        plan.zygote.as_flattened().as_flattened().iter().for_each(|coordinate| bytes.signed(*coordinate));
        bytes.size(plan.hinges.len());
        for hinge in &plan.hinges {
            bytes.size(match hinge.kind {
                HingeKind::Fold => 0,
                HingeKind::Bridge => 1,
            });
            hinge.panels.iter().chain(&hinge.edges).for_each(|number| bytes.size(*number));
            bytes.size(match hinge.side {
                Side::E => 0,
                Side::N => 1,
                Side::W => 2,
                Side::S => 3,
            });
            bytes.signed(i32::from(hinge.opening_deg));
            bytes.signed(i32::from(hinge.zygote_angle_deg));
            bytes.signed(i32::from(hinge.target_angle_deg));
        }
        bytes.size(plan.piles.len());
        for pile in &plan.piles {
            pile.cell.iter().for_each(|coordinate| bytes.signed(*coordinate));
            bytes.size(pile.panels.len());
            pile.panels.iter().for_each(|panel| bytes.size(*panel));
        }
        bytes.size(plan.root);
        Self(bytes.0.finalize())
    }
}

impl Fingerprint {
    /// The fingerprint of which hinge each step moves and which steps it waits for.
    pub(super) fn of_order(steps: &[Step]) -> Self {
        let mut bytes = Bytes(ALGORITHM.digest());
        for step in steps {
            bytes.size(step.hinge);
            bytes.size(step.after.len());
            step.after.iter().for_each(|before| bytes.size(*before));
        }
        Self(bytes.0.finalize())
    }
}

/// Little-endian, 4 bytes a coordinate, 8 a count or number.
struct Bytes(Digest<'static, u64>);

impl Bytes {
    fn signed(&mut self, value: i32) {
        self.0.update(&value.to_le_bytes());
    }

    fn size(&mut self, value: usize) {
        self.0.update(&(value as u64).to_le_bytes());
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl Serialize for Fingerprint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Fingerprint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        u64::from_str_radix(&text, 16).ok().map(Self).filter(|read| read.to_string() == text).ok_or_else(
            || de::Error::custom(format!("expected 16 lower-case hexadecimal digits, found \"{text}\"")),
        )
    }
}
