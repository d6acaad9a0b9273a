//! Kept settings of which a bit has flipped, and those of a newer firmware.

use std::sync::OnceLock;

use crc::{CRC_32_ISO_HDLC, Crc};
use firmware::gcs::Session;
use firmware::parameters::Parameters;

use crate::machine::devices::{SettingsFlash, StageParameters};
use crate::random::Random;
use crate::rig::{ControllerMemory, Rig};

/// What an operator keeps, and the ticks in which it is kept.
const LINES: &[u8] = b"VLS 100\nCCL 1 ADVANCED\nSPA 1 0x54500300 260\nCMS 1\nWPA 100\nERR?\n";
const TICKS: u32 = 100;
/// Bytes of a record before what is kept: its head, twice, of which one may be damaged. Its CRC and its end stand behind.
const FRONT: usize = 32;
const LENGTH: usize = 8;
/// A record without moves and calibration has an older version than the newest that the firmware knows.
const MORE_THAN_KNOWN: u16 = 16;
/// That of the records, as zip and Ethernet have it.
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// A flash with settings that were whole once.
pub(super) fn damaged(random: &mut Random) -> SettingsFlash {
    let (mut bytes, length) = record();
    // What is kept, or the CRC behind it; not the bytes that fill up the last word.
    let place = random.below(length as u32 + 4) as usize;
    let filled = if place < length {
        place
    } else {
        length.next_multiple_of(4) + place - length
    };
    bytes[FRONT + filled] ^= 1 << random.below(8);
    SettingsFlash::holding(&bytes)
}

/// A flash with settings that a newer firmware has written: their version, which comes first, is a later one, and all else is whole.
pub(super) fn newer(random: &mut Random) -> SettingsFlash {
    let (mut bytes, length) = record();
    let version = u16::from_le_bytes([bytes[FRONT], bytes[FRONT + 1]]);
    let later = version + MORE_THAN_KNOWN + random.below(1_000) as u16;
    bytes[FRONT..FRONT + 2].copy_from_slice(&later.to_le_bytes());
    let end = FRONT + length.next_multiple_of(4);
    // Of the head, once, and of what is kept.
    let crc = CRC.checksum(&[&bytes[..FRONT / 2], &bytes[FRONT..FRONT + length]].concat());
    bytes[end..end + 4].copy_from_slice(&crc.to_le_bytes());
    SettingsFlash::holding(&bytes)
}

/// What is kept, in its record, and how long it is without that.
fn record() -> (Vec<u8>, usize) {
    static KEPT: OnceLock<Vec<u8>> = OnceLock::new();
    let bytes = KEPT.get_or_init(kept).clone();
    let length: [u8; 4] = [0, 1, 2, 3].map(|i| bytes[LENGTH + i]);
    (bytes, u32::from_le_bytes(length) as usize)
}

fn kept() -> Vec<u8> {
    // The machine comes with none, so that these are the only ones.
    let parameters = Parameters::REFERENCE.uncommissioned();
    let mut memory = ControllerMemory::new();
    let (stage, flash) = (StageParameters::REFERENCE, SettingsFlash::in_memory());
    let mut rig = Rig::simulated(&mut memory, &stage, &parameters, flash);
    let mut session = Session::new();
    let mut answers = Vec::new();
    session.receive(LINES);
    for _ in 0..TICKS {
        rig.tick(&mut ());
        // Writing to a vector does not fail.
        let _ = rig.service(&mut session, &mut answers);
        rig.keep();
    }
    assert_eq!(answers, b"0\n", "the settings are kept");
    rig.settings_store.flash().bytes().to_vec()
}
