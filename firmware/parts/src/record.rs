//! One record of what outlives power, as it stands in flash: 512 bytes, the checksum last.
//!
//! | bytes | what |
//! |---|---|
//! | 0..4 | number of the record, the highest counts |
//! | 4..8 | number of the latest start |
//! | 8 | version of what follows; 0 without anything |
//! | 9..508 | settings and calibrations ([`Kept`]) in postcard, zeros behind them |
//! | 508..512 | CRC-32 of all before |

use zygote_protocol::Kept;

/// Bytes of a record; sectors hold a whole number of them.
pub(crate) const RECORD: usize = 512;
/// What the kept bytes mean; another number is not ours to read. Version 1 had settings alone, in records of 64 bytes.
pub(crate) const VERSION: u8 = 2;
/// Bytes of a record for what is kept.
const ROOM: usize = RECORD - 13;

const NOTHING: u8 = 0;
const CRC: crc::Crc<u32, crc::NoTable> = crc::Crc::<u32, crc::NoTable>::new(&crc::CRC_32_ISO_HDLC);

/// What is kept stays bytes, so that what another firmware kept survives this one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Record {
    pub(crate) number: u32,
    pub(crate) start: u32,
    pub(crate) version: u8,
    pub(crate) kept: [u8; ROOM],
}

impl Record {
    /// The first one of a flash, before the start `start`.
    pub(crate) const fn first(start: u32) -> Self {
        Self { number: 0, start, version: NOTHING, kept: [0; ROOM] }
    }

    /// The same with this kept; `None` if it is too long for a record.
    pub(crate) fn with<const H: usize, const S: usize>(
        mut self,
        version: u8,
        kept: &Kept<H, S>,
    ) -> Option<Self> {
        self.version = version;
        self.kept.fill(0);
        postcard::to_slice(kept, &mut self.kept).ok()?;
        Some(self)
    }

    /// What is kept, if anything is; else the version that isn't ours.
    pub(crate) fn kept<const H: usize, const S: usize>(&self) -> Result<Option<Kept<H, S>>, u8> {
        match self.version {
            NOTHING => Ok(None),
            VERSION => postcard::take_from_bytes(&self.kept).map(|(kept, _)| Some(kept)).map_err(|_| VERSION),
            other => Err(other),
        }
    }

    pub(crate) fn to_bytes(self) -> [u8; RECORD] {
        let front = self.number.to_le_bytes().into_iter().chain(self.start.to_le_bytes());
        let all = front.chain([self.version]).chain(self.kept);
        let mut bytes = [0; RECORD];
        bytes.iter_mut().zip(all).for_each(|(place, byte)| *place = byte);
        let (content, sum) = bytes.split_at_mut(RECORD - 4);
        sum.copy_from_slice(&CRC.checksum(content).to_le_bytes());
        bytes
    }

    /// The record in these bytes, if its checksum is right.
    pub(crate) fn from_bytes(bytes: &[u8; RECORD]) -> Option<Self> {
        let (content, sum) = bytes.split_last_chunk::<4>()?;
        if CRC.checksum(content) != u32::from_le_bytes(*sum) {
            return None;
        }
        let (number, rest) = content.split_first_chunk()?;
        let (start, rest) = rest.split_first_chunk()?;
        let (&version, rest) = rest.split_first()?;
        Some(Self {
            number: u32::from_le_bytes(*number),
            start: u32::from_le_bytes(*start),
            version,
            kept: rest.try_into().ok()?,
        })
    }
}
