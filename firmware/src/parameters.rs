//! Every tunable of the controller, in physical units, with the reference stage as default.
//!
//! What the tick uses is derived from these once, in `control/config.rs`. Defaults are those of the reference stage
//! unless a line says otherwise.

mod connector_order;
mod consistency;
mod recovery;

pub use connector_order::ConnectorOrder;
pub(crate) use consistency::MIN_HOST_SILENCE_MS;

use crate::motion::{Limits, TurnDirection};
use kinematics::Geometry;

/// Rows of a record unless told otherwise: with all tables 16,384 samples.
pub const MAX_RECORD_ROWS: usize = 2048;

/// PWM counts of full duty on the reference controller: 168 MHz over 40 kHz.
pub const PWM_COUNTS: u16 = 4200;

/// All parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters {
    /// Mechanism.
    pub geometry: Geometry,
    /// Limits of motion, and the control rate.
    pub limits: Limits,
    /// What the pivots carry, for torque feedforward.
    pub platform: Platform,
    /// What the carriages do on their guides, for feedforward.
    pub guides: Guides,
    /// The bridges' common supply and PWM.
    pub power: PowerStage,
    /// Ring drives, pivot by pivot.
    pub drives: [Drive; 3],
    /// Servo.
    pub servo: Servo,
    /// What the servos have learnt of their drives, as it is kept, pivot by pivot.
    pub learnt: [Learnt; 3],
    /// Encoders, pivot by pivot.
    pub encoders: [EncoderMounting; 3],
    /// What their readings are off by within each period of their scales, pivot by pivot.
    pub subdivision: [Subdivision; 3],
    /// When the stage counts as settled.
    pub window: SettlingWindow,
    /// Thresholds of the faults.
    pub supervision: Supervision,
    /// Guards of excitations.
    pub excitation: ExcitationLimits,
    /// Which connector of the board is which pivot's.
    pub wiring: Wiring,
    /// The data recorder.
    pub recorder: RecorderParameters,
    /// What targets mean.
    pub targets: Targets,
    /// Whether zeros and directions of the encoders, and all else that a machine has of its own, are known to be this machine's. If
    /// not, nothing drives.
    pub commissioned: bool,
}

/// What commanded targets mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Targets {
    /// Which way round to an orientation.
    pub turn_direction: TurnDirection,
    /// Whether `MOV` gives the targets of a stream, one after the other, instead of places to move to.
    pub streamed: bool,
}

/// Moving mass in the platform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Platform {
    /// Platform without payload.
    pub mass_kg: f64,
    /// About the platform centre.
    pub inertia_kg_m2: f64,
    /// Payload.
    pub payload_kg: f64,
    /// Payload about its own centre of mass.
    pub payload_inertia_kg_m2: f64,
    /// Centre of the payload's mass in the platform's axes.
    pub payload_centre_mm: [f64; 2],
}

/// The carriages on their guides, all three alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guides {
    /// Coulomb friction of a carriage.
    pub coulomb_n: f64,
    /// Viscous friction of a carriage.
    pub viscous_n_s_m: f64,
    /// Distance over which the friction builds up after a reversal (presliding).
    pub presliding_um: f64,
    /// Stiffness across a guide; 0: it is rigid.
    pub stiffness_n_um: f64,
}

/// What the three bridges share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerStage {
    /// PWM frequency.
    pub pwm_hz: f64,
    /// Counts of a full PWM period; at most 32,767.
    pub pwm_counts: u16,
    /// Nominal supply; the duty is computed from the measured one.
    pub supply_v: f64,
    /// Largest voltage that the servo puts on a motor at the nominal supply; never more than the bridge can give.
    pub voltage_limit_v: f64,
    /// The same while the stage is recovered from out of its reach.
    pub recovery_voltage_v: f64,
    /// Largest current of a motor.
    pub current_limit_a: f64,
}

/// A brushed DC motor behind a gear, as seen at the ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Torque constant of the motor, equal to its voltage constant in V s/rad.
    pub torque_constant_n_m_a: f64,
    /// Motor turns per ring turn.
    pub gear_ratio: f64,
    /// Winding resistance.
    pub resistance_ohm: f64,
    /// Winding inductance.
    pub inductance_h: f64,
    /// Time in each PWM period for which both switches of a leg are off.
    pub dead_time_s: f64,
    /// Current from which the whole dead time counts; below, the PWM's ripple makes up for a part of it.
    pub dead_time_knee_a: f64,
    /// Ring, carriage, gear and rotor together, at the ring.
    pub inertia_kg_m2: f64,
    /// What of it is the rotor's and its side of the gear.
    pub motor_inertia_kg_m2: f64,
    /// Viscous friction at the ring.
    pub viscous_n_m_s: f64,
    /// Coulomb friction at the ring.
    pub coulomb_n_m: f64,
    /// Distance over which friction builds up after a reversal (presliding).
    pub presliding_rad: f64,
}

/// Servo gains.
///
/// With voltage drive a ring follows `J w' = (Kt N / R) (u - Kt N w)` below the electrical corner, so a velocity gain
/// Kv crosses over at `Kv Kt N / (R J)`: 40 V s/rad on 0.035 kg m^2 (a ring and its share of the platform) gives 1,600
/// rad/s, 260 Hz. The electrical corner at R / L = 3,000 rad/s, 72 us from latch to the middle of the duty's effect and
/// the 1.5 kHz resonance leave that room for a loop gain half as high again: a motor constant 20 % over and an inertia
/// 20 % under the model. The position gain and the integral's corner lie a factor 5 below it (300 and 350 1/s), 11 and
/// 12 deg of phase at crossover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// Velocity setpoint per position error.
    pub position_1_s: f64,
    /// Voltage per velocity error.
    pub velocity_v_s_rad: f64,
    /// Voltage per integral of the velocity error.
    pub integral_v_rad: f64,
}

/// What the loops of the pivots have in common, and their gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Servo {
    /// Gains, pivot by pivot.
    pub gains: [Gains; 3],
    /// Filters of the feedback, pivot by pivot.
    pub filters: [FeedbackFilters; 3],
    /// Torque ripple that is made up for, pivot by pivot.
    pub ripple: [Ripple; 3],
    /// Cyclic errors of the gears that are made up for, pivot by pivot.
    pub gear_errors: [GearError; 3],
    /// Inertia of a pivot, ring and share of the platform, that velocity gain and integral gain are for: where a pivot moves more
    /// they are larger by as much. 0: they are the same everywhere.
    pub scheduled_inertia_kg_m2: f64,
    /// How fast feedforward learns, as a share of the integral gain (0: not at all); see `control/servo`.
    pub learning: f64,
    /// The same for friction, as a share of `learning`: its signal does not vanish at rest, where it adds to the
    /// integral.
    pub friction_learning: f64,
    /// Whether what was learnt is stored without being asked for: when the servo goes off, and at rest from time to time.
    pub keeps_learnt: bool,
    /// Time from the encoders' latch to the middle of the period in which the duty computed from it acts, by which
    /// voltage feedforward looks ahead: 15 us to the tick, 32 us to the PWM period, half of the 50 us it acts.
    pub latency_s: f64,
    /// What becomes of the gains while the setpoint rests.
    pub rest: RestMode,
}

/// Filters between feedback and voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeedbackFilters {
    /// Against resonances.
    pub notches: [Notch; 2],
    /// Against the winding's lag.
    pub lead: Lead,
}

/// A notch filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Notch {
    /// Centre; 0: no filter.
    pub frequency_hz: f64,
    /// Distance of the frequencies at which it lets 1/sqrt(2) pass, if it lets nothing pass at its centre.
    pub width_hz: f64,
    /// What it lets pass at its centre, 0 to 1.
    pub gain: f64,
}

/// A lead: the gain grows between two frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lead {
    /// From here on; 0: no lead.
    pub from_hz: f64,
    /// Up to here.
    pub to_hz: f64,
}

/// Sines of a pivot's torque ripple.
pub const HARMONICS: usize = 4;

/// Torque ripple of a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// Its sines.
    pub harmonics: [Harmonic; HARMONICS],
}

/// A sine of the pivot's angle in a drive's torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Periods in a turn of the ring.
    pub periods: f64,
    /// Amplitude at the ring; 0: there is none.
    pub amplitude_n_m: f64,
    /// Phase at pivot angle 0, of a sine.
    pub phase_deg: f64,
}

/// The cyclic error of a gear: what its motor stands further on than the ring, seen at the ring, a sine once a turn of the motor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GearError {
    /// Amplitude; 0: there is none.
    pub amplitude_urad: f64,
    /// Phase at pivot angle 0, of a sine.
    pub phase_deg: f64,
}

/// What a servo has learnt of its drive: volts that feedforward adds to the model's. See `control/servo`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Learnt {
    /// For each rad/s of the setpoint.
    pub rate_v_s_rad: f64,
    /// For each N m.
    pub torque_v_n_m: f64,
    /// Against friction.
    pub friction_v: f64,
    /// What the motor constant at the ring is more than the model has it, by the measured current.
    pub motor_constant_v_s_rad: f64,
}

/// Rest mode: with the setpoint at rest for some time the loop becomes slower, so that it does not answer the noise of the
/// encoders and does not hunt in the gap of the transmission; a push brings the full loop back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestMode {
    /// What is left of velocity gain, position gain and integral rate; 1: there is no rest mode.
    pub stiffness: f64,
    /// Time at rest after which they fall.
    pub delay_s: f64,
    /// Following error, encoder counts, mean of the settling window's time, from which on the loop is the full one.
    pub wake_counts: f64,
}

/// How an encoder is mounted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EncoderMounting {
    /// Reading, in counts, at pivot angle 0.
    pub zero_counts: u32,
    /// Whether it counts down when the pivot angle grows.
    pub reversed: bool,
}

/// Sines of the error within a period of an encoder's scale. For a fourth the settings that a sector of the flash holds have no room.
pub const SUBDIVISION_HARMONICS: usize = 3;

/// The error that an encoder makes within each period of its scale (sub-divisional or interpolation error).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subdivision {
    /// Periods of the scale in a turn; 0: not known, nothing is corrected.
    pub periods: u32,
    /// One, two and three sines in a period.
    pub harmonics: [SubdivisionHarmonic; SUBDIVISION_HARMONICS],
}

/// A sine of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubdivisionHarmonic {
    /// By which the encoder reads too much, in the direction in which it counts. In whole numbers, which take the least of the memory.
    pub amplitude_nrad: u16,
    /// Phase at reading 0, of a sine, tenths of a degree.
    pub phase_tenths_deg: i16,
}

/// When the stage counts as settled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettlingWindow {
    /// Largest following error of any pivot, in encoder counts.
    pub counts: f64,
    /// For how long.
    pub dwell_s: f64,
    /// The error is the mean of this time: the window may be smaller than the encoders' noise.
    pub mean_s: f64,
}

/// Thresholds of the faults.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supervision {
    /// Largest following error of a pivot whose setpoint rests.
    pub following_error_rad: f64,
    /// What is allowed besides, for each rad/s of the setpoint: a time by which it may lag.
    pub following_error_s: f64,
    /// Bad encoder frames in a row that are bridged by extrapolation.
    pub bridged_frames: u8,
    /// Largest pivot acceleration that can be real: a frame that asks for more is bad, whatever its CRC says.
    pub plausible_acceleration_rad_s2: f64,
    /// Lowest supply.
    pub supply_min_v: f64,
    /// Rate of a pivot that is a fault, over the largest rate of a pivot in motion.
    pub overspeed_factor: f64,
    /// Distance of a pivot's setpoint in which its encoder must show something new.
    pub frozen_rad: f64,
    /// Change of a drive's voltage after which its encoder must show something new.
    pub frozen_v: f64,
    /// Swing of the voltage that the feedback asks for which, to and fro at a setpoint that hardly moves, is an oscillation.
    pub oscillation_v: f64,
    /// Longest time of a bridge at its largest duty (saturated).
    pub max_saturation_s: f64,
    /// How far a motor's current may be from what its voltage should drive, besides a share of that.
    pub unexplained_current_a: f64,
    /// Current that a motor bears for ever.
    pub motor_current_a: f64,
    /// Time in which a motor's winding goes most of the way (all but 1/e) to its final temperature.
    pub motor_heating_s: f64,
    /// Ticks that may be late, one in a hundred ticks forgiven.
    pub late_ticks: u32,
    /// How far out of the usable disk the platform's setpoint is a fault.
    pub disk_margin_mm: f64,
    /// How far out of its guide's range a pivot's setpoint is a fault, track radii.
    pub guide_margin: f64,
    /// How far under their smallest angle two measured pivots are a fault.
    pub separation_margin_rad: f64,
    /// Duration of a fault's controlled stop.
    pub stop_s: f64,
    /// Whether the stage may be driven with a debugger attached.
    pub debugger_allowed: bool,
    /// Whether the emergency stop has to be pressed once after each start before anything drives.
    pub stop_test_needed: bool,
    /// Longest silence of the host; 0 when any is allowed.
    pub host_silence_ms: f64,
}

/// What an excitation may do with the servo off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExcitationLimits {
    /// Largest voltage of a motor; with the servo on what is added to the servo's.
    pub voltage_v: f64,
    /// Furthest that a pivot may go.
    pub way_rad: f64,
    /// Largest rate of a pivot.
    pub rate_rad_s: f64,
    /// Share of the servo's gains where rings are held each on its own.
    pub stiffness: f64,
}

/// Which of the board's connectors is which pivot's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wiring {
    /// Numbers of the encoder ports of pivot 1, 2 and 3, as the digits of one: 123 is straight. See [`ConnectorOrder`].
    pub encoder_order: u16,
    /// The same of the bridges.
    pub bridge_order: u16,
    /// Whether a positive voltage turns the ring to smaller angles.
    pub motors_reversed: [bool; 3],
}

/// Records of the data recorder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecorderParameters {
    /// Rows of a record.
    pub points: u32,
    /// How many of them are from before the trigger.
    pub before: u32,
}

impl Guides {
    /// Whether there is anything of them to be made up for.
    #[must_use]
    pub fn are_told(&self) -> bool {
        self.coulomb_n != 0.0 || self.viscous_n_s_m != 0.0 || self.stiffness_n_um != 0.0
    }
}

impl FeedbackFilters {
    /// No filter.
    pub const NONE: Self = Self {
        notches: [Notch {
            frequency_hz: 0.0,
            width_hz: 200.0,
            gain: 0.1,
        }; 2],
        lead: Lead {
            from_hz: 0.0,
            to_hz: 3_000.0,
        },
    };
}

impl Ripple {
    /// No ripple.
    pub const NONE: Self = Self {
        harmonics: [Harmonic {
            periods: 0.0,
            amplitude_n_m: 0.0,
            phase_deg: 0.0,
        }; HARMONICS],
    };
}

impl Subdivision {
    /// Nothing is corrected.
    pub const NONE: Self = Self {
        periods: 0,
        harmonics: [SubdivisionHarmonic {
            amplitude_nrad: 0,
            phase_tenths_deg: 0,
        }; SUBDIVISION_HARMONICS],
    };
}

impl Parameters {
    /// The reference stage, commissioned.
    pub const REFERENCE: Self = Self {
        geometry: Geometry::REFERENCE,
        limits: Limits::REFERENCE,
        platform: Platform {
            mass_kg: 3.0,
            inertia_kg_m2: 0.02,
            payload_kg: 0.0,
            payload_inertia_kg_m2: 0.0,
            payload_centre_mm: [0.0, 0.0],
        },
        guides: Guides {
            coulomb_n: 0.0,
            viscous_n_s_m: 0.0,
            presliding_um: 20.0,
            stiffness_n_um: 0.0,
        },
        power: PowerStage {
            pwm_hz: 40e3,
            pwm_counts: PWM_COUNTS,
            supply_v: 48.0,
            voltage_limit_v: 60.0,
            // 8.6 N m at rest, a third of what the reference motion asks for; 5 mm/s and friction need half a volt.
            recovery_voltage_v: 6.0,
            // Ordinary motion of the bare platform asks for 2.5 A; 5.5 A come of all pivots at their largest acceleration.
            current_limit_a: 6.0,
        },
        drives: [Drive {
            torque_constant_n_m_a: 0.06,
            gear_ratio: 50.0,
            resistance_ohm: 2.1,
            inductance_h: 0.7e-3,
            // What makers of such bridges state.
            dead_time_s: 200e-9,
            // A tenth of the largest current ripple, 48 V / (4 L 40 kHz): near rest the pulses are short.
            dead_time_knee_a: 0.043,
            inertia_kg_m2: 0.02,
            motor_inertia_kg_m2: 0.012,
            viscous_n_m_s: 0.05,
            coulomb_n_m: 0.1,
            presliding_rad: 100e-6,
        }; 3],
        servo: Servo {
            gains: [Gains {
                position_1_s: 400.0,
                velocity_v_s_rad: 40.0,
                integral_v_rad: 14_000.0,
            }; 3],
            filters: [FeedbackFilters::NONE; 3],
            ripple: [Ripple::NONE; 3],
            gear_errors: [GearError {
                amplitude_urad: 0.0,
                phase_deg: 0.0,
            }; 3],
            scheduled_inertia_kg_m2: 0.0,
            learning: 1.0,
            friction_learning: 0.2,
            keeps_learnt: false,
            latency_s: 72e-6,
            rest: RestMode {
                stiffness: 0.1,
                delay_s: 0.05,
                wake_counts: 6.0,
            },
        },
        learnt: [Learnt {
            rate_v_s_rad: 0.0,
            torque_v_n_m: 0.0,
            friction_v: 0.0,
            motor_constant_v_s_rad: 0.0,
        }; 3],
        encoders: [
            EncoderMounting {
                zero_counts: 12_345_678,
                reversed: false,
            },
            EncoderMounting {
                zero_counts: 50_331_649,
                reversed: true,
            },
            EncoderMounting {
                zero_counts: 67_000_000,
                reversed: false,
            },
        ],
        subdivision: [Subdivision::NONE; 3],
        window: SettlingWindow {
            counts: 2.0,
            dwell_s: 2e-3,
            mean_s: 1e-3,
        },
        supervision: Supervision {
            // A push of 40 N m on a ring, nearly all that a motor can hold, leaves half of it.
            following_error_rad: 2e-3,
            following_error_s: 1e-4,
            bridged_frames: 4,
            plausible_acceleration_rad_s2: 50_000.0,
            supply_min_v: 36.0,
            overspeed_factor: 1.25,
            // 2,000 counts, over and over the same one.
            frozen_rad: 2e-4,
            // Half a volt is 0.7 N m, seven times the friction.
            frozen_v: 0.5,
            // An unstable loop swings by more than half of the supply; a stable one that rings on a machine it was not told of by a third
            // at most.
            oscillation_v: 20.0,
            unexplained_current_a: 1.0,
            debugger_allowed: false,
            stop_test_needed: false,
            max_saturation_s: 0.1,
            motor_current_a: 4.0,
            motor_heating_s: 20.0,
            late_ticks: 10,
            disk_margin_mm: 0.5,
            guide_margin: 0.005,
            separation_margin_rad: 0.5 * core::f64::consts::PI / 180.0,
            stop_s: 0.06,
            host_silence_ms: 0.0,
        },
        excitation: ExcitationLimits {
            // Holds a ring to 0.67 rad/s, by its back-EMF: 7 mJ of platform.
            voltage_v: 2.0,
            // What braking adds at that rate leaves it under 20 mrad.
            way_rad: 12e-3,
            rate_rad_s: 0.7,
            stiffness: 0.1,
        },
        wiring: Wiring {
            encoder_order: 123,
            bridge_order: 123,
            motors_reversed: [false; 3],
        },
        recorder: RecorderParameters {
            points: MAX_RECORD_ROWS as u32,
            before: 0,
        },
        targets: Targets {
            turn_direction: TurnDirection::AsGiven,
            streamed: false,
        },
        commissioned: true,
    };

    /// What a controller has by itself, with nothing stored: nobody has said yet how this machine's encoders are mounted.
    #[must_use]
    pub const fn uncommissioned(self) -> Self {
        Self {
            encoders: [EncoderMounting {
                zero_counts: 0,
                reversed: false,
            }; 3],
            commissioned: false,
            ..self
        }
    }
}

impl Default for Parameters {
    fn default() -> Self {
        Self::REFERENCE
    }
}
