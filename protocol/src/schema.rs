//! One number for the shape of every message: two ends with the same number read each other's bytes.

use crate::crc::Crc32Flavor;
use crate::{Fault, Hello, HelloReply, Report, Request, Telemetry, Urgent};
use postcard_schema::Schema;

/// The number, as [`compute`] gives it; a test holds them equal. A constant, so that an MCU need not walk through all schemas.
pub const fn hash() -> u32 {
    0x7a13_a429
}

/// CRC-32 over the postcard schemas of everything that crosses the wire.
pub fn compute() -> u32 {
    let mut crc = Crc32Flavor::new();
    for schema in [
        Hello::SCHEMA,
        HelloReply::SCHEMA,
        Request::SCHEMA,
        Report::SCHEMA,
        Urgent::SCHEMA,
        Fault::SCHEMA,
        Telemetry::SCHEMA,
    ] {
        crc.add(schema);
    }
    crc.finish()
}
