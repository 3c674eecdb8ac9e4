//! Feeds the independent watchdog, if every task has been alive since it last did (S9).
//!
//! It runs below everything else: whoever keeps the processor to himself starves it too.

use embassy_stm32::pac::{
    IWDG,
    iwdg::vals::{Key, Pr},
};
use embassy_time::{Duration, Instant, Ticker};
use zygote_parts::{Beats, RollCall};

pub(crate) const CONTROL: usize = 0;
pub(crate) const RECEIVE: usize = 1;
pub(crate) const TRANSMIT: usize = 2;
pub(crate) const SERVOS: usize = 3;
const TASKS: usize = 4;
const NAMES: [&str; TASKS] = ["control", "receive", "transmit", "servos"];

/// Where the tasks say that they came around.
pub(crate) static BEATS: Beats<TASKS> = Beats::new();

/// Every task comes around at least twice in this time.
const ROLL_CALL: Duration = Duration::from_millis(50);
/// How long a task may sleep before it has to come around.
pub(crate) const LONGEST_SLEEP: Duration = Duration::from_millis(20);

/// A count lasts 0.5 ms (32 kHz / 16); the oscillator runs at 17 to 47 kHz.
const PRESCALER: Pr = Pr::DIVIDE_BY16;
/// 200 ms: a reset comes 136 to 376 ms after the last feed, 426 ms after the last sign of a stuck task at the latest.
const PATIENCE: u16 = 400;
/// 2 s, 1.3 s at the least, for what halts the processor with everything off: erasing a sector takes 0.8 s at the most.
const MORE_PATIENCE: u16 = 4_000;

/// Starts the watchdog, patient while the board starts.
pub(crate) fn unleash() {
    IWDG.kr().write(|key| key.set_key(Key::START));
    be_patient();
}

/// For what halts the processor. Nothing may be energised.
pub(crate) fn be_patient() {
    wait_for(MORE_PATIENCE);
}

/// From now on S9 holds.
pub(crate) fn be_strict() {
    wait_for(PATIENCE);
}

fn wait_for(counts: u16) {
    IWDG.kr().write(|key| key.set_key(Key::ENABLE));
    IWDG.pr().write(|prescaler| prescaler.set_pr(PRESCALER));
    IWDG.rlr().write(|reload| reload.set_rl(counts));
    // A reload takes the new length only once that has come through to the watchdog's own clock: six of its slow
    // cycles. Should that clock stand still, there is nothing to wait for.
    let deadline = Instant::now() + Duration::from_millis(2);
    while IWDG.sr().read().0 != 0 && Instant::now() < deadline {}
    feed();
}

fn feed() {
    IWDG.kr().write(|key| key.set_key(Key::RESET));
}

/// Calls the roll, for good.
#[embassy_executor::task]
pub(crate) async fn supervise() {
    let (mut roll, mut ticker) = (RollCall::new(), Ticker::every(ROLL_CALL));
    be_strict();
    loop {
        ticker.next().await;
        match roll.call(&BEATS) {
            Ok(()) => feed(),
            Err(task) => defmt::error!("task {} is stuck", NAMES.get(task).copied().unwrap_or_default()),
        }
    }
}
