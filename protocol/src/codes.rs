//! Refusals and faults by number. Numbers are never reused; new ones are appended.

use core::fmt;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Declares a code enum with its printed number and its meaning side by side.
macro_rules! codes {
    ($(#[$doc:meta])* $name:ident, $letter:literal { $($(#[$vdoc:meta])* $variant:ident = $number:literal, $text:literal;)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
        pub enum $name { $($(#[$vdoc])* #[doc = $text] $variant,)+ }

        impl $name {
            /// Every code, in the order of the numbers.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The number that people quote and that documents use.
            pub const fn number(self) -> u16 {
                match self { $(Self::$variant => $number,)+ }
            }

            /// What it means, for people.
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $text,)+ }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($letter, "{:02}: {}"), self.number(), self.meaning())
            }
        }
    };
}

codes! {
    /// Why a command was refused.
    RefusalCode, "R" {
        WrongState = 1, "the command isn't allowed in this state (expected one state, got another, numbered as State)";
        NoUpload = 2, "no upload is under way";
        TooManySteps = 3, "more steps than the MCU has room for, or than were declared";
        StepsOutOfSequence = 4, "these steps don't follow on the ones before";
        ProgramIncomplete = 5, "fewer steps arrived than were declared";
        ProgramChecksum = 6, "the program's checksum isn't the declared one";
        ProgramEmpty = 7, "a program needs at least one step";
        UnknownChannel = 8, "a step names a channel that the board doesn't have (at: step)";
        ChannelTaken = 9, "two steps drive the same channel (at: step)";
        HingeTaken = 10, "two steps move the same hinge (at: step)";
        OrderViolated = 11, "a step waits for itself or for a later one (at: step)";
        StepOverTemperature = 12, "a step's temperatures aren't below the ceiling, or out of order (at: step, in 0.01 °C)";
        StepOverOnTime = 13, "a step's on-time is above the limit or too short for its hold or gain window, or its rest is too short (at: step, in ms)";
        StepOverCurrent = 14, "a step alone draws more than the supply gives (at: step, in mA)";
        RigMismatch = 15, "the program is for another rig";
        RunMismatch = 16, "the program belongs to another run";
        LimitAboveCeiling = 17, "a limit is laxer than the board's ceiling (at: the limit's number, in its unit)";
        LifetimeTooLong = 18, "an arming may not last so long (in ms)";
        StopPressed = 19, "the emergency stop is pressed";
        ServoRange = 20, "a servo pulse is outside what the board allows (at: step, in us)";
        Unreadable = 21, "the command passed its checksum but can't be read: of another version, or a field too long";
    }
}

codes! {
    /// Why everything was turned off.
    FaultCode, "F" {
        LinkLost = 1, "the host was silent for too long (value and limit in ms)";
        Stopped = 2, "a stop frame arrived";
        StopButton = 3, "the emergency stop button is pressed";
        SessionEnded = 4, "another session was opened while this one was armed";
        ArmExpired = 5, "the arming expired before a start (limit in ms)";
        OverTemperature = 6, "a hinge is too hot (value and limit in 0.01 °C)";
        OnTooLong = 7, "a heater was on for too long (value and limit in ms)";
        SensorOpen = 8, "a thermistor reads open (value in ADC counts)";
        SensorShorted = 9, "a thermistor reads shorted (value in ADC counts)";
        SensorJumped = 10, "a thermistor jumps (value and limit in 0.01 °C)";
        NoGain = 11, "heating doesn't raise the temperature: loose thermistor or broken heater (rise and limit in 0.01 °C)";
        UnexpectedHeat = 12, "a heater that is off gets warm: shorted MOSFET (value and limit in 0.01 °C)";
        OverCurrent = 13, "the supply gives more current than allowed (value and limit in mA)";
        SensorFrozen = 14, "a thermistor's reading stands still while the power of its heater changes (value in 0.01 °C, limit in ms)";
        NoCooling = 15, "a heater that is off doesn't cool: shorted MOSFET, frozen thermistor or too hot a place (fall and least fall in 0.01 °C)";
    }
}
