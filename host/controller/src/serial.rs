//! A serial port as a transport: a board's virtual COM port, or the pseudo-terminal of the simulator.

use crate::Transport;
use serialport::{ClearBuffer, SerialPort};
use std::io::{self, Read, Write};
use std::time::{Duration, Instant};
use zygote_protocol::Micros;

/// Writing blocks no longer than this: what takes longer is a line that nobody reads.
const WRITE_TIMEOUT: Duration = Duration::from_secs(1);

/// A port that can't be opened.
#[derive(Debug, thiserror::Error)]
pub enum SerialError {
    /// There is no such port.
    #[error("{device}: no such port; {}", ports_here(.ports))]
    NotFound {
        /// The port asked for.
        device: String,
        /// The ports that there are.
        ports: Vec<String>,
    },
    /// The port is there, but this program may not use it, or another one does.
    #[error(
        "{device}: the port can't be opened at {baud} baud; is another program using it, and may you read and write it?"
    )]
    CannotOpen {
        /// The port asked for.
        device: String,
        /// The speed asked for.
        baud: u32,
        /// What the system says.
        #[source]
        source: serialport::Error,
    },
}

fn ports_here(ports: &[String]) -> String {
    if ports.is_empty() {
        "no serial port was found on this machine".to_owned()
    } else {
        format!("ports here: {}", ports.join(", "))
    }
}

/// The names of the serial ports on this machine.
pub fn serial_ports() -> Vec<String> {
    let ports = serialport::available_ports().unwrap_or_default();
    ports.into_iter().map(|port| port.port_name).collect()
}

/// An open serial port.
pub struct SerialTransport {
    device: String,
    port: Box<dyn SerialPort>,
    start: Instant,
}

impl SerialTransport {
    /// Opens a port, 8N1, without flow control.
    ///
    /// # Errors
    /// [`SerialError`], with what to look at.
    pub fn open(device: &str, baud: u32) -> Result<Self, SerialError> {
        if !std::path::Path::new(device).exists() && cfg!(unix) {
            return Err(SerialError::NotFound { device: device.to_owned(), ports: serial_ports() });
        }
        let opened = serialport::new(device, baud).timeout(WRITE_TIMEOUT).open();
        let port =
            opened.map_err(|source| SerialError::CannotOpen { device: device.to_owned(), baud, source })?;
        // What a former program left unread belongs to nobody; failing to drop it costs only a few bad frames.
        port.clear(ClearBuffer::Input).ok();
        Ok(Self { device: device.to_owned(), port, start: Instant::now() })
    }
}

impl Transport for SerialTransport {
    fn now(&self) -> Micros {
        Micros(u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX))
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port.set_timeout(WRITE_TIMEOUT)?;
        self.port.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        let left = Duration::from_micros(deadline.since(self.now()));
        // The port waits in whole milliseconds; a wait of none would make the caller spin.
        self.port.set_timeout(left.max(Duration::from_millis(1)))?;
        match self.port.read(buffer) {
            Ok(0) => Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(count) => Ok(count),
            Err(error) if matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::Interrupted) => {
                Ok(0)
            }
            Err(error) => Err(error),
        }
    }

    fn name(&self) -> String {
        self.device.clone()
    }
}
