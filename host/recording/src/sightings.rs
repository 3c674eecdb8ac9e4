//! What a recording shows of the hinges that were heated, to hold them against their calibration.

use crate::Recording;
use zygote_controller::Sightings;

impl Recording {
    /// Every look at every hinge.
    pub fn sightings(&self) -> Sightings {
        let mut sightings = Sightings::default();
        for event in &self.events {
            sightings.note(&event.record);
        }
        for look in &self.telemetry {
            let motions = look
                .motions
                .iter()
                .map(|motion| (motion.hinge, motion.phase.as_str(), motion.temperature_c, motion.duty));
            sightings.look(look.mcu_us, look.supply_v, look.current_a, motions);
        }
        sightings
    }
}
