//! The instructions that an interrupt handler of the image can come to.

use super::instruction::Instruction;
use crate::proof::{Engine, ProofError, listing};
use std::collections::HashMap;
use std::path::Path;

/// By address.
#[derive(Clone, Debug)]
pub struct Program {
    instructions: HashMap<u64, Instruction>,
    /// As they are written.
    texts: HashMap<u64, String>,
}

impl Program {
    /// Everything from a handler on.
    ///
    /// # Errors
    /// When there is anything in the image that is not understood, or no such handler.
    pub fn read(path: &Path, handler: &str) -> Result<Self, ProofError> {
        let engine = Engine::new()?;
        let mut program = Self {
            instructions: HashMap::new(),
            texts: HashMap::new(),
        };
        for (at, decoded) in listing(path, handler)? {
            let instruction = Instruction::decode(&engine, &decoded.bytes, at)?;
            program.instructions.insert(at, instruction);
            program.texts.insert(at, decoded.text);
        }
        Ok(program)
    }

    /// The instruction at an address.
    #[must_use]
    pub fn at(&self, address: u64) -> Option<&Instruction> {
        self.instructions.get(&address)
    }

    /// The same as it is written.
    #[must_use]
    pub fn text(&self, address: u64) -> Option<&str> {
        self.texts.get(&address).map(String::as_str)
    }

    /// Where they stand.
    pub fn addresses(&self) -> impl Iterator<Item = u64> {
        self.instructions.keys().copied()
    }
}
