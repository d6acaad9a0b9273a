//! When and where a section was measured: date, commit, time taken, cores. Nothing that names the machine.

use std::path::Path;
use std::process::Command;
use std::thread::available_parallelism;
use std::time::Duration;

use desk::date::today;

use super::Kind;

/// The conditions of a run that is about to begin.
pub(super) struct Conditions {
    date: String,
    commit: String,
    machine: String,
}

impl Conditions {
    pub(super) fn now(root: &Path, kind: Kind) -> Self {
        Self {
            date: today(),
            commit: commit(root),
            machine: machine(kind),
        }
    }

    /// As the page has them.
    pub(super) fn text(&self, taken: Duration) -> String {
        let Self {
            date,
            commit,
            machine,
        } = self;
        format!(
            "{date}, {commit}, {:.0} s on {machine}",
            taken.as_secs_f64().ceil()
        )
    }
}

/// The commit, and whether anything but what is written differs from it.
fn commit(root: &Path) -> String {
    let Some(hash) = said(root, "git", &["rev-parse", "--short=9", "HEAD"]) else {
        return "no commit".to_owned();
    };
    let status = [
        "status",
        "--porcelain",
        "--untracked-files=no",
        "--",
        ".",
        ":!hal-sim/MEASURED.md",
        ":!hal-sim/PLANT.md",
    ];
    match said(root, "git", &status) {
        Some(changes) if changes.is_empty() => format!("commit {hash}"),
        _ => format!("commit {hash} with changes"),
    }
}

/// Cores, kind of processor, compiler; for host times how busy the machine was before.
fn machine(kind: Kind) -> String {
    let cores = available_parallelism().map_or(1, usize::from);
    let mut text = format!(
        "{cores} cores ({}, {})",
        std::env::consts::ARCH,
        std::env::consts::OS
    );
    let compiler = said(Path::new("."), "rustc", &["--version"]);
    if let Some((name, version)) = (compiler.as_deref()).and_then(|all| all.split_once(' ')) {
        let version = version.split(' ').next().unwrap_or(version);
        text += &format!(", {name} {version}");
    }
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    if let (Kind::HostTime, Some(load)) = (kind, load.split(' ').next().filter(|it| !it.is_empty()))
    {
        text += &format!(", load {load} before");
    }
    text
}

/// What a program prints, if it ends well.
fn said(folder: &Path, program: &str, arguments: &[&str]) -> Option<String> {
    let output = (Command::new(program).args(arguments).current_dir(folder))
        .output()
        .ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
