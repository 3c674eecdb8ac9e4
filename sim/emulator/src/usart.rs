//! The serial line's end on the chip: a byte each way at a time, at the rate that the program sets. Bytes of the host wait
//! outside until there is time on the line for them.

use std::collections::VecDeque;

const SR: u32 = 0x00;
const DR: u32 = 0x04;
const BRR: u32 = 0x08;
const CR1: u32 = 0x0c;
const END: u32 = 0x1c;

const ORE: u32 = 1 << 3;
const IDLE: u32 = 1 << 4;
const RXNE: u32 = 1 << 5;
const TC: u32 = 1 << 6;
const TXE: u32 = 1 << 7;
const RE: u32 = 1 << 2;
const TE: u32 = 1 << 3;
const UE: u32 = 1 << 13;
const OVER8: u32 = 1 << 15;
/// Start, eight bits, stop.
const BITS: u64 = 10;

#[derive(Debug, Clone)]
pub(crate) struct Usart {
    registers: [u32; (END / 4) as usize],
    divisor: u64,
    status: u32,
    received: u8,
    /// What SR showed when it was last read: reading DR after it clears those flags.
    seen: u32,
    /// Bytes of the host that have not arrived yet.
    incoming: VecDeque<u8>,
    /// When the next of them has arrived, and when a line that went quiet is seen to be idle.
    arrival: Option<u64>,
    idle: Option<u64>,
    /// The byte that is being sent, until when, and the one after it.
    shifting: Option<(u8, u64)>,
    waiting: Option<u8>,
    outgoing: Vec<u8>,
}

impl Usart {
    pub(crate) fn new() -> Self {
        Self {
            registers: [0; (END / 4) as usize],
            divisor: 1,
            status: TC | TXE,
            received: 0,
            seen: 0,
            incoming: VecDeque::new(),
            arrival: None,
            idle: None,
            shifting: None,
            waiting: None,
            outgoing: Vec::new(),
        }
    }

    /// A reset: what is on its way to a chip that doesn't listen is lost, and what wasn't sent is never sent.
    pub(crate) fn reset(&mut self) {
        *self = Self { divisor: self.divisor, outgoing: std::mem::take(&mut self.outgoing), ..Self::new() };
    }

    pub(crate) fn set_divisor(&mut self, divisor: u64) {
        self.divisor = divisor;
    }

    /// Bytes from the host, whose line begins to carry them now.
    pub(crate) fn send(&mut self, bytes: &[u8], now: u64) {
        // Nobody listens before the program has set up its end.
        if self.control() & (UE | RE) != UE | RE {
            return;
        }
        self.incoming.extend(bytes);
        if self.arrival.is_none() && !self.incoming.is_empty() {
            self.arrival = Some(now + self.frame());
            self.idle = None;
        }
    }

    /// Takes the bytes that have been sent whole.
    pub(crate) fn take(&mut self, out: &mut Vec<u8>) {
        out.append(&mut self.outgoing);
    }

    /// Rate of the line in cycles of the core's clock for each bit.
    pub(crate) fn bit(&self) -> u64 {
        let brr = u64::from(self.registers[(BRR / 4) as usize]);
        let clocks = if self.control() & OVER8 == 0 { brr } else { (brr >> 4) * 8 + (brr & 7) };
        clocks.max(1) * self.divisor
    }

    pub(crate) fn read(&mut self, offset: u32, now: u64) -> u32 {
        self.sync(now);
        match offset {
            SR => {
                self.seen = self.status;
                self.status
            }
            DR => {
                self.status &= !(RXNE | self.seen & (ORE | IDLE));
                self.seen = 0;
                self.received.into()
            }
            _ => self.registers.get((offset / 4) as usize).copied().unwrap_or(0),
        }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32, now: u64) {
        self.sync(now);
        match offset {
            SR => self.status &= value | !(RXNE | TC),
            DR if self.control() & (UE | TE) == UE | TE => {
                self.status &= !TC;
                let byte = value.to_le_bytes()[0];
                if self.shifting.is_none() {
                    self.shifting = Some((byte, now + self.frame()));
                } else {
                    self.waiting = Some(byte);
                    self.status &= !TXE;
                }
            }
            DR => {}
            _ => {
                if let Some(register) = self.registers.get_mut((offset / 4) as usize) {
                    *register = value;
                }
            }
        }
    }

    /// Notes what has happened by now.
    pub(crate) fn sync(&mut self, now: u64) {
        while let Some(at) = self.arrival.filter(|at| *at <= now) {
            if let Some(byte) = self.incoming.pop_front() {
                self.arrive(byte);
            }
            self.arrival = (!self.incoming.is_empty()).then_some(at + self.frame());
            self.idle = self.arrival.is_none().then_some(at + self.frame());
        }
        if self.idle.is_some_and(|at| at <= now) {
            self.idle = None;
            self.status |= IDLE;
        }
        while let Some((byte, done)) = self.shifting.filter(|(_, done)| *done <= now) {
            self.outgoing.push(byte);
            self.shifting = self.waiting.take().map(|byte| (byte, done + self.frame()));
            self.status |= if self.shifting.is_some() { TXE } else { TXE | TC };
        }
    }

    /// The next cycle at which a flag changes.
    pub(crate) fn next_event(&self) -> Option<u64> {
        [self.arrival, self.idle, self.shifting.map(|(_, done)| done)].into_iter().flatten().min()
    }

    pub(crate) fn interrupts(&self) -> bool {
        // IDLEIE, RXNEIE, TCIE and TXEIE have the places of their flags; an overrun comes with RXNEIE.
        let overrun = if self.status & ORE == 0 { 0 } else { RXNE };
        self.control() & (self.status | overrun) & (IDLE | RXNE | TC | TXE) != 0
    }

    fn arrive(&mut self, byte: u8) {
        if self.control() & (UE | RE) != UE | RE {
            return;
        }
        if self.status & RXNE == 0 {
            self.received = byte;
            self.status |= RXNE;
        } else {
            self.status |= ORE;
        }
    }

    fn control(&self) -> u32 {
        self.registers[(CR1 / 4) as usize]
    }

    fn frame(&self) -> u64 {
        BITS * self.bit()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 921,600 baud of a quarter of 166 MHz.
    fn open() -> Usart {
        let mut usart = Usart::new();
        usart.set_divisor(4);
        usart.write(BRR, 45, 0);
        usart.write(CR1, UE | RE | TE | RXNE, 0);
        usart
    }

    const FRAME: u64 = 1800;

    #[test]
    fn bytes_arrive_one_after_the_other_and_then_the_line_is_idle() {
        let mut usart = open();
        usart.send(b"ab", 0);
        assert_eq!(usart.next_event(), Some(FRAME));
        assert_eq!(usart.read(SR, FRAME - 1) & RXNE, 0);
        assert_eq!(usart.read(SR, FRAME) & RXNE, RXNE);
        assert!(usart.interrupts());
        assert_eq!(usart.read(DR, FRAME), u32::from(b'a'));
        assert!(!usart.interrupts());
        assert_eq!(usart.read(DR, 2 * FRAME), u32::from(b'b'));
        assert_eq!(usart.read(SR, 3 * FRAME) & (IDLE | RXNE), IDLE);
        usart.read(DR, 3 * FRAME);
        assert_eq!(usart.read(SR, 3 * FRAME) & IDLE, 0);
    }

    #[test]
    fn a_byte_that_nobody_took_in_time_costs_the_next() {
        let mut usart = open();
        usart.send(b"abc", 0);
        assert_eq!(usart.read(SR, 2 * FRAME) & (ORE | RXNE), ORE | RXNE);
        assert_eq!(usart.read(DR, 2 * FRAME), u32::from(b'a'));
        assert_eq!(usart.read(SR, 2 * FRAME) & ORE, 0);
        assert_eq!(usart.read(DR, 3 * FRAME), u32::from(b'c'));
    }

    #[test]
    fn sent_bytes_take_their_time() {
        let mut usart = open();
        let mut out = Vec::new();
        usart.write(DR, u32::from(b'x'), 0);
        assert_eq!(usart.read(SR, 1) & TXE, TXE);
        usart.write(DR, u32::from(b'y'), 1);
        assert_eq!(usart.read(SR, 2) & (TXE | TC), 0);
        usart.sync(FRAME);
        usart.take(&mut out);
        assert_eq!(out, b"x");
        assert_eq!(usart.read(SR, 2 * FRAME) & (TXE | TC), TXE | TC);
        usart.take(&mut out);
        assert_eq!(out, b"xy");
    }

    #[test]
    fn before_the_program_listens_bytes_are_lost() {
        let mut usart = Usart::new();
        usart.send(b"a", 0);
        assert_eq!(usart.next_event(), None);
    }
}
