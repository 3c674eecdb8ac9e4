//! What the core is doing, with what belongs to it. The diagram stands in `core`.

use zygote_protocol::{Fault, Limits, Micros, Millis, State};

/// See [`crate::Core`].
#[derive(Debug, Clone, Copy)]
pub(crate) enum Mode {
    Idle,
    Loaded,
    Armed { until: Micros, lifetime: Millis, limits: Limits },
    Running(Limits),
    Finished,
    Safe(Fault),
}

impl Mode {
    pub(crate) fn state(&self) -> State {
        match self {
            Self::Idle => State::Idle,
            Self::Loaded => State::Loaded,
            Self::Armed { .. } => State::Armed,
            Self::Running(_) => State::Running,
            Self::Finished => State::Finished,
            Self::Safe(_) => State::Safe,
        }
    }

    pub(crate) fn fault(&self) -> Option<Fault> {
        match self {
            Self::Safe(fault) => Some(*fault),
            Self::Idle | Self::Loaded | Self::Armed { .. } | Self::Running(_) | Self::Finished => None,
        }
    }

    /// Something may be energised (S2).
    pub(crate) fn is_energised(&self) -> bool {
        match self {
            Self::Armed { .. } | Self::Running(_) => true,
            Self::Idle | Self::Loaded | Self::Finished | Self::Safe(_) => false,
        }
    }
}
