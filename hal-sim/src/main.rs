//! `tripivot`: see [`hal_sim::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    hal_sim::cli::main()
}
