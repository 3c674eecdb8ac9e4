//! The whole MCU in one value: bytes, readings and time in, bytes and actuator commands out.
//!
//! ```text
//!            Commit          Arm            Start            every step done
//!   Idle ------------> Loaded ----> Armed ---------> Running ----------------> Finished
//!    ^                   ^           |  Disarm          | Disarm                  |
//!    |                   +-----------+------------------+      Arm, Upload <------+
//!    | Clear
//!   Safe <---- any fault, stop, lost link or new session while Armed or Running; a stop from any state
//! ```
//!
//! Only Armed and Running energise anything (S2): `outputs` is off in every other state.

use crate::config::Config;
use crate::event_queue::EventQueue;
use crate::handlers;
use crate::io::{Inputs, Outputs};
use crate::mode::Mode;
use crate::program::{Program, index, refuse};
use crate::sequencer::{Instant, Sequencer};
use crate::settings::Keeper;
use crate::supply_guard::SupplyGuard;
use crate::thermal_guard::ThermalGuard;
use crate::trip::Trip;
use zygote_protocol::{
    Action, Buffers, CentiCelsius, Channels, Event, EventKind, Fault, FaultCode, Heat, Hello, HelloReply,
    Kept, Limits, Link, LinkCounters, MAX_PAYLOAD, MemoryReport, Micros, Milliamps, Millis, Millivolts,
    NO_SESSION, Pulse, Received, RefusalCode, Report, Request, Response, Snapshot, State, StepState,
    Telemetry, Urgent, VERSION, VERSION_MIN, WINDOW, decode_payload, granted_session, peek_request_id,
    peek_versions, schema,
};

/// Time between two telemetry messages.
const TELEMETRY_EVERY: Millis = Millis(100);
/// The core acts within this of a lost link, and is ticked this often; if not, the dead man's switch acts.
const DEAD_MAN_GRACE: Millis = Millis(30);
/// Link room that events leave to responses.
const ROOM_FOR_RESPONSES: usize = 2;

/// The firmware of a board with so many heaters, servos and springs, and room for a program of so many steps.
#[derive(Debug)]
pub struct Core<const HEATERS: usize, const SERVOS: usize, const SPRINGS: usize, const STEPS: usize> {
    pub(crate) config: Config,
    pub(crate) mode: Mode,
    pub(crate) program: Program<STEPS>,
    pub(crate) sequencer: Sequencer<STEPS>,
    pub(crate) guards: [ThermalGuard; HEATERS],
    pub(crate) stop_pressed: bool,
    servos_lost: bool,
    pub(crate) keeper: Keeper<HEATERS, SERVOS>,
    pub(crate) outputs: Outputs<HEATERS, SERVOS, SPRINGS>,
    link: Link,
    events: EventQueue,
    supply_guard: SupplyGuard,
    /// What was left of the time before the last reset.
    pub(crate) before: Option<Snapshot>,
    /// Sessions that were opened.
    openings: u32,
    /// Time of the latest control tick.
    pub(crate) ticked: Micros,
    telemetry_due: Micros,
    pub(crate) supply: Millivolts,
    pub(crate) current: Milliamps,
}

impl<const HEATERS: usize, const SERVOS: usize, const SPRINGS: usize, const STEPS: usize>
    Core<HEATERS, SERVOS, SPRINGS, STEPS>
{
    /// A core in state Idle, everything off. `before` is what the board kept of the time before its reset.
    pub fn new(config: Config, now: Micros, before: Option<Snapshot>) -> Self {
        const {
            assert!(
                STEPS >= HEATERS + SERVOS + SPRINGS,
                "a program has a step a channel at most, and none is streamed"
            );
        };
        let keeper = Keeper::new(&config);
        Self {
            config,
            mode: Mode::Idle,
            program: Program::new(),
            sequencer: Sequencer::new(),
            guards: [ThermalGuard::NEW; HEATERS],
            stop_pressed: false,
            servos_lost: false,
            keeper,
            outputs: Outputs::OFF,
            link: Link::new(now),
            events: EventQueue::new(),
            supply_guard: SupplyGuard::new(),
            before,
            openings: 0,
            ticked: now,
            telemetry_due: now,
            supply: Millivolts(0),
            current: Milliamps(0),
        }
    }

    /// What the board kept: settings in force as far as it allows them (S13), and what was measured. To be told once, after the start.
    pub fn restore(&mut self, kept: Kept<HEATERS, SERVOS>) {
        self.keeper.restore(&mut self.config, kept);
    }

    /// What the board found in the memory that outlives power, for hosts that ask. To be told once, after the start; nothing was
    /// ever kept otherwise.
    pub fn remember(&mut self, memory: MemoryReport) {
        self.keeper.remember(memory);
    }

    /// What the board is to write down now, and then to say so to [`Self::stored`]; nothing is energised.
    pub fn to_store(&self) -> Option<&Kept<HEATERS, SERVOS>> {
        self.keeper.to_store()
    }

    /// What [`Self::to_store`] gave is kept for good, or can't be.
    pub fn stored(&mut self, is_stored: bool) {
        self.keeper.stored(&mut self.config, is_stored);
    }

    /// What every actuator is to do now. To be applied after each call of the other functions.
    pub fn outputs(&self) -> &Outputs<HEATERS, SERVOS, SPRINGS> {
        &self.outputs
    }

    /// What the MCU is doing.
    pub fn state(&self) -> State {
        self.mode.state()
    }

    /// Why the MCU is in the safe state.
    pub fn fault(&self) -> Option<Fault> {
        self.mode.fault()
    }

    /// The state of every step of the program.
    pub fn step_states(&self) -> impl Iterator<Item = StepState> {
        self.sequencer.states()
    }

    /// A number that changes with everything that [`Self::snapshot`] tells but the time.
    pub fn changes(&self) -> u32 {
        self.events.count().wrapping_add(self.openings)
    }

    /// What is to be kept over a reset (S9): boards write it down whenever [`Self::changes`] is another.
    pub fn snapshot(&self, now: Micros) -> Snapshot {
        let (state, run, fault) = (self.mode.state(), self.program.run(), self.mode.fault());
        let mut snapshot = Snapshot::new(self.config.identity.boot, now, state, run, fault);
        snapshot.session = self.link.session();
        self.sequencer.states().for_each(|state| snapshot.push(state));
        snapshot
    }

    /// When nothing may be energised any more unless this core is heard of again: the board's dead man's switch acts then,
    /// whatever became of the core (S3). `None` while nothing is energised.
    pub fn dead_line(&self) -> Option<Micros> {
        let limits = match self.mode {
            Mode::Armed { limits, .. } | Mode::Running(limits) => limits,
            Mode::Idle | Mode::Loaded | Mode::Finished | Mode::Safe(_) => return None,
        };
        let heard = self.link.last_heard().plus(limits.link_timeout).plus(DEAD_MAN_GRACE);
        Some(heard.min(self.ticked.plus(DEAD_MAN_GRACE)))
    }

    /// The open session.
    pub fn link_session(&self) -> Option<u32> {
        self.link.session()
    }

    /// What the link has seen.
    pub fn link_counters(&self) -> LinkCounters {
        self.link.counters()
    }

    /// The channels that can be used: fitted, and known to this core.
    pub(crate) fn channels(&self) -> Channels {
        let Channels { heaters, servos, springs } = self.config.channels;
        Channels {
            heaters: heaters.min(index(HEATERS)),
            servos: servos.min(index(SERVOS)),
            springs: springs.min(index(SPRINGS)),
        }
    }

    /// Takes bytes from the host.
    pub fn handle_bytes(&mut self, now: Micros, mut bytes: &[u8]) {
        loop {
            let Some(received) = self.link.receive_with_room(now, &mut bytes) else { return };
            match received {
                Received::Hello(asked, payload) => {
                    // Only the front: a hello of another version may go on differently, and is answered all the same.
                    let hello = peek_versions(payload);
                    self.greet(now, asked, hello.as_ref());
                }
                Received::Message(payload) => {
                    let request = decode_payload::<Request>(payload).ok_or(peek_request_id(payload));
                    self.answer(now, request);
                }
                Received::Urgent(payload) => {
                    // What can't be read but is urgent is taken for a stop: that is the safe side.
                    let Urgent::Stop = decode_payload(payload).unwrap_or(Urgent::Stop);
                    self.trip(now, Trip::new(FaultCode::Stopped, 0, 0));
                }
                // These are sent by MCUs only.
                Received::HelloReply(..) | Received::Telemetry(_) | Received::Reset => {}
            }
        }
    }

    /// Answers a hello. Another session than the open one takes over, and nothing stays energised for it.
    fn greet(&mut self, now: Micros, asked: u32, hello: Option<&Hello>) {
        let Some(hello) = hello else { return };
        let speaks_ours =
            hello.min <= VERSION && hello.current >= VERSION_MIN && hello.schema == schema::hash();
        let session = granted_session(asked, self.config.identity.boot);
        let is_new = self.link.session() != Some(session) && !self.link.was_replaced(session);
        if speaks_ours && asked != NO_SESSION && is_new {
            if self.mode.is_energised() {
                self.trip(now, Trip::new(FaultCode::SessionEnded, 0, 0));
            }
            self.events.clear();
            self.keeper.forget_answer();
            self.link.open(session, now);
            self.openings = self.openings.wrapping_add(1);
        }
        let reply = HelloReply {
            min: VERSION_MIN,
            current: VERSION,
            schema: schema::hash(),
            identity: self.config.identity.clone(),
            ceiling: self.config.ceiling,
            channels: self.channels(),
            buffers: Buffers {
                steps: index(STEPS),
                window: u8::try_from(WINDOW).unwrap_or(u8::MAX),
                payload: index(MAX_PAYLOAD),
            },
        };
        let sent = self.link.send_hello_reply(asked, &reply);
        debug_assert!(sent.is_ok(), "a hello fits a frame");
    }

    /// Does what a request asks; one that can't be read is refused under the number at its front.
    fn answer(&mut self, now: Micros, request: Result<Request, Option<u16>>) {
        let (id, result) = match request {
            Ok(Request { id, command }) => match handlers::handle(self, now, id, command) {
                Some(result) => (id, result),
                None => return,
            },
            Err(id) => (id.unwrap_or_default(), Err(refuse(RefusalCode::Unreadable, 0, 0, 0))),
        };
        let sent = self.link.send(&Report::Response(Response { id, result }));
        debug_assert!(sent.is_ok(), "requests are turned away while there is no room for their answer");
    }

    /// Writes bytes for the host into `out`, which has room for [`zygote_protocol::MAX_ENCODED`], and returns how
    /// many; 0 when nothing is due. To be called until it returns 0.
    pub fn poll_transmit(&mut self, now: Micros, out: &mut [u8]) -> usize {
        if self.link.session().is_some()
            && self.link.room() > 0
            && let Some(response) = self.keeper.take_answer()
        {
            let sent = self.link.send(&Report::Response(response));
            debug_assert!(sent.is_ok(), "there was room, and an answer is forgotten with its session");
        }
        while self.link.session().is_some() && self.link.room() > ROOM_FOR_RESPONSES {
            let Some(event) = self.events.pop() else { break };
            let sent = self.link.send(&Report::Event(event));
            debug_assert!(sent.is_ok(), "there was room");
        }
        self.link.poll_transmit(now, out)
    }

    /// When [`Self::poll_transmit`] will next have something to send.
    pub fn poll_timeout(&self, now: Micros) -> Option<Micros> {
        self.link.poll_timeout(now)
    }

    /// The control tick: takes a reading of everything and decides what every actuator does. Boards call it at
    /// least every 5 ms, so that a stop and a lost link act in time (S3, S8).
    pub fn tick(&mut self, now: Micros, inputs: &Inputs<'_>) {
        self.ticked = now;
        self.supply = inputs.supply;
        self.current = inputs.current;
        self.stop_pressed = inputs.stop_pressed;
        self.servos_lost = inputs.servos_lost;
        self.sample(inputs);
        if self.stop_pressed && !matches!(self.mode, Mode::Safe(_)) {
            self.trip(now, Trip::new(FaultCode::StopButton, 0, 0));
        }
        if let Err(fault) = self.check_all(now) {
            self.fail(fault);
        }
        if let Mode::Running(limits) = self.mode
            && let Err(fault) = self.run(now, &limits)
        {
            self.fail(fault);
        }
        if now >= self.telemetry_due {
            self.telemetry_due = now.plus(TELEMETRY_EVERY);
            self.send_telemetry(now);
        }
    }

    /// Gives every guard its reading; a fitted heater without one reads as open.
    fn sample(&mut self, inputs: &Inputs<'_>) {
        let is_energised = self.mode.is_energised();
        let fitted = usize::from(self.config.channels.heaters);
        let readings = inputs.thermistors.iter().copied().chain(core::iter::repeat(u16::MAX));
        for (guard, counts) in self.guards.iter_mut().zip(readings).take(fitted) {
            if !is_energised {
                guard.forgive();
            }
            guard.sample(counts, &self.config.thermistor);
        }
    }

    /// Everything that must hold while something may be energised.
    fn check_all(&mut self, now: Micros) -> Result<(), Fault> {
        let limits = match self.mode {
            Mode::Armed { until, limits, lifetime } => {
                if now >= until {
                    return Err(Trip::new(FaultCode::ArmExpired, lifetime.0, lifetime.0).at(now, None, None));
                }
                limits
            }
            Mode::Running(limits) => limits,
            Mode::Idle | Mode::Loaded | Mode::Finished | Mode::Safe(_) => return Ok(()),
        };
        let silence = now.since(self.link.last_heard());
        if self.link.session().is_none() || silence > limits.link_timeout.to_micros() {
            let silence = i64::try_from(silence / 1000).unwrap_or(i64::MAX);
            return Err(Trip::new(FaultCode::LinkLost, silence, limits.link_timeout.0).at(now, None, None));
        }
        self.check_heaters(now, &limits)?;
        self.check_servos().map_err(|trip| trip.at(now, None, None))?;
        self.check_supply(now, &limits).map_err(|trip| trip.at(now, None, None))
    }

    fn check_supply(&mut self, now: Micros, limits: &Limits) -> Result<(), Trip> {
        self.supply_guard.check(self.current, limits.supply)?;
        let planned = self.sequencer.planned(self.program.steps());
        let planned = if self.sequencer.drives_servo() { None } else { Some(planned) };
        self.supply_guard.check_planned(now, self.current, planned)
    }

    /// Servos that hold a structure let go of it when their pulses fail; nothing else may move then. A program
    /// without servos needs no driver.
    fn check_servos(&self) -> Result<(), Trip> {
        let needs_servos = self.program.steps().iter().any(|step| matches!(step.action, Action::Turn(_)));
        if self.servos_lost && needs_servos { Err(Trip::new(FaultCode::ServosLost, 0, 0)) } else { Ok(()) }
    }

    fn check_heaters(&mut self, now: Micros, limits: &Limits) -> Result<(), Fault> {
        let steps = self.program.steps();
        for ((at, step), state) in (0..).zip(steps).zip(self.sequencer.states()) {
            let (Action::Heat(Heat { channel, max_temperature, .. })
            | Action::Pulse(Pulse { channel, max_temperature, .. })) = step.action
            else {
                continue;
            };
            let Some(guard) = self.guards.get_mut(usize::from(channel)) else { continue };
            let driven = state == StepState::Moving;
            let most = max_temperature.min(limits.max_temperature);
            guard.check(driven, most).map_err(|trip| trip.at(now, Some(at), Some(channel)))?;
        }
        Ok(())
    }

    fn run(&mut self, now: Micros, limits: &Limits) -> Result<(), Fault> {
        let mut outputs = Outputs { main_switch: true, ..Outputs::OFF };
        let guards = &self.guards;
        let temperature = |channel| temperature_of(guards, channel);
        let instant = Instant { now, supply: limits.supply, temperature: &temperature };
        self.sequencer.advance(self.program.steps(), &instant, &mut self.events, &mut outputs)?;
        self.outputs = outputs;
        if self.sequencer.is_finished() {
            self.enter(now, Mode::Finished);
        }
        Ok(())
    }

    fn send_telemetry(&mut self, now: Micros) {
        if self.link.session().is_none() {
            return;
        }
        let guards = &self.guards;
        let temperature = |channel| temperature_of(guards, channel);
        let instant = Instant { now, supply: Milliamps(0), temperature: &temperature };
        let telemetry = Telemetry {
            at: now,
            state: self.mode.state(),
            supply: self.supply,
            current: self.current,
            opened: self.sequencer.opened(),
            motions: self.sequencer.motions(&instant),
        };
        let sent = self.link.send_telemetry(&telemetry);
        debug_assert!(sent.is_ok(), "telemetry fits a frame");
    }

    /// Goes into another state and says so. Leaving Armed and Running turns everything off.
    pub(crate) fn enter(&mut self, now: Micros, mode: Mode) {
        let was_energised = self.mode.is_energised();
        self.mode = mode;
        if !self.mode.is_energised() {
            self.outputs = Outputs::OFF;
            if was_energised {
                self.sequencer.interrupt();
            }
        }
        self.events.push(Event { at: now, kind: EventKind::State(self.mode.state()) });
    }

    /// Forgets what the guards learned, at arming.
    pub(crate) fn restart_guards(&mut self) {
        self.guards.iter_mut().for_each(ThermalGuard::restart);
        self.supply_guard = SupplyGuard::new();
    }

    fn trip(&mut self, now: Micros, trip: Trip) {
        self.fail(trip.at(now, None, None));
    }

    /// Everything off, latched until cleared; the first fault is the one that is told.
    fn fail(&mut self, fault: Fault) {
        self.outputs = Outputs::OFF;
        if matches!(self.mode, Mode::Safe(_)) {
            return;
        }
        self.enter(fault.at, Mode::Safe(fault));
        if self.link.session().is_some() {
            // With more faults waiting than the link keeps, the host has not listened; its next status tells it.
            self.link.send_urgent(&fault).ok();
        }
    }
}

fn temperature_of(guards: &[ThermalGuard], channel: u16) -> Option<CentiCelsius> {
    guards.get(usize::from(channel)).and_then(ThermalGuard::temperature)
}
