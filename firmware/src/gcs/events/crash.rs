//! How a program ended before this start.

use core::fmt;

/// How many bytes of a source file's path are kept: its end.
pub const CRASH_FILE_BYTES: usize = 12;

/// How a program ended before this start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crash {
    /// A panic.
    Panic {
        /// The end of the source file's path, without extension: [`Crash::file_end`].
        file: [u8; CRASH_FILE_BYTES],
        /// Its line.
        line: u16,
    },
    /// An exception of the processor.
    Exception {
        /// Why.
        cause: CrashCause,
        /// Where; 0 where there was no stack left to tell it.
        program_counter: u32,
        /// The return address then.
        link: u32,
        /// The processor's fault status (ARMv7-M: `CFSR`).
        status: u32,
    },
    /// Where the stack stood at the exception, and how a fault came to be one (ARMv7-M: `HFSR`).
    State {
        /// The stack pointer.
        stack: u32,
        /// The processor's hard fault status.
        hard_fault: u32,
    },
    /// Which address the instruction of the exception could not reach, where the processor knows it.
    NoAccess(u32),
}

/// Why the processor has left the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum CrashCause {
    /// The crystal stopped.
    ClockFailure,
    /// An instruction or an access was none.
    ProcessorFault,
    /// The control loop did not end its tick, or had none.
    LoopStoodStill,
    /// An interrupt that nobody has enabled.
    UnexpectedInterrupt,
}

impl CrashCause {
    /// All of them, each in the place of its number.
    pub(super) const ALL: [Self; 4] = [
        Self::ClockFailure,
        Self::ProcessorFault,
        Self::LoopStoodStill,
        Self::UnexpectedInterrupt,
    ];

    const fn text(self) -> &'static str {
        match self {
            Self::ClockFailure => "the crystal stopped",
            Self::ProcessorFault => "processor fault",
            Self::LoopStoodStill => "the control loop stood still",
            Self::UnexpectedInterrupt => "unexpected interrupt",
        }
    }
}

impl Crash {
    /// What is kept of a source file's path: its end without the extension, behind zeros where it is shorter.
    pub fn file_end(path: &str) -> [u8; CRASH_FILE_BYTES] {
        let path = path.strip_suffix(".rs").unwrap_or(path);
        let mut end = [0; CRASH_FILE_BYTES];
        for (place, byte) in end.iter_mut().rev().zip(path.bytes().rev()) {
            *place = byte;
        }
        end
    }
}

impl fmt::Display for Crash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panic { file, line } => {
                f.write_str("before the start: panic in ")?;
                for byte in file.iter().filter(|byte| byte.is_ascii_graphic()) {
                    write!(f, "{}", char::from(*byte))?;
                }
                write!(f, ", line {line}")
            }
            Self::Exception {
                cause,
                program_counter,
                link,
                status,
            } => {
                write!(f, "before the start: {}", cause.text())?;
                if *program_counter == 0 {
                    f.write_str(", its stack lost")?;
                } else {
                    write!(f, " at {program_counter:#010x}, called from {link:#010x}")?;
                }
                if *status != 0 {
                    write!(f, ", status {status:#010x}")?;
                }
                Ok(())
            }
            Self::State { stack, hard_fault } => write!(
                f,
                "before the start: stack at {stack:#010x}, hard fault status {hard_fault:#010x}"
            ),
            Self::NoAccess(address) => write!(f, "before the start: no access to {address:#010x}"),
        }
    }
}
