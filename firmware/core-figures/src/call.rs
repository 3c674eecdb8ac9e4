//! What goes in and out of an entry: the emulator writes and reads it by the offsets of C.

use zygote_protocol::{MAX_ENCODED, RETAINED_WORDS};

/// Heaters; as many servos, and as many springs.
pub(crate) const CHANNELS: usize = 16;
/// Room for a frame, in whole words.
pub(crate) const BYTES: usize = MAX_ENCODED.next_multiple_of(8);

/// Arguments and results of every entry.
#[repr(C)]
pub(crate) struct Call {
    pub(crate) now: u64,
    /// `u64::MAX` for none, as in `due`.
    pub(crate) dead_line: u64,
    /// When there is next something to send.
    pub(crate) due: u64,
    pub(crate) boot: u32,
    pub(crate) supply: u32,
    pub(crate) current: u32,
    pub(crate) stop_pressed: u32,
    pub(crate) main_switch: u32,
    pub(crate) changes: u32,
    pub(crate) thermistors: [u16; CHANNELS],
    /// Per mille.
    pub(crate) heaters: [u16; CHANNELS],
    /// Microseconds, 0 for no pulse.
    pub(crate) servos: [u16; CHANNELS],
    pub(crate) springs: [u16; CHANNELS],
    pub(crate) retained: [u32; RETAINED_WORDS],
    /// Bytes in `bytes`, in or out.
    pub(crate) length: u32,
    pub(crate) bytes: [u8; BYTES],
}
