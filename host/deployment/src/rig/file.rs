//! A rig file as it is typed, before its rules are looked at. Unknown keys are refused here.

use super::quantity::{Amps, Celsius, Ohms, Seconds, Volts};
use super::settings::{Kind, ServoTable, SmaTable, SpringTable};
use super::sim::SimTable;
use super::weight::{Gravity, PanelTable};
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RigFile {
    /// Looked at before anything else, see [`super::Rig::read`].
    #[serde(rename = "version")]
    pub(super) _version: u32,
    pub(super) rig: Identity,
    pub(super) supply: SupplyTable,
    #[serde(default)]
    pub(super) link: LinkTable,
    pub(super) node: Vec<NodeTable>,
    #[serde(default)]
    pub(super) hinges: HingesTable,
    #[serde(default)]
    pub(super) hinge: Vec<HingeTable>,
    #[serde(default)]
    pub(super) sma: SmaTable,
    #[serde(default)]
    pub(super) servo: ServoTable,
    #[serde(default)]
    pub(super) spring: SpringTable,
    #[serde(default)]
    pub(super) panel: PanelTable,
    #[serde(default)]
    pub(super) gravity: Gravity,
    #[serde(default)]
    pub(super) sim: SimTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Identity {
    pub(super) id: String,
    #[serde(default = "room")]
    pub(super) ambient: Celsius,
    #[serde(default)]
    pub(super) calibration: Option<String>,
}

fn room() -> Celsius {
    Celsius(22.0)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SupplyTable {
    pub(super) voltage: Volts,
    pub(super) limit: Amps,
    pub(super) resistance: Ohms,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct LinkTable {
    pub(super) timeout: Seconds,
    pub(super) baud: u32,
}

impl Default for LinkTable {
    fn default() -> Self {
        Self { timeout: Seconds(1.0), baud: 921_600 }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NodeTable {
    pub(super) name: String,
    #[serde(default)]
    pub(super) heaters: u16,
    #[serde(default)]
    pub(super) servos: u16,
    #[serde(default)]
    pub(super) springs: u16,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct HingesTable {
    pub(super) default: Kind,
}

impl Default for HingesTable {
    fn default() -> Self {
        Self { default: Kind::Sma }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HingeTable {
    pub(super) hinge: usize,
    pub(super) kind: Option<Kind>,
    pub(super) node: Option<String>,
    pub(super) channel: Option<u16>,
    pub(super) sma: Option<SmaTable>,
    pub(super) servo: Option<ServoTable>,
    pub(super) spring: Option<SpringTable>,
}
