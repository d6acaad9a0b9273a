//! Numbers of the parameters that commissioning reads and sets.

/// Pivots, encoder ports, bridges.
pub const AXES: usize = 3;

pub const ENCODER_ZERO: u32 = 0x5450_0600;
pub const ENCODER_REVERSED: u32 = 0x5450_0610;
pub const ENCODER_ORDER: u32 = 0x5450_0620;
pub const BRIDGE_ORDER: u32 = 0x5450_0630;
pub const MOTOR_REVERSED: u32 = 0x5450_0640;
/// Of the scale of pivot 1's encoder; behind it amplitude and phase of each harmonic.
pub const SCALE_PERIODS: u32 = 0x5450_0E10;
pub const POSITION_GAIN: u32 = 0x5450_0300;
pub const VELOCITY_GAIN: u32 = 0x5450_0301;
pub const INTEGRAL_GAIN: u32 = 0x5450_0302;
/// How fast feedforward learns, as a share of the integral gain.
pub const LEARNING: u32 = 0x5450_0303;
/// Inertia that gains are scheduled by; 0: they are not.
pub const SCHEDULED_INERTIA: u32 = 0x5450_0306;
pub const REST_STIFFNESS: u32 = 0x5450_0308;
pub const SETTLING_COUNTS: u32 = 0x5450_0400;
pub const EXCITATION_V: u32 = 0x5450_0D00;
pub const EXCITATION_WAY: u32 = 0x5450_0D01;
pub const EXCITATION_RATE: u32 = 0x5450_0D02;
/// Of the platform, deg/s.
pub const ROTATION_SPEED: u32 = 0x5450_0103;
pub const PIVOT_RATE: u32 = 0x5450_0106;
pub const PIVOT_ACCELERATION: u32 = 0x5450_0107;
pub const FAULT_STOP: u32 = 0x5450_050F;
pub const TORQUE_CONSTANT: u32 = 0x5450_0810;
pub const GEAR_RATIO: u32 = 0x5450_0811;
pub const RESISTANCE: u32 = 0x5450_0812;
pub const INDUCTANCE: u32 = 0x5450_0813;
pub const DEAD_TIME: u32 = 0x5450_0814;
pub const DEAD_TIME_KNEE: u32 = 0x5450_0815;
pub const VISCOUS: u32 = 0x5450_0818;
pub const COULOMB: u32 = 0x5450_0819;
/// A ring with its drive; and what of that is the motor's with its side of the gear, of all and of each.
pub const INERTIA: u32 = 0x5450_0817;
pub const MOTORS_INERTIA: u32 = 0x5450_0840;
pub const MOTOR_INERTIA: u32 = 0x5450_0850;
/// Cyclic error of the gear, urad, and its phase, deg.
pub const GEAR_ERROR: u32 = 0x5450_0A1C;
pub const GEAR_PHASE: u32 = 0x5450_0A1D;
pub const TRACK_RADIUS: u32 = 0x5450_0200;
pub const PLATFORM_MASS: u32 = 0x5450_0700;
pub const PLATFORM_INERTIA: u32 = 0x5450_0701;
pub const PAYLOAD_MASS: u32 = 0x5450_0702;
pub const PAYLOAD_INERTIA: u32 = 0x5450_0703;
pub const PAYLOAD_X: u32 = 0x5450_0704;
pub const PAYLOAD_Y: u32 = 0x5450_0705;
/// Of the carriages on their guides.
pub const GUIDE_COULOMB: u32 = 0x5450_0706;
pub const GUIDE_VISCOUS: u32 = 0x5450_0707;
pub const GUIDE_PRESLIDING: u32 = 0x5450_0708;
pub const GUIDE_STIFFNESS: u32 = 0x5450_0709;
/// Of all pivots.
pub const RING_INERTIA: u32 = 0x5450_0807;
pub const NOMINAL_SUPPLY: u32 = 0x5450_0806;
pub const PWM_HZ: u32 = 0x5450_080B;

/// Of a pivot that has one of its own, counted from 0; `first` is pivot 1's.
pub const fn of(first: u32, pivot: usize) -> u32 {
    first + 0x10 * pivot as u32
}
