//! `cargo image-check`: what can be proven of the image, and what it takes of the memories.

use std::process::ExitCode;

use super::error::CliError;
use crate::chip::elf_file;
use crate::cost::{Sizes, print_sizes};
use crate::proof::{
    CONTROL_LOOP, Code, NESTING, STACK_LEFT, Stack, faults, print_proof, print_stack, vector_faults,
};

pub(super) fn run() -> Result<ExitCode, CliError> {
    let path = elf_file::find();
    let path = path.ok_or_else(|| CliError::Value("no image: `cargo stage` builds it".into()))?;
    let code = Code::read(&path)?;
    let handlers = CONTROL_LOOP;
    let mut faults = faults(&code, handlers);
    faults.extend(vector_faults(&code));
    println!("{}", print_proof(&code, handlers, &faults));
    let stack = Stack::of(&code, NESTING)?;
    println!("{}", print_stack(&code, &stack));
    let sizes = Sizes::read(&path).map_err(CliError::Value)?;
    print!("{}", print_sizes(&sizes));
    if !faults.is_empty() {
        let what = format!(
            "{} faults in the control loop and the vectors",
            faults.len()
        );
        return Err(CliError::Grown(what));
    }
    if stack.left() < STACK_LEFT {
        let what = format!("{} bytes of stack left, too few", stack.left());
        return Err(CliError::Grown(what));
    }
    Ok(ExitCode::SUCCESS)
}
