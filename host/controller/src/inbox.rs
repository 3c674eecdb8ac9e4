//! What a session has received and nobody has asked for yet: responses, news, and the answers that tell the MCU's time.

use crate::clock::{Clock, Exchange};
use std::collections::{BTreeMap, VecDeque};
use zygote_protocol::{
    Event, Fault, Micros, Received, Refusal, Reply, Report, Response, Telemetry, decode_payload,
};

/// News that wait to be asked for. A program that doesn't ask loses the oldest telemetry first: that is lossy anyway.
const MOST_TELEMETRY: usize = 1_024;

/// News from the MCU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Notice {
    /// Something happened.
    Event(Event),
    /// Everything was turned off.
    Fault(Fault),
    /// A look at the rig.
    Telemetry(Telemetry),
}

/// What ends a session.
pub(crate) enum Broken {
    /// The MCU knows no such session.
    Forgotten,
    /// A message of so many bytes can't be read.
    Unreadable(usize),
}

/// Everything received and not yet asked for.
#[derive(Debug, Default)]
pub(crate) struct Inbox {
    responses: BTreeMap<u16, Result<Reply, Refusal>>,
    notices: VecDeque<Notice>,
    last_fault: Option<Fault>,
    clock: Clock,
    /// When requests were made that will be answered with the MCU's time.
    asked_time: BTreeMap<u16, Micros>,
    /// The session's own question for the time, which nobody waits for.
    probe: Option<u16>,
}

impl Inbox {
    /// A request that is answered with the MCU's time goes out now; `own`: nobody will ask for the response.
    pub(crate) fn expect_time(&mut self, id: u16, now: Micros, own: bool) {
        self.asked_time.insert(id, now);
        if own {
            self.probe = Some(id);
        }
    }

    /// The session's own question for the time has no answer yet.
    pub(crate) fn is_probing(&self) -> bool {
        self.probe.is_some()
    }

    /// Another session begins, with the same clock at the other end or another.
    pub(crate) fn restart(&mut self, same_clock: bool) {
        let clock = if same_clock { std::mem::take(&mut self.clock) } else { Clock::new() };
        *self = Self { clock, ..Self::default() };
    }

    pub(crate) fn clock(&self) -> &Clock {
        &self.clock
    }

    pub(crate) fn response(&mut self, id: u16) -> Option<Result<Reply, Refusal>> {
        self.responses.remove(&id)
    }

    pub(crate) fn notice(&mut self) -> Option<Notice> {
        self.notices.pop_front()
    }

    /// Takes what the link received.
    pub(crate) fn take(&mut self, now: Micros, received: Received<'_>) -> Result<(), Broken> {
        match received {
            Received::Message(payload) => {
                match decode_payload(payload).ok_or(Broken::Unreadable(payload.len()))? {
                    Report::Response(response) => self.take_response(now, response),
                    Report::Event(event) => self.notices.push_back(Notice::Event(event)),
                }
            }
            Received::Urgent(payload) => {
                let fault: Fault = decode_payload(payload).ok_or(Broken::Unreadable(payload.len()))?;
                // Urgent messages may come more than once; a fault is told once.
                if self.last_fault != Some(fault) {
                    self.last_fault = Some(fault);
                    self.notices.push_back(Notice::Fault(fault));
                }
            }
            Received::Telemetry(payload) => {
                let telemetry = decode_payload(payload).ok_or(Broken::Unreadable(payload.len()))?;
                self.take_telemetry(telemetry);
            }
            Received::Reset => return Err(Broken::Forgotten),
            // A late answer to a repeated hello; an MCU sends no hello of its own.
            Received::HelloReply(..) | Received::Hello(..) => {}
        }
        Ok(())
    }

    fn take_telemetry(&mut self, telemetry: Telemetry) {
        if self.notices.len() >= MOST_TELEMETRY
            && let Some(oldest) =
                self.notices.iter().position(|notice| matches!(notice, Notice::Telemetry(_)))
        {
            self.notices.remove(oldest);
        }
        self.notices.push_back(Notice::Telemetry(telemetry));
    }

    fn take_response(&mut self, now: Micros, Response { id, result }: Response) {
        if let (Some(sent), Ok(Reply::Status(status))) = (self.asked_time.remove(&id), &result) {
            self.clock.add(Exchange { sent, received: now, mcu: status.at });
        }
        if self.probe == Some(id) {
            self.probe = None;
        } else {
            self.responses.insert(id, result);
        }
    }
}
