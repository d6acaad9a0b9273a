//! The instructions that a function can come to.

use super::code::Code;
use super::elf::Elf;
use super::error::ProofError;
use super::step::{Decoded, Engine};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Every instruction of a function and of all that it leads to, by address.
///
/// # Errors
/// When there is anything in the image that is not understood, or no such function.
pub fn listing(path: &Path, start: &str) -> Result<BTreeMap<u64, Decoded>, ProofError> {
    let bytes = std::fs::read(path).map_err(|error| ProofError::File(error.to_string()))?;
    let elf = Elf::read(&bytes).map_err(ProofError::File)?;
    let code = Code::of(&elf)?;
    let none = || ProofError::File(format!("no function {start}"));
    let mut waiting = vec![code.named(start).ok_or_else(none)?];
    let mut seen: BTreeSet<u64> = waiting.iter().copied().collect();
    let mut instructions = BTreeMap::new();
    let engine = Engine::new()?;
    while let Some(at) = waiting.pop() {
        let (Some(function), Some((_, size))) = (code.functions.get(&at), elf.functions.get(&at))
        else {
            continue;
        };
        for (at, decoded) in elf.instructions(&engine, at, *size)? {
            instructions.insert(at, decoded);
        }
        let next = function.edges.iter().map(|edge| edge.to);
        waiting.extend(next.filter(|to| seen.insert(*to)));
    }
    Ok(instructions)
}
