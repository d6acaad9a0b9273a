//! The summary printed after a run.

use std::fmt;

use super::Run;
use super::csv::fixed;
use super::sample::Move;
use super::statistics::{PoseErrors, Spread};

/// Moves listed at most; a longer run lists those that took longest to settle.
const MOVES_LISTED: usize = 20;

/// A [`Run`]'s summary: `Display` it.
#[derive(Clone, Copy, Debug)]
pub struct Summary<'a> {
    run: &'a Run,
}

impl<'a> Summary<'a> {
    pub(super) fn new(run: &'a Run) -> Self {
        Self { run }
    }
}

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        errors(f, self.run)?;
        moves(f, self.run)?;
        limits(f, self.run)?;
        conditions(f, self.run)
    }
}

fn errors(f: &mut fmt::Formatter<'_>, run: &Run) -> fmt::Result {
    let statistics = run.trace.statistics();
    let ticks = statistics.moving.truth.theta_urad.count();
    if ticks == 0 {
        return writeln!(f, "following error: the setpoint never moved\n");
    }
    writeln!(f, "errors while moving ({ticks} ticks)")?;
    writeln!(
        f,
        "                              {:>10}  {:>10}",
        "peak", "rms"
    )?;
    line(
        f,
        "following, pivots",
        &statistics.pivot_error_lsb,
        "encoder LSB",
    )?;
    poses(f, &statistics.moving, "sag")?;
    let at_rest = &statistics.at_rest;
    let ticks = at_rest.truth.theta_urad.count();
    if ticks > 0 {
        writeln!(
            f,
            "errors at rest ({ticks} ticks, from 20 ms after each move on)"
        )?;
        poses(f, at_rest, "lost motion")?;
    }
    Ok(())
}

/// Errors of the pose, by who sees them; what nobody sees is named by what it mostly is.
fn poses(f: &mut fmt::Formatter<'_>, errors: &PoseErrors, unseen: &str) -> fmt::Result {
    let kinds = [
        ("following".to_owned(), &errors.following),
        ("true pose".to_owned(), &errors.truth),
        (format!("unseen ({unseen})"), &errors.unseen),
    ];
    for (what, spread) in &kinds {
        line(f, &format!("{what}, centre"), &spread.xy_um, "um")?;
        line(f, &format!("{what}, theta"), &spread.theta_urad, "urad")?;
    }
    writeln!(f)
}

fn line(f: &mut fmt::Formatter<'_>, what: &str, spread: &Spread, unit: &str) -> fmt::Result {
    let (peak, rms) = (spread.peak(), spread.rms());
    writeln!(f, "  {what:<28}{peak:>10.3}  {rms:>10.3}  {unit}")
}

fn moves(f: &mut fmt::Formatter<'_>, run: &Run) -> fmt::Result {
    let moves = &run.moves;
    if moves.is_empty() {
        return writeln!(f, "no moves\n");
    }
    let listed = listed(moves);
    write!(f, "moves")?;
    if listed.len() < moves.len() {
        write!(
            f,
            " ({} of {}, slowest to settle)",
            listed.len(),
            moves.len()
        )?;
    }
    writeln!(
        f,
        "\n    #    start s    to x mm     y mm   theta deg   profile s   settle ms"
    )?;
    for index in listed {
        one_move(f, run, index)?;
    }
    totals(f, run)?;
    writeln!(f)
}

fn one_move(f: &mut fmt::Formatter<'_>, run: &Run, index: usize) -> fmt::Result {
    let (number, one) = (index + 1, &run.moves[index]);
    let [x_mm, y_mm, theta_deg] = one.target.map(|value| fixed(value, 3));
    let (start_s, profile_s) = (one.start_s, one.profile_s());
    write!(
        f,
        "  {number:>3}  {start_s:>9.3}  {x_mm:>9}  {y_mm:>7}  {theta_deg:>10}  {profile_s:>10.4}  "
    )?;
    match one.settle_s() {
        Some(settle_s) => writeln!(f, "{:>10.2}", 1e3 * settle_s),
        None if run.never_settles(index) => writeln!(f, "{:>10}", "never"),
        None => writeln!(f, "{:>10}", "no time"),
    }
}

fn totals(f: &mut fmt::Formatter<'_>, run: &Run) -> fmt::Result {
    let moves = &run.moves;
    let profiles: Vec<f64> = moves.iter().map(Move::profile_s).collect();
    let settles_ms: Vec<f64> = (moves.iter())
        .filter_map(|one| Some(1e3 * one.settle_s()?))
        .collect();
    let mut line = |what: &str, profile_s: f64, settle_ms: f64| {
        writeln!(f, "  {what:<46}{profile_s:>10.4}  {settle_ms:>10.2}")
    };
    line("mean", mean(&profiles), mean(&settles_ms))?;
    line("worst", worst(&profiles), worst(&settles_ms))?;
    match run.never_settled() {
        0 => Ok(()),
        never => writeln!(f, "  never settled: {never}"),
    }
}

/// Indices of the moves to list, in the order of time.
fn listed(moves: &[Move]) -> Vec<usize> {
    let settle_s = |&index: &usize| moves[index].settle_s().unwrap_or(f64::INFINITY);
    let mut indices: Vec<usize> = (0..moves.len()).collect();
    indices.sort_by(|a, b| settle_s(b).total_cmp(&settle_s(a)));
    indices.truncate(MOVES_LISTED);
    indices.sort_unstable();
    indices
}

fn limits(f: &mut fmt::Formatter<'_>, run: &Run) -> fmt::Result {
    let statistics = run.trace.statistics();
    let (end_s, wall_s) = (statistics.end_s, run.wall_s);
    writeln!(
        f,
        "{:<22}{:>10.1} %",
        "peak duty",
        100.0 * statistics.peak_duty
    )?;
    writeln!(
        f,
        "{:<22}{:>10.2} deg",
        "smallest separation", statistics.separation_deg
    )?;
    writeln!(f, "{:<22}{end_s:>10.3} s", "simulated time")?;
    let speed = end_s / wall_s;
    writeln!(f, "{:<22}{speed:>10.1} times real time", "speed")
}

fn conditions(f: &mut fmt::Formatter<'_>, run: &Run) -> fmt::Result {
    writeln!(f, "\nconditions")?;
    for (name, value) in run.conditions.list() {
        writeln!(f, "  {name:<20}{value}")?;
    }
    writeln!(f)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn worst(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NAN, f64::max)
}
