//! The fuzz target by hand: `cargo run --release --bin fuzz -- --seconds 3600`, with `--seed` to start elsewhere or,
//! with `--cases 1`, to see a case again. Exit code 1 when something did not hold.

use std::process::ExitCode;
use std::time::{Duration, Instant};

/// What is asked for.
struct Options {
    seconds: u64,
    seed: u64,
    cases: u64,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        seconds: 60,
        seed: 1,
        cases: u64::MAX,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next();
        let number = value.as_deref().and_then(|text| text.parse().ok());
        let number = number.ok_or(format!("{name} needs a whole number"))?;
        match &*name {
            "--seconds" => options.seconds = number,
            "--seed" => options.seed = number,
            "--cases" => options.cases = number,
            _ => return Err(format!("{name}: not one of --seconds, --seed, --cases")),
        }
    }
    Ok(options)
}

fn main() -> ExitCode {
    let options = match options() {
        Ok(options) => options,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::from(2);
        }
    };
    let end = Instant::now() + Duration::from_secs(options.seconds);
    let mut cases = 0;
    while cases < options.cases && Instant::now() < end {
        let seed = options.seed.wrapping_add(cases);
        if std::panic::catch_unwind(|| tests::fuzz::run_all(seed)).is_err() {
            eprintln!("seed {seed}: see it again with --seed {seed} --cases 1");
            return ExitCode::FAILURE;
        }
        cases += 1;
    }
    println!("{cases} cases from seed {} on, nothing found", options.seed);
    ExitCode::SUCCESS
}
