//! The image's file: functions, which bytes of its code are instructions, the vector table, words that could be addresses.

use super::error::ProofError;
use super::step::{Decoded, Engine};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use std::collections::BTreeMap;
use std::ops::Range;

const VECTORS: &str = ".vector_table";
/// Where code is: what runs from flash, and what from RAM, which not every image has.
const TEXT: &str = ".text";
const LOOP: &str = ".control_loop";

/// What the proofs read of the file.
pub struct Elf {
    /// Names by address, with sizes.
    pub functions: BTreeMap<u64, (String, u64)>,
    /// The code, by where it lies when it runs.
    pub code: Vec<(u64, Vec<u8>)>,
    /// Parts of it that are constants.
    pub constants: Vec<Range<u64>>,
    /// Every vector but the first, which is the stack's start.
    pub vectors: Vec<u64>,
    /// Every word that is not an instruction, outside the vector table.
    pub words: Vec<u64>,
    /// The memory of the stack, bytes.
    pub stack: u64,
}

impl Elf {
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let file = object::File::parse(bytes).map_err(|error| error.to_string())?;
        let section = |name: &str| {
            let section = file.section_by_name(name);
            let found = section.and_then(|section| Some((section.address(), section.data().ok()?)));
            found.ok_or_else(|| format!("no section {name}"))
        };
        let mut code = vec![section(TEXT)?];
        code.extend(section(LOOP));
        let constants = code.iter().zip([TEXT, LOOP]);
        let constants = constants
            .flat_map(|((at, bytes), name)| constants_of(&file, name, at + bytes.len() as u64));
        let constants: Vec<Range<u64>> = constants.collect();
        let mut found = Vec::new();
        for (at, data) in [section(".rodata")?, section(".data")?] {
            found.extend(words(data, at));
        }
        for range in &constants {
            let data = bytes_of(&code, range).unwrap_or_default();
            found.extend(words(data, range.start));
        }
        let address = |name: &str| {
            let symbol = file.symbol_by_name(name);
            let symbol = symbol.ok_or_else(|| format!("no symbol {name}"))?;
            Ok::<_, String>(symbol.address())
        };
        Ok(Self {
            functions: functions(&file),
            code: (code.into_iter())
                .map(|(at, bytes)| (at, bytes.to_vec()))
                .collect(),
            constants,
            vectors: words(section(VECTORS)?.1, 0).skip(1).collect(),
            words: found,
            stack: address("_stack_start")? - address("_stack_end")?,
        })
    }
}

impl Elf {
    /// The instructions of so many bytes of code, without the constants between them.
    pub fn instructions(
        &self,
        engine: &Engine,
        start: u64,
        size: u64,
    ) -> Result<Vec<(u64, Decoded)>, ProofError> {
        let end = start + size;
        let mut instructions = Vec::new();
        let mut next = start;
        while next < end {
            let constants = self.constants.iter().find(|range| range.contains(&next));
            if let Some(range) = constants {
                next = range.end;
                continue;
            }
            let bytes = bytes_of(&self.code, &(next..end)).ok_or(ProofError::Bytes(next))?;
            let decoded = engine.decode(bytes, next)?;
            let length = decoded.length;
            instructions.push((next, decoded));
            next += length;
        }
        Ok(instructions)
    }

    /// The word that stands in the code at an address.
    pub fn word(&self, at: u64) -> Option<u32> {
        let bytes = bytes_of(&self.code, &(at..at + 4))?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?))
    }
}

/// The bytes of code at these addresses.
fn bytes_of<'a, B: AsRef<[u8]>>(code: &'a [(u64, B)], range: &Range<u64>) -> Option<&'a [u8]> {
    code.iter().find_map(|(at, bytes)| {
        let start = range.start.checked_sub(*at)? as usize;
        bytes.as_ref().get(start..(range.end - at) as usize)
    })
}

/// Functions by address: of several names the one with a size, then the first.
fn functions(file: &object::File<'_>) -> BTreeMap<u64, (String, u64)> {
    let mut functions: BTreeMap<u64, (String, u64)> = BTreeMap::new();
    for symbol in file.symbols() {
        if symbol.kind() != SymbolKind::Text || symbol.size() == 0 {
            continue;
        }
        let name = symbol.name().unwrap_or_default();
        let name = format!("{:#}", rustc_demangle::demangle(name));
        functions
            .entry(even(symbol.address()))
            .or_insert((name, symbol.size()));
    }
    functions
}

/// From each symbol `$d` to the next `$t`: what the compiler calls data between the instructions.
fn constants_of(file: &object::File<'_>, section: &str, end: u64) -> Vec<Range<u64>> {
    let text = file.section_by_name(section).map(|section| section.index());
    let mut marks = BTreeMap::new();
    for symbol in file.symbols().filter(|it| it.section_index() == text) {
        match symbol.name() {
            Ok(name) if name.starts_with("$d") => drop(marks.insert(symbol.address(), true)),
            Ok(name) if name.starts_with("$t") => drop(marks.insert(symbol.address(), false)),
            _ => {}
        }
    }
    let ends = marks.keys().copied().skip(1).chain([end]);
    let ranges = marks.iter().zip(ends);
    ranges
        .filter(|((_, is_data), _)| **is_data)
        .map(|((start, _), end)| *start..end)
        .collect()
}

fn words(data: &[u8], at: u64) -> impl Iterator<Item = u64> {
    let skip = (at.wrapping_neg() % 4) as usize;
    let words = data.get(skip..).unwrap_or_default().chunks_exact(4);
    words.map(|word| u64::from(u32::from_le_bytes([word[0], word[1], word[2], word[3]])))
}

/// A function's address without the bit that says Thumb.
pub fn even(address: u64) -> u64 {
    address & !1
}
