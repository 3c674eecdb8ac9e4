//! Puts a rig to a plan: which channel of which node drives which hinge.

use super::settings::{Drive, Kind};
use super::{Entry, Place, Rig, RigError};
use crate::tree::Tree;
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

/// A hinge on its way to a channel.
#[derive(Debug, Clone, Copy)]
struct Socket {
    node: Option<usize>,
    channel: Option<u16>,
    drive: Drive,
}

/// A node and the kind of its channels.
type Bank = (usize, Kind);

/// Of every bank the channels that the rig file gives away.
type Taken = BTreeMap<Bank, BTreeSet<u16>>;

impl Rig {
    /// The fitting of each of `hinges` hinges of which nothing is known: as neighbours count those with neighbouring
    /// numbers. With one node it is that of any plan.
    ///
    /// # Errors
    /// [`RigError`] when the rig can't drive that plan.
    pub fn fit(&self, hinges: usize) -> Result<Vec<Fitting>, RigError> {
        self.fit_along(hinges, (0..hinges).map(|hinge| (hinge, hinge.checked_sub(1))))
    }

    /// The fitting of each of a plan's hinges. A hinge without a node of its own goes to that of the hinge before it in the
    /// tree, or, where that is full, to the first with room; from the root out, strip by strip. Hinges without a channel of
    /// their own get the free channels of their kind and node in the order of their numbers.
    ///
    /// # Errors
    /// [`RigError`] when the rig can't drive that plan.
    pub fn fit_tree(&self, tree: &Tree) -> Result<Vec<Fitting>, RigError> {
        let branches = tree.branches();
        self.fit_along(branches.len(), branches.iter().map(|branch| (branch.hinge, branch.before)))
    }

    /// `walk` has every hinge once, each with one that comes before.
    fn fit_along(
        &self,
        hinges: usize,
        walk: impl Iterator<Item = (usize, Option<usize>)>,
    ) -> Result<Vec<Fitting>, RigError> {
        let (mut places, taken) = self.given(hinges)?;
        let mut room = self.room(&places)?;
        // Nodes that may have room of a kind, the first first.
        let mut first: BTreeMap<Kind, usize> = BTreeMap::new();
        for (hinge, before) in walk {
            if places[hinge].node.is_some() {
                continue;
            }
            let kind = places[hinge].drive.kind();
            let has_room = |node: &usize| room.get(&(*node, kind)).is_some_and(|room| *room > 0);
            let near = before.and_then(|before| places[before].node).filter(has_room);
            let node = near.or_else(|| {
                let first = first.entry(kind).or_default();
                *first = (*first..self.nodes.len()).find(has_room)?;
                Some(*first)
            });
            // Counted by `room`, so there is one; still a refusal, not a panic.
            let node = node.ok_or_else(|| self.too_few(kind, hinges))?;
            room.entry((node, kind)).and_modify(|room| *room -= 1);
            places[hinge].node = Some(node);
        }
        let mut free: BTreeMap<Bank, _> = BTreeMap::new();
        for (index, node) in self.nodes.iter().enumerate() {
            for kind in Kind::ALL {
                let taken = taken.get(&(index, kind)).cloned().unwrap_or_default();
                let channels = (0..node.channels(kind)).filter(move |channel| !taken.contains(channel));
                free.insert((index, kind), channels);
            }
        }
        let fitting = |place: Socket| {
            let kind = place.drive.kind();
            let node = place.node.unwrap_or_default();
            let channel = place.channel.or_else(|| free.get_mut(&(node, kind))?.next());
            let channel = channel.ok_or_else(|| self.too_few(kind, hinges))?;
            Ok(Fitting { node, channel, drive: place.drive })
        };
        let fittings = places.into_iter().map(fitting).collect::<Result<Vec<_>, _>>()?;
        self.hold_measured(&fittings)?;
        Ok(fittings)
    }

    /// What was measured with one servo, or one heater and thermistor, says nothing of another.
    fn hold_measured(&self, fittings: &[Fitting]) -> Result<(), RigError> {
        for measured in &self.measured {
            let Some(fitting) = fittings.get(measured.hinge) else { continue };
            if fitting.channel != measured.channel {
                let (hinge, channel) = (measured.hinge, measured.channel);
                return Err(RigError::Value {
                    place: self.places.of("rig.calibration"),
                    expected: format!(
                        "hinge {hinge} at channel {}, where it is now: calibrate it again",
                        fitting.channel
                    ),
                    found: format!("a calibration at channel {channel}"),
                });
            }
        }
        Ok(())
    }

    /// What the rig file says of every hinge, and the channels that it gives away.
    fn given(&self, hinges: usize) -> Result<(Vec<Socket>, Taken), RigError> {
        let last = hinges.saturating_sub(1);
        let shared = Socket { node: None, channel: None, drive: self.shared(self.default_kind) };
        let mut places = vec![shared; hinges];
        let mut taken = Taken::new();
        for (index, entry) in self.entries.iter().enumerate() {
            let at = |key: &str| self.places.of(format!("hinge[{index}].{key}"));
            let Some(place) = places.get_mut(entry.hinge) else {
                return Err(RigError::NoSuchHinge { place: at("hinge"), hinge: entry.hinge, last });
            };
            let (node, kind) = (self.node_of(entry), entry.drive.kind());
            *place = Socket { node, channel: entry.channel, drive: entry.drive };
            let (Some(node), Some(channel)) = (node, entry.channel) else { continue };
            let available = self.nodes.get(node).map_or(0, |node| node.channels(kind));
            let expected = if channel >= available {
                format!("one of the node's {available} {}, numbered from 0", kind.channel_key())
            } else if !taken.entry((node, kind)).or_default().insert(channel) {
                format!("a {} channel that no other hinge has", kind.name())
            } else {
                continue;
            };
            return Err(RigError::Value { place: at("channel"), expected, found: channel.to_string() });
        }
        for measured in &self.measured {
            if let Some(place) = places.get_mut(measured.hinge) {
                place.drive = measured.drive;
            }
        }
        let own = self.sim.hinges().map(|(hinge, _)| hinge);
        let mut own = own.chain(self.sim.servos().map(|(hinge, _)| hinge));
        if let Some(hinge) = own.find(|hinge| *hinge >= hinges) {
            return Err(RigError::NoSuchHinge { place: self.places.of("sim.hinge"), hinge, last });
        }
        Ok((places, taken))
    }

    /// The node that a hinge's entry gives; a channel alone is one of the only node.
    fn node_of(&self, entry: &Entry) -> Option<usize> {
        match &entry.node {
            Some(name) => self.nodes.iter().position(|node| node.name == *name),
            None => entry.channel.map(|_| 0),
        }
    }

    /// Channels that are left for hinges without a node of their own; enough for all of them.
    fn room(&self, places: &[Socket]) -> Result<BTreeMap<Bank, usize>, RigError> {
        let mut needed: BTreeMap<(Option<usize>, Kind), usize> = BTreeMap::new();
        for place in places {
            *needed.entry((place.node, place.drive.kind())).or_default() += 1;
        }
        let mut room = BTreeMap::new();
        for kind in Kind::ALL {
            let all: usize = needed.iter().filter(|((_, of), _)| *of == kind).map(|(_, count)| count).sum();
            if all > self.nodes.iter().map(|node| usize::from(node.channels(kind))).sum() {
                return Err(self.too_few(kind, all));
            }
            for (index, node) in self.nodes.iter().enumerate() {
                let (needed, available) = (
                    needed.get(&(Some(index), kind)).copied().unwrap_or(0),
                    usize::from(node.channels(kind)),
                );
                let left = available.checked_sub(needed).ok_or_else(|| RigError::TooFewChannels {
                    place: self.place_of_channels(index, kind),
                    kind,
                    needed,
                    nodes: 1,
                    available,
                })?;
                room.insert((index, kind), left);
            }
        }
        Ok(room)
    }

    fn too_few(&self, kind: Kind, needed: usize) -> RigError {
        RigError::TooFewChannels {
            place: self.place_of_channels(0, kind),
            kind,
            needed,
            nodes: self.nodes.len(),
            available: self.nodes.iter().map(|node| usize::from(node.channels(kind))).sum(),
        }
    }

    fn place_of_channels(&self, node: usize, kind: Kind) -> Place {
        self.places.of_first(&[format!("node[{node}].{}", kind.channel_key()), "node".to_owned()])
    }
}
