//! Kinematics of a calibrated machine in the tick: see [`crate::calibration`].

use super::config::Config;
use super::pivot_setpoints::PivotSetpoints;
use super::servo::platform_torques;
use super::state::State;
use crate::calibration::{Calibration, CalibrationMargins, IDEAL};
use crate::number::Fixed;
use kinematics::{
    Acceleration, Angle, CorrectedInverse, Corrections, Curves, DirectError, Line, Pose, Series,
    Tangents, Twist, corrected_inverse, corrected_pivot_motion, direct, in_platform_axes,
    missing_rad, newton_step,
};

/// A calibration that the tick is to compute with.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationInForce {
    /// The machine.
    pub calibration: Calibration,
    /// By what the supervisor's margins are widened.
    pub margins: CalibrationMargins,
}

/// Of Newton's method, to a pose: less than 1e-8 rad are left.
const NEWTON_STEPS: u32 = 2;

/// The calibration as the tick carries it.
#[derive(Clone, Debug)]
pub(super) struct Calibrated {
    /// If not, the machine is as drawn.
    pub is_on: bool,
    /// By what the supervisor's are wider; zero when it is off.
    pub margins: CalibrationMargins,
    /// The lines, and the curves as they are near where the pivots are.
    near: Corrections<Fixed, Tangents<Fixed>>,
    series: [Series<f32>; 3],
}

impl CalibrationInForce {
    /// As drawn.
    pub const OFF: Self = Self {
        calibration: IDEAL,
        margins: CalibrationMargins::NONE,
    };
}

impl Default for Calibrated {
    fn default() -> Self {
        Self {
            is_on: false,
            margins: CalibrationMargins::NONE,
            near: Corrections {
                lines: [Line::IDEAL; 3],
                curves: [Tangents::ZERO; 3],
            },
            series: [Series::ZERO; 3],
        }
    }
}

impl Calibrated {
    /// Another one from now on. One that corrects nothing is none: every bit stays as it is without.
    pub fn set(&mut self, wanted: &CalibrationInForce) {
        self.is_on = !wanted.calibration.are_zero();
        self.margins = wanted.margins;
        self.near.lines = wanted.calibration.lines;
        self.series = wanted.calibration.curves;
    }

    /// The curves of a pivot whose encoder is to read `encoder`, at a place on its guide: for the ticks to come.
    #[inline(never)]
    pub fn look_up(&mut self, pivot: usize, encoder: Angle, rho: f32) {
        if let (Some(tangents), Some(series), Some(line)) = (
            self.near.curves.get_mut(pivot),
            self.series.get(pivot),
            self.near.lines.get(pivot),
        ) {
            // The ring's angle but for the curve itself, over which it hardly changes.
            *tangents = with_guide(&of_ring(series, encoder - line.encoder_zero), series, rho);
        }
    }

    /// The pose of measured pivots; and the curves there, from which the ticks to come go on.
    ///
    /// From the drawn machine's pose two steps of Newton's method, the straightness being looked up at each. In a function of
    /// the loop's own, which the image's linker finds.
    #[inline(never)]
    pub fn measured_pose(
        &mut self,
        config: &Config,
        encoders: &[Angle; 3],
    ) -> Result<Pose<Fixed>, DirectError> {
        let Corrections { lines, curves } = &mut self.near;
        let mut rings = *encoders;
        for (ring, line) in rings.iter_mut().zip(&*lines) {
            *ring -= line.encoder_zero;
        }
        let mut pose = direct(&rings)?;
        if !self.is_on {
            return Ok(pose);
        }
        for ((tangents, series), ring) in curves.iter_mut().zip(&self.series).zip(rings) {
            *tangents = of_ring(series, ring);
        }
        let (twist, acceleration) = (Twist::default(), Acceleration::default());
        for _ in 0..NEWTON_STEPS {
            let mut at = None;
            let _ = self.pivot_setpoints(config, &pose, &twist, &acceleration, Some(&mut at));
            let at = at.ok_or(DirectError::OutsideTrack)?;
            let mut missing = missing_rad(&at, encoders);
            for (i, tangents) in self.near.curves.iter_mut().enumerate() {
                let rho = at.guides[i].rho();
                let before = Curves::<Fixed>::straightness(tangents, rho).value;
                *tangents = with_guide(tangents, &self.series[i], rho);
                let now = Curves::<Fixed>::straightness(tangents, rho).value;
                missing[i] -= (now - before) * at.over_travel[i];
            }
            pose = newton_step(&pose, &at, &self.near.lines, &missing);
        }
        Ok(pose)
    }

    /// Setpoint of the pose to setpoints of the pivots as their encoders read them, if it is a pose of the mechanism; and, if
    /// asked, how the pose was solved.
    // The corrected inverse stands here, once in the loop's memory: a function of its own would hand its results over in memory.
    #[inline(never)]
    pub fn pivot_setpoints(
        &self,
        config: &Config,
        pose: &Pose<Fixed>,
        twist: &Twist<f32>,
        acceleration: &Acceleration<f32>,
        solved: Option<&mut Option<CorrectedInverse<Fixed>>>,
    ) -> Option<PivotSetpoints> {
        let at = corrected_inverse(pose, &self.near).ok()?;
        let guides = &at.guides;
        let (twist, acceleration) = in_platform_axes(guides, twist, acceleration);
        let setpoints = PivotSetpoints {
            angles: at.encoders,
            motion: corrected_pivot_motion(&at, &self.near.lines, &twist, &acceleration),
            torques: platform_torques(&config.servo.body, guides, &twist, &acceleration),
            lengths: [guides[0].rho(), guides[1].rho(), guides[2].rho()],
            cosines: [guides[0].cosine, guides[1].cosine, guides[2].cosine],
        };
        if let Some(solved) = solved {
            *solved = Some(at);
        }
        Some(setpoints)
    }
}

// Once in the loop's memory: they are long.

/// See [`Tangents::of_ring`].
#[inline(never)]
fn of_ring(series: &Series<f32>, ring: Angle) -> Tangents<Fixed> {
    Tangents::of_ring(series, ring)
}

/// See [`Tangents::with_guide`].
#[inline(never)]
fn with_guide(tangents: &Tangents<Fixed>, series: &Series<f32>, rho: f32) -> Tangents<Fixed> {
    tangents.with_guide(series, rho)
}

impl State {
    /// Looks up the curves of the pivot that is inspected in this tick, for those to come.
    #[inline]
    pub(super) fn look_up_curves(&mut self, slot: usize, target: &[Angle; 3], lengths: &[f32; 3]) {
        if self.calibrated.is_on
            && let (Some(&encoder), Some(&rho)) = (target.get(slot), lengths.get(slot))
        {
            self.calibrated.look_up(slot, encoder, rho);
        }
    }
}
