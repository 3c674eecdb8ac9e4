//! The three tasks. Each awaits, calls the core, and applies; none decides.

use crate::{sensors::Sensors, shell::Shell};
use embassy_stm32::{
    peripherals::IWDG,
    usart::{BufferedUartRx, BufferedUartTx},
    wdg::IndependentWatchdog,
};
use embassy_time::{Duration, Ticker};
use embedded_io_async::{Read, Write};

/// Period of the control tick.
const TICK: Duration = Duration::from_millis(1);

/// Sensors to core, at 1 kHz. Only this task feeds the watchdog: an executor that is stuck resets the chip.
#[embassy_executor::task]
pub(crate) async fn control(
    shell: &'static Shell,
    mut sensors: Sensors,
    mut watchdog: IndependentWatchdog<'static, IWDG>,
) {
    let mut ticker = Ticker::every(TICK);
    loop {
        ticker.next().await;
        shell.tick(&sensors.read());
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

/// Core to host, a piece at a time, so that an urgent frame waits for little.
#[embassy_executor::task]
pub(crate) async fn transmit(shell: &'static Shell, mut line: BufferedUartTx<'static>) {
    let mut bytes = [0; 512];
    loop {
        let count = shell.transmit(&mut bytes);
        if count == 0 {
            shell.speak.wait().await;
        } else if let Err(error) = line.write_all(bytes.get(..count).unwrap_or_default()).await {
            defmt::warn!("line: {}", error);
        }
    }
}
