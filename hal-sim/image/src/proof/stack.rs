//! The deepest stack.

use super::code::Code;
use super::error::ProofError;
use std::collections::BTreeMap;

/// How deep calls through pointers nest at the most. A GCS answer is the deepest: the interpreter calls `core::fmt::write`,
/// which calls a value's `fmt` (1), which formats its parts by `write!` (2), a part being a reference whose `fmt` calls that of
/// what it refers to (3), which calls the writer (4), whose provided methods call `write_str` (5). One more for good measure.
pub const NESTING: u32 = 6;

/// Bytes that the processor pushes when an interrupt comes: 26 words with the floating-point unit's, and one to align them.
pub const EXCEPTION_FRAME: u64 = 4 * 27;

/// The first function: whoever started the chip, it sets the stack pointer to the stack's begin before anything else.
const START_UP: &str = "Reset";

/// Functions that share a priority, and so never stand on the stack together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// In words.
    pub name: &'static str,
    /// Its handlers.
    pub handlers: &'static [&'static str],
}

/// The levels, lowest priority first: each may interrupt the ones before it once.
pub const LEVELS: [Level; 5] = [
    Level {
        name: "start and idle task",
        handlers: &["Reset"],
    },
    Level {
        name: "recorders",
        handlers: &["CRYP"],
    },
    Level {
        name: "tick",
        handlers: &["TIM1_CC"],
    },
    Level {
        name: "latch",
        handlers: &["TIM3"],
    },
    Level {
        name: "processor faults",
        handlers: &["DefaultHandler"],
    },
];

/// Bytes of its memory that have to be left, so that a change or two still fit.
pub const STACK_LEFT: u64 = 4096;

/// Handlers of the control loop.
pub const CONTROL_LOOP: &[&str] = &["TIM3", "TIM1_CC"];

/// How deep a function gets, and on which way.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Depth {
    /// Bytes.
    pub bytes: u64,
    /// Addresses of the functions called, the deepest last.
    pub path: Vec<u64>,
}

/// Works depths out, each once.
pub struct Depths<'a> {
    code: &'a Code,
    known: BTreeMap<(u64, u32), Depth>,
    under_way: Vec<u64>,
}

impl<'a> Depths<'a> {
    /// Of the functions of an image.
    #[must_use]
    pub fn new(code: &'a Code) -> Self {
        Self {
            code,
            known: BTreeMap::new(),
            under_way: Vec::new(),
        }
    }

    /// How deep the function at an address gets, with so many calls through pointers one within the other.
    ///
    /// # Errors
    /// A recursion, or a stack pointer that moves in a way that is not understood.
    pub fn of(&mut self, at: u64, nesting: u32) -> Result<Depth, ProofError> {
        if let Some(depth) = self.known.get(&(at, nesting)) {
            return Ok(depth.clone());
        }
        let code = self.code;
        let Some(function) = code.functions.get(&at) else {
            return Ok(Depth::default());
        };
        if let Some(unknown) = function.unknown.first()
            && function.name != START_UP
        {
            return Err(ProofError::StackPointer(function.name.clone(), *unknown));
        }
        if self.under_way.contains(&at) {
            let names = self.under_way.iter().map(|at| code.name(*at));
            return Err(ProofError::Recursion(
                names.collect::<Vec<_>>().join(" -> "),
            ));
        }
        self.under_way.push(at);
        let frame = u64::from(function.frame);
        let mut deepest = Depth {
            bytes: frame,
            path: vec![at],
        };
        for edge in &function.edges {
            let below = self.of(edge.to, nesting)?;
            deepest.take(at, if edge.tail { 0 } else { frame }, &below);
        }
        self.under_way.pop();
        if !function.pointers.is_empty() && nesting > 0 {
            // A new search: a function may be called again through a pointer, that is what the nesting bounds.
            let under_way = std::mem::take(&mut self.under_way);
            for to in &code.taken {
                let below = self.of(*to, nesting - 1)?;
                deepest.take(at, frame, &below);
            }
            self.under_way = under_way;
        }
        self.known.insert((at, nesting), deepest.clone());
        Ok(deepest)
    }
}

impl Depth {
    fn take(&mut self, at: u64, frame: u64, below: &Self) {
        if frame + below.bytes > self.bytes {
            self.bytes = frame + below.bytes;
            self.path = std::iter::once(at)
                .chain(below.path.iter().copied())
                .collect();
        }
    }
}

/// The image's stack.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stack {
    /// Depth of each of the [`LEVELS`].
    pub levels: Vec<Depth>,
    /// All of them on top of each other, with what the processor pushes between them, bytes.
    pub bytes: u64,
    /// The memory it has, bytes.
    pub memory: u64,
}

impl Stack {
    /// The deepest that an image's stack gets.
    ///
    /// # Errors
    /// What makes that unknown.
    pub fn of(code: &Code, nesting: u32) -> Result<Self, ProofError> {
        let known = |at: &u64| {
            let name = code.name(*at);
            LEVELS.iter().any(|level| level.handlers.contains(&&*name))
        };
        if let Some(handler) = code.handlers.iter().find(|at| !known(at)) {
            return Err(ProofError::Handler(code.name(*handler)));
        }
        let mut depths = Depths::new(code);
        let mut levels = Vec::new();
        for level in LEVELS {
            let mut deepest = Depth::default();
            for handler in level.handlers.iter().filter_map(|name| code.named(name)) {
                let depth = depths.of(handler, nesting)?;
                deepest = if depth.bytes > deepest.bytes {
                    depth
                } else {
                    deepest
                };
            }
            levels.push(deepest);
        }
        let frames = EXCEPTION_FRAME * (LEVELS.len() as u64 - 1);
        Ok(Self {
            bytes: levels.iter().map(|depth| depth.bytes).sum::<u64>() + frames,
            levels,
            memory: code.stack,
        })
    }

    /// Bytes left.
    #[must_use]
    pub fn left(&self) -> u64 {
        self.memory.saturating_sub(self.bytes)
    }
}
