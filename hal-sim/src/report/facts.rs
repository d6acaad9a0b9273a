//! What a run amounts to, for programs: the summary's numbers as they are serialised. Units are in the names.

use serde::Serialize;

use super::sample::Move;
use super::statistics::{PoseSpread, Spread};
use super::{Conditions, Run};

/// A [`Run`]'s summary: serialise it.
#[derive(Clone, Debug, Serialize)]
pub struct Facts<'a> {
    /// What was run.
    pub run: &'a str,
    /// What it was made under.
    pub conditions: &'a Conditions,
    /// Following errors while moving.
    pub following_error: FollowingError,
    /// Errors of the true pose while moving.
    pub true_error: PoseError,
    /// What of them no encoder sees (sag).
    pub unseen_error: PoseError,
    /// Errors at rest.
    pub at_rest: AtRest,
    /// The moves in the order of time.
    pub moves: Vec<Leg>,
    /// How many of them never settled, though they had the time to.
    pub never_settled: usize,
    /// Largest magnitude of any duty, 0 to 1.
    pub peak_duty: f64,
    /// Smallest angle between two pivots; none without a tick.
    pub smallest_separation_deg: f64,
    /// Time of the last tick.
    pub simulated_s: f64,
    /// Wall-clock time of the simulation.
    pub wall_s: f64,
}

/// Following errors over the moving ticks: what the encoders see.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FollowingError {
    /// So many.
    pub ticks: u64,
    /// Distance of the centre from its setpoint.
    pub centre_um: PeakRms,
    /// Orientation minus its setpoint.
    pub theta_urad: PeakRms,
    /// Measured minus setpoint of the three pivots, encoder LSB.
    pub pivots_lsb: PeakRms,
}

/// Errors from 20 ms after each move on.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct AtRest {
    /// So many.
    pub ticks: u64,
    /// What the encoders see.
    pub following_error: PoseError,
    /// Where the platform is.
    pub true_error: PoseError,
    /// What of that no encoder sees (lost motion).
    pub unseen_error: PoseError,
}

/// Errors of the pose.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PoseError {
    /// Distance of the centre from its setpoint.
    pub centre_um: PeakRms,
    /// Orientation minus its setpoint.
    pub theta_urad: PeakRms,
}

/// Largest magnitude and root mean square.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PeakRms {
    /// Largest magnitude.
    pub peak: f64,
    /// Root mean square.
    pub rms: f64,
}

/// One move.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Leg {
    /// When the setpoint started.
    pub start_s: f64,
    /// When it arrived.
    pub profile_end_s: f64,
    /// When the stage had settled; none if it had not when the next move began or the run ended.
    pub settled_s: Option<f64>,
    /// From the arrival until settled; none as above.
    pub settle_ms: Option<f64>,
    /// Where to, along x.
    pub x_mm: f64,
    /// Along y.
    pub y_mm: f64,
    /// The orientation.
    pub theta_deg: f64,
}

impl From<&Spread> for PeakRms {
    fn from(spread: &Spread) -> Self {
        Self {
            peak: spread.peak(),
            rms: spread.rms(),
        }
    }
}

impl From<&PoseSpread> for PoseError {
    fn from(spread: &PoseSpread) -> Self {
        Self {
            centre_um: (&spread.xy_um).into(),
            theta_urad: (&spread.theta_urad).into(),
        }
    }
}

impl From<&Move> for Leg {
    fn from(one: &Move) -> Self {
        let [x_mm, y_mm, theta_deg] = one.target;
        Self {
            start_s: one.start_s,
            profile_end_s: one.profile_end_s,
            settled_s: one.settled_s,
            settle_ms: one.settle_s().map(|settle_s| 1e3 * settle_s),
            x_mm,
            y_mm,
            theta_deg,
        }
    }
}

/// The facts of a run.
pub(super) fn facts(run: &Run) -> Facts<'_> {
    let statistics = run.trace.statistics();
    Facts {
        run: &run.name,
        conditions: &run.conditions,
        following_error: FollowingError {
            ticks: statistics.pivot_error_lsb.count() / 3,
            centre_um: (&statistics.moving.following.xy_um).into(),
            theta_urad: (&statistics.moving.following.theta_urad).into(),
            pivots_lsb: (&statistics.pivot_error_lsb).into(),
        },
        true_error: (&statistics.moving.truth).into(),
        unseen_error: (&statistics.moving.unseen).into(),
        at_rest: AtRest {
            ticks: statistics.at_rest.truth.theta_urad.count(),
            following_error: (&statistics.at_rest.following).into(),
            true_error: (&statistics.at_rest.truth).into(),
            unseen_error: (&statistics.at_rest.unseen).into(),
        },
        moves: run.moves.iter().map(Leg::from).collect(),
        never_settled: run.never_settled(),
        peak_duty: statistics.peak_duty,
        smallest_separation_deg: statistics.separation_deg,
        simulated_s: statistics.end_s,
        wall_s: run.wall_s,
    }
}
