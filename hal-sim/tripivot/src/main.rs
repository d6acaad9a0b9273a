//! `tripivot`: see [`tripivot::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    tripivot::cli::main()
}
