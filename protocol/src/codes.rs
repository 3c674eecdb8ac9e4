//! Refusals and faults by number, with all that people are told of them: the one source of `Display`, of
//! `zygote explain` and of the page `docs/src/faults.md`. Numbers are never reused; new ones are appended.

use core::fmt;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// What a person needs to know of a code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Explanation {
    /// What it means.
    pub meaning: &'static str,
    /// What the numbers are that come with it, and their unit; empty where they are all 0.
    pub numbers: &'static str,
    /// Is the position of the hinges still known?
    pub position: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

/// Declares a code enum: name, number, meaning, numbers, position, remedy.
macro_rules! codes {
    ($(#[$doc:meta])* $name:ident, $letter:literal {
        $($variant:ident = $number:literal, $meaning:literal, $numbers:literal, $position:expr, $remedy:literal;)+
    }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
        pub enum $name { $(#[doc = $meaning] $variant,)+ }

        impl $name {
            /// Every code, in the order of the numbers.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];
            /// What stands before the number.
            pub const LETTER: char = $letter;

            /// The number that people quote and that documents use.
            pub const fn number(self) -> u16 {
                match self { $(Self::$variant => $number,)+ }
            }

            /// What it means, for people.
            pub const fn meaning(self) -> &'static str {
                self.explanation().meaning
            }

            /// All that people are told of it.
            pub const fn explanation(self) -> Explanation {
                match self { $(Self::$variant => Explanation {
                    meaning: $meaning, numbers: $numbers, position: $position, remedy: $remedy,
                },)+ }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let Explanation { meaning, numbers, .. } = self.explanation();
                write!(f, "{}{:02}: {meaning}", Self::LETTER, self.number())?;
                if numbers.is_empty() { Ok(()) } else { write!(f, " ({numbers})") }
            }
        }
    };
}

/// A refused command changed nothing.
const AS_BEFORE: &str = "yes, as before: a refused command changes nothing";
/// What most faults say of the position.
const BUT_MOVING: &str = "yes, but hinges that were moving";

codes! {
    /// Why a command was refused. The numbers are where, what was expected and what came.
    RefusalCode, 'R' {
        WrongState = 1, "the command isn't allowed in this state",
            "expected and got are numbers of `State`; where several are allowed, one of them", AS_BEFORE, "ask Status, see the table of commands";
        NoUpload = 2, "no upload is under way",
            "at: `first` of the Steps", AS_BEFORE, "Upload first";
        TooManySteps = 3, "more steps than the MCU has room for, or than were declared",
            "room or declared number; number of steps", AS_BEFORE, "cut the program in runs, or use a larger board";
        StepsOutOfSequence = 4, "these steps don't follow on the ones before",
            "at and got: `first`; expected: the next index", AS_BEFORE, "send the steps in order, each once";
        ProgramIncomplete = 5, "fewer steps arrived than were declared",
            "declared; stored", AS_BEFORE, "send the rest, then Commit";
        ProgramChecksum = 6, "the program's checksum isn't the declared one",
            "declared; computed by the MCU", AS_BEFORE, "upload again";
        ProgramEmpty = 7, "a program needs at least one step",
            "1; 0", AS_BEFORE, "make a schedule that has a step";
        UnknownChannel = 8, "a step or a calibration names a channel that the board doesn't have",
            "at: step, or the calibration's channel; highest channel; channel", AS_BEFORE, "mend the rig file";
        ChannelTaken = 9, "two steps drive the same channel",
            "at: the second step; channel; channel", AS_BEFORE, "mend the rig file";
        HingeTaken = 10, "two steps move the same hinge",
            "at: the second step; hinge; hinge", AS_BEFORE, "make the schedule anew";
        OrderViolated = 11, "a step waits for itself or for a later one",
            "at: step; its index less 1; the late one", AS_BEFORE, "make the schedule anew";
        StepOverTemperature = 12, "a step's temperatures aren't below the limit, or are out of order: cool < target < highest <= limit, least gain > 0",
            "at: step; bound; value, in 0.01 °C", AS_BEFORE, "mend the rig file";
        StepOverOnTime = 13, "a step's on-time (or release pulse) is above the limit, its hold not below it, its gain window above it, or its rest below the least",
            "at: step; bound; value, in ms", AS_BEFORE, "mend the rig file";
        StepOverCurrent = 14, "a step alone draws more than the supply gives",
            "at: step; limit; current, in mA", AS_BEFORE, "mend the rig file, or use a stronger supply";
        RigMismatch = 15, "the program is for another rig",
            "", AS_BEFORE, "use the right rig file";
        RunMismatch = 16, "the program in store belongs to another run",
            "run in store; run asked for", AS_BEFORE, "upload again";
        LimitAboveCeiling = 17, "a limit is laxer than the board's ceiling",
            "at: number of the limit; ceiling; value, in its unit", AS_BEFORE, "ask for no more than the ceiling";
        LifetimeTooLong = 18, "an arming may not last so long",
            "600,000; lifetime, in ms", AS_BEFORE, "ask for ten minutes at most";
        StopPressed = 19, "the emergency stop is pressed",
            "0; 1", AS_BEFORE, "look at the rig, release the button";
        ServoRange = 20, "a servo pulse is outside what the board sends, or its servo was measured to bear",
            "at: step; nearest bound; pulse, in us", AS_BEFORE, "mend the rig file";
        Unreadable = 21, "the command passed its checksum but can't be read: of another version, or a field too long",
            "0; 0", AS_BEFORE, "use host and firmware of one version";
        NotStored = 22, "what was to be kept can't be stored: the flash doesn't take it",
            "", AS_BEFORE, "try again; if that doesn't help, the flash is worn: replace the board";
        Storing = 23, "something is being stored",
            "", AS_BEFORE, "wait for their answer";
        PulseDuty = 24, "a pulse's power isn't between 1 and 1,000 per mille",
            "at: step; nearest bound; power, per mille", AS_BEFORE, "ask for a power within the bounds";
        CalibratedCurrent = 25, "a step declares less current than its heater was measured to draw",
            "at: step; least current; current, in mA", AS_BEFORE, "name the calibration in the rig file (`rig.calibration`) and make the schedule anew; calibrate again what was replaced";
        CalibratedGain = 26, "a step expects less of its heater than a quarter of what was measured, so a loose thermistor would be seen late",
            "at: step; least gain; gain, in 0.01 °C", AS_BEFORE, "name the calibration in the rig file (`rig.calibration`) and make the schedule anew; calibrate again what was replaced";
        CalibratedTarget = 27, "a step's target isn't above the temperature at which its hinge was measured to be open",
            "at: step; that temperature; target, in 0.01 °C", AS_BEFORE, "raise the rig file's `target` and make the schedule anew; calibrate again what was replaced";
        CalibrationValue = 28, "a calibration has a value that can't be",
            "at: channel; nearest possible value; value", AS_BEFORE, "calibrate again";
    }
}

codes! {
    /// Why everything was turned off. The numbers are what was measured and what it was held against.
    FaultCode, 'F' {
        LinkLost = 1, "the host was silent for too long",
            "silence and link timeout, in ms", BUT_MOVING,
            "look at cable, host and baud rate";
        Stopped = 2, "a stop frame came",
            "0 and 0", BUT_MOVING,
            "find out why somebody stopped it";
        StopButton = 3, "the emergency stop button is pressed, or its wire is cut",
            "0 and 0", BUT_MOVING,
            "look at the rig, release the button";
        SessionEnded = 4, "another session was opened while armed or running",
            "0 and 0", BUT_MOVING,
            "let one program use the port";
        ArmExpired = 5, "the arming expired before a start",
            "lifetime and lifetime, in ms", "yes: nothing had moved",
            "arm and start again";
        OverTemperature = 6, "a hinge is too hot",
            "temperature and limit, in 0.01 °C", "not of this hinge: an alloy too hot forgets its shape",
            "let it cool, look for damage, check the thermistor and the heater's power";
        OnTooLong = 7, "a heater was on for too long",
            "time and limit, in ms", "not of this hinge: perhaps half open",
            "check heater, supply voltage and draught; or allow more time";
        SensorOpen = 8, "a thermistor reads open",
            "counts and highest good counts", BUT_MOVING,
            "check its wire";
        SensorShorted = 9, "a thermistor reads shorted",
            "counts and lowest good counts", BUT_MOVING,
            "check its wire";
        SensorJumped = 10, "a thermistor jumps",
            "reading and last good reading, in 0.01 °C", BUT_MOVING,
            "check wire, connector and shielding";
        NoGain = 11, "heating doesn't raise the temperature: loose thermistor or broken heater",
            "rise and least rise, in 0.01 °C", "not of this hinge: with a loose thermistor it was heated",
            "glue the thermistor, check the heater";
        UnexpectedHeat = 12, "a heater that is off gets warm: shorted MOSFET",
            "temperature and limit, in 0.01 °C", "not of this hinge: it may open before its turn",
            "keep the supply off, replace the MOSFET";
        OverCurrent = 13, "the supply gives more current than allowed",
            "current and limit, in mA; acts 10 % above it", BUT_MOVING,
            "look for a short or a blocked servo";
        SensorFrozen = 14, "a thermistor's reading stands still while the power of its heater changes",
            "reading, in 0.01 °C; time, in ms", "not of this hinge: perhaps half open",
            "check the thermistor's wire and the multiplexer";
        NoCooling = 15, "a heater that is off doesn't cool: shorted MOSFET, frozen thermistor or too hot a place",
            "fall and least fall in 10 s, in 0.01 °C", "not of this hinge: it may be heated still",
            "keep the supply off; check MOSFET and thermistor; at more than 40 °C around it raise the rig file's cool_to";
        UnplannedCurrent = 16, "the supply gives more current than what is on should draw",
            "current and planned current, in mA; acts 25 % and 100 mA above it for 250 ms, while no servo is driven", "not of a hinge that is heated unasked",
            "keep the supply off; look for a shorted MOSFET or heater; measure the currents of the rig file";
        ServosLost = 17, "the servo driver doesn't answer, or lost its settings",
            "0 and 0", "not of the servos: they are limp",
            "check the driver's supply, its bus and its pull-ups";
    }
}
