//! A simulated board as a rig file describes it.

use zygote_deployment::{Drive, Fitting, Rig, RigError, Schedule, SmaPlant};
use zygote_emulator::{EmulatedBoard, EmulatorError, Image};
use zygote_protocol::Channels;
use zygote_sim::Board;
use zygote_sim::plant::{Config, PlantError, ServoConfig, SmaConfig, SpringConfig, SupplyConfig};

/// Opening angle of a hinge that no schedule names, degrees.
const NO_HINGE_DEG: f64 = 180.0;

/// Why a rig can't be simulated.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// More or fewer nodes than one.
    #[error("the simulator runs one node for now, the rig has {nodes}")]
    Nodes {
        /// How many.
        nodes: usize,
    },
    /// The rig doesn't suit the schedule.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// Physics that can't be.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// The emulated board can't go on.
    #[error(transparent)]
    Emulator(#[from] EmulatorError),
}

/// The channels of a rig's only node.
///
/// # Errors
/// [`BoardError::Nodes`].
pub fn channels(rig: &Rig) -> Result<Channels, BoardError> {
    match rig.nodes.as_slice() {
        [node] => Ok(Channels { heaters: node.heaters, servos: node.servos, springs: node.springs }),
        nodes => Err(BoardError::Nodes { nodes: nodes.len() }),
    }
}

/// The board of a rig's node, with the hinges of a schedule on its channels; without a schedule every channel of the
/// node has a hinge that opens to 180 degrees.
///
/// # Errors
/// [`BoardError`].
pub fn board(rig: &Rig, schedule: Option<&Schedule>, boot: u32) -> Result<Board, BoardError> {
    Ok(Board::new(&plant(rig, schedule)?, channels(rig)?, boot)?)
}

/// The board of a rig's node, as [`board`], with a program of its own that runs on an emulated chip. The seed is that of
/// what its memory holds at the start.
///
/// # Errors
/// [`BoardError`], among others for a rig with more channels than the board has.
pub fn emulated(
    image: &Image,
    rig: &Rig,
    schedule: Option<&Schedule>,
    seed: u64,
) -> Result<EmulatedBoard, BoardError> {
    Ok(EmulatedBoard::new(image, &plant(rig, schedule)?, seed)?)
}

/// The board of a rig's node with closed hinges of the physics that the rig's `[sim]` tells: nothing is deployed, they are measured.
///
/// # Errors
/// [`BoardError`].
pub fn bench(rig: &Rig, fittings: &[Fitting], boot: u32) -> Result<Board, BoardError> {
    let mut plant = plant(rig, None)?;
    for (hinge, fitting) in fittings.iter().enumerate() {
        let channel = usize::from(fitting.channel);
        match fitting.drive {
            Drive::Sma(_) => {
                if let Some(place) = plant.heaters.get_mut(channel) {
                    *place = sma(rig.sim.sma_plant(hinge), 0.0, NO_HINGE_DEG);
                }
            }
            Drive::Servo(_) => {
                if let Some(place) = plant.servos.get_mut(channel) {
                    *place = servo(rig, hinge, 0.0);
                }
            }
            Drive::Spring(_) => {}
        }
    }
    Ok(Board::new(&plant, channels(rig)?, boot)?)
}

/// The physics behind the board of [`board`].
///
/// # Errors
/// [`BoardError`].
pub fn plant(rig: &Rig, schedule: Option<&Schedule>) -> Result<Config, BoardError> {
    let channels = channels(rig)?;
    let mut plant = Config {
        ambient_c: rig.sim.ambient.0,
        supply: SupplyConfig {
            open_circuit_v: rig.supply.voltage.0,
            source_ohm: rig.supply.resistance.0,
            ..SupplyConfig::default()
        },
        heaters: vec![SmaConfig::opening(NO_HINGE_DEG); usize::from(channels.heaters)],
        servos: vec![ServoConfig::default(); usize::from(channels.servos)],
        springs: vec![SpringConfig::opening(NO_HINGE_DEG); usize::from(channels.springs)],
        seed: rig.sim.seed,
    };
    if let Some(schedule) = schedule {
        fit_hinges(&mut plant, rig, schedule)?;
    }
    Ok(plant)
}

fn fit_hinges(plant: &mut Config, rig: &Rig, schedule: &Schedule) -> Result<(), BoardError> {
    let fittings = rig.fit(schedule.steps.len())?;
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
            Drive::Servo(_) => {
                if let Some(place) = plant.servos.get_mut(channel) {
                    *place = servo(rig, step.hinge, start_deg);
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

/// A servo that turns the other way has its angles exchanged, not its pulses. A hinge stands between its stops.
fn servo(rig: &Rig, hinge: usize, start_deg: f64) -> ServoConfig {
    let truth = rig.sim.servo_plant(hinge);
    let (pulse_0, pulse_270) = rig.true_pulses(hinge);
    let mut ends = [(pulse_0.0 * 1e6, 0.0), (pulse_270.0 * 1e6, 270.0)];
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    let [(pulse_min_us, pulse_min_deg), (pulse_max_us, pulse_max_deg)] = ends;
    ServoConfig {
        start_deg: start_deg.clamp(truth.stop_low.0, truth.stop_high.0),
        pulse_min_us,
        pulse_max_us,
        pulse_min_deg,
        pulse_max_deg,
        bow_deg: truth.bow.0,
        stop_low_deg: truth.stop_low.0,
        stop_high_deg: truth.stop_high.0,
        dead_band_deg: truth.dead_band.0,
        backlash_deg: truth.backlash.0,
        ..ServoConfig::default()
    }
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
