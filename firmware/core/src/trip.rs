//! Why a guard wants everything off, before it is known which step that concerns.

use zygote_protocol::{Fault, FaultCode, Micros};

/// A guard's verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Trip {
    pub(crate) code: FaultCode,
    pub(crate) value: i64,
    pub(crate) limit: i64,
}

impl Trip {
    pub(crate) fn new(code: FaultCode, value: impl Into<i64>, limit: impl Into<i64>) -> Self {
        Self { code, value: value.into(), limit: limit.into() }
    }

    /// The fault that this trip makes.
    pub(crate) fn at(self, at: Micros, step: Option<u16>, channel: Option<u16>) -> Fault {
        let Self { code, value, limit } = self;
        Fault { code, at, step, channel, value, limit }
    }
}
