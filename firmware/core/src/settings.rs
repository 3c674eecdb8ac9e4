//! Settings that outlive power: checked and put into force here, written down by the board (S13).

use crate::config::Config;
use crate::program::refuse;
use zygote_protocol::{
    LimitName, MemoryReport, MemoryState, Micros, Refusal, RefusalCode, Reply, Response, Settings,
    SettingsReport, TooLax,
};

/// What is compiled into the board, and settings on their way into its memory.
#[derive(Debug)]
pub(crate) struct Keeper {
    compiled: Settings,
    memory: MemoryReport,
    storing: Option<Storing>,
    /// An answer that waits for room on the line.
    late: Option<Response>,
}

/// Settings that the board is to write down, and whom to tell; nobody, once another session is open.
#[derive(Debug)]
struct Storing {
    settings: Settings,
    request: Option<u16>,
}

impl Keeper {
    pub(crate) fn new(config: &Config) -> Self {
        Self { compiled: in_force(config), memory: MemoryReport::BLANK, storing: None, late: None }
    }

    /// What was stored comes into force as far as the board allows it.
    pub(crate) fn restore(&self, config: &mut Config, stored: &Settings) {
        put_into_force(config, &stored.within(&self.compiled));
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

    /// Whether settings are being written down.
    pub(crate) fn is_storing(&self) -> bool {
        self.storing.is_some()
    }

    /// Takes settings to be written down; the answer follows then.
    ///
    /// # Errors
    /// Settings that go beyond the board, and any while others are being written down.
    pub(crate) fn configure(&mut self, request: u16, settings: Settings) -> Result<(), Refusal> {
        if self.is_storing() || self.late.is_some() {
            return Err(refuse(RefusalCode::Storing, 0, 0, 0));
        }
        match settings.laxer_than(&self.compiled) {
            None => {
                self.storing = Some(Storing { settings, request: Some(request) });
                Ok(())
            }
            Some(TooLax::Limit(name, ceiling, got)) => {
                Err(refuse(RefusalCode::LimitAboveCeiling, limit_number(name), ceiling, got))
            }
            Some(TooLax::Pulse(bound, got)) => Err(refuse(RefusalCode::ServoRange, 0, bound, got)),
        }
    }

    pub(crate) fn to_store(&self) -> Option<&Settings> {
        self.storing.as_ref().map(|storing| &storing.settings)
    }

    /// The board has written them down, or couldn't; only what is surely kept comes into force.
    pub(crate) fn stored(&mut self, config: &mut Config, is_stored: bool) {
        let Some(Storing { settings, request }) = self.storing.take() else { return };
        self.memory.state = if is_stored { MemoryState::Kept } else { MemoryState::Unusable };
        if is_stored {
            put_into_force(config, &settings);
        }
        let result = if is_stored { Ok(Reply::Done) } else { Err(refuse(RefusalCode::NotStored, 0, 0, 0)) };
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
}

fn in_force(config: &Config) -> Settings {
    Settings {
        ceiling: config.ceiling,
        shortest_pulse_us: *config.servo_pulse_us.start(),
        longest_pulse_us: *config.servo_pulse_us.end(),
    }
}

fn put_into_force(config: &mut Config, settings: &Settings) {
    config.ceiling = settings.ceiling;
    config.servo_pulse_us = settings.shortest_pulse_us..=settings.longest_pulse_us;
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
