//! The checksum in an image: worked out over what will lie in flash, and written into its file.

use firmware::image_checksum::{NO_CHECKSUM, image_checksum};
use object::read::elf::{ElfFile32, FileHeader, ProgramHeader};
use object::{Endianness, Object, ObjectSymbol, elf};

/// Where the image's start-up looks for it.
const CHECKSUM: &str = "IMAGE_CHECKSUM";
/// What flash reads where nobody has written.
const ERASED: u8 = 0xFF;
const CHECKSUM_BYTES: usize = 4;

/// Gives an image its checksum.
///
/// # Errors
/// What is wrong with the file.
pub fn seal(image: Vec<u8>) -> Result<Vec<u8>, String> {
    let (at, checksum) = checksum(&image)?;
    with_checksum(image, at, checksum)
}

/// The image as it was linked, whether it was given its checksum or not.
///
/// # Errors
/// What is wrong with the file.
pub fn unseal(image: Vec<u8>) -> Result<Vec<u8>, String> {
    let (at, _) = checksum(&image)?;
    with_checksum(image, at, NO_CHECKSUM)
}

fn with_checksum(mut image: Vec<u8>, at: usize, checksum: u32) -> Result<Vec<u8>, String> {
    let place = image.get_mut(at..at + CHECKSUM_BYTES);
    place
        .ok_or("the checksum lies behind the end of the file")?
        .copy_from_slice(&checksum.to_le_bytes());
    Ok(image)
}

/// Where in the file the checksum lies, and what it should be.
fn checksum(image: &[u8]) -> Result<(usize, u32), String> {
    let said = |error: object::Error| error.to_string();
    let file = ElfFile32::<Endianness>::parse(image).map_err(said)?;
    let endian = file.endian();
    let headers = file
        .elf_header()
        .program_headers(endian, image)
        .map_err(said)?;
    // Address in flash, place in the file, bytes.
    let mut parts: Vec<(usize, usize, &[u8])> = Vec::new();
    for header in headers {
        let bytes = header
            .data(endian, image)
            .map_err(|()| "a part lies behind the end of the file")?;
        if header.p_type(endian) == elf::PT_LOAD && !bytes.is_empty() {
            let (address, place) = (header.p_paddr(endian), header.p_offset(endian));
            parts.push((address as usize, place as usize, bytes));
        }
    }
    let begin = parts.iter().map(|(address, ..)| *address).min();
    let begin = begin.ok_or("nothing in it is for flash")?;
    let end = parts
        .iter()
        .map(|(address, _, bytes)| address + bytes.len())
        .max();
    let mut flash = vec![ERASED; end.unwrap_or(begin) - begin];
    for (address, _, bytes) in &parts {
        flash[address - begin..][..bytes.len()].copy_from_slice(bytes);
    }
    let symbol = file.symbols().find(|symbol| symbol.name() == Ok(CHECKSUM));
    let symbol = symbol.ok_or("it has no place for a checksum")?.address() as usize;
    let place = parts.iter().find_map(|(address, place, bytes)| {
        let within = symbol.checked_sub(*address)?;
        (within + CHECKSUM_BYTES <= bytes.len()).then_some(place + within)
    });
    let place = place.ok_or("its checksum is not in flash")?;
    Ok((place, image_checksum(&flash, symbol - begin)))
}
