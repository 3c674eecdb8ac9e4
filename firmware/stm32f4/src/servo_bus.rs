//! The task that tells the servo driver its pulses. It runs below the control tick and may wait for its bus; a bus
//! that hangs costs it a time-out, and the servos their enable pin.

use crate::{servo_gate, supervisor};
use embassy_embedded_hal::SetConfig;
use embassy_stm32::{
    i2c::{self, I2c, Master},
    mode::Blocking,
    pac::gpio::{
        Gpio,
        vals::{Moder, Odr},
    },
    time::Hertz,
};
use embassy_time::{Duration, Ticker, block_for};
use embedded_hal::i2c::{ErrorType, Operation};
use zygote_parts::Pca9685;

/// Where a PCA9685 is with its address pins open.
const ADDRESS: u8 = 0x40;
/// A pulse is sent every 20 ms, so nothing is gained by telling the chip more often.
const PERIOD: Duration = Duration::from_millis(20);
/// Periods between two looks at whether the chip is set up as it was left.
const CHECK_EVERY: u32 = 5;
/// Periods between two attempts to find a chip that is lost.
const RETRY_EVERY: u32 = 10;
/// Fast mode.
const CLOCK: Hertz = Hertz(400_000);
/// The longest transfer takes 135 us.
const TIMEOUT: Duration = Duration::from_millis(2);
/// Half a period of the clock that frees a bus: 100 kHz.
const HALF_CLOCK: Duration = Duration::from_micros(5);

/// An I2C bus whose clock can be driven by hand.
pub struct ServoBus {
    /// The driver.
    pub i2c: I2c<'static, Blocking, Master>,
    /// Port and pin of its clock.
    pub clock: (Gpio, u8),
}

impl ServoBus {
    /// The driver's settings: fast mode, and no wait without an end.
    pub fn config() -> i2c::Config {
        let mut config = i2c::Config::default();
        config.frequency = CLOCK;
        config.timeout = TIMEOUT;
        config
    }

    /// Frees a bus on which a chip waits for the rest of a transfer that a reset cut: nine clocks end any.
    fn free(&mut self) {
        let (port, pin) = (self.clock.0, usize::from(self.clock.1));
        port.odr().modify(|levels| levels.set_odr(pin, Odr::HIGH));
        // Still open-drain: the pin is the driver's but for its mode.
        port.moder().modify(|mode| mode.set_moder(pin, Moder::OUTPUT));
        for level in [Odr::LOW, Odr::HIGH].into_iter().cycle().take(18) {
            port.odr().modify(|levels| levels.set_odr(pin, level));
            block_for(HALF_CLOCK);
        }
        port.moder().modify(|mode| mode.set_moder(pin, Moder::ALTERNATE));
        // Resets the peripheral, which keeps a bus that it believes busy.
        if self.i2c.set_config(&CLOCK).is_err() {
            defmt::warn!("servo bus: settings refused");
        }
    }
}

impl ErrorType for ServoBus {
    type Error = i2c::Error;
}

impl embedded_hal::i2c::I2c for ServoBus {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), Self::Error> {
        self.i2c.blocking_transaction(address, operations)
    }
}

/// Keeps the chip told, and the gate shut while it can't be.
#[embassy_executor::task]
pub(crate) async fn serve(bus: ServoBus) {
    let mut chip = Pca9685::new(bus, ADDRESS);
    let mut ticker = Ticker::every(PERIOD);
    let (mut is_up, mut period) = (false, 0_u32);
    loop {
        supervisor::BEATS.beat(supervisor::SERVOS);
        let due = |every| period.is_multiple_of(every);
        let wanted = servo_gate::wanted();
        let result = if is_up {
            let checked = if due(CHECK_EVERY) { chip.check() } else { Ok(()) };
            Some(checked.and_then(|()| chip.send(&wanted)))
        } else if due(RETRY_EVERY) {
            chip.bus().free();
            Some(chip.start())
        } else {
            None
        };
        match result {
            // Freshly started it has no pulses; those wanted are sent in the next period.
            Some(Ok(())) if is_up => servo_gate::told(&wanted),
            Some(Ok(())) => {
                defmt::info!("servo driver found");
                is_up = true;
                servo_gate::told(&servo_gate::NO_PULSES);
            }
            Some(Err(lost)) => {
                servo_gate::lose();
                if is_up {
                    defmt::error!("{}", defmt::Display2Format(&lost));
                }
                is_up = false;
            }
            None => {}
        }
        period = period.wrapping_add(1);
        ticker.next().await;
    }
}
