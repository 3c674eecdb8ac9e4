//! What a rehearsal needs of a board: to be driven, to be broken, and to be seen through. The simulated board is one; the
//! emulated one, which runs the program of the real board, is another.

use crate::board::BoardError;
use zygote_deployment::Kind;
use zygote_emulator::EmulatedBoard;
use zygote_protocol::{Fault, Micros, ResetCause, Snapshot, State, StepState};
use zygote_sim::plant::Plant;
use zygote_sim::{Board, Device, Stuck};

/// A board under rehearsal.
pub trait Subject {
    /// Virtual time.
    fn now(&self) -> Micros;
    /// Its boot id, as far as that can be seen.
    fn boot(&self) -> Option<u32>;
    /// The physics, as they truly are.
    fn plant(&self) -> &Plant;
    /// The physics, to break something.
    fn plant_mut(&mut self) -> &mut Plant;
    /// What the firmware core is doing.
    fn state(&self) -> State;
    /// The state that it was in for the latest step of time, which was `before` when that began.
    fn state_meanwhile(&self, before: State) -> State {
        before
    }
    /// Why it is in the safe state.
    fn fault(&self) -> Option<Fault>;
    /// The state of every step of its program; none where it has none.
    fn step_states(&self) -> Vec<StepState>;
    /// An actuator gets power, or a pulse, if the main switch is closed.
    fn drives(&self, kind: Kind, channel: usize) -> bool;
    /// Moves time on to `until`, or less far.
    ///
    /// # Errors
    /// [`BoardError`] for what the board can't do.
    fn advance(&mut self, until: Micros) -> Result<(), BoardError>;
    /// Takes bytes from the host, now.
    fn receive(&mut self, bytes: &[u8]);
    /// Appends the bytes that there are for the host, now.
    fn transmit(&mut self, out: &mut Vec<u8>);
    /// Presses or releases the emergency stop button.
    fn press_stop(&mut self, pressed: bool);
    /// Resets the MCU.
    fn reset(&mut self, cause: ResetCause);
    /// Stops its program.
    fn hang(&mut self, stuck: Stuck);
}

impl Subject for Board {
    fn now(&self) -> Micros {
        Board::now(self)
    }

    fn boot(&self) -> Option<u32> {
        Some(Board::boot(self))
    }

    fn plant(&self) -> &Plant {
        Board::plant(self)
    }

    fn plant_mut(&mut self) -> &mut Plant {
        Board::plant_mut(self)
    }

    fn state(&self) -> State {
        self.core().state()
    }

    fn fault(&self) -> Option<Fault> {
        self.core().fault()
    }

    fn step_states(&self) -> Vec<StepState> {
        self.core().step_states().collect()
    }

    fn drives(&self, kind: Kind, channel: usize) -> bool {
        let outputs = self.core().outputs();
        match kind {
            Kind::Sma => outputs.heaters.get(channel).is_some_and(|duty| duty.per_mille() > 0),
            Kind::Servo => outputs.servos.get(channel).is_some_and(Option::is_some),
            Kind::Spring => outputs.springs.get(channel).is_some_and(|on| *on),
        }
    }

    fn advance(&mut self, until: Micros) -> Result<(), BoardError> {
        Ok(Device::advance(self, until)?)
    }

    fn receive(&mut self, bytes: &[u8]) {
        Board::receive(self, bytes);
    }

    fn transmit(&mut self, out: &mut Vec<u8>) {
        Board::transmit(self, out);
    }

    fn press_stop(&mut self, pressed: bool) {
        Board::press_stop(self, pressed);
    }

    fn reset(&mut self, cause: ResetCause) {
        Board::reset(self, cause);
    }

    fn hang(&mut self, stuck: Stuck) {
        Board::hang(self, stuck);
    }
}

/// Its program's decisions are read from the snapshot that it keeps in RAM; what it drives, from its pins.
impl Subject for EmulatedBoard {
    fn now(&self) -> Micros {
        EmulatedBoard::now(self)
    }

    fn boot(&self) -> Option<u32> {
        self.snapshot().map(|snapshot| snapshot.boot)
    }

    fn plant(&self) -> &Plant {
        EmulatedBoard::plant(self)
    }

    fn plant_mut(&mut self) -> &mut Plant {
        EmulatedBoard::plant_mut(self)
    }

    fn state(&self) -> State {
        self.snapshot().map_or(State::Idle, |snapshot| snapshot.state)
    }

    /// The program moves its pins first, and then keeps what it has decided.
    fn state_meanwhile(&self, before: State) -> State {
        if self.kept_behind_pins() { self.state() } else { before }
    }

    fn fault(&self) -> Option<Fault> {
        self.snapshot().and_then(|snapshot| snapshot.fault)
    }

    fn step_states(&self) -> Vec<StepState> {
        self.snapshot()
            .map_or_else(Vec::new, |snapshot| (0..snapshot.steps).map(|step| of(snapshot, step)).collect())
    }

    fn drives(&self, kind: Kind, channel: usize) -> bool {
        let drive = self.drive();
        match kind {
            Kind::Sma => drive.heaters.get(channel).is_some_and(|duty| duty.per_mille() > 0),
            Kind::Servo => drive.servos.get(channel).is_some_and(Option::is_some),
            Kind::Spring => drive.springs.get(channel).is_some_and(|on| *on),
        }
    }

    fn advance(&mut self, until: Micros) -> Result<(), BoardError> {
        Ok(Device::advance(self, until)?)
    }

    fn receive(&mut self, bytes: &[u8]) {
        EmulatedBoard::receive(self, bytes);
    }

    fn transmit(&mut self, out: &mut Vec<u8>) {
        EmulatedBoard::transmit(self, out);
    }

    fn press_stop(&mut self, pressed: bool) {
        EmulatedBoard::press_stop(self, pressed);
    }

    /// Whatever the cause is to be: a reset from outside comes through the reset pin.
    fn reset(&mut self, _cause: ResetCause) {
        EmulatedBoard::reset(self);
    }

    fn hang(&mut self, stuck: Stuck) {
        EmulatedBoard::hang(self, stuck);
    }
}

/// A snapshot doesn't tell a step that moves from one that was interrupted, but a run that goes on has only the former.
fn of(snapshot: &Snapshot, step: u16) -> StepState {
    match snapshot.step(step) {
        StepState::Interrupted if snapshot.state == State::Running => StepState::Moving,
        state => state,
    }
}
