//! The proofs as they are printed.

use super::code::Code;
use super::safe::{Fault, reached_bytes};
use super::stack::{EXCEPTION_FRAME, LEVELS, NESTING, Stack};
use std::fmt::Write;

/// What holds of the control loop, or what does not.
#[must_use]
pub fn print_proof(code: &Code, handlers: &[&str], faults: &[Fault]) -> String {
    let mut text = String::new();
    let functions = code.functions.len();
    let instructions: u32 = code.functions.values().map(|it| it.instructions).sum();
    let _ = writeln!(text, "{functions} functions, {instructions} instructions");
    if faults.is_empty() {
        let _ = writeln!(
            text,
            "control loop ({}): no way to a panic, a trap, a call through a pointer, a recursion, or f64",
            handlers.join(", ")
        );
        let bytes = reached_bytes(code, handlers);
        let _ = writeln!(
            text,
            "control loop: all {bytes} bytes of its code are in RAM, and it makes no address of the flash"
        );
        let _ = writeln!(text, "image: no fused multiply-add");
    }
    for fault in faults {
        let _ = writeln!(text, "{fault}");
    }
    let _ = writeln!(text, "interrupts are masked or let through by");
    for (function, at, instruction) in code.masks() {
        let _ = writeln!(text, "  {at:#010x} {instruction:<20} {function}");
    }
    text
}

/// The deepest stack, way by way.
#[must_use]
pub fn print_stack(code: &Code, stack: &Stack) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{:>8}  deepest stack, bytes", stack.bytes);
    for (i, (level, depth)) in LEVELS.iter().zip(&stack.levels).enumerate() {
        if i > 0 {
            let _ = writeln!(text, "{EXCEPTION_FRAME:>8}  pushed by the processor");
        }
        let _ = writeln!(text, "{:>8}  {}", depth.bytes, level.name);
        for at in &depth.path {
            let frame = code.functions.get(at).map_or(0, |it| it.frame);
            let _ = writeln!(text, "{frame:>14}  {}", code.name(*at));
        }
    }
    let pointers = (code.functions.values())
        .filter(|it| !it.pointers.is_empty())
        .count();
    let _ = writeln!(
        text,
        "{:>8}  left of {} bytes ({:.0} %)",
        stack.left(),
        stack.memory,
        100.0 * stack.left() as f64 / stack.memory as f64
    );
    let _ = writeln!(
        text,
        "calls through pointers in {pointers} functions, taken to reach any of {} functions, {NESTING} deep; no recursion",
        code.taken.len()
    );
    text
}
