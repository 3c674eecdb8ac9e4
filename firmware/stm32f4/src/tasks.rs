//! The three tasks around the core. Each awaits, calls the core, and applies; none decides.

use crate::{
    sensors::Sensors,
    shell::Shell,
    supervisor::{self, BEATS, LONGEST_SLEEP},
};
use embassy_stm32::usart::{self, BufferedUartRx, BufferedUartTx};
use embassy_time::{Duration, Ticker, with_timeout};
use embedded_io_async::{Read, Write};
use zygote_protocol::MAX_ENCODED;

/// Period of the control tick, of which reading everything takes a fifth.
const TICK: Duration = Duration::from_millis(1);
/// What is given to the line at once; every board's buffer has room for it.
const PIECE: usize = 64;

/// Sensors to core.
#[embassy_executor::task]
pub(crate) async fn control(shell: &'static Shell, mut sensors: Sensors) {
    let mut ticker = Ticker::every(TICK);
    loop {
        ticker.next().await;
        shell.tick(&sensors.read());
        BEATS.beat(supervisor::CONTROL);
    }
}

/// Host to core.
#[embassy_executor::task]
pub(crate) async fn receive(shell: &'static Shell, mut line: BufferedUartRx<'static>) {
    let mut bytes = [0; 128];
    loop {
        match with_timeout(LONGEST_SLEEP, line.read(&mut bytes)).await {
            Ok(Ok(count)) => shell.receive(bytes.get(..count).unwrap_or_default()),
            // Lost or broken bytes: the frame's check finds them and the host repeats the frame.
            Ok(Err(error)) => defmt::warn!("line: {}", error),
            // Nothing came.
            Err(_) => {}
        }
        BEATS.beat(supervisor::RECEIVE);
    }
}

/// Core to host, a frame at a time, so that an urgent frame waits for little. Every tick wakes it.
#[embassy_executor::task]
pub(crate) async fn transmit(shell: &'static Shell, mut line: BufferedUartTx<'static>) {
    let mut bytes = [0; MAX_ENCODED];
    loop {
        BEATS.beat(supervisor::TRANSMIT);
        let count = shell.transmit(&mut bytes);
        if count == 0 {
            shell.speak.wait().await;
        } else if let Err(error) = send(&mut line, bytes.get(..count).unwrap_or_default()).await {
            defmt::warn!("line: {}", error);
        }
    }
}

/// Sends a frame in pieces, each once the one before is out: embassy's driver (0.6) refuses what is longer than its buffer, and
/// who waits in it for room in a buffer that isn't empty is never woken. Who waits for the end may be missed too, so he looks
/// again; a line that stays stuck is the watchdog's business.
async fn send(line: &mut BufferedUartTx<'static>, frame: &[u8]) -> Result<(), usart::Error> {
    for piece in frame.chunks(PIECE) {
        while with_timeout(LONGEST_SLEEP, line.flush()).await.is_err() {}
        line.write_all(piece).await?;
    }
    Ok(())
}
