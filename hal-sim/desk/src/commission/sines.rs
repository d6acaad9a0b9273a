//! Multisines on one motor after the other, with the servo on, while the platform turns: so that friction keeps its sign.

use super::bench::Bench;
use super::found::{CommissionError, fail};
use super::id::AXES;
use crate::record::RecordError;
use commissioning::frequency_response::{Line, Run, frequency_response};
use commissioning::record::{Record, Signals, Timing};
use firmware::control::excitation::{PERIOD_TICKS, line_harmonics};

/// Peak of an excitation, V: its root mean square is a third of it, some times what the dead time takes.
pub const PEAK_V: f64 = 8.0;
/// The same where that lifts the teeth of gears, at their resonance: a spring that lets go is in no model.
pub const GENTLE_V: f64 = 5.0;
/// How many times as strong that is as a weaker excitation, which shows what play in the gears does.
pub const WEAKER: f64 = 2.5;
/// Ticks from row to row, and rows of a period.
const TICKS_PER_ROW: usize = 4;
const PERIOD_ROWS: usize = PERIOD_TICKS as usize / TICKS_PER_ROW;
/// Harmonics of the lowest line and of the highest, 29 Hz and 2.3 kHz, and lines at a time.
const HARMONICS: [u32; 2] = [6, 470];
const LINES: usize = 15;
/// Time that a turn at a steady rate takes to begin, s, that a move to a place takes at most, and that all turns back take: over a serial line
/// records are fetched for minutes, while the platform turns on.
const BEGIN_S: f64 = 0.3;
const LONGEST_S: f64 = 20.0;
const LONGEST_BACK_S: f64 = 120.0;

/// Where, mm, and at what rate the platform turns about its centre, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    pub x_mm: f64,
    pub y_mm: f64,
    pub rate_rad_s: f64,
}

/// In the middle turning changes nothing of what the motors move: it turns as fast as ripple and friction are told apart best.
pub const CENTRE: Spot = Spot {
    x_mm: 0.0,
    y_mm: 0.0,
    rate_rad_s: 2.0,
};
/// Far out it does: as slowly as friction just keeps its sign, and from the same angle each time. 30 degrees beside a guide, where the
/// numbers of the machine are told apart better than midway between two.
pub const FAR_OUT: Spot = Spot {
    x_mm: 70.0,
    y_mm: 0.0,
    rate_rad_s: 0.04,
};
/// Where loops are measured and gains are judged: near the rim, midway between two guides, where the platform rings most on them (see
/// [`commissioning::tuning::PLACES`]).
pub const NEAR_RIM: Spot = Spot {
    x_mm: 65.8,
    y_mm: 38.0,
    rate_rad_s: FAR_OUT.rate_rad_s,
};

impl Spot {
    fn is_central(&self) -> bool {
        self.x_mm == 0.0 && self.y_mm == 0.0
    }

    /// In words.
    pub fn words(&self) -> String {
        if self.is_central() {
            "in the middle".to_owned()
        } else {
            format!("at X {:.0} Y {:.0}", self.x_mm, self.y_mm)
        }
    }
}

/// What was recorded at a spot.
#[derive(Clone, Debug, PartialEq)]
pub struct Excited {
    pub peak_v: f64,
    pub runs: Vec<Run>,
    pub lines: Vec<Line>,
}

/// What is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recorded {
    /// All that a model of the drives takes: volts, currents and angles, one pivot after the other; so many periods.
    Drives {
        /// Behind the one that is left out.
        periods: usize,
    },
    /// What the loop takes once the drives are known: currents and angles, of all pivots at once.
    Loop,
}

impl Recorded {
    /// Rows at the beginning of a record that are left out: what a start excites dies in them.
    const fn left_out(self) -> usize {
        match self {
            Self::Drives { .. } => PERIOD_ROWS,
            // More there is no room for.
            Self::Loop => 800,
        }
    }

    /// Rows of a record: behind what is left out, as many periods as there is room for.
    const fn rows(self) -> usize {
        let periods = match self {
            Self::Drives { periods } => periods,
            Self::Loop => 2,
        };
        self.left_out() + periods * PERIOD_ROWS
    }
}

/// Excites each motor with so many sets of lines of a peak, which lie between each other's, and records all pivots.
pub fn excite(
    bench: &mut Bench<'_>,
    spot: &Spot,
    (sets, peak_v): (u32, f64),
    recorded: Recorded,
) -> Result<Excited, CommissionError> {
    bench.reserve(recorded.rows())?;
    go_to(bench, spot)?;
    if spot.is_central() {
        turn(bench, spot)?;
    }
    let mut runs = Vec::new();
    for set in 0..sets {
        let [lowest, highest] = harmonics(set, sets);
        let mut experiments: [Vec<Record>; AXES] = Default::default();
        for (drive, records) in experiments.iter_mut().enumerate() {
            let line = format!(
                "EXC SINES {} {peak_v} {} {lowest} {highest} {LINES}",
                drive + 1,
                (1e3 * bench.period_s * (recorded.rows() * TICKS_PER_ROW) as f64).ceil()
            );
            records.push(Record {
                first_tick: recorded.left_out() * TICKS_PER_ROW,
                pivots: record(bench, spot, recorded, &line)?,
            });
        }
        runs.push(Run {
            period_ticks: PERIOD_TICKS as usize,
            ticks_per_row: TICKS_PER_ROW,
            bins: line_harmonics(lowest, highest, LINES)
                .iter()
                .map(|harmonic| *harmonic as usize)
                .collect(),
            experiments,
        });
    }
    bench.ask("HLT")?;
    bench.settle()?;
    bench.ask("MOV X 0 Y 0 W 0")?;
    bench.wait_for_target(LONGEST_BACK_S)?;
    match frequency_response(&runs, &Timing::STAGE) {
        Ok(lines) => Ok(Excited {
            peak_v,
            runs,
            lines,
        }),
        Err(error) => fail(
            format!("{}: {error}", spot.words()),
            "the voltage of the excitation, and what the motors do with it",
        ),
    }
}

/// Lowest and highest harmonic of a set.
fn harmonics(set: u32, sets: u32) -> [u32; 2] {
    let [lowest, highest] = HARMONICS.map(f64::from);
    let gap = (highest / lowest).powf(1.0 / f64::from(sets * LINES as u32 - 1));
    let last = highest * gap.powi(set as i32 - (sets as i32 - 1));
    [HARMONICS[0] + set, last.round() as u32]
}

/// All pivots while one motor is excited.
fn record(
    bench: &mut Bench<'_>,
    spot: &Spot,
    recorded: Recorded,
    line: &str,
) -> Result<[Signals; AXES], CommissionError> {
    let rows = recorded.rows();
    let mut pivots = match recorded {
        Recorded::Loop => at_spot(bench, spot, |bench| {
            bench.record_all(rows, TICKS_PER_ROW, line)
        })?,
        Recorded::Drives { .. } => {
            let mut pivots: [Signals; AXES] = Default::default();
            for (pivot, signals) in pivots.iter_mut().enumerate() {
                *signals = at_spot(bench, spot, |bench| {
                    bench.record(pivot, rows, TICKS_PER_ROW, Some(line))
                })?
                .signals;
            }
            pivots
        }
    };
    for signals in &mut pivots {
        for values in [
            &mut signals.volts,
            &mut signals.current_a,
            &mut signals.angle_rad,
        ] {
            values.drain(..recorded.left_out());
        }
    }
    Ok(pivots)
}

/// A record while the platform turns; far out from the same angle each time.
fn at_spot<T>(
    bench: &mut Bench<'_>,
    spot: &Spot,
    record: impl FnOnce(&mut Bench<'_>) -> Result<T, RecordError>,
) -> Result<T, CommissionError> {
    if !spot.is_central() {
        turn(bench, spot)?;
    }
    let recorded = record(bench)?;
    bench.excitation_end()?;
    if !spot.is_central() {
        bench.ask("HLT")?;
        bench.settle()?;
        go_to(bench, spot)?;
    }
    Ok(recorded)
}

fn go_to(bench: &mut Bench<'_>, spot: &Spot) -> Result<(), CommissionError> {
    bench.ask(&format!("MOV X {} Y {} W 0", spot.x_mm, spot.y_mm))?;
    bench.wait_for_target(LONGEST_S)
}

fn turn(bench: &mut Bench<'_>, spot: &Spot) -> Result<(), CommissionError> {
    bench.turn(spot.rate_rad_s)?;
    Ok(bench.delay(BEGIN_S)?)
}
