//! Kept settings of which a bit has flipped.

use std::sync::OnceLock;

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

/// A flash with settings that were whole once.
pub(super) fn damaged(random: &mut Random) -> SettingsFlash {
    static KEPT: OnceLock<Vec<u8>> = OnceLock::new();
    let mut bytes = KEPT.get_or_init(kept).clone();
    let length: [u8; 4] = [0, 1, 2, 3].map(|i| bytes[LENGTH + i]);
    let length = u32::from_le_bytes(length) as usize;
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
