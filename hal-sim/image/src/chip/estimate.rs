//! What `llvm-mca` makes of instructions that ran one after the other: cycles of a Cortex-M4 without wait states. Jumps count
//! as instructions; that the core refills its pipeline after one is not in it. Calls are given as jumps: for one it takes a hundred
//! cycles, whatever is called. Its model has one cycle for each load and store.

use super::follow::Step;
use crate::cycles::{Kind, Program};
use std::io::Write;
use std::process::{Command, Stdio};

const PROGRAM: &str = "llvm-mca";
const ARGUMENTS: [&str; 5] = [
    "-mtriple=thumbv7em-none-eabihf",
    "-mcpu=cortex-m4",
    "-iterations=1",
    "-all-views=false",
    "-summary-view",
];
const CYCLES: &str = "Total Cycles:";
const INSTRUCTIONS: &str = "Instructions:";

/// Instructions that were understood, and their cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Estimate {
    /// Instructions.
    pub instructions: u64,
    /// Cycles.
    pub cycles: u64,
}

/// Asks `llvm-mca`.
///
/// # Errors
/// Why there is no estimate, for whoever reads the report: most machines do not have it.
pub fn estimate(program: &Program, steps: &[Step]) -> Result<Estimate, String> {
    let missing = |error: std::io::Error| format!("{PROGRAM}: {error}");
    let mut child = Command::new(PROGRAM)
        .args(ARGUMENTS)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(missing)?;
    if let Some(mut input) = child.stdin.take() {
        input
            .write_all(source(program, steps).as_bytes())
            .map_err(missing)?;
    }
    let output = child.wait_with_output().map_err(missing)?;
    let text = String::from_utf8_lossy(&output.stdout);
    let number = |name: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(name));
        line.and_then(|number| number.trim().parse().ok())
    };
    match (number(INSTRUCTIONS), number(CYCLES)) {
        (Some(instructions), Some(cycles)) => Ok(Estimate {
            instructions,
            cycles,
        }),
        _ => {
            let errors = String::from_utf8_lossy(&output.stderr);
            let first = errors.lines().next().unwrap_or("no answer");
            Err(format!("{PROGRAM}: {first}"))
        }
    }
}

/// The instructions as an assembler takes them. Where a jump leads does not matter here.
fn source(program: &Program, steps: &[Step]) -> String {
    let mut text = String::from(".syntax unified\n.fpu fpv4-sp-d16\n");
    for step in steps {
        let line = program.text(step.at).unwrap_or_default();
        match program.at(step.at).map(|it| it.kind) {
            Some(Kind::Jump) => text.push_str(&jump(line)),
            _ => text.push_str(line),
        }
        text.push('\n');
    }
    text
}

fn jump(text: &str) -> String {
    if text.starts_with("bl ") || text.starts_with("blx") {
        return "b #4".to_owned();
    }
    match text.rsplit_once('#') {
        Some((before, _)) => format!("{before}#4"),
        None => text.to_owned(),
    }
}
