//! The checksum of an image in flash: given by a tool after linking, checked at every start and from then on.

use crc::{CRC_32_ISO_HDLC, Crc, Digest, Table};

/// What an image carries that was given no checksum: what erased flash reads.
pub const NO_CHECKSUM: u32 = u32::MAX;

// 30 ms at a start for half a megabyte; the larger tables are flash, and no faster from there.
static CRC: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);

/// The checksum of an image that is looked at piece by piece, but for the four bytes where its checksum lies.
pub struct ImageDigest(Digest<'static, u32, Table<1>>);

#[allow(clippy::new_without_default)] // Of no bytes yet: nothing that anybody has.
impl ImageDigest {
    /// Of no bytes yet.
    pub fn new() -> Self {
        Self(CRC.digest())
    }

    /// Takes the bytes that follow.
    pub fn update(&mut self, piece: &[u8]) {
        self.0.update(piece);
    }

    /// The checksum. Never [`NO_CHECKSUM`].
    pub fn finish(self) -> u32 {
        match self.0.finalize() {
            NO_CHECKSUM => 0,
            checksum => checksum,
        }
    }
}

/// CRC-32 of an image but for the four bytes at `checksum_at`, where its checksum lies. Never [`NO_CHECKSUM`].
// In a place of its own in the image: a bench lets it say what it likes.
#[inline(never)]
pub fn image_checksum(image: &[u8], checksum_at: usize) -> u32 {
    let mut digest = ImageDigest::new();
    digest.update(image.get(..checksum_at).unwrap_or(image));
    digest.update(image.get(checksum_at + 4..).unwrap_or_default());
    digest.finish()
}

#[cfg(test)]
mod tests {
    use super::image_checksum;

    #[test]
    fn every_bit_counts_but_those_of_the_checksum_itself() {
        let image = [0x5A; 64];
        let sound = image_checksum(&image, 20);
        for bit in 0..8 * image.len() {
            let mut flipped = image;
            flipped[bit / 8] ^= 1 << (bit % 8);
            let is_own = (20..24).contains(&(bit / 8));
            assert_eq!(image_checksum(&flipped, 20) == sound, is_own, "bit {bit}");
        }
    }
}
