//! Settings and calibrations that outlive power: checked and put into force here, written down by the board (S13).

use crate::calibration;
use crate::config::Config;
use crate::program::refuse;
use zygote_protocol::{
    Calibration, Channels, Kept, LimitName, MemoryReport, MemoryState, Micros, Refusal, RefusalCode, Reply,
    Response, Settings, SettingsReport, TooLax,
};

/// What outlives power, what is compiled into the board, and a change on its way into the board's memory.
#[derive(Debug)]
pub(crate) struct Keeper<const HEATERS: usize, const SERVOS: usize> {
    compiled: Settings,
    /// As it is or, while it is written down, will be.
    kept: Kept<HEATERS, SERVOS>,
    memory: MemoryReport,
    storing: Option<Storing>,
    /// An answer that waits for room on the line.
    late: Option<Response>,
}

/// One thing of what is kept.
#[derive(Debug, Clone, Copy)]
enum Change {
    Settings(Option<Settings>),
    Calibration(Calibration),
}

/// A change that the board is to write down: how to take it back, and whom to tell; nobody, once another session is open.
#[derive(Debug)]
struct Storing {
    undo: Change,
    request: Option<u16>,
}

impl<const HEATERS: usize, const SERVOS: usize> Keeper<HEATERS, SERVOS> {
    pub(crate) fn new(config: &Config) -> Self {
        let compiled = in_force(config);
        Self { compiled, kept: Kept::NOTHING, memory: MemoryReport::BLANK, storing: None, late: None }
    }

    /// What was stored comes into force as far as the board allows it.
    pub(crate) fn restore(&mut self, config: &mut Config, kept: Kept<HEATERS, SERVOS>) {
        self.kept = kept;
        self.put_into_force(config);
    }

    /// What the board found in its memory.
    pub(crate) fn remember(&mut self, memory: MemoryReport) {
        self.memory = memory;
    }

    pub(crate) fn memory(&self) -> MemoryReport {
        self.memory
    }

    pub(crate) fn report(&self, at: Micros, config: &Config) -> Reply {
        Reply::Settings(SettingsReport { at, in_force: in_force(config), compiled: self.compiled })
    }

    /// What was measured. Nothing may be armed by it while it is written down.
    pub(crate) fn known(&self) -> &Kept<HEATERS, SERVOS> {
        &self.kept
    }

    /// Whether something is being written down.
    pub(crate) fn is_storing(&self) -> bool {
        self.storing.is_some()
    }

    /// Takes settings to be written down; the answer follows then.
    ///
    /// # Errors
    /// Settings that go beyond the board, and any while something is being written down.
    pub(crate) fn configure(&mut self, request: u16, settings: Settings) -> Result<(), Refusal> {
        match settings.laxer_than(&self.compiled) {
            None => self.store(request, Change::Settings(Some(settings))),
            Some(TooLax::Limit(name, ceiling, got)) => {
                Err(refuse(RefusalCode::LimitAboveCeiling, limit_number(name), ceiling, got))
            }
            Some(TooLax::Pulse(bound, got)) => Err(refuse(RefusalCode::ServoRange, 0, bound, got)),
        }
    }

    /// Takes what was measured to be written down; the answer follows then.
    ///
    /// # Errors
    /// Values and channels that can't be, and any while something is being written down.
    pub(crate) fn calibrate(
        &mut self,
        request: u16,
        calibration: Calibration,
        channels: Channels,
    ) -> Result<(), Refusal> {
        calibration::check_actuator(calibration.actuator(), channels)?;
        calibration::check_values(&calibration)?;
        self.store(request, Change::Calibration(calibration))
    }

    fn store(&mut self, request: u16, change: Change) -> Result<(), Refusal> {
        if self.is_storing() || self.late.is_some() {
            return Err(refuse(RefusalCode::Storing, 0, 0, 0));
        }
        let undo = self.change(change);
        self.storing = Some(Storing { undo, request: Some(request) });
        Ok(())
    }

    /// Makes a change; the one that takes it back.
    fn change(&mut self, change: Change) -> Change {
        match change {
            Change::Settings(settings) => {
                Change::Settings(core::mem::replace(&mut self.kept.settings, settings))
            }
            // The board has the channel, so something was or wasn't known of it.
            Change::Calibration(new) => Change::Calibration(self.kept.put(new).unwrap_or(new)),
        }
    }

    pub(crate) fn to_store(&self) -> Option<&Kept<HEATERS, SERVOS>> {
        self.is_storing().then_some(&self.kept)
    }

    /// The board has written it down, or couldn't; only what is surely kept comes into force.
    pub(crate) fn stored(&mut self, config: &mut Config, is_stored: bool) {
        let Some(Storing { undo, request }) = self.storing.take() else { return };
        self.memory.state = if is_stored { MemoryState::Kept } else { MemoryState::Unusable };
        let result = if is_stored {
            self.put_into_force(config);
            Ok(Reply::Done)
        } else {
            self.change(undo);
            Err(refuse(RefusalCode::NotStored, 0, 0, 0))
        };
        self.late = request.map(|id| Response { id, result });
    }

    /// The answer that waits.
    pub(crate) fn take_answer(&mut self) -> Option<Response> {
        self.late.take()
    }

    /// Another session is open: nobody waits for the answer any more.
    pub(crate) fn forget_answer(&mut self) {
        self.late = None;
        if let Some(storing) = &mut self.storing {
            storing.request = None;
        }
    }

    fn put_into_force(&self, config: &mut Config) {
        let settings = self.kept.settings.map_or(self.compiled, |kept| kept.within(&self.compiled));
        config.ceiling = settings.ceiling;
        config.servo_pulse_us = settings.shortest_pulse_us..=settings.longest_pulse_us;
    }
}

fn in_force(config: &Config) -> Settings {
    Settings {
        ceiling: config.ceiling,
        shortest_pulse_us: *config.servo_pulse_us.start(),
        longest_pulse_us: *config.servo_pulse_us.end(),
    }
}

/// The place of a limit in [`zygote_protocol::Limits`].
pub(crate) fn limit_number(name: LimitName) -> u16 {
    match name {
        LimitName::MaxTemperature => 0,
        LimitName::MaxOn => 1,
        LimitName::MinRest => 2,
        LimitName::Supply => 3,
        LimitName::LinkTimeout => 4,
    }
}
