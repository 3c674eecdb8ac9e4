//! The bill of materials: panels, hinges by kind and angle, magnets or screws, and with a rig what drives the hinges.

use crate::panel::{Holes, Panel};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use zygote_deployment::{Fitting, Kind, Rig, Tree, TreeError, table};
use zygote_stacking::{HingeKind, Plan};

/// What a rig gives to each hinge of a plan.
#[derive(Debug, Clone)]
pub struct Drives {
    /// By hinge.
    pub fittings: Vec<Fitting>,
    /// Names of the nodes.
    pub nodes: Vec<String>,
}

/// A rig that has no drives for a plan.
#[derive(Debug, thiserror::Error)]
pub enum DrivesError {
    /// The plan is no tree.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// The rig has too few channels, or names hinges that aren't there.
    #[error(transparent)]
    Rig(#[from] zygote_deployment::RigError),
}

impl Drives {
    /// What `rig` gives to the hinges of a plan.
    ///
    /// # Errors
    /// [`DrivesError`] if the rig can't drive the plan.
    pub fn of(plan: &Plan, rig: &Rig) -> Result<Self, DrivesError> {
        let fittings = rig.fit_tree(&Tree::new(plan)?)?;
        Ok(Self { fittings, nodes: rig.nodes.iter().map(|node| node.name.clone()).collect() })
    }

    /// A hinge's drive in words: kind, node, channel.
    pub(crate) fn words(&self, hinge: usize) -> Option<String> {
        let fitting = self.fittings.get(hinge)?;
        let node = self.nodes.get(fitting.node)?;
        Some(format!("{} at {node}, channel {}", fitting.drive.kind().name(), fitting.channel))
    }
}

/// A line of the bill.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Item {
    /// What.
    pub part: &'static str,
    /// Which.
    pub detail: String,
    /// How many.
    pub count: usize,
}

/// What to have before building.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Bill {
    /// The model of the plan.
    pub model: String,
    /// Its lines.
    pub items: Vec<Item>,
    /// All pieces together.
    pub total: usize,
}

impl Bill {
    /// The bill of a plan; without drives nobody says what moves its hinges.
    pub fn new(plan: &Plan, panel: &Panel, drives: Option<&Drives>) -> Self {
        let mut items = Vec::new();
        let mut add = |part, detail: String, count| {
            if count > 0 {
                items.push(Item { part, detail, count });
            }
        };
        let Panel { side_mm, thickness_mm, .. } = panel;
        add("panel", format!("{side_mm} x {side_mm} x {thickness_mm} mm"), plan.panels());
        let mut hinges: BTreeMap<_, usize> = BTreeMap::new();
        for (number, hinge) in plan.hinges.iter().enumerate() {
            let drive = drives.and_then(|drives| drives.fittings.get(number)).map(|fit| fit.drive.kind());
            *hinges.entry((drive, hinge.kind == HingeKind::Bridge, hinge.opening_deg)).or_default() += 1;
        }
        for ((drive, is_bridge, angle), count) in &hinges {
            let kind = table::kind_name(if *is_bridge { HingeKind::Bridge } else { HingeKind::Fold });
            let drive = drive.map_or(String::new(), |drive| format!("{}, ", drive.name()));
            add("hinge", format!("{drive}{kind}, opens to {angle} degrees"), *count);
        }
        match panel.holes {
            Holes::None => {}
            Holes::Magnets(magnet) => {
                let detail = format!("cylinder, {} x {} mm", magnet.diameter_mm, magnet.length_mm);
                add("magnet", detail, 4 * plan.panels());
            }
            // A hinge sits on two panels.
            Holes::Screws(screws) => {
                add("screw", format!("for a hole of {} mm", screws.diameter_mm), 4 * plan.hinges.len());
            }
        }
        if let Some(drives) = drives {
            electronics(drives, &mut add);
        }
        let total = items.iter().map(|item| item.count).sum();
        Self { model: plan.source.model.clone(), items, total }
    }

    /// As comma-separated values.
    pub fn csv(&self) -> String {
        let mut text = "part,detail,count\n".to_owned();
        for Item { part, detail, count } in &self.items {
            let _infallible = writeln!(text, "{part},\"{}\",{count}", detail.replace('"', "\"\""));
        }
        let _infallible = writeln!(text, "total,,{}", self.total);
        text
    }

    /// As JSON.
    ///
    /// # Errors
    /// Never in practice: texts and counts are what JSON has.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// As a table for people.
    pub fn table(&self) -> String {
        let width = self.total.to_string().len();
        let mut text = String::new();
        for Item { part, detail, count } in &self.items {
            let _infallible = writeln!(text, "{count:>width$}  {part:<18} {detail}");
        }
        let _infallible = writeln!(text, "{:>width$}  in all", self.total);
        text
    }
}

/// What stands on the benches of the nodes that drive a hinge.
fn electronics(drives: &Drives, add: &mut impl FnMut(&'static str, String, usize)) {
    let used: BTreeSet<usize> = drives.fittings.iter().map(|fitting| fitting.node).collect();
    for node in used {
        let name = drives.nodes.get(node).map_or("", String::as_str);
        let channels = |kind: Kind| {
            drives.fittings.iter().filter(|fit| fit.node == node && fit.drive.kind() == kind).count()
        };
        add("board", name.to_owned(), 1);
        add("MOSFET channel", format!("heater, {name}"), channels(Kind::Sma));
        add("thermistor", name.to_owned(), channels(Kind::Sma));
        add("servo channel", name.to_owned(), channels(Kind::Servo));
        add("MOSFET channel", format!("burn wire or latch, {name}"), channels(Kind::Spring));
    }
}
