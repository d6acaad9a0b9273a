//! Kinematics of a calibrated machine in the tick: see [`crate::calibration`].

use super::config::Config;
use super::pivot_setpoints::{PivotSetpoints, pose};
use super::servo::platform_torques;
use crate::calibration::{Calibration, CalibrationMargins, IDEAL};
use crate::motion::Position;
use crate::number::Fixed;
use kinematics::{
    Acceleration, Angle, CorrectedInverse, Corrections, Curves, DirectError, Line, Pose, Series,
    Tangents, Twist, corrected_inverse, corrected_pivot_motion, direct, in_platform_axes, inverse,
    missing_rad, newton_step,
};

/// A calibration that the tick is to compute with.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationInForce {
    /// If not, the machine is as drawn, and every bit as it is without a calibration.
    pub is_on: bool,
    /// The machine.
    pub calibration: Calibration,
    /// By what the supervisor's margins are widened.
    pub margins: CalibrationMargins,
}

/// Encoders may read so much more than in the pose that was followed: one step of Newton's method leaves the square of it. A tick is
/// 50 us: by hand nothing turns by that much.
const MOST_MISSING_RAD: f32 = 2e-3;
/// No more than that, and the machine stands still, but for noise: 0.02 rad/s.
const STILL_RAD: f32 = 1e-6;

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
    /// The pose of the encoders up to the last tick, while the servo is off.
    followed: Option<Followed>,
}

/// A pose that is followed.
#[derive(Clone, Copy, Debug)]
struct Followed {
    pose: Pose<Fixed>,
    /// What the encoders read more than in the pose before, at most, rad.
    missing_rad: f32,
    /// It is the drawn machine's.
    is_drawn: bool,
}

impl CalibrationInForce {
    /// As drawn.
    pub const OFF: Self = Self {
        is_on: false,
        calibration: IDEAL,
        margins: CalibrationMargins::NONE,
    };

    /// What the tick has the encoders read while it holds a position, in its own arithmetic; `None` where no pose of the mechanism is.
    /// Whoever judges a calibration by true poses commands the machine so.
    pub fn held_encoders(&self, position: &Position) -> Option<[Angle; 3]> {
        /// Each pivot's curves are looked up that often: at first from wherever they were, then from the reading itself.
        const LOOKS: usize = 3;
        let pose = pose(position)?;
        if !self.is_on {
            return Some(inverse(&pose).ok()?.pivots);
        }
        let mut calibrated = Calibrated::default();
        calibrated.set(self);
        for _ in 0..LOOKS {
            for slot in 0..3 {
                let at = corrected_inverse(&pose, &calibrated.near).ok()?;
                calibrated.look_up_at(slot, &at.encoders, &at.guides.map(|guide| guide.rho()));
            }
        }
        Some(corrected_inverse(&pose, &calibrated.near).ok()?.encoders)
    }
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
            followed: None,
        }
    }
}

impl Calibrated {
    /// Another one from now on.
    pub fn set(&mut self, wanted: &CalibrationInForce) {
        self.is_on = wanted.is_on;
        self.margins = wanted.margins;
        self.near.lines = wanted.calibration.lines;
        self.near.curves = [Tangents::ZERO; 3];
        self.series = wanted.calibration.curves;
        self.followed = None;
    }

    /// The curves of a pivot whose encoder is to read `encoder`, at a place on its guide: for the ticks to come.
    #[inline(never)]
    fn look_up(&mut self, pivot: usize, encoder: Angle, rho: f32) {
        if let (Some(tangents), Some(series), Some(line)) = (
            self.near.curves.get_mut(pivot),
            self.series.get(pivot),
            self.near.lines.get(pivot),
        ) {
            // The ring's angle but for the curve itself, over which it hardly changes.
            *tangents = with_guide(&of_ring(series, encoder - line.encoder_zero), series, rho);
        }
    }

    /// The pose in which the encoders read this; the servo goes on there. Of a machine that stands still it is the pose that was
    /// followed up to the tick before. One that is moved by hand takes one more step of Newton's method.
    ///
    /// # Errors
    /// [`DirectError`]: no platform can stand so, or it is not known yet how.
    // In a function of the loop's own, which the image's linker finds.
    #[inline(never)]
    pub fn measured_pose(
        &mut self,
        config: &Config,
        encoders: &[Angle; 3],
    ) -> Result<Pose<Fixed>, DirectError> {
        if !self.is_on {
            return drawn_pose(encoders);
        }
        let followed = self.followed.take().ok_or(DirectError::OutsideTrack)?;
        if followed.missing_rad < STILL_RAD {
            return Ok(followed.pose);
        }
        if followed.is_drawn {
            return Err(DirectError::OutsideTrack);
        }
        let step = self.newton(config, &followed.pose, encoders);
        let (followed, _) = step.ok_or(DirectError::OutsideTrack)?;
        Ok(followed.pose)
    }

    /// The curves of the pivot that is inspected in this tick, at its encoder's setpoint and its place on the guide.
    #[inline]
    pub fn look_up_at(&mut self, slot: usize, encoders: &[Angle; 3], lengths: &[f32; 3]) {
        if let (Some(&encoder), Some(&rho)) = (encoders.get(slot), lengths.get(slot)) {
            self.look_up(slot, encoder, rho);
        }
    }

    /// While the servo is off: follows the pose, and looks up the curves of one pivot. Not in the tick that has switched it off,
    /// which has driven: both would be longer than a period.
    #[inline(never)]
    pub fn follow(&mut self, config: &Config, encoders: &[Angle; 3], slot: usize) {
        let Some(followed) = self.followed.take() else {
            self.followed = self.begin(encoders);
            return;
        };
        if followed.is_drawn {
            self.followed = self.approach(config, &followed.pose, encoders);
        } else if let Some((followed, lengths)) = self.newton(config, &followed.pose, encoders) {
            self.look_up_at(slot, encoders, &lengths);
            self.followed = Some(followed);
        }
    }

    /// The drawn machine's pose, with all curves looked up near it: a tick has no room for more beside it.
    fn begin(&mut self, encoders: &[Angle; 3]) -> Option<Followed> {
        let mut rings = *encoders;
        for (ring, line) in rings.iter_mut().zip(&self.near.lines) {
            *ring -= line.encoder_zero;
        }
        let pose = drawn_pose(&rings).ok()?;
        for ((tangents, series), ring) in self.near.curves.iter_mut().zip(&self.series).zip(rings) {
            *tangents = of_ring(series, ring);
        }
        Some(Followed {
            pose,
            missing_rad: f32::INFINITY,
            is_drawn: true,
        })
    }

    /// From the drawn machine's pose one step on the built one, with the curves along the guides looked up there too.
    fn approach(
        &mut self,
        config: &Config,
        pose: &Pose<Fixed>,
        encoders: &[Angle; 3],
    ) -> Option<Followed> {
        let at = self.solve(config, pose)?;
        let mut missing_rad = missing_of(&at, encoders);
        for (i, tangents) in self.near.curves.iter_mut().enumerate() {
            let rho = at.guides[i].rho();
            *tangents = with_guide(tangents, &self.series[i], rho);
            let straightness = Curves::<Fixed>::straightness(tangents, rho).value;
            missing_rad[i] -= straightness * at.over_travel[i];
        }
        Some(Followed {
            pose: nearer(pose, &at, &self.near.lines, &missing_rad),
            missing_rad: f32::INFINITY,
            is_drawn: false,
        })
    }

    /// Where the setpoint is: the pose is followed from there when the servo goes off, with the curves as they are.
    #[inline]
    pub fn follow_from(&mut self, pose: &Pose<Fixed>) {
        self.followed = Some(Followed {
            pose: *pose,
            missing_rad: f32::INFINITY,
            is_drawn: false,
        });
    }

    /// One step of Newton's method, and the places on the guides before it; `None` when the pose is too far from where it was
    /// followed to.
    fn newton(
        &self,
        config: &Config,
        pose: &Pose<Fixed>,
        encoders: &[Angle; 3],
    ) -> Option<(Followed, [f32; 3])> {
        let at = self.solve(config, pose)?;
        let missing = missing_of(&at, encoders);
        let mut missing_rad = 0.0;
        for missing in missing.map(f32::abs) {
            if missing > missing_rad {
                missing_rad = missing;
            }
        }
        if missing_rad > MOST_MISSING_RAD {
            return None;
        }
        let followed = Followed {
            pose: nearer(pose, &at, &self.near.lines, &missing),
            missing_rad,
            is_drawn: false,
        };
        let lengths = [at.guides[0].rho(), at.guides[1].rho(), at.guides[2].rho()];
        Some((followed, lengths))
    }

    /// See [`corrected_inverse`].
    fn solve(&self, config: &Config, pose: &Pose<Fixed>) -> Option<CorrectedInverse<Fixed>> {
        let (twist, acceleration) = (Twist::default(), Acceleration::default());
        let (mut at, mut unused) = (None, PivotSetpoints::at_rest([Angle::ZERO; 3]));
        let at_rest = (&twist, &acceleration);
        let _ = self.pivot_setpoints(config, pose, at_rest, &mut unused, Some(&mut at));
        at
    }

    /// Setpoint of the pose to setpoints of the pivots as their encoders read them, if it is a pose of the mechanism, written where they
    /// are kept; and, if asked, how the pose was solved.
    // The corrected inverse stands here, once in the loop's memory: a function of its own would hand its results over in memory.
    #[inline(never)]
    pub fn pivot_setpoints(
        &self,
        config: &Config,
        pose: &Pose<Fixed>,
        (twist, acceleration): (&Twist<f32>, &Acceleration<f32>),
        wanted: &mut PivotSetpoints,
        solved: Option<&mut Option<CorrectedInverse<Fixed>>>,
    ) -> Option<()> {
        let at = corrected_inverse(pose, &self.near).ok()?;
        let guides = &at.guides;
        let (twist, acceleration) = in_platform_axes(guides, twist, acceleration);
        wanted.angles = at.encoders;
        wanted.motion = corrected_pivot_motion(&at, &self.near.lines, &twist, &acceleration);
        wanted.torques = platform_torques(&config.servo.body, guides, &twist, &acceleration);
        wanted.lengths = [guides[0].rho(), guides[1].rho(), guides[2].rho()];
        wanted.cosines = [guides[0].cosine, guides[1].cosine, guides[2].cosine];
        if let Some(solved) = solved {
            *solved = Some(at);
        }
        Some(())
    }
}

// Once in the loop's memory: they are long.

/// See [`direct`].
#[inline(never)]
fn drawn_pose(rings: &[Angle; 3]) -> Result<Pose<Fixed>, DirectError> {
    direct(rings)
}

/// See [`newton_step`].
#[inline(never)]
fn nearer(
    pose: &Pose<Fixed>,
    at: &CorrectedInverse<Fixed>,
    lines: &[Line<Fixed>; 3],
    missing_rad: &[f32; 3],
) -> Pose<Fixed> {
    newton_step(pose, at, lines, missing_rad)
}

/// See [`missing_rad`].
#[inline(never)]
fn missing_of(at: &CorrectedInverse<Fixed>, encoders: &[Angle; 3]) -> [f32; 3] {
    missing_rad(at, encoders)
}

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
