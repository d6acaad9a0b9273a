//! What a board finds out about itself at the start, and what is no fault.

/// What a board finds out about itself at the start, and what is no fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum BoardNotice {
    /// A dip of the chip's supply under 2.7 V resets it only with the option bytes set so.
    BrownOutLevel,
    /// The option bytes start the chip from the second bank of flash, where settings are.
    BootsFromSettings,
    /// Silicon with errata that later ones do not have.
    EarlySilicon,
    /// A chip with half the flash.
    NoSecondBank,
    /// Nobody has given the image a checksum.
    NoChecksum,
}

impl BoardNotice {
    /// All of them, each in the place of its number.
    pub(super) const ALL: [Self; 5] = [
        Self::BrownOutLevel,
        Self::BootsFromSettings,
        Self::EarlySilicon,
        Self::NoSecondBank,
        Self::NoChecksum,
    ];

    /// In words.
    pub(super) const fn text(self) -> &'static str {
        match self {
            Self::BrownOutLevel => {
                "option bytes: brown-out reset not at level 3 (BOR_LEV 0), a dip of the chip's supply may go unnoticed"
            }
            Self::BootsFromSettings => {
                "option bytes: BFB2 is set, the chip may start from the wrong bank"
            }
            Self::EarlySilicon => "silicon before revision 3",
            Self::NoSecondBank => "the chip has less than 2 MB of flash: settings can not be kept",
            Self::NoChecksum => "the image has no checksum: damage to it would not be found",
        }
    }
}
