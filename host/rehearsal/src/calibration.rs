//! A rehearsal whose host calibrates the shape-memory hinges instead of opening them: pulses, program after program, while things go wrong.

use crate::board::BoardError;
use crate::run::{Ending, HELLO_PATIENCE, NUMBER, Rehearsed, Trial};
use zygote_controller::Session;
use zygote_controller::calibrate::{self, Calibration, Hinge, calibrate};
use zygote_deployment::Drive;
use zygote_protocol::Limits;

impl Trial {
    /// Runs it with a host that measures every shape-memory hinge of the rig.
    ///
    /// # Errors
    /// A rig that can't be simulated, or a cause that its plant can't have.
    pub fn calibrate(&self) -> Result<Rehearsed, BoardError> {
        let mut stage = self.open()?;
        let stop = stage.user_stops();
        let ending = match Session::connect(&mut stage, NUMBER, HELLO_PATIENCE) {
            Err(error) => Ending::Refused(error.to_string()),
            Ok(mut session) => {
                let mut hinges = self.hinges(&session.info().ceiling)?;
                let calibration =
                    Calibration { rig: &self.rig, run: NUMBER, clear: false, interrupted: &|| stop.get() };
                match calibrate(&mut session, &calibration, &mut hinges, &mut |_| Ok(()), &mut |_| {}) {
                    Ok(()) => {
                        let done = |hinge: &&Hinge| hinge.ending == Some(calibrate::Ending::Done);
                        Ending::Measured { done: hinges.iter().filter(done).count(), of: hinges.len() }
                    }
                    Err(error) => Ending::Refused(error.to_string()),
                }
            }
        };
        self.close(stage, ending)
    }

    fn hinges(&self, ceiling: &Limits) -> Result<Vec<Hinge>, BoardError> {
        let fittings = self.rig.fit(self.schedule.steps.len())?;
        let hinge = |(number, fitting): (usize, &zygote_deployment::Fitting)| match fitting.drive {
            Drive::Sma(settings) => Some(Hinge::new(number, fitting.channel, settings, ceiling)),
            Drive::Servo(_) | Drive::Spring(_) => None,
        };
        Ok(fittings.iter().enumerate().filter_map(hinge).collect())
    }
}
