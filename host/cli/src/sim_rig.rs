//! A simulated board as a rig file describes it: what `deploy --sim` and `sim` run on.

use crate::failure::{Failure, OrFail};
use anyhow::anyhow;
use std::io;
use zygote_controller::Transport;
use zygote_deployment::{Drive, Fitting, Rig, Schedule, SmaPlant};
use zygote_protocol::{Channels, Micros};
use zygote_sim::Board;
use zygote_sim::plant::{Config, ServoConfig, SmaConfig, SpringConfig, SupplyConfig};

/// Opening angle of a hinge that no schedule names, degrees.
const NO_HINGE_DEG: f64 = 180.0;

/// The board of a rig's node, with the hinges of a schedule on its channels; without a schedule every channel of the
/// node has a hinge that opens to 180 degrees.
pub(crate) fn board(rig: &Rig, schedule: Option<&Schedule>, boot: u32) -> Result<Board, Failure> {
    let [node] = rig.nodes.as_slice() else {
        let error = anyhow!("the simulator runs one node for now, the rig has {}", rig.nodes.len());
        return Err(Failure::BadInput(error));
    };
    let channels = Channels { heaters: node.heaters, servos: node.servos, springs: node.springs };
    let mut plant = Config {
        ambient_c: rig.sim.ambient.0,
        supply: SupplyConfig {
            open_circuit_v: rig.supply.voltage.0,
            source_ohm: rig.supply.resistance.0,
            ..SupplyConfig::default()
        },
        heaters: vec![SmaConfig::opening(NO_HINGE_DEG); usize::from(node.heaters)],
        servos: vec![ServoConfig::default(); usize::from(node.servos)],
        springs: vec![SpringConfig::opening(NO_HINGE_DEG); usize::from(node.springs)],
        seed: rig.sim.seed,
    };
    if let Some(schedule) = schedule {
        fit_hinges(&mut plant, rig, schedule)?;
    }
    Board::new(&plant, channels, boot).or_bad_input()
}

fn fit_hinges(plant: &mut Config, rig: &Rig, schedule: &Schedule) -> Result<(), Failure> {
    let fittings = rig.fit(schedule.steps.len()).or_bad_input()?;
    for step in &schedule.steps {
        let Some(Fitting { channel, drive, .. }) = fittings.get(step.hinge) else { continue };
        let channel = usize::from(*channel);
        let (start_deg, opening_deg) = (f64::from(step.from_opening_deg), f64::from(step.opening_deg));
        match drive {
            Drive::Sma(_) => {
                if let Some(place) = plant.heaters.get_mut(channel) {
                    *place = sma(rig.sim.sma_plant(step.hinge), start_deg, opening_deg);
                }
            }
            Drive::Servo(servo) => {
                if let Some(place) = plant.servos.get_mut(channel) {
                    *place = ServoConfig {
                        start_deg,
                        pulse_min_us: servo.pulse_0.0 * 1e6,
                        pulse_max_us: servo.pulse_270.0 * 1e6,
                        ..ServoConfig::default()
                    };
                }
            }
            Drive::Spring(_) => {
                if let Some(place) = plant.springs.get_mut(channel) {
                    *place = SpringConfig { start_deg, ..SpringConfig::opening(opening_deg) };
                }
            }
        }
    }
    Ok(())
}

fn sma(truth: &SmaPlant, start_deg: f64, opening_deg: f64) -> SmaConfig {
    let mut sma = SmaConfig::opening(opening_deg);
    sma.start_deg = start_deg;
    sma.heater_ohm = truth.heater_resistance.0;
    sma.convection_w_per_m2_k = truth.convection.0;
    sma.panel_w_per_k = truth.panel_conductance.0;
    sma.load_mn_m = truth.load.0 * 1e3;
    sma.alloy.mf_c = truth.martensite_finish.0;
    sma.alloy.ms_c = truth.martensite_start.0;
    sma.alloy.as_c = truth.austenite_start.0;
    sma.alloy.af_c = truth.austenite_finish.0;
    sma
}

/// The simulated board in virtual time: waiting for bytes is what makes its clock run.
pub(crate) struct SimTransport {
    board: Board,
    from_board: Vec<u8>,
}

impl SimTransport {
    pub(crate) fn new(board: Board) -> Self {
        Self { board, from_board: Vec::new() }
    }

    /// The board, for a look at the truth.
    pub(crate) fn board(&self) -> &Board {
        &self.board
    }
}

impl Transport for SimTransport {
    fn now(&self) -> Micros {
        self.board.now()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.board.receive(bytes);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        loop {
            self.board.transmit(&mut self.from_board);
            if !self.from_board.is_empty() || self.board.now() >= deadline {
                break;
            }
            self.board.advance(deadline).map_err(io::Error::other)?;
        }
        let count = self.from_board.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(self.from_board.drain(..count)) {
            *place = byte;
        }
        Ok(count)
    }

    fn name(&self) -> String {
        "simulator".to_owned()
    }
}
