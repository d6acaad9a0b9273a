//! Why nothing is proven.

/// Why nothing is proven.
#[derive(Debug, thiserror::Error)]
pub enum ProofError {
    /// The file is no image.
    #[error("{0}")]
    File(String),
    /// Bytes that should be an instruction.
    #[error("no instruction at {0:#010x}")]
    Bytes(u64),
    /// A jump to where no function is.
    #[error("{0} leads to {1:#010x}, where no function is")]
    Nowhere(String, u64),
    /// Functions that call each other round and round: their stack has no bound.
    #[error("recursion: {0}")]
    Recursion(String),
    /// The stack pointer changes in a way that is not understood.
    #[error("{0} moves the stack pointer at {1:#010x} in a way that is not understood")]
    StackPointer(String, u64),
    /// An interrupt handler of which the stack's table of levels knows nothing.
    #[error("{0} handles an interrupt of which the levels of the stack know nothing")]
    Handler(String),
}
