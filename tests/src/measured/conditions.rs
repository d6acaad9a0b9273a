//! When and where a section was measured: date, commit, time taken, cores. Nothing that names the machine.

use std::path::Path;
use std::process::Command;
use std::thread::available_parallelism;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use super::Kind;

/// The conditions of a run that is about to begin.
pub(super) struct Conditions {
    date: String,
    commit: String,
    machine: String,
}

impl Conditions {
    pub(super) fn now(root: &Path, kind: Kind) -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            date: date(since.unwrap_or_default().as_secs() / 86_400),
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

/// Year, month and day of a day since 1970-01-01 (H. Hinnant, "chrono-compatible low-level date algorithms").
fn date(day: u64) -> String {
    let from_march_0 = day + 719_468;
    let era = from_march_0 / 146_097;
    let of_era = from_march_0 % 146_097;
    let year_of_era = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = (month_from_march + 2) % 12 + 1;
    let year = 400 * era + year_of_era + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02}")
}

/// The commit, and whether anything but the page itself differs from it.
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

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn days_have_their_dates() {
        for (day, text) in [
            (0, "1970-01-01"),
            (59, "1970-03-01"),
            (11_016, "2000-02-29"),
            (11_017, "2000-03-01"),
            (20_453, "2025-12-31"),
            (20_454, "2026-01-01"),
        ] {
            assert_eq!(date(day), text);
        }
    }
}
