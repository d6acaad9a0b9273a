//! `image`: see [`image::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    image::cli::main()
}
