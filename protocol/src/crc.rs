//! CRC-32/ISO-HDLC (the one of zlib and Ethernet), of bytes and of whatever postcard can encode.

use crc::{CRC_32_ISO_HDLC, Crc, Digest, Table};
use serde::Serialize;

// A table takes 1 KiB of flash, and a third of the time: the sum over a whole program is the longest thing that the MCU ever does at once.
static CRC32: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);

/// The checksum of some bytes.
pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    CRC32.checksum(bytes)
}

/// Sums up encodings without storing them.
pub(crate) struct Crc32Flavor(Digest<'static, u32, Table<1>>);

impl Crc32Flavor {
    pub(crate) fn new() -> Self {
        Self(CRC32.digest())
    }

    /// Adds the postcard encoding of a value.
    pub(crate) fn add<T: Serialize + ?Sized>(&mut self, value: &T) {
        // The flavor below refuses no byte, and our types are ones that postcard encodes.
        let encoded = postcard::serialize_with_flavor(value, ByteSum(&mut self.0));
        debug_assert!(encoded.is_ok(), "every message encodes");
    }

    pub(crate) fn finish(self) -> u32 {
        self.0.finalize()
    }
}

struct ByteSum<'a>(&'a mut Digest<'static, u32, Table<1>>);

impl postcard::ser_flavors::Flavor for ByteSum<'_> {
    type Output = ();

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.0.update(&[byte]);
        Ok(())
    }

    fn finalize(self) -> postcard::Result<()> {
        Ok(())
    }
}
