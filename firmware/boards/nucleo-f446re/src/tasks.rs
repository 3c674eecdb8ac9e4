//! The three tasks. Each awaits, calls the core, and applies; none decides.

use crate::{sensors::Sensors, shell::Shell};
use embassy_stm32::{
    peripherals::IWDG,
    usart::{BufferedUartRx, BufferedUartTx},
    wdg::IndependentWatchdog,
};
use embassy_time::{Duration, Ticker};
use embedded_io_async::{Read, Write};
use zygote_protocol::MAX_ENCODED;

/// Period of the control tick: the core asks for 5 ms at most, and reading everything takes half of one.
const TICK: Duration = Duration::from_millis(2);

/// Sensors to core. Only this task feeds the watchdog: an executor that is stuck resets the chip.
#[embassy_executor::task]
pub(crate) async fn control(
    shell: &'static Shell,
    mut sensors: Sensors,
    mut watchdog: IndependentWatchdog<'static, IWDG>,
) {
    let mut ticker = Ticker::every(TICK);
    loop {
        ticker.next().await;
        let inputs = sensors.read().await;
        shell.tick(&inputs);
        watchdog.pet();
    }
}

/// Host to core.
#[embassy_executor::task]
pub(crate) async fn receive(shell: &'static Shell, mut line: BufferedUartRx<'static>) {
    let mut bytes = [0; 128];
    loop {
        match line.read(&mut bytes).await {
            Ok(count) => shell.receive(bytes.get(..count).unwrap_or_default()),
            // Lost or broken bytes: the frame's check finds them and the host repeats the frame.
            Err(error) => defmt::warn!("line: {}", error),
        }
    }
}

/// Core to host, a frame at a time, so that an urgent frame waits for little.
#[embassy_executor::task]
pub(crate) async fn transmit(shell: &'static Shell, mut line: BufferedUartTx<'static>) {
    let mut bytes = [0; MAX_ENCODED];
    loop {
        let count = shell.transmit(&mut bytes);
        if count == 0 {
            shell.speak.wait().await;
        } else if let Err(error) = line.write_all(bytes.get(..count).unwrap_or_default()).await {
            defmt::warn!("line: {}", error);
        }
    }
}
