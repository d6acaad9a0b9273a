//! The checksum of an image in flash: given by a tool after linking, checked at every start.

use crc::{CRC_32_ISO_HDLC, Crc, Table};

/// What an image carries that was given no checksum: what erased flash reads.
pub const NO_CHECKSUM: u32 = u32::MAX;

/// CRC-32 of an image but for the four bytes at `checksum_at`, where its checksum lies. Never [`NO_CHECKSUM`].
pub fn image_checksum(image: &[u8], checksum_at: usize) -> u32 {
    // 30 ms at a start for half a megabyte; the larger tables are flash, and no faster from there.
    const CRC: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);
    let mut digest = CRC.digest();
    digest.update(image.get(..checksum_at).unwrap_or(image));
    digest.update(image.get(checksum_at + 4..).unwrap_or_default());
    match digest.finalize() {
        NO_CHECKSUM => 0,
        checksum => checksum,
    }
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
