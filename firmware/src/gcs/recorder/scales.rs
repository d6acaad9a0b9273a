//! From the words of a row to mm, deg and s.

use super::channel::{Channel, PIVOTS, Signal, setpoint};
use crate::calibration::MachineCalibration;
use crate::commander::coordinates::measured;
use crate::commander::frames::ActiveFrames;
use crate::control::units::{CURRENT_A_PER_COUNT, SUPPLY_V_PER_COUNT};
use crate::parameters::Parameters;
use crate::recorder::{MAX_ROW_WORDS, RawSignal, SignalFormat};
use kinematics::{Angle, Geometry};

/// What turns words into mm, deg and s, as it was when the record was ordered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scales {
    geometry: Geometry,
    pwm_counts: f64,
    period_s: f64,
    /// Dead time's knee of each drive, A.
    knees_a: [f64; 3],
}

const LENGTH: f64 = 1.0 / 536_870_912.0;
const ANGLE_DEG: f64 = 360.0 / 268_435_456.0;
const ERROR_DEG: f64 = 360.0 / 4_294_967_296.0;

impl Scales {
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            geometry: parameters.geometry,
            pwm_counts: f64::from(parameters.power.pwm_counts),
            period_s: 1.0 / parameters.limits.rate_hz,
            knees_a: (parameters.drives.each_ref()).map(|drive| drive.dead_time_knee_a),
        }
    }

    /// Seconds from tick to tick.
    pub const fn period_s(&self) -> f64 {
        self.period_s
    }

    /// What a word's number is multiplied by.
    pub fn factor(&self, word: RawSignal) -> f64 {
        let radius_mm = self.geometry.radius_mm;
        match (word.format(), word) {
            (SignalFormat::Length, _) => LENGTH * radius_mm,
            (SignalFormat::Angle, _) => ANGLE_DEG,
            (SignalFormat::AngleError, _) => ERROR_DEG,
            (SignalFormat::Float, RawSignal::Velocity(0 | 1) | RawSignal::Acceleration(0 | 1)) => {
                radius_mm
            }
            (SignalFormat::Float, RawSignal::ModelCurrent(i)) => {
                (self.knees_a.get(usize::from(i)).copied()).unwrap_or_default()
            }
            (
                SignalFormat::Float,
                RawSignal::Integral(_)
                | RawSignal::LearntRate(_)
                | RawSignal::LearntTorque(_)
                | RawSignal::LearntFriction(_),
            ) => 1.0,
            (SignalFormat::Float, _) => 180.0 / core::f64::consts::PI,
            (_, RawSignal::Duty(_)) => 1.0 / self.pwm_counts,
            (_, RawSignal::Current(_)) => CURRENT_A_PER_COUNT,
            (_, RawSignal::Supply) => SUPPLY_V_PER_COUNT,
            (SignalFormat::Count, _) => 1.0,
        }
    }
}

/// What a machine is when a record of it is read.
pub(super) struct MachineNow<'a> {
    /// What it is off the drawing, if that is known: what its encoders read is a pose by it.
    pub built: Option<&'a MachineCalibration>,
    /// Its lengths over those of the track as the parameter says.
    pub growth: f64,
}

/// A row of a record, as it was read.
pub(super) struct RecordRow<'a> {
    pub words: &'a [RawSignal],
    pub values: [i64; MAX_ROW_WORDS],
    pub scales: &'a Scales,
    /// The row, counted from that of the trigger.
    pub row: i64,
    /// Ticks from row to row.
    pub every: u32,
    pub machine: &'a MachineNow<'a>,
    /// Measured pose, once somebody has asked; and by the drawing.
    pub pose: Option<[f64; 3]>,
    pub drawn_pose: Option<[f64; 3]>,
}

impl RecordRow<'_> {
    /// The value of a channel, mm, deg or as its option says; not a number where the pivots are no pose.
    pub fn value(&mut self, channel: Channel) -> f64 {
        match channel.signal {
            Signal::Zero => 0.0,
            Signal::Word(word) => self.word(word),
            Signal::Measured(i) => self.pose()[usize::from(i)],
            Signal::MeasuredAsDrawn(i) => self.drawn_pose()[usize::from(i)],
            Signal::Error(i) => self.pose()[usize::from(i)] - self.word(setpoint(i)),
            Signal::Time => self.row as f64 * f64::from(self.every) * self.scales.period_s,
        }
    }

    fn integer(&self, word: RawSignal) -> i64 {
        let place = self.words.iter().position(|own| *own == word);
        place.map_or(0, |place| self.values[place])
    }

    fn word(&self, word: RawSignal) -> f64 {
        let integer = self.integer(word);
        let number = match word.format() {
            SignalFormat::Float => f64::from(f32::from_bits(integer as u32)),
            _ => integer as f64,
        };
        let grown = if is_length(word) {
            self.machine.growth
        } else {
            1.0
        };
        number * self.scales.factor(word) * grown
    }

    fn pose(&mut self) -> [f64; 3] {
        if let Some(pose) = self.pose {
            return pose;
        }
        let pose = self.pose_on(self.machine.built);
        self.pose = Some(pose);
        pose
    }

    fn drawn_pose(&mut self) -> [f64; 3] {
        let pose = self.drawn_pose.unwrap_or_else(|| self.pose_on(None));
        self.drawn_pose = Some(pose);
        pose
    }

    fn pose_on(&self, built: Option<&MachineCalibration>) -> [f64; 3] {
        let pivots = PIVOTS.map(|pivot| Angle::from_units(self.integer(pivot) << 4));
        let mut geometry = self.scales.geometry;
        geometry.radius_mm *= self.machine.growth;
        measured(&pivots, &ActiveFrames::BASE, &geometry, built)
            .map_or([f64::NAN; 3], |pose| [pose[0], pose[1], pose[5]])
    }
}

/// Whether a word is a length, or a velocity or an acceleration in lengths.
const fn is_length(word: RawSignal) -> bool {
    matches!(
        word,
        RawSignal::Centre(_) | RawSignal::Velocity(0 | 1) | RawSignal::Acceleration(0 | 1)
    )
}
