//! Puts a rig to a plan: which channel drives which hinge.

use super::settings::{Drive, Kind};
use super::{Rig, RigError};
use std::collections::{BTreeMap, BTreeSet};

/// What drives one hinge of a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitting {
    /// Index of the node in the rig file.
    pub node: usize,
    /// Channel of the node, of the kind that `drive` is.
    pub channel: u16,
    /// Settings of the hinge.
    pub drive: Drive,
}

impl Rig {
    /// The fitting of each of a plan's `hinges` hinges. Hinges without a channel of their own get the free
    /// channels of their kind in the order of their numbers.
    ///
    /// # Errors
    /// [`RigError`] when the rig can't drive that plan.
    pub fn fit(&self, hinges: usize) -> Result<Vec<Fitting>, RigError> {
        let [node] = self.nodes.as_slice() else {
            return Err(RigError::SeveralNodes { place: self.places.of("node"), nodes: self.nodes.len() });
        };
        let mut drives = vec![(None, self.shared(self.default_kind)); hinges];
        let mut taken: BTreeMap<Kind, BTreeSet<u16>> = BTreeMap::new();
        for (index, entry) in self.entries.iter().enumerate() {
            let place = |key: &str| self.places.of(format!("hinge[{index}].{key}"));
            let Some(drive) = drives.get_mut(entry.hinge) else {
                let last = hinges.saturating_sub(1);
                return Err(RigError::NoSuchHinge { place: place("hinge"), hinge: entry.hinge, last });
            };
            *drive = (entry.channel, entry.drive);
            let Some(channel) = entry.channel else { continue };
            let kind = entry.drive.kind();
            let available = node.channels(kind);
            let expected = if channel >= available {
                format!("one of the node's {available} {}, numbered from 0", kind.channel_key())
            } else if !taken.entry(kind).or_default().insert(channel) {
                format!("a {} channel that no other hinge has", kind.name())
            } else {
                continue;
            };
            return Err(RigError::Value { place: place("channel"), expected, found: channel.to_string() });
        }
        if let Some((hinge, _)) = self.sim.hinges().find(|(hinge, _)| *hinge >= hinges) {
            let last = hinges.saturating_sub(1);
            return Err(RigError::NoSuchHinge { place: self.places.of("sim.hinge"), hinge, last });
        }
        for kind in Kind::ALL {
            let needed = drives.iter().filter(|(_, drive)| drive.kind() == kind).count();
            let available = node.channels(kind);
            if needed > usize::from(available) {
                let place =
                    self.places.of_first(&[format!("node[0].{}", kind.channel_key()), "node".to_owned()]);
                return Err(RigError::TooFewChannels { place, kind, needed, available });
            }
        }
        let mut free: BTreeMap<Kind, _> = BTreeMap::new();
        for kind in Kind::ALL {
            let taken = taken.remove(&kind).unwrap_or_default();
            free.insert(kind, (0..node.channels(kind)).filter(move |channel| !taken.contains(channel)));
        }
        drives
            .into_iter()
            .map(|(channel, drive)| {
                let kind = drive.kind();
                let channel = channel.or_else(|| free.get_mut(&kind).and_then(Iterator::next));
                // Counted above, so this can't happen; still a refusal, not a panic.
                let channel = channel.ok_or_else(|| RigError::TooFewChannels {
                    place: self.places.whole(),
                    kind,
                    needed: hinges,
                    available: node.channels(kind),
                })?;
                Ok(Fitting { node: 0, channel, drive })
            })
            .collect()
    }
}
