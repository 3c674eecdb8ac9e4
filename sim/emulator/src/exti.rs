//! External interrupts: a change of a pin's level that the program asked for. And the register that says which port a
//! line listens to.

const IMR: u32 = 0x00;
const RTSR: u32 = 0x08;
const FTSR: u32 = 0x0c;
const SWIER: u32 = 0x10;
const PR: u32 = 0x14;
const END: u32 = 0x18;
/// In SYSCFG: four lines each in four registers.
const EXTICR: u32 = 0x08;

#[derive(Debug, Clone, Default)]
pub(crate) struct Exti {
    registers: [u32; (END / 4) as usize],
    ports: [u32; 4],
}

impl Exti {
    pub(crate) fn read(&self, offset: u32) -> u32 {
        self.registers.get((offset / 4) as usize).copied().unwrap_or(0)
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32) {
        match offset {
            PR => self.registers[(PR / 4) as usize] &= !value,
            SWIER => self.registers[(PR / 4) as usize] |= value & self.read(IMR),
            _ => {
                if let Some(register) = self.registers.get_mut((offset / 4) as usize) {
                    *register = value;
                }
            }
        }
    }

    pub(crate) fn read_system(&self, offset: u32) -> u32 {
        offset.checked_sub(EXTICR).and_then(|at| self.ports.get((at / 4) as usize)).copied().unwrap_or(0)
    }

    pub(crate) fn write_system(&mut self, offset: u32, value: u32) {
        if let Some(ports) = offset.checked_sub(EXTICR).and_then(|at| self.ports.get_mut((at / 4) as usize)) {
            *ports = value;
        }
    }

    /// A pin of a port changes its level.
    pub(crate) fn edge(&mut self, port: u32, pin: u8, high: bool) {
        let line = 1 << pin;
        let listens = self.ports[usize::from(pin / 4)] >> (4 * (pin % 4)) & 0xf == port;
        let wanted = self.read(if high { RTSR } else { FTSR });
        if listens && wanted & line != 0 {
            self.registers[(PR / 4) as usize] |= line;
        }
    }

    /// A line of `lines` raises its interrupt.
    pub(crate) fn interrupts(&self, lines: u32) -> bool {
        self.read(PR) & self.read(IMR) & lines != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_edge_and_the_port_that_were_asked_for_interrupt() {
        let mut exti = Exti::default();
        exti.write_system(0x14, 2 << 4);
        exti.write(IMR, 1 << 13);
        exti.write(FTSR, 1 << 13);
        exti.edge(0, 13, false);
        exti.edge(2, 13, true);
        assert!(!exti.interrupts(!0));
        exti.edge(2, 13, false);
        assert!(exti.interrupts(0xfc00));
        exti.write(PR, 1 << 13);
        assert!(!exti.interrupts(0xfc00));
    }
}
