//! One record of what outlives power, as it stands in flash: 64 bytes, the checksum last.
//!
//! | bytes | what |
//! |---|---|
//! | 0..4 | number of the record, the highest counts |
//! | 4..8 | number of the latest start |
//! | 8 | version of the settings that follow; 0 without any |
//! | 9..60 | settings in postcard, zeros behind them |
//! | 60..64 | CRC-32 of all before |

use zygote_protocol::Settings;

/// Bytes of a record; sectors hold a whole number of them.
pub(crate) const RECORD: usize = 64;
/// What the settings' bytes mean; another number is not ours to read.
pub(crate) const VERSION: u8 = 1;

const NOTHING: u8 = 0;
const CRC: crc::Crc<u32, crc::NoTable> = crc::Crc::<u32, crc::NoTable>::new(&crc::CRC_32_ISO_HDLC);

/// What is kept. Settings stay bytes, so that those of another firmware survive this one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Record {
    pub(crate) number: u32,
    pub(crate) start: u32,
    pub(crate) version: u8,
    pub(crate) settings: [u8; 51],
}

impl Record {
    /// The first one of a flash, before the start `start`.
    pub(crate) const fn first(start: u32) -> Self {
        Self { number: 0, start, version: NOTHING, settings: [0; 51] }
    }

    /// The same with these settings; `None` if they are too long for it.
    pub(crate) fn with(mut self, version: u8, settings: &Settings) -> Option<Self> {
        self.version = version;
        self.settings.fill(0);
        postcard::to_slice(settings, &mut self.settings).ok()?;
        Some(self)
    }

    /// The settings, if there are any; else the version that isn't ours.
    pub(crate) fn settings(&self) -> Result<Option<Settings>, u8> {
        match self.version {
            NOTHING => Ok(None),
            VERSION => postcard::take_from_bytes(&self.settings)
                .map(|(settings, _)| Some(settings))
                .map_err(|_| VERSION),
            other => Err(other),
        }
    }

    pub(crate) fn to_bytes(self) -> [u8; RECORD] {
        let front = self.number.to_le_bytes().into_iter().chain(self.start.to_le_bytes());
        let all = front.chain([self.version]).chain(self.settings);
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
            settings: rest.try_into().ok()?,
        })
    }
}
