//! The chip's own number, which the maker has burnt in.

use core::fmt::Write;
use heapless::String;

/// Where its 12 bytes lie.
const UNIQUE_ID: *const [u8; 12] = 0x1FFF_7A10 as *const [u8; 12];

/// The number in hexadecimal.
pub type Serial = String<24>;

/// The serial number of this chip.
pub fn serial() -> Serial {
    // SAFETY: 12 bytes of the system memory, which can be read on every part of the family.
    let id = unsafe { UNIQUE_ID.read_volatile() };
    let mut serial = Serial::new();
    for byte in id {
        // Two digits for each of 12 bytes fit.
        let _ = write!(serial, "{byte:02X}");
    }
    serial
}
