//! A section's command as a child process.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::conditions::Conditions;
use super::{Measured, Section, figures};

/// What the sections on the chip need before.
const IMAGE: &str = "source .ci/target-toolchain && cargo stage && cargo cost-image";
/// With this cargo says on standard error that all is built.
const BUILT: &str = "Running ";

/// Why there are no figures.
#[derive(Debug)]
pub enum RunError {
    /// bash could not be started, or not be waited for.
    Io(std::io::Error),
    /// The command did not end with exit code 0. What it printed.
    Failed(String),
    /// The command printed no figures.
    Empty,
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Io(error) => write!(f, "bash: {error}"),
            Self::Failed(output) => write!(f, "{output}failed"),
            Self::Empty => write!(f, "no figures in the output"),
        }
    }
}

impl std::error::Error for RunError {}

impl From<std::io::Error> for RunError {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error)
    }
}

/// Builds the images that the sections on the chip need.
///
/// # Errors
/// When that fails.
pub fn prepare(root: &Path) -> Result<(), RunError> {
    let ended = bash(root, IMAGE)?;
    ended.output.map(|_| ())
}

/// Runs a section's command.
///
/// # Errors
/// When the command can not be run, fails, or prints no figures.
pub fn run(root: &Path, section: &Section, short: bool) -> Result<Measured, RunError> {
    let command = section.command(short);
    let conditions = Conditions::now(root, section.kind);
    let ended = bash(root, command)?;
    let figures = figures(&ended.output?, section.without);
    if figures.is_empty() {
        return Err(RunError::Empty);
    }
    Ok(Measured {
        command: command.to_owned(),
        conditions: conditions.text(ended.taken),
        figures,
    })
}

struct Ended {
    /// Standard output, if the command ended well.
    output: Result<String, RunError>,
    /// Without what was built before.
    taken: Duration,
}

fn bash(root: &Path, command: &str) -> Result<Ended, RunError> {
    let mut child = Command::new("bash")
        .args(["-c", command])
        .current_dir(root)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let begun = Instant::now();
    let built = told(&mut child);
    let mut output = Vec::new();
    let mut stdout = child.stdout.take().expect("piped");
    stdout.read_to_end(&mut output)?;
    let is_good = child.wait()?.success();
    let built = built.join().expect("a reader");
    let output = String::from_utf8_lossy(&output).into_owned();
    Ok(Ended {
        output: if is_good {
            Ok(output)
        } else {
            Err(RunError::Failed(output))
        },
        taken: built.unwrap_or(begun).elapsed(),
    })
}

/// Passes standard error on; when cargo was done with building.
fn told(child: &mut Child) -> thread::JoinHandle<Option<Instant>> {
    let stderr = BufReader::new(child.stderr.take().expect("piped"));
    thread::spawn(move || {
        let mut built = None;
        for line in stderr.split(b'\n').map_while(Result::ok) {
            let line = String::from_utf8_lossy(&line);
            eprintln!("{line}");
            if line.trim_start().starts_with(BUILT) {
                built = built.or_else(|| Some(Instant::now()));
            }
        }
        built
    })
}
