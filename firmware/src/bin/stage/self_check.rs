//! What the chip says of itself at the start: which one it is, how it was set up, whether the program is whole.

use core::ptr::addr_of;
use firmware::{
    gcs::BoardNotice,
    image_checksum::{NO_CHECKSUM, image_checksum},
};
use stm32f4xx_hal::pac;

/// The image's checksum, which `cargo seal` puts here.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".rodata.IMAGE_CHECKSUM")]
pub static IMAGE_CHECKSUM: u32 = NO_CHECKSUM;

/// Where the manufacturer says how many KiB of flash there are. Some chips have nothing there.
const FLASH_KIB: *const u16 = 0x1FFF_7A22 as *const u16;
const BOTH_BANKS_KIB: u16 = 2048;
/// Revisions A, Y and 1; the next is 3.
const EARLY_REVISIONS: [u16; 3] = [0x1000, 0x1003, 0x1007];
/// Code of the highest level, 2.7 V.
const BROWN_OUT_LEVEL_3: u8 = 0;
const BFB2: u32 = 1 << 4;

unsafe extern "C" {
    /// Begin of the image, of the RAM that is filled from it, its end, and where it is filled from.
    static __vector_table: u8;
    static __sdata: u8;
    static __edata: u8;
    static __sidata: u8;
}

/// What was found.
pub struct SelfCheck {
    /// Both banks of flash are there.
    pub has_second_bank: bool,
    /// The program is not what was linked.
    pub image_damaged: bool,
    notices: [(bool, BoardNotice); 5],
}

impl SelfCheck {
    /// Looks.
    pub fn new(dbgmcu: &pac::DBGMCU, flash: &pac::FLASH) -> Self {
        // SAFETY: the word is there on every chip of the family.
        let flash_kib = unsafe { FLASH_KIB.read_volatile() };
        let has_second_bank = matches!(flash_kib, 0 | BOTH_BANKS_KIB..);
        let options = flash.optcr().read();
        let revision = dbgmcu.idcode().read().rev_id().bits();
        let (image, checksum_at, checksum) = image();
        let is_whole = |checksum| checksum == image_checksum(image, checksum_at);
        let brown_out = options.bor_lev().bits() == BROWN_OUT_LEVEL_3;
        Self {
            has_second_bank,
            image_damaged: !checksum.is_none_or(is_whole),
            notices: [
                (!brown_out, BoardNotice::BrownOutLevel),
                (options.bits() & BFB2 != 0, BoardNotice::BootsFromSettings),
                (
                    EARLY_REVISIONS.contains(&revision),
                    BoardNotice::EarlySilicon,
                ),
                (!has_second_bank, BoardNotice::NoSecondBank),
                (checksum.is_none(), BoardNotice::NoChecksum),
            ],
        }
    }

    /// What is no fault, for `EVT?`.
    pub fn notices(&self) -> impl Iterator<Item = BoardNotice> {
        let found = self.notices.iter().filter(|(is_so, _)| *is_so);
        found.map(|(_, notice)| *notice)
    }
}

/// Whether the processor looks for its vectors where this image has them, whoever started it.
pub fn has_own_vectors() -> bool {
    // SAFETY: reading this register has no effect.
    let vectors = unsafe { &*cortex_m::peripheral::SCB::PTR }.vtor.read();
    vectors as usize == addr_of!(__vector_table) as usize
}

/// The image in flash, where in it its checksum lies, and that, if it has one.
pub fn image() -> (&'static [u8], usize, Option<u32>) {
    let begin = addr_of!(__vector_table);
    let checksum_at = addr_of!(IMAGE_CHECKSUM) as usize - begin as usize;
    let filled = addr_of!(__edata) as usize - addr_of!(__sdata) as usize;
    let length = addr_of!(__sidata) as usize + filled - begin as usize;
    // SAFETY: the image from its first byte to its last, which nobody writes.
    let image = unsafe { core::slice::from_raw_parts(begin, length) };
    // SAFETY: read as it lies in flash: the tool writes it after the compiler has seen it.
    let checksum = unsafe { addr_of!(IMAGE_CHECKSUM).read_volatile() };
    let checksum = (checksum != NO_CHECKSUM).then_some(checksum);
    (image, checksum_at, checksum)
}
