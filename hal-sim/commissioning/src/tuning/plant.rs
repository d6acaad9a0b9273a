//! What the servos see: from the volts of a tick to the angles that are read later, at frequencies up to half the ticks' rate.

use crate::chain::{Chain, Place};
use crate::closed_loop::LoopLine;
use crate::drive_model::{DriveModel, Electrical};
use crate::frequency_response::hold;
use crate::record::Timing;
use crate::tuning::servo::At;
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::TAU;

/// Responses from volts told to angles read, all delays in them, and what the pivots move there.
#[derive(Clone, Debug, PartialEq)]
pub struct Plant {
    /// Frequencies, rising.
    pub hz: Vec<f64>,
    /// Responses, rad/V.
    pub response: Vec<Matrix3<Complex<f64>>>,
    /// What each pivot moves, kg m^2: by it the gains may be scheduled.
    pub inertia: [f64; 3],
    /// Whether the frequencies reach from half a hertz to nearly half the ticks' rate: else neither stability nor rejection is known.
    pub is_complete: bool,
    pub(super) tick_s: f64,
    /// The frequencies, for a servo with this tick.
    pub(super) at: Vec<At>,
}

/// Places that gains have to be good at, track radii: in the middle, and at the rim of the reference stage's disk, midway between two guides, where the
/// platform rings most on them, and towards one (guides lie along 90, 210 and 330 deg); then at the others. Elsewhere it rings less: `hal-sim` tests that
/// gains which are sound here are so all over the disk.
pub const PLACES: [[f64; 2]; 7] = [
    [0.0, 0.0],
    [0.69282, 0.4],
    [0.0, 0.8],
    [-0.69282, 0.4],
    [0.0, -0.8],
    [-0.69282, -0.4],
    [0.69282, -0.4],
];
/// How many of them a search looks at; the others differ by the load's centre alone, and are looked at after it.
pub const SEARCHED: usize = 3;

/// Lowest frequency of a grid, Hz; its highest, over half the ticks' rate; where resonances and margins are, from, Hz, and to, over the highest; points
/// of the three parts, equal by their logarithms.
const FROM_HZ: f64 = 0.5;
const END: f64 = 0.98;
const NEAR_FROM_HZ: f64 = 20.0;
const NEAR_TO: f64 = 0.4;
const POINTS: [usize; 3] = [60, 420, 20];

/// See [`Plant::thinned`].
const THINNED: usize = 3;

/// Frequencies for a plant.
#[must_use]
pub fn grid(timing: &Timing) -> Vec<f64> {
    let end_hz = 0.5 * END / timing.tick_s;
    let ends = [FROM_HZ, NEAR_FROM_HZ, NEAR_TO * end_hz, end_hz];
    let part = |(ends, points): (&[f64], usize)| {
        let (from, gap) = (ends[0], ends[1] / ends[0]);
        (0..points).map(move |k| from * gap.powf(k as f64 / points as f64))
    };
    ends.windows(2).zip(POINTS).flat_map(part).collect()
}

/// From volts at the terminals to the rings' angles, rad/V, as continuous signals: what [`crate::closed_loop`] measures.
#[must_use]
pub fn angle_by_volts(
    electrical: &[Electrical; 3],
    chain: &Chain,
    place: &Place,
    hz: f64,
) -> Matrix3<Complex<f64>> {
    let s = Complex::new(0.0, TAU * hz);
    let angles = chain.compliance(hz, place);
    let diagonal = |value: &dyn Fn(&Electrical) -> Complex<f64>| {
        Matrix3::from_diagonal(&Vector3::new(
            value(&electrical[0]),
            value(&electrical[1]),
            value(&electrical[2]),
        ))
    };
    let constants = diagonal(&|drive| drive.motor_constant.into());
    let windings = diagonal(&|drive| drive.resistance_ohm + s * drive.inductance_h);
    let impedance = windings + constants * angles.motor * constants * s;
    let nothing = Matrix3::repeat(Complex::new(f64::NAN, f64::NAN));
    impedance
        .try_inverse()
        .map_or(nothing, |inverse| angles.ring * constants * inverse)
}

impl Plant {
    /// From responses, rad/V, at these frequencies; whether they are complete. Ticks as long as these have been told to the responses' delays.
    #[must_use]
    pub fn new(
        hz: Vec<f64>,
        response: Vec<Matrix3<Complex<f64>>>,
        inertia: [f64; 3],
        is_complete: bool,
        tick_s: f64,
    ) -> Self {
        Self {
            at: hz.iter().map(|&hz| At::new(hz, tick_s)).collect(),
            hz,
            response,
            inertia,
            is_complete,
            tick_s,
        }
    }

    /// From the model, at a place.
    #[must_use]
    pub fn from_model(
        electrical: &[Electrical; 3],
        chain: &Chain,
        place: &Place,
        timing: &Timing,
    ) -> Self {
        let hz = grid(timing);
        let response = hz
            .iter()
            .map(|&hz| angle_by_volts(electrical, chain, place, hz) * seen(hz, timing))
            .collect();
        let inertia = diagonal_of(&chain.inertia(place));
        Self::new(hz, response, inertia, true, timing.tick_s)
    }

    /// The same at several places; those outside the track are left out.
    #[must_use]
    pub fn at_places(
        electrical: &[Electrical; 3],
        chain: &Chain,
        places: &[[f64; 2]],
        timing: &Timing,
    ) -> Vec<Self> {
        (places.iter())
            .filter_map(|[x, y]| Place::new(*x, *y))
            .map(|place| Self::from_model(electrical, chain, &place, timing))
            .collect()
    }

    /// With a load, what an identified machine may be as well, at each place: springs and dampers off, windings cold after a rest or warm at
    /// work.
    #[must_use]
    pub fn as_they_may_be(
        model: &DriveModel,
        chain: &Chain,
        places: &[[f64; 2]],
        timing: &Timing,
    ) -> Vec<Self> {
        let [softer, stiffer] = &chain.as_it_may_be(&model.mechanical.uncertainty());
        let as_found = &model.electrical;
        let at_work = &as_found.each_ref().map(Electrical::at_work);
        let rested = &as_found.each_ref().map(Electrical::rested);
        [(rested, softer), (as_found, stiffer), (at_work, chain)]
            .map(|(electrical, chain)| Self::at_places(electrical, chain, places, timing))
            .concat()
    }

    /// What seldom comes together: springs and dampers off, and windings warm at work.
    #[must_use]
    pub fn as_they_seldom_are(
        model: &DriveModel,
        chain: &Chain,
        places: &[[f64; 2]],
        timing: &Timing,
    ) -> Vec<Self> {
        let at_work = &model.electrical.each_ref().map(Electrical::at_work);
        (chain.as_it_may_be(&model.mechanical.uncertainty()).iter())
            .flat_map(|chain| Self::at_places(at_work, chain, places, timing))
            .collect()
    }

    /// As it was measured, at the lines alone: to see what margins a measurement gives at gains that the model was tuned for.
    #[must_use]
    pub fn from_lines(lines: &[LoopLine], inertia: [f64; 3], timing: &Timing) -> Self {
        let hz = lines.iter().map(|line| line.hz).collect();
        let response = lines
            .iter()
            .map(|line| line.plant * seen(line.hz, timing))
            .collect();
        Self::new(hz, response, inertia, false, timing.tick_s)
    }
}

impl Plant {
    /// The same under a controller that schedules its gains by another load, the one that it knows.
    #[must_use]
    pub fn scheduled_by(self, known: &Self) -> Self {
        Self {
            inertia: known.inertia,
            ..self
        }
    }

    /// At each third of its frequencies, if they are complete: enough to see valleys, in a third of the time.
    pub(super) fn thinned(&self) -> Self {
        let every = if self.is_complete { THINNED } else { 1 };
        Self {
            hz: self.hz.iter().copied().step_by(every).collect(),
            response: self.response.iter().copied().step_by(every).collect(),
            at: self.at.iter().copied().step_by(every).collect(),
            ..*self
        }
    }
}

fn seen(hz: f64, timing: &Timing) -> Complex<f64> {
    hold(hz, timing) * Complex::cis(TAU * hz * timing.angle_s)
}

fn diagonal_of(matrix: &Matrix3<f64>) -> [f64; 3] {
    matrix.diagonal().into()
}
