//! What a board hands over, and the start of everything.

use crate::{
    actuators::Actuators,
    dead_man,
    memory::Keeping,
    reset,
    safe_state::{self, Held},
    sensors::Sensors,
    servo_bus::{self, ServoBus},
    servo_gate,
    shell::{self, BoardCore, Shell},
    supervisor, tasks,
};
use defmt_rtt as _;
use embassy_executor::{Executor, InterruptExecutor, Spawner};
use embassy_stm32::{
    Peri,
    gpio::{Level, Output, Pin, Speed},
    interrupt,
    interrupt::{InterruptExt, Priority},
    pac::Interrupt,
    peripherals::FLASH,
    usart::{BufferedUartRx, BufferedUartTx},
};
use static_cell::StaticCell;
use zygote_core::{Config, Outputs};
use zygote_protocol::{ResetCause, Snapshot};

/// Heaters that a board has at most; one multiplexer has as many thermistors.
pub const HEATERS: usize = 16;
/// Servos that a board has at most: those of one PCA9685.
pub const SERVOS: usize = 16;
/// Spring releases that a board has at most.
pub const SPRINGS: usize = 4;
/// Steps of one program: at most one for each channel.
pub(crate) const STEPS: usize = HEATERS + SERVOS + SPRINGS;

/// The outputs of a board.
pub(crate) type BoardOutputs = Outputs<HEATERS, SERVOS, SPRINGS>;

/// All that is the board's own.
pub struct Board {
    /// Who it is and what it has, given its boot id and why it started.
    pub config: fn(u32, ResetCause) -> Config,
    /// Heaters, springs, main switch.
    pub actuators: Actuators,
    /// Thermistors, supply, stop button.
    pub sensors: Sensors,
    /// From the host.
    pub receiver: BufferedUartRx<'static>,
    /// To the host.
    pub transmitter: BufferedUartTx<'static>,
    /// To the servo driver.
    pub servos: ServoBus,
    /// The servo driver's enable pin, high.
    pub servos_enable: Output<'static>,
    /// What outlives power.
    pub flash: Peri<'static, FLASH>,
}

/// An interrupt without use on these boards: it carries the high executor.
const CARRIER: Interrupt = Interrupt::UART5;

static HIGH: InterruptExecutor = InterruptExecutor::new();

#[allow(
    unsafe_code,
    reason = "the vector table asks for it; the executor was started before the interrupt was unmasked"
)]
#[interrupt]
unsafe fn UART5() {
    unsafe { HIGH.on_interrupt() };
}

/// The first instructions of a board's `main`: everything off (S1), whatever may fail after them.
pub fn first(pins: &'static [Held]) {
    safe_state::declare(pins);
    safe_state::all_off();
}

/// An output that is low from the start.
pub fn low(pin: Peri<'static, impl Pin>) -> Output<'static> {
    Output::new(pin, Level::Low, Speed::Low)
}

/// Starts every task, and runs them for good.
pub fn run(board: Board) -> ! {
    static LOW: StaticCell<Executor> = StaticCell::new();

    let Board { config, actuators, mut sensors, receiver, transmitter, servos, servos_enable, flash } = board;
    supervisor::unleash();
    servo_gate::install(servos_enable);

    let (cause, kept) = (reset::cause(), reset::kept());
    // After power was off memory holds anything, even something that looks whole.
    let kept = kept.filter(|_| cause != ResetCause::Power);
    let mut keeping = Keeping::open(flash);
    // The first start of all is numbered by chance; without memory every one is.
    let chance = reset::chance(sensors.noise());
    let boot = keeping.count_start(chance).unwrap_or(chance);
    let start = Start { config: config(boot, cause), kept, keeping };

    // Below the interrupts of time, line, stop button and dead man's switch, above the low executor.
    CARRIER.set_priority(Priority::P6);
    let high = HIGH.start(CARRIER);
    high.spawn(defmt::unwrap!(begin(start, actuators, sensors, receiver, transmitter)));
    LOW.init(Executor::new()).run(|spawner| {
        spawner.spawn(defmt::unwrap!(servo_bus::serve(servos)));
        spawner.spawn(defmt::unwrap!(supervisor::supervise()));
    })
}

/// What the core starts with.
struct Start {
    config: Config,
    kept: Option<Snapshot>,
    keeping: Keeping,
}

/// Builds the core where it lives, on the high executor, and spawns the tasks around it.
#[embassy_executor::task]
async fn begin(
    start: Start,
    actuators: Actuators,
    sensors: Sensors,
    receiver: BufferedUartRx<'static>,
    transmitter: BufferedUartTx<'static>,
) {
    static SHELL: StaticCell<Shell> = StaticCell::new();
    #[expect(unsafe_code, reason = "nothing else asks for it; this is a task of an executor")]
    let spawner = unsafe { Spawner::for_current_executor().await };
    let Start { config, kept, keeping } = start;
    let mut core = BoardCore::new(config, shell::now(), kept);
    if let Some(kept) = keeping.kept() {
        core.restore(kept);
    }
    core.remember(keeping.report());
    let shell = SHELL.init(Shell::new(core, actuators, keeping));
    dead_man::watch();
    spawner.spawn(defmt::unwrap!(tasks::control(shell, sensors)));
    spawner.spawn(defmt::unwrap!(tasks::receive(shell, receiver)));
    spawner.spawn(defmt::unwrap!(tasks::transmit(shell, transmitter)));
}
