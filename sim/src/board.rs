//! A simulated board: the firmware core on a plant, in virtual time.
//!
//! ```text
//!   host bytes --> Core --Outputs--> Plant
//!                   ^                  |
//!                   +----- Inputs <----+      every TICK
//! ```

use crate::plant::{Config as PlantConfig, Drive, Plant, PlantError};
use core::time::Duration;
use zygote_core::{Config, Core, Inputs, NTC_10K};
use zygote_protocol::{
    CentiCelsius, Channels, Identity, Kept, Limits, MAX_ENCODED, MemoryReport, MemoryState, Micros,
    Milliamps, Millis, ResetCause, Retained,
};

/// Time between two control ticks: as slow as the core allows, to be fast.
pub const TICK: Millis = Millis(5);

/// The watchdog resets an MCU that hasn't fed it for so long (S9).
const WATCHDOG: Millis = Millis(400);

/// Channels and steps that the simulated board has room for.
const HEATERS: usize = 256;
const SERVOS: usize = 192;
const SPRINGS: usize = 64;
const STEPS: usize = HEATERS + SERVOS + SPRINGS;

/// The firmware core as the simulated board runs it.
pub type SimCore = Core<HEATERS, SERVOS, SPRINGS, STEPS>;

/// What the simulated board keeps over power cycles.
type SimKept = Kept<HEATERS, SERVOS>;

/// What no host can exceed on the simulated board; a choice that suits paper and plastic next to the hinges.
pub const CEILING: Limits = Limits {
    max_temperature: CentiCelsius(13_000),
    max_on: Millis(60_000),
    min_rest: Millis(500),
    supply: Milliamps(40_000),
    link_timeout: Millis(5_000),
};

/// How an MCU is stuck.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stuck {
    /// Its tasks don't run any more, its timer interrupt does: the dead man's switch acts.
    Tasks,
    /// Nothing runs any more; outputs stay as they are until the watchdog acts.
    Everything,
}

/// A simulated board.
pub struct Board {
    core: Box<SimCore>,
    plant: Plant,
    channels: Channels,
    boot: u32,
    now: Micros,
    next_tick: Micros,
    stop_pressed: bool,
    stuck: Option<(Stuck, Micros)>,
    /// What outlives power.
    kept: Option<Box<SimKept>>,
    /// Memory that a reset leaves alone, and the core's changes that it holds.
    retained: (u32, Retained),
}

impl Board {
    /// A board with these channels on this plant, just switched on; `boot` is its boot id.
    ///
    /// # Errors
    /// [`PlantError`] for a plant that can't be.
    pub fn new(plant: &PlantConfig, channels: Channels, boot: u32) -> Result<Self, PlantError> {
        let plant = Plant::new(plant)?;
        let core = Box::new(Core::new(config(channels, boot, ResetCause::Power), Micros(0), None));
        Ok(Self {
            core,
            plant,
            channels,
            boot,
            now: Micros(0),
            next_tick: Micros(0),
            stop_pressed: false,
            stuck: None,
            kept: None,
            retained: (0, Retained::NOTHING),
        })
    }

    /// Virtual time since the board was switched on.
    pub fn now(&self) -> Micros {
        self.now
    }

    /// The firmware core.
    pub fn core(&self) -> &SimCore {
        &self.core
    }

    /// The MCU's boot id: its number of resets, counted from what it was made with.
    pub fn boot(&self) -> u32 {
        self.boot
    }

    /// The physics, as they truly are.
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// The physics, to break something.
    pub fn plant_mut(&mut self) -> &mut Plant {
        &mut self.plant
    }

    /// Presses or releases the emergency stop button.
    pub fn press_stop(&mut self, pressed: bool) {
        self.stop_pressed = pressed;
    }

    /// Resets the MCU; the plant goes on. The clock goes on too, as seen from outside.
    pub fn reset(&mut self, cause: ResetCause) {
        self.boot = self.boot.wrapping_add(1);
        self.stuck = None;
        let before = if cause == ResetCause::Power { None } else { self.retained.1.recall() };
        *self.core = Core::new(config(self.channels, self.boot, cause), self.now, before);
        if let Some(kept) = &self.kept {
            self.core.restore(SimKept::clone(kept));
            self.core.remember(MemoryReport { state: MemoryState::Kept, damaged: 0 });
        }
        self.retained = (0, Retained::NOTHING);
        self.next_tick = self.now.plus(TICK);
    }

    /// Stops the MCU's program from now on, until a reset.
    pub fn hang(&mut self, stuck: Stuck) {
        self.stuck = Some((stuck, self.now));
    }

    /// Writes down what must outlive a reset.
    fn retain(&mut self) {
        let changes = self.core.changes();
        if changes != self.retained.0 {
            self.retained = (changes, Retained::new(&self.core.snapshot(self.now)));
        }
    }

    /// Takes bytes from the host, now.
    pub fn receive(&mut self, bytes: &[u8]) {
        // A stuck program leaves them in the line's buffer, which runs over.
        if self.stuck.is_none() {
            self.core.handle_bytes(self.now, bytes);
            if let Some(kept) = self.core.to_store() {
                self.kept = Some(Box::new(kept.clone()));
                self.core.stored(true);
            }
            self.retain();
        }
    }

    /// Appends the bytes that the core has for the host, now.
    pub fn transmit(&mut self, out: &mut Vec<u8>) {
        if self.stuck.is_some() {
            return;
        }
        let mut frame = [0; MAX_ENCODED];
        loop {
            let length = self.core.poll_transmit(self.now, &mut frame);
            match frame.get(..length) {
                None | Some([]) => return,
                Some(bytes) => out.extend_from_slice(bytes),
            }
        }
    }

    /// Moves time on to `until`, or to the next control tick if that is earlier.
    ///
    /// # Errors
    /// [`PlantError`], which a drive of this board never causes.
    pub fn advance(&mut self, until: Micros) -> Result<(), PlantError> {
        let to = self.reset_due().unwrap_or(self.next_tick).min(until).max(self.now);
        let outputs = self.core.outputs();
        let drive = Drive {
            heaters: &outputs.heaters,
            servos: &outputs.servos,
            springs: &outputs.springs,
            main_switch: outputs.main_switch,
        };
        self.plant.advance(Duration::from_micros(to.since(self.now)), &drive)?;
        self.now = to;
        match self.stuck {
            None => self.tick(),
            Some((stuck, _)) if self.reset_due().is_some_and(|due| self.now >= due) => {
                self.reset(if stuck == Stuck::Tasks && self.core.dead_line().is_some() {
                    ResetCause::DeadMan
                } else {
                    ResetCause::Watchdog
                });
            }
            Some(_) => {}
        }
        Ok(())
    }

    /// When a stuck MCU is reset: by the dead man's switch, which its timer interrupt looks after, else by the watchdog.
    fn reset_due(&self) -> Option<Micros> {
        let (stuck, since) = self.stuck?;
        let watchdog = since.plus(WATCHDOG);
        Some(match stuck {
            Stuck::Tasks => self.core.dead_line().map_or(watchdog, |line| line.min(watchdog)),
            Stuck::Everything => watchdog,
        })
    }

    /// The control tick, where it is due.
    fn tick(&mut self) {
        if self.now >= self.next_tick {
            self.next_tick = self.now.plus(TICK);
            let readings = self.plant.sense();
            let inputs = Inputs {
                thermistors: &readings.thermistors,
                supply: readings.supply,
                current: readings.current,
                stop_pressed: self.stop_pressed,
                servos_lost: false,
            };
            self.core.tick(self.now, &inputs);
            self.retain();
        }
    }
}

fn config(channels: Channels, boot: u32, reset: ResetCause) -> Config {
    let text = |text: &str| text.chars().take(12).collect::<String>();
    let identity = Identity {
        boot,
        firmware: short(env!("CARGO_PKG_VERSION")),
        git: short(&text(option_env!("ZYGOTE_GIT").unwrap_or("unknown"))),
        board: short("simulated"),
        unique_id: *b"zygote-sim-1",
        reset,
    };
    Config { identity, ceiling: CEILING, channels, thermistor: NTC_10K, servo_pulse_us: 400..=2_600 }
}

/// As much of a text as a field of the hello has room for.
fn short<const N: usize>(text: &str) -> heapless::String<N> {
    let mut field = heapless::String::new();
    for letter in text.chars() {
        if field.push(letter).is_err() {
            break;
        }
    }
    field
}
