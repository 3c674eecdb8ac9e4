//! A serial line to a simulated board in virtual time: both directions carry a byte every ten bits, and no faster.

use std::collections::VecDeque;
use std::io;
use zygote_controller::Transport;
use zygote_protocol::Micros;
use zygote_sim::Board;

/// Start bit, eight bits, stop bit.
const BITS_PER_BYTE: u64 = 10;

/// Bytes on their way in one direction, in pieces that end with a frame's delimiter: nothing happens before that comes.
#[derive(Debug, Default)]
struct Wire {
    pieces: VecDeque<(Micros, Vec<u8>)>,
    piece: Vec<u8>,
    /// When the last byte is through.
    free_ns: u64,
}

impl Wire {
    fn put(&mut self, now: Micros, bytes: &[u8], byte_ns: u64) {
        for byte in bytes {
            self.free_ns = self.free_ns.max(now.0 * 1_000) + byte_ns;
            self.piece.push(*byte);
            if *byte == 0 {
                let arrives = Micros(self.free_ns.div_ceil(1_000));
                self.pieces.push_back((arrives, std::mem::take(&mut self.piece)));
            }
        }
    }

    fn due(&self) -> Option<Micros> {
        self.pieces.front().map(|(due, _)| *due)
    }

    fn get(&mut self, now: Micros) -> Option<Vec<u8>> {
        self.due().filter(|due| *due <= now)?;
        self.pieces.pop_front().map(|(_, piece)| piece)
    }
}

/// The line, with the board at its other end.
pub(crate) struct PacedLine {
    board: Board,
    byte_ns: u64,
    to_board: Wire,
    to_host: Wire,
    /// Arrived, but the host had no room for it yet.
    arrived: VecDeque<u8>,
}

impl PacedLine {
    pub(crate) fn new(board: Board, baud: u32) -> Self {
        let byte_ns = BITS_PER_BYTE * 1_000_000_000 / u64::from(baud.max(1));
        let (to_board, to_host) = (Wire::default(), Wire::default());
        Self { board, byte_ns, to_board, to_host, arrived: VecDeque::new() }
    }

    /// The board at its other end.
    pub(crate) fn board(&self) -> &Board {
        &self.board
    }

    /// Lets the board take what has arrived and say what it has to say.
    fn exchange(&mut self) {
        let now = self.board.now();
        while let Some(piece) = self.to_board.get(now) {
            self.board.receive(&piece);
        }
        let mut said = Vec::new();
        self.board.transmit(&mut said);
        self.to_host.put(now, &said, self.byte_ns);
        while let Some(piece) = self.to_host.get(now) {
            self.arrived.extend(piece);
        }
    }
}

impl Transport for PacedLine {
    fn now(&self) -> Micros {
        self.board.now()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.to_board.put(self.board.now(), bytes, self.byte_ns);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        loop {
            self.exchange();
            if !self.arrived.is_empty() || self.board.now() >= deadline {
                break;
            }
            let next = [self.to_board.due(), self.to_host.due(), Some(deadline)].into_iter().flatten().min();
            self.board.advance(next.unwrap_or(deadline)).map_err(io::Error::other)?;
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
