//! The steps, in the order in which they are run: first what puts no power on a motor.

mod carried;
mod ends;
mod forces;
mod friction;
mod gains;
mod gears;
mod guides;
mod hand;
mod hunting;
mod identification;
mod keep;
mod limits;
mod nudges;
mod reference;
mod response;
mod ring_servo;
mod sde;
mod step_response;
mod tuning;
mod verification;
mod windings;
mod wiring;
mod wiring_picture;
mod zeros;

use super::Step;
pub(super) use gains::{rest_for, settle_widely};

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
        name: "ends",
        about: "in place of the jig: each ring moved until a guide is at its end, both ways, twice; the encoders' zeros from where that was",
        run: ends::run,
    },
    Step {
        name: "reference",
        about: "the first closed loop: a slow turn and a slow square",
        run: reference::run,
    },
    Step {
        name: "sde",
        about: "a slow turn: the error of each encoder within a period of its scale is taken from its readings, where the scale is known",
        run: sde::run,
    },
    Step {
        name: "gains",
        about: "the gains are raised until a kick rings on, in the middle and far out; three tenths of that are used",
        run: gains::run,
    },
    Step {
        name: "friction",
        about: "turning at steady rates both ways: motor constants and friction",
        run: friction::run,
    },
    Step {
        name: "identification",
        about: "sines on one motor after the other while the platform turns in the middle, and far out: windings, inertias, mass, resonances",
        run: identification::run,
    },
    Step {
        name: "response",
        about: "the loop with these gains, in the middle and far out: sensitivity and margins of all three pivots together; a small step",
        run: response::run,
    },
    Step {
        name: "tuning",
        about: "gains and notches for the least sensitivity at 30 Hz with Ms of 2 at most, measured again and kept if they are better",
        run: tuning::run,
    },
    Step {
        name: "limits",
        about: "limits of motion: those of a controller that knows nothing, or what motors and supply bear with this load where that is less",
        run: limits::run,
    },
    Step {
        name: "gears",
        about: "turning once more, and faster: how unevenly each gear turns; made up for from here on",
        run: gears::run,
    },
    Step {
        name: "verification",
        about: "moves at full speed: following error and settling; a small step",
        run: verification::run,
    },
    Step {
        name: "forces",
        about: "moves around the middle: whether what the motors have to do for them fits the zeros of the encoders; what rings and platform weigh",
        run: forces::run,
    },
    Step {
        name: "guides",
        about: "what those moves and the resonances tell of the guides: friction of the carriages, how guides give way; made up for from here on",
        run: guides::run,
    },
    Step {
        name: "keep",
        about: "what was found is kept, and read back",
        run: keep::run,
    },
];
