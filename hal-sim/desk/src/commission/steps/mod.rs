//! The steps, in the order in which they are run: first what puts no power on a motor.

mod friction;
mod gains;
mod hand;
mod identification;
mod keep;
mod limits;
mod nudges;
mod reference;
mod response;
mod ring_servo;
mod tuning;
mod verification;
mod windings;
mod wiring;
mod zeros;

use super::Step;

/// See the module.
pub static STEPS: &[Step] = &[
    Step {
        name: "wiring",
        about: "the machine at rest with the motors off: encoders, supply, current sensors",
        run: wiring::run,
    },
    Step {
        name: "hand",
        about: "the platform is turned by hand: which way each encoder counts, and in which order the pivots follow each other",
        run: hand::run,
    },
    Step {
        name: "nudges",
        about: "a rising voltage on one motor after the other: which pivot it moves, which way, and what it takes",
        run: nudges::run,
    },
    Step {
        name: "windings",
        about: "short pulses: resistance and inductance of each winding",
        run: windings::run,
    },
    Step {
        name: "ring servo",
        about: "each ring under a soft servo of its own, moved by a milliradian",
        run: ring_servo::run,
    },
    Step {
        name: "zeros",
        about: "the platform in its jig: what each encoder reads at pivot angle 0",
        run: zeros::run,
    },
    Step {
        name: "reference",
        about: "the first closed loop: a slow turn and a slow square",
        run: reference::run,
    },
    Step {
        name: "gains",
        about: "the gains are raised until a kick rings on, in the middle and far out; half of that is used",
        run: gains::run,
    },
    Step {
        name: "friction",
        about: "turning at steady rates both ways: motor constants and friction",
        run: friction::run,
    },
    Step {
        name: "identification",
        about: "sines on one motor after the other while the platform turns in the middle: windings, inertias, mass, resonances",
        run: identification::run,
    },
    Step {
        name: "response",
        about: "the loop with these gains, in the middle and far out: sensitivity and margins of all three pivots together",
        run: response::run,
    },
    Step {
        name: "tuning",
        about: "gains and notches for the least sensitivity at 30 Hz with Ms of 2 at most, measured again and kept if they are better",
        run: tuning::run,
    },
    Step {
        name: "limits",
        about: "limits of motion are lowered to what motors and supply bear with this load",
        run: limits::run,
    },
    Step {
        name: "verification",
        about: "moves at full speed: following error and settling",
        run: verification::run,
    },
    Step {
        name: "keep",
        about: "what was found is kept, and read back",
        run: keep::run,
    },
];

/// Numbers of parameters that the steps set.
pub(super) mod id {
    pub const ENCODER_ZERO: u32 = 0x5450_0600;
    pub const ENCODER_REVERSED: u32 = 0x5450_0610;
    pub const ENCODER_ORDER: u32 = 0x5450_0620;
    pub const BRIDGE_ORDER: u32 = 0x5450_0630;
    pub const MOTOR_REVERSED: u32 = 0x5450_0640;
    pub const POSITION_GAIN: u32 = 0x5450_0300;
    pub const VELOCITY_GAIN: u32 = 0x5450_0301;
    pub const INTEGRAL_GAIN: u32 = 0x5450_0302;
    pub const REST_STIFFNESS: u32 = 0x5450_0308;
    pub const SETTLING_COUNTS: u32 = 0x5450_0400;
    pub const EXCITATION_V: u32 = 0x5450_0D00;
    pub const PIVOT_RATE: u32 = 0x5450_0106;
    pub const PIVOT_ACCELERATION: u32 = 0x5450_0107;
    pub const TORQUE_CONSTANT: u32 = 0x5450_0810;
    pub const GEAR_RATIO: u32 = 0x5450_0811;
    pub const RESISTANCE: u32 = 0x5450_0812;
    pub const INDUCTANCE: u32 = 0x5450_0813;
    pub const DEAD_TIME: u32 = 0x5450_0814;
    pub const DEAD_TIME_KNEE: u32 = 0x5450_0815;
    pub const VISCOUS: u32 = 0x5450_0818;
    pub const COULOMB: u32 = 0x5450_0819;
    pub const TRACK_RADIUS: u32 = 0x5450_0200;
    pub const PLATFORM_MASS: u32 = 0x5450_0700;
    pub const PLATFORM_INERTIA: u32 = 0x5450_0701;
    pub const PAYLOAD_MASS: u32 = 0x5450_0702;
    pub const PAYLOAD_INERTIA: u32 = 0x5450_0703;
    pub const PAYLOAD_X: u32 = 0x5450_0704;
    pub const PAYLOAD_Y: u32 = 0x5450_0705;
    /// Of all pivots.
    pub const RING_INERTIA: u32 = 0x5450_0807;
    pub const NOMINAL_SUPPLY: u32 = 0x5450_0806;
    pub const PWM_HZ: u32 = 0x5450_080B;

    /// Of a pivot that has one of its own, counted from 0; `first` is pivot 1's.
    pub const fn of(first: u32, pivot: usize) -> u32 {
        first + 0x10 * pivot as u32
    }
}
