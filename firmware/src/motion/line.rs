//! Planning a straight line from rest to rest.

use super::axis::{JERK_STEP, SUB_BITS};
use super::limits::{Limits, Line, centre};
use super::plan::{Piece, Plan, Position, Start};
use super::profile::Profile;
use core::fmt;
use heapless::Vec;
use kinematics::Geometry;

/// Why a move is refused. Nothing has moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// The target lies outside the disk that is usable at every orientation.
    OutsideDisk {
        /// Distance of the target from the track's centre.
        radius_mm: f64,
        /// Radius of the usable disk.
        usable_mm: f64,
    },
    /// Theta would pass what [`Position`] is meant to hold.
    TooManyTurns,
    /// The limits leave no finite duration.
    Limits,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutsideDisk {
                radius_mm,
                usable_mm,
            } => write!(
                f,
                "target {radius_mm:.6} mm from the centre, the usable disk ends at {usable_mm:.6} mm"
            ),
            Self::TooManyTurns => f.write_str("more turns than can be counted"),
            Self::Limits => {
                f.write_str("the limits of speed, acceleration and jerk allow no motion")
            }
        }
    }
}

/// A thousand million turns, in units of a position.
const MOST_TURNS: i64 = 1_000_000_000 << 32;

/// Slack for a target on the rim itself: its coordinates are rounded to 2^-32 track radii.
const RIM: f64 = 1e-9;

/// Whether `target` can be moved to, at any orientation.
pub fn check_target(target: &Position, geometry: &Geometry) -> Result<(), Refusal> {
    let [x, y] = centre(target);
    let radius = libm::hypot(x, y);
    if radius > geometry.usable_radius() + RIM {
        return Err(Refusal::OutsideDisk {
            radius_mm: radius * geometry.radius_mm,
            usable_mm: geometry.usable_radius() * geometry.radius_mm,
        });
    }
    if target[2].unsigned_abs() > MOST_TURNS.unsigned_abs() {
        return Err(Refusal::TooManyTurns);
    }
    Ok(())
}

/// Plans the straight line `from` -> `to` (both at rest): all three axes start and end together, and the end is exact.
pub fn plan_line(
    id: u32,
    from: Position,
    to: Position,
    limits: &Limits,
    geometry: &Geometry,
) -> Result<Plan, Refusal> {
    check_target(&to, geometry)?;
    if !limits.all_positive() {
        return Err(Refusal::Limits);
    }
    let mut plan = Plan {
        id,
        start: Start::Rest(from),
        pieces: Vec::new(),
        nudge: [0; 3],
        end: to,
    };
    if from == to {
        return Ok(plan);
    }
    let line = Line::new(&from, &to);
    let profile = Profile::new(&limits.along(&line, geometry)).ok_or(Refusal::Limits)?;
    let volume = profile.volume();
    let duration = i128::from(profile.jerk + profile.ramp + profile.way);
    let mut jerk = [0i64; 3];
    for i in 0..3 {
        let way = (i128::from(to[i]) - i128::from(from[i])) << SUB_BITS;
        let steps = way / (volume * i128::from(JERK_STEP));
        // Fits: a jerk that large would be 2^-9 turns a tick cubed.
        jerk[i] = i64::try_from(steps * i128::from(JERK_STEP)).map_err(|_| Refusal::Limits)?;
        let rest = way - i128::from(jerk[i]) * volume;
        plan.nudge[i] = i64::try_from(rest / duration).map_err(|_| Refusal::Limits)?;
    }
    for (ticks, sign) in profile.segments() {
        if ticks > 0 {
            let piece = Piece {
                ticks,
                jerk: jerk.map(|j| j * sign),
            };
            // Seven segments, room for seven.
            let _ = plan.pieces.push(piece);
        }
    }
    Ok(plan)
}
