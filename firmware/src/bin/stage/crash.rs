//! Why the program has ended: kept over the reset that follows, and told by `EVT?` after it.

use core::sync::atomic::{AtomicU32, Ordering};
use firmware::gcs::{CRASH_FILE_BYTES, Crash, CrashCause};
use stm32f4xx_hal::pac::Interrupt;

/// Words that are kept.
const WORDS: usize = 9;
/// What they begin with when the rest is a panic's.
const PANIC_MAGIC: u32 = 0x5041_4E49;
/// When it is an exception's.
pub const EXCEPTION_MAGIC: u32 = 0x4558_4350;

/// The words: which kind, then what the kind has. The start-up code leaves them alone. Of an exception, written in
/// [`fault_handlers`](crate::fault_handlers): its number, the stack pointer, program counter, link register, and the
/// registers CFSR, HFSR, MMFAR and BFAR of the processor.
#[unsafe(link_section = ".ccm.CRASH")]
pub static CRASH: [AtomicU32; WORDS] = [const { AtomicU32::new(0) }; WORDS];

/// Numbers of exceptions: the processor's own, and the first of the chip's.
const NON_MASKABLE: u32 = 2;
const HARD_FAULT: u32 = 3;
const FIRST_INTERRUPT: u32 = 16;
const WINDOW_WATCHDOG: u32 = FIRST_INTERRUPT + Interrupt::WWDG as u32;

/// Which of two addresses is the one that could not be reached, of CFSR.
const MEMORY_ADDRESS_VALID: u32 = 1 << 7;
const BUS_ADDRESS_VALID: u32 = 1 << 15;

/// Keeps where a panic was.
pub fn keep_panic(location: Option<&core::panic::Location<'_>>) {
    let (file, line) = location.map_or(("", 0), |location| (location.file(), location.line()));
    let words = Crash::file_end(file);
    CRASH[1].store(line, Ordering::Relaxed);
    for (place, word) in CRASH[2..].iter().zip(words.chunks_exact(4)) {
        let mut bytes = [0; 4];
        bytes.copy_from_slice(word);
        place.store(u32::from_le_bytes(bytes), Ordering::Relaxed);
    }
    CRASH[0].store(PANIC_MAGIC, Ordering::Release);
}

/// What was kept, once: the end of the program, the processor's state then, and the address that it could not reach.
pub fn take() -> [Option<Crash>; 3] {
    let words: [u32; WORDS] = core::array::from_fn(|i| CRASH[i].load(Ordering::Relaxed));
    match CRASH[0].swap(0, Ordering::Acquire) {
        PANIC_MAGIC => {
            let mut file = [0; CRASH_FILE_BYTES];
            for (bytes, word) in file.chunks_exact_mut(4).zip(&words[2..]) {
                bytes.copy_from_slice(&word.to_le_bytes());
            }
            let line = u16::try_from(words[1]).unwrap_or(u16::MAX);
            [Some(Crash::Panic { file, line }), None, None]
        }
        EXCEPTION_MAGIC => {
            let [
                _,
                number,
                stack,
                program_counter,
                link,
                status,
                hard_fault,
                memory,
                bus,
            ] = words;
            let address = if status & BUS_ADDRESS_VALID != 0 {
                Some(bus)
            } else {
                (status & MEMORY_ADDRESS_VALID != 0).then_some(memory)
            };
            let exception = Crash::Exception {
                cause: cause(number),
                program_counter,
                link,
                status,
            };
            let state = Crash::State { stack, hard_fault };
            [Some(exception), Some(state), address.map(Crash::NoAccess)]
        }
        _ => [None; 3],
    }
}

const fn cause(number: u32) -> CrashCause {
    match number {
        NON_MASKABLE => CrashCause::ClockFailure,
        HARD_FAULT => CrashCause::ProcessorFault,
        WINDOW_WATCHDOG => CrashCause::LoopStoodStill,
        _ => CrashCause::UnexpectedInterrupt,
    }
}
