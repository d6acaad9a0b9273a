//! The image taken apart: functions, and what leads from one to another.

use super::elf::{Elf, even};
use super::error::ProofError;
use super::step::{Decoded, Engine, Step};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

/// Both banks of the flash.
pub(super) const FLASH: Range<u64> = 0x0800_0000..0x0820_0000;

/// What the linker calls its long jumps.
const LONG_JUMP: &str = "__Thumbv7ABSLongThunk_";

/// How one function leads to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Edge {
    /// Address of the other one.
    pub to: u64,
    /// Nothing of the first one's frame is left by then.
    pub tail: bool,
}

/// One function.
#[derive(Clone, Debug, Default)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// Where it leads.
    pub edges: BTreeSet<Edge>,
    /// Where it calls through a pointer.
    pub pointers: Vec<u64>,
    /// Everything it pushes, bytes.
    pub frame: u32,
    /// Where it has a trap, a fused multiply-add, an unknown change of the stack pointer, a change of an interrupt mask.
    pub traps: Vec<u64>,
    #[allow(missing_docs)]
    pub fused: Vec<u64>,
    #[allow(missing_docs)]
    pub unknown: Vec<u64>,
    #[allow(missing_docs)]
    pub masks: Vec<(u64, String)>,
    /// Where it comes by an address of the flash.
    pub flash: Vec<u64>,
    /// Instructions.
    pub instructions: u32,
    /// Bytes.
    pub size: u64,
}

/// All of them.
pub struct Code {
    /// By address.
    pub functions: BTreeMap<u64, Function>,
    /// Functions whose address stands in a word of data, or is put together by two instructions.
    pub taken: BTreeSet<u64>,
    /// What handles exceptions and interrupts.
    pub handlers: BTreeSet<u64>,
    /// The memory of the stack, bytes.
    pub stack: u64,
}

impl Code {
    /// Reads an image.
    ///
    /// # Errors
    /// When there is anything in it that is not understood.
    pub fn read(path: &Path) -> Result<Self, ProofError> {
        let bytes = std::fs::read(path).map_err(|error| ProofError::File(error.to_string()))?;
        Self::of(&Elf::read(&bytes).map_err(ProofError::File)?)
    }

    pub(super) fn of(elf: &Elf) -> Result<Self, ProofError> {
        let engine = Engine::new()?;
        let mut code = Self {
            functions: BTreeMap::new(),
            taken: BTreeSet::new(),
            handlers: elf
                .vectors
                .iter()
                .filter(|it| **it != 0)
                .map(|it| even(*it))
                .collect(),
            stack: elf.stack,
        };
        for (&at, (name, size)) in &elf.functions {
            let function = code.function(&engine, elf, at, name, *size)?;
            code.functions.insert(at, function);
        }
        let words = elf.words.iter().copied();
        code.taken
            .extend(words.filter(|word| word & 1 == 1).map(even));
        code.taken.retain(|at| elf.functions.contains_key(at));
        Ok(code)
    }

    fn function(
        &mut self,
        engine: &Engine,
        elf: &Elf,
        at: u64,
        name: &str,
        size: u64,
    ) -> Result<Function, ProofError> {
        let end = at + size;
        let mut function = Function {
            name: name.to_owned(),
            size,
            ..Function::default()
        };
        let mut lower = BTreeMap::<u16, Vec<u32>>::new();
        let instructions = elf.instructions(engine, at, size)?;
        if let Some(to) = long_jump(name, &instructions) {
            let nowhere = || ProofError::Nowhere(name.to_owned(), to);
            let to = owner(elf, to).ok_or_else(nowhere)?;
            function.edges.insert(Edge { to, tail: true });
            function.instructions += instructions.len() as u32;
            return Ok(function);
        }
        for (here, decoded) in instructions {
            self.note(&mut function, &mut lower, (at..end, here), decoded, elf)?;
        }
        Ok(function)
    }

    /// Takes note of what the instruction at an address of a function means.
    fn note(
        &mut self,
        function: &mut Function,
        lower: &mut BTreeMap<u16, Vec<u32>>,
        (all, at): (Range<u64>, u64),
        decoded: Decoded,
        elf: &Elf,
    ) -> Result<(), ProofError> {
        function.instructions += 1;
        let mut lead = |to: u64, tail: bool| {
            let nowhere = || ProofError::Nowhere(function.name.clone(), to);
            let to = owner(elf, to).ok_or_else(nowhere)?;
            function.edges.insert(Edge { to, tail });
            Ok(())
        };
        match decoded.step {
            Step::Call(to) => lead(to, false)?,
            Step::Jump(to) if all.contains(&to) => {}
            Step::Jump(to) => lead(to, true)?,
            Step::CallPointer | Step::JumpPointer => function.pointers.push(at),
            Step::Grow(bytes) => function.frame += bytes,
            Step::StackUnknown => function.unknown.push(at),
            Step::Trap => function.traps.push(at),
            Step::Fused => function.fused.push(at),
            Step::Mask => function.masks.push((at, decoded.text)),
            Step::Lower(register, half) => lower.entry(register).or_default().push(half),
            // With every lower half that this register has had: too many rather than too few.
            Step::Upper(register, half) => {
                if FLASH.contains(&(u64::from(half) << 16)) {
                    function.flash.push(at);
                }
                let lower = lower.get(&register).map_or(&[][..], |halves| halves);
                let whole = lower.iter().map(|lower| u64::from(half << 16 | lower));
                self.taken.extend(whole.filter(|it| it & 1 == 1).map(even));
            }
            Step::Literal(place) => {
                let word = elf.word(place).ok_or(ProofError::Bytes(place))?;
                if FLASH.contains(&word.into()) {
                    function.flash.push(at);
                }
            }
            Step::Plain => {}
        }
        Ok(())
    }

    /// The function of this name.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<u64> {
        let found = self.functions.iter().find(|(_, it)| it.name == name);
        found.map(|(at, _)| *at)
    }

    /// Its name; an address where there is none.
    #[must_use]
    pub fn name(&self, at: u64) -> String {
        let function = self.functions.get(&at);
        function.map_or_else(|| format!("{at:#010x}"), |it| it.name.clone())
    }

    /// Every instruction that holds interrupts back or lets them through, with its function.
    pub fn masks(&self) -> impl Iterator<Item = (&str, u64, &str)> {
        self.functions.values().flat_map(|function| {
            let masks = function.masks.iter();
            masks.map(|(at, text)| (&*function.name, *at, &**text))
        })
    }
}

/// Where the linker's own jump leads to that goes further than an instruction reaches: from flash to RAM, or back.
fn long_jump(name: &str, instructions: &[(u64, Decoded)]) -> Option<u64> {
    let steps: Vec<_> = instructions
        .iter()
        .map(|(_, decoded)| &decoded.step)
        .collect();
    match steps[..] {
        [
            Step::Lower(from, lower),
            Step::Upper(to, upper),
            Step::JumpPointer,
        ] if name.starts_with(LONG_JUMP) && from == to => {
            Some(even(u64::from(upper << 16 | lower)))
        }
        _ => None,
    }
}

/// The function in which an address lies.
fn owner(elf: &Elf, at: u64) -> Option<u64> {
    let (start, (_, size)) = elf.functions.range(..=at).next_back()?;
    (at < start + size).then_some(*start)
}
