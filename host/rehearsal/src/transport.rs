//! The simulated line as the controller sees it: waiting for bytes is what makes the virtual clock run.

use crate::stage::Stage;
use crate::subject::Subject;
use std::io;
use zygote_controller::Transport;
use zygote_protocol::Micros;

impl<B: Subject> Transport for Stage<B> {
    fn now(&self) -> Micros {
        self.board().now()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.alive()?;
        self.take_from_host(bytes).map_err(io::Error::other)
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        while self.arrived.is_empty() && self.board().now() < deadline {
            self.alive()?;
            self.step(deadline).map_err(io::Error::other)?;
        }
        let count = self.arrived.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(self.arrived.drain(..count)) {
            *place = byte;
        }
        Ok(count)
    }

    fn name(&self) -> String {
        "simulator".to_owned()
    }
}

/// Borrowed, so that the stage is still there when a session ends or none comes about.
impl<B: Subject> Transport for &mut Stage<B> {
    fn now(&self) -> Micros {
        Transport::now(&**self)
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        Transport::send(*self, bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        Transport::receive(*self, buffer, deadline)
    }

    fn name(&self) -> String {
        Transport::name(&**self)
    }
}

impl<B: Subject> Stage<B> {
    /// The host's process runs, and time isn't over.
    fn alive(&self) -> io::Result<()> {
        if self.host_is_killed() {
            return Err(io::Error::new(io::ErrorKind::BrokenPipe, "the host was killed"));
        }
        if self.is_over() {
            return Err(io::Error::new(io::ErrorKind::TimedOut, "the rehearsal's time is over"));
        }
        Ok(())
    }
}
