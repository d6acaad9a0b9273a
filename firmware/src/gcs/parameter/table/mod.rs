//! The declaration of all parameters.
//!
//! Ranges are what a stage of this kind can be, and what the tick's arithmetic holds; what has to hold between several
//! of them stands in `check`. Limits of motion can be lowered at level 0 and raised again as far as the stage was set
//! up for; level 1 raises them further.

mod pivots;

use super::descriptor::{Kind, Parameter, ValueSource, When};
use crate::commander::axis::Axis;
use crate::drivers::biss::POSITION_BITS;
use crate::drivers::power_stage::MOST_MEASURED_A;
use crate::gcs::request::MAX_DELAY_MS;
use crate::motion::TurnDirection;
use crate::recorder::RECORDER_WORDS;
use pivots::{DRIVES, GAINS, LEARNT, RIPPLE, SUBDIVISION, of_pivots};

/// What the parameters of a group share.
#[derive(Clone, Copy)]
struct Group {
    name: &'static str,
    level: u8,
    when: When,
}

const LIMIT: Group = group("limit", 0, When::AtRest);
const TARGET: Group = group("target", 0, When::AtRest);
const GEOMETRY: Group = group("geometry", 1, When::ServoOff);
const SERVO: Group = group("servo", 1, When::AtRest);
const WINDOW: Group = group("window", 0, When::AtRest);
const SUPERVISION: Group = group("supervision", 1, When::AtRest);
const ENCODER: Group = group("encoder", 1, When::ServoOff);
const EXCITATION: Group = group("excitation", 1, When::ServoOff);
const COMMISSIONING: Group = group("commissioning", 1, When::ServoOff);
const PLATFORM: Group = group("platform", 0, When::AtRest);
const RECORDER: Group = group("recorder", 0, When::AtRest);
const DRIVE: Group = group("drive", 1, When::AtRest);
const RIPPLE_GROUP: Group = group("ripple", 1, When::AtRest);
const LEARNT_GROUP: Group = group("learnt", 1, When::AtRest);
const SUBDIVISION_GROUP: Group = group("subdivision", 1, When::ServoOff);

const fn group(name: &'static str, level: u8, when: When) -> Group {
    Group { name, level, when }
}

impl Group {
    const fn float(
        self,
        id: u32,
        text: &'static str,
        unit: &'static str,
        range: [f64; 2],
        source: ValueSource,
    ) -> Parameter {
        Parameter {
            id,
            kind: Kind::Float,
            when: self.when,
            level: self.level,
            group: self.name,
            text,
            unit,
            range,
            source,
        }
    }

    const fn int(
        self,
        id: u32,
        text: &'static str,
        range: [f64; 2],
        source: ValueSource,
    ) -> Parameter {
        Parameter {
            kind: Kind::Int,
            ..self.float(id, text, "", range, source)
        }
    }
}

/// A parameter that can only be read.
const fn read_only(
    id: u32,
    kind: Kind,
    text: &'static str,
    unit: &'static str,
    source: ValueSource,
) -> Parameter {
    Parameter {
        kind,
        ..group("controller", 0, When::Never).float(id, text, unit, [0.0; 2], source)
    }
}

/// A field of the parameters, as it is or as a number.
macro_rules! at {
    ($($field:tt)+) => { ValueSource::Settable(|p| p.$($field)+, |p, value| p.$($field)+ = value) };
}
macro_rules! whole {
    ($number:ty: $($field:tt)+) => {
        ValueSource::Settable(|p| p.$($field)+ as f64, |p, value| p.$($field)+ = value as $number)
    };
}
macro_rules! flag {
    ($($field:tt)+) => {
        ValueSource::Settable(|p| f64::from(u8::from(p.$($field)+)), |p, value| p.$($field)+ = value != 0.0)
    };
}

/// Largest count of an encoder.
const COUNTS: f64 = ((1u32 << POSITION_BITS) - 1) as f64;

/// The parameter that `CMS` sets.
pub(in crate::gcs) const COMMISSIONED: u32 = 0x5450_0C00;

/// Most points that a record of one word has room for.
const ROWS: f64 = RECORDER_WORDS as f64;
/// By their numbers.
const WAYS: [TurnDirection; 4] = [
    TurnDirection::AsGiven,
    TurnDirection::Shortest,
    TurnDirection::Positive,
    TurnDirection::Negative,
];

fn way_number(way: TurnDirection) -> f64 {
    let place = WAYS.iter().position(|&other| other == way);
    place.map_or(0.0, |place| place as f64)
}

/// Every parameter, in the order of `HPA?`. A static: a constant would stand in the image once for each use.
pub static PARAMETERS: &[Parameter] = &join::<COUNT>(&[
    COMMON,
    &of_pivots::<{ 4 * GAINS.len() }>(GAINS),
    AFTER_GAINS,
    &of_pivots::<{ 4 * DRIVES.len() }>(DRIVES),
    POWER,
    &of_pivots::<{ 4 * RIPPLE.len() }>(RIPPLE),
    &of_pivots::<{ 4 * LEARNT.len() }>(LEARNT),
    &of_pivots::<{ 4 * SUBDIVISION.len() }>(SUBDIVISION),
]);

const COUNT: usize = COMMON.len()
    + AFTER_GAINS.len()
    + POWER.len()
    + 4 * (GAINS.len() + DRIVES.len() + RIPPLE.len() + LEARNT.len() + SUBDIVISION.len());

/// Lists one after the other.
const fn join<const N: usize>(lists: &[&[Parameter]]) -> [Parameter; N] {
    let mut all = [COMMON[0]; N];
    let (mut list, mut place) = (0, 0);
    while list < lists.len() {
        let mut i = 0;
        while i < lists[list].len() {
            all[place] = lists[list][i];
            i += 1;
            place += 1;
        }
        list += 1;
    }
    assert!(place == N);
    all
}

#[rustfmt::skip]
const COMMON: &[Parameter] = &[
    read_only(0x0700_0601, Kind::Char, "unit of the axis", "", ValueSource::Axis(Axis::unit)),
    read_only(0x0E00_0200, Kind::Float, "servo update time", "s", ValueSource::ReadOnly(|p| 1.0 / p.limits.rate_hz)),
    TARGET.int(0x1900_1900, "trajectory source: 0 moves to targets, 1 streamed targets", [0.0, 1.0], flag!(targets.streamed)),

    RECORDER.int(0x1600_0201, "points of a record, as many as the tables leave room for", [1.0, ROWS], whole!(u32: recorder.points)),
    RECORDER.int(0x5450_0900, "points of it from before the trigger", [0.0, ROWS], whole!(u32: recorder.before)),

    LIMIT.float(0x5450_0100, "speed of the platform centre", "mm/s", [0.2, 2_000.0], at!(limits.speed_mm_s)),
    LIMIT.float(0x5450_0101, "acceleration of the platform centre", "mm/s^2", [4.0, 50_000.0], at!(limits.acceleration_mm_s2)),
    LIMIT.float(0x5450_0102, "jerk of the platform centre", "mm/s^3", [400.0, 5e6], at!(limits.jerk_mm_s3)),
    LIMIT.float(0x5450_0103, "speed of rotation", "deg/s", [0.36, 5_000.0], at!(limits.turn_speed_deg_s)),
    LIMIT.float(0x5450_0104, "acceleration of rotation", "deg/s^2", [7.2, 40_000.0], at!(limits.turn_acceleration_deg_s2)),
    LIMIT.float(0x5450_0105, "jerk of rotation", "deg/s^3", [720.0, 5e6], at!(limits.turn_jerk_deg_s3)),
    LIMIT.float(0x5450_0106, "rate of a pivot, as far as the drives bear it (error 4011)", "rad/s", [0.01, 100.0], at!(limits.pivot_rate_rad_s)),
    LIMIT.float(0x5450_0107, "acceleration of a pivot, in an urgent stop too, as far as the drives bear it with the load (error 4011)", "rad/s^2", [0.3, 2_000.0], at!(limits.pivot_acceleration_rad_s2)),
    Parameter { level: 1, ..LIMIT.float(0x5450_0108, "how much harder an urgent stop brakes, as far as the pivots' acceleration lets it", "", [1.0, 4.0], at!(limits.stop_factor)) },

    TARGET.int(0x5450_0110, "way of W to a target: 0 literal, 1 shortest, 2 always positive, 3 always negative", [0.0, 3.0],
        ValueSource::Settable(|p| way_number(p.targets.turn_direction), |p, number| p.targets.turn_direction = WAYS[number as usize & 3])),

    GEOMETRY.float(0x5450_0200, "radius of the track", "mm", [20.0, 1_000.0], at!(geometry.radius_mm)),
    GEOMETRY.float(0x5450_0201, "start of a guide", "track radii", [0.05, 0.95], at!(geometry.guide_start)),
    GEOMETRY.float(0x5450_0202, "length of a guide", "track radii", [0.1, 2.0], at!(geometry.guide_length)),
    GEOMETRY.float(0x5450_0203, "smallest angle between pivots", "deg", [0.0, 110.0],
        ValueSource::Settable(|p| p.geometry.separation_rad.to_degrees(), |p, deg| p.geometry.separation_rad = deg.to_radians())),

    SERVO.float(0x5450_0303, "learning, share of the integral gain", "", [0.0, 1.0], at!(servo.learning)),
    SERVO.float(0x5450_0304, "learning of friction, share of learning", "", [0.0, 1.0], at!(servo.friction_learning)),
    SERVO.float(0x5450_0305, "latency from latch to duty", "s", [0.0, 1e-3], at!(servo.latency_s)),
    SERVO.float(0x5450_0306, "inertia of a pivot and its share of the platform that velocity and integral gain are for, 0: the same gains everywhere", "kg m^2", [0.0, 10.0], at!(servo.scheduled_inertia_kg_m2)),
    SERVO.float(0x5450_0308, "what rest leaves of the gains' rates, 1: there is no rest mode", "", [0.05, 1.0], at!(servo.rest.stiffness)),
    SERVO.float(0x5450_0309, "time at rest after which they fall, 0.6 s at least if the loop does not hunt", "s", [0.0, 10.0], at!(servo.rest.delay_s)),
    SERVO.float(0x5450_030A, "mean following error that brings the full gains back", "encoder counts", [1.0, 1_000.0], at!(servo.rest.wake_counts)),
    SERVO.int(0x5450_030B, "what was learnt is kept over a restart: 0 by WPA alone, 1 by itself as well", [0.0, 1.0], flag!(servo.keeps_learnt)),
];
#[rustfmt::skip]
const AFTER_GAINS: &[Parameter] = &[

    WINDOW.float(0x5450_0400, "settling window; what has settled is so until it is out of twice that", "encoder counts", [0.5, 1_000.0], at!(window.counts)),
    WINDOW.float(0x5450_0401, "settling dwell", "s", [5e-5, 10.0], at!(window.dwell_s)),
    WINDOW.float(0x5450_0402, "time over whose mean the error is taken, at most 32 ticks", "s", [5e-5, 1.6e-3], at!(window.mean_s)),

    SUPERVISION.float(0x5450_0500, "largest following error", "rad", [2e-5, 0.05], at!(supervision.following_error_rad)),
    SUPERVISION.float(0x5450_0501, "lowest supply", "V", [24.0, 60.0], at!(supervision.supply_min_v)),
    SUPERVISION.int(0x5450_0502, "bad encoder frames that are bridged", [0.0, 10.0], whole!(u8: supervision.bridged_frames)),
    SUPERVISION.float(0x5450_0503, "largest plausible acceleration of a pivot", "rad/s^2", [1_000.0, 500_000.0],
        at!(supervision.plausible_acceleration_rad_s2)),
    SUPERVISION.float(0x5450_0504, "following error allowed besides, by rate", "rad per rad/s", [0.0, 0.001], at!(supervision.following_error_s)),
    SUPERVISION.float(0x5450_0505, "rate of a pivot that is a fault, over its largest in motion", "", [1.05, 3.0], at!(supervision.overspeed_factor)),
    SUPERVISION.float(0x5450_0506, "way in which an encoder must show something new", "rad", [1e-6, 0.05], at!(supervision.frozen_rad)),
    SUPERVISION.float(0x5450_0507, "voltage beyond what moved a pivot last, after which its encoder must show something new", "V", [0.1, 36.0], at!(supervision.frozen_v)),
    SUPERVISION.float(0x5450_0508, "longest time of a bridge at its largest duty", "s", [1e-3, 1.0], at!(supervision.max_saturation_s)),
    SUPERVISION.float(0x5450_0509, "current that a motor bears for ever", "A", [0.1, 6.0], at!(supervision.motor_current_a)),
    SUPERVISION.float(0x5450_050A, "heating time of a motor", "s", [0.01, 120.0], at!(supervision.motor_heating_s)),
    SUPERVISION.int(0x5450_050B, "late ticks that are allowed, one in 100 ticks forgiven", [0.0, 100.0], whole!(u32: supervision.late_ticks)),
    SUPERVISION.float(0x5450_050C, "how far out of the disk the setpoint is a fault", "mm", [0.01, 5.0], at!(supervision.disk_margin_mm)),
    SUPERVISION.float(0x5450_050D, "how far out of a guide's range the setpoint is a fault", "track radii", [1e-4, 0.05], at!(supervision.guide_margin)),
    SUPERVISION.float(0x5450_050E, "how far under their smallest angle pivots are a fault", "deg", [0.05, 5.0],
        ValueSource::Settable(|p| p.supervision.separation_margin_rad.to_degrees(), |p, deg| p.supervision.separation_margin_rad = deg.to_radians())),
    SUPERVISION.float(0x5450_050F, "duration of a fault's controlled stop, at least what the drives bear (error 4011)", "s", [0.01, 1.0], at!(supervision.stop_s)),
    SUPERVISION.float(0x5450_0511, "swing of a servo's voltage that is an oscillation", "V", [0.5, 60.0], at!(supervision.oscillation_v)),
    SUPERVISION.float(0x5450_0513, "how far a motor's current may be from what its voltage should drive, besides 60 % of that", "A", [0.2, 20.0], at!(supervision.unexplained_current_a)),
    SUPERVISION.int(0x5450_0512, "whether the stage may be driven with a debugger attached, which can halt the loop under load", [0.0, 1.0], flag!(supervision.debugger_allowed)),
    SUPERVISION.int(0x5450_0514, "whether the emergency stop has to be pressed once after each start before anything drives", [0.0, 1.0], flag!(supervision.stop_test_needed)),
    Parameter { level: 0, ..SUPERVISION.float(0x5450_0510, "longest silence of all connections together, 0 for any; HBT asks for the like of one connection", "ms", [0.0, MAX_DELAY_MS], at!(supervision.host_silence_ms)) },

    ENCODER.int(0x5450_0600, "reading of encoder 1 at pivot angle 0", [0.0, COUNTS], whole!(u32: encoders[0].zero_counts)),
    ENCODER.int(0x5450_0601, "reading of encoder 2 at pivot angle 0", [0.0, COUNTS], whole!(u32: encoders[1].zero_counts)),
    ENCODER.int(0x5450_0602, "reading of encoder 3 at pivot angle 0", [0.0, COUNTS], whole!(u32: encoders[2].zero_counts)),
    ENCODER.int(0x5450_0610, "whether encoder 1 counts down", [0.0, 1.0], flag!(encoders[0].reversed)),
    ENCODER.int(0x5450_0611, "whether encoder 2 counts down", [0.0, 1.0], flag!(encoders[1].reversed)),
    ENCODER.int(0x5450_0612, "whether encoder 3 counts down", [0.0, 1.0], flag!(encoders[2].reversed)),

    ENCODER.int(0x5450_0620, "ports of the encoders of pivot 1, 2 and 3, a digit each", [123.0, 321.0], whole!(u16: wiring.encoder_order)),
    ENCODER.int(0x5450_0630, "bridges of pivot 1, 2 and 3, a digit each", [123.0, 321.0], whole!(u16: wiring.bridge_order)),
    ENCODER.int(0x5450_0640, "whether a positive voltage turns pivot 1 to smaller angles", [0.0, 1.0], flag!(wiring.motors_reversed[0])),
    ENCODER.int(0x5450_0641, "whether a positive voltage turns pivot 2 to smaller angles", [0.0, 1.0], flag!(wiring.motors_reversed[1])),
    ENCODER.int(0x5450_0642, "whether a positive voltage turns pivot 3 to smaller angles", [0.0, 1.0], flag!(wiring.motors_reversed[2])),

    EXCITATION.float(0x5450_0D00, "largest voltage of an excitation", "V", [0.1, 12.0], at!(excitation.voltage_v)),
    EXCITATION.float(0x5450_0D01, "furthest that it may move a pivot", "rad", [1e-4, 7.0], at!(excitation.way_rad)),
    EXCITATION.float(0x5450_0D02, "largest rate of a pivot during it", "rad/s", [0.01, 5.0], at!(excitation.rate_rad_s)),
    EXCITATION.float(0x5450_0D03, "share of the servo's gains with which rings are held, each by itself", "", [0.01, 1.0], at!(excitation.stiffness)),

    COMMISSIONING.int(COMMISSIONED, "whether all that this machine has of its own is set: if not, nothing drives; CMS sets it", [0.0, 1.0], flag!(commissioned)),

    PLATFORM.float(0x5450_0700, "mass of the platform", "kg", [0.1, 50.0], at!(platform.mass_kg)),
    PLATFORM.float(0x5450_0701, "inertia of the platform", "kg m^2", [1e-4, 2.0], at!(platform.inertia_kg_m2)),
    PLATFORM.float(0x5450_0702, "mass of the payload", "kg", [0.0, 50.0], at!(platform.payload_kg)),
    PLATFORM.float(0x5450_0703, "inertia of the payload about its own centre", "kg m^2", [0.0, 2.0], at!(platform.payload_inertia_kg_m2)),
    PLATFORM.float(0x5450_0704, "x of the payload's centre on the platform", "mm", [-500.0, 500.0], at!(platform.payload_centre_mm[0])),
    PLATFORM.float(0x5450_0705, "y of the payload's centre on the platform", "mm", [-500.0, 500.0], at!(platform.payload_centre_mm[1])),
    PLATFORM.float(0x5450_0706, "friction of a carriage on its guide; with one of these three a pivot has one ripple less", "N", [0.0, 50.0], at!(guides.coulomb_n)),
    PLATFORM.float(0x5450_0707, "viscous friction of a carriage", "N s/m", [0.0, 500.0], at!(guides.viscous_n_s_m)),
    PLATFORM.float(0x5450_0708, "presliding of a carriage", "um", [0.1, 1000.0], at!(guides.presliding_um)),
    PLATFORM.float(0x5450_0709, "stiffness across a guide; 0: rigid", "N/um", [0.0, 1000.0], at!(guides.stiffness_n_um)),

];
/// Largest limit of a motor's current, A: what goes beyond it must still be seen.
const CURRENT_LIMIT_A: f64 = 7.0;
const _: () = assert!(CURRENT_LIMIT_A < MOST_MEASURED_A);
#[rustfmt::skip]
const POWER: &[Parameter] = &[
    DRIVE.float(0x5450_0806, "nominal supply", "V", [6.0, 60.0], at!(power.supply_v)),
    DRIVE.float(0x5450_080D, "largest voltage of a motor; the bridge gives 98 % of the supply at most", "V", [1.0, 60.0], at!(power.voltage_limit_v)),
    DRIVE.float(0x5450_080E, "largest voltage of a motor in recovery (RCV)", "V", [1.0, 24.0], at!(power.recovery_voltage_v)),
    DRIVE.float(0x5450_080F, "largest current of a motor", "A", [0.5, CURRENT_LIMIT_A], at!(power.current_limit_a)),
    Parameter { when: When::Never, ..DRIVE.float(0x5450_080B, "PWM frequency", "Hz", [0.0; 2], ValueSource::ReadOnly(|p| p.power.pwm_hz)) },
    Parameter { when: When::Never, ..DRIVE.int(0x5450_080C, "counts of a PWM period", [0.0; 2], ValueSource::ReadOnly(|p| f64::from(p.power.pwm_counts))) },
];

impl Parameter {
    /// The parameter of an id.
    pub fn find(id: u32) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.id == id)
    }
}
