//! What rings and platform weigh, as the controller is told it. Sines tell best what a pivot moves in all, in the middle. On most machines resonances tell the
//! parts apart as well, on some they do not; moves around the middle do on all, but not better than friction and gears let them.

use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::id;
use commissioning::chain::{Chain, Load, Place};
use commissioning::drive_model::{LOAD_INERTIA, MASS, Mechanical};
use commissioning::platform::Platform;

/// Share of the load that is told as payload: it is all of one piece to the motors, and only a payload may have its centre elsewhere.
const PAYLOAD: f64 = 0.5;
/// Most that moves may tell what a pivot moves in the middle off what sines tell, over itself, for their parts to be used.
const MOST_APART: f64 = 0.1;
/// Standard deviations of what moves tell, over itself: of the mass over the inertia of a drive, and of the inertia of the load. Friction and gears make them,
/// not noise, so that nothing in the records tells them: they are those of 14 unknown machines.
const RATIO_BY_MOVES: f64 = 0.007;
const INERTIA_BY_MOVES: f64 = 0.01;
/// The same of what sines tell, besides what they tell of that: a model of springs is not all that a machine is. Of 117 unknown machines.
const RATIO_BY_SINES: f64 = 0.01;
const INERTIA_BY_SINES: f64 = 0.015;

/// Tells the controller, which takes it at rest and between motions.
pub(super) fn set(
    bench: &mut Bench<'_>,
    chain: &Chain,
    radius_m: f64,
) -> Result<(), CommissionError> {
    let mass_kg = chain.load.mass / (radius_m * radius_m);
    let payload_kg = PAYLOAD * mass_kg;
    let [x_m, y_m] = chain
        .load
        .moment
        .map(|moment| moment / radius_m / payload_kg);
    let beside = payload_kg * (x_m * x_m + y_m * y_m);
    bench.set(&[
        (id::RING_INERTIA, chain.motor_inertia + chain.ring_inertia),
        (id::MOTORS_INERTIA, chain.motor_inertia),
        (id::PLATFORM_MASS, mass_kg - payload_kg),
        (id::PLATFORM_INERTIA, chain.load.inertia - beside),
        (id::PAYLOAD_MASS, payload_kg),
        (id::PAYLOAD_INERTIA, 0.0),
        (id::PAYLOAD_X, x_m * 1e3),
        (id::PAYLOAD_Y, y_m * 1e3),
    ])?;
    Ok(())
}

/// Tells the controller the parts as sines and moves tell them together; what is found.
pub(super) fn set_parts(
    bench: &mut Bench<'_>,
    found: &mut Found,
    sines: &Mechanical,
    moves: &Platform,
) -> Result<(), CommissionError> {
    let radius_m = 1e-3 * bench.parameter(id::TRACK_RADIUS)?;
    let moved = with(
        &sines.chain,
        moves.drive_inertia,
        moves.mass_kg * radius_m * radius_m,
        moves.inertia_kg_m2,
    );
    let apart = in_the_middle(&moved) / in_the_middle(&sines.chain) - 1.0;
    let is_used = apart.abs() < MOST_APART;
    let besides = if is_used {
        ""
    } else {
        ": its parts are not used"
    };
    found.push(Finding::told(
        "what a pivot moves in the middle, by these moves beside the sines",
        format!("{:+.1} %{besides}", 100.0 * apart),
    ));
    if !is_used {
        return Ok(());
    }
    let together = together(sines, &moved);
    let drive = together.motor_inertia + together.ring_inertia;
    let mass_kg = together.load.mass / (radius_m * radius_m);
    let inertia = together.load.inertia;
    found.push(Finding::told(
        "its parts by both, used from here on",
        format!("motor and ring {drive:.5} kg m^2, platform and load {mass_kg:.2} kg and {inertia:.4} kg m^2"),
    ));
    found.number("inertia of a motor with its ring", drive, "kg m^2");
    found.number("mass of platform and load", mass_kg, "kg");
    found.number("inertia of platform and load", inertia, "kg m^2");
    set(bench, &together, radius_m)
}

/// What a pivot moves there, kg m^2.
fn in_the_middle(chain: &Chain) -> f64 {
    chain.inertia(&Place::centre())[(0, 0)]
}

/// A chain of other parts; the motor keeps what the resonances tell of it.
fn with(chain: &Chain, drive: f64, mass: f64, inertia: f64) -> Chain {
    Chain {
        ring_inertia: drive - chain.motor_inertia,
        load: Load {
            mass,
            inertia,
            ..chain.load
        },
        ..*chain
    }
}

/// The parts by both, each counting as it is sure, which move as much at a pivot in the middle as by the sines.
fn together(sines: &Mechanical, moved: &Chain) -> Chain {
    let chain = &sines.chain;
    let ratio = |chain: &Chain| chain.load.mass / (chain.motor_inertia + chain.ring_inertia);
    let ratio = mean(
        [ratio(chain), ratio(moved)],
        [
            // What one has more, the other has less.
            RATIO_BY_SINES.hypot(sines.drive_inertia_deviation + sines.deviations[MASS]),
            RATIO_BY_MOVES,
        ],
    );
    let inertia = mean(
        [chain.load.inertia, moved.load.inertia],
        [
            INERTIA_BY_SINES.hypot(sines.deviations[LOAD_INERTIA]),
            INERTIA_BY_MOVES,
        ],
    );
    // It is a line over the inertia of the drive.
    let moves = |drive: f64| in_the_middle(&with(chain, drive, ratio * drive, inertia));
    let drive = (in_the_middle(chain) - moves(0.0)) / (moves(1.0) - moves(0.0));
    with(chain, drive, ratio * drive, inertia)
}

/// Mean of two, with their standard deviations over themselves.
fn mean([one, other]: [f64; 2], [of_one, of_other]: [f64; 2]) -> f64 {
    let share = of_one.powi(2) / (of_one.powi(2) + of_other.powi(2));
    one * (other / one).powf(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHAIN: Chain = Chain {
        motor_inertia: 0.0154,
        ring_inertia: 0.0072,
        stiffness: 1.1e6,
        damping: 4.0,
        viscous: 0.05,
        guide_stiffness: 3.7e5,
        guide_damping: 1.8,
        along_stiffness: 0.0,
        along_damping: 0.0,
        load: Load {
            mass: 0.0331,
            inertia: 0.0249,
            moment: [0.0, 0.0],
        },
    };

    fn sines(of_parts: f64) -> Mechanical {
        let mut deviations = vec![of_parts / 2.0; 13];
        deviations[LOAD_INERTIA] = of_parts;
        Mechanical {
            chain: CHAIN,
            excited: CHAIN,
            deviations,
            residual: 0.1,
            drive_inertia_deviation: of_parts / 2.0,
        }
    }

    /// What torques are off stays out, and the motor keeps what the resonances tell of it.
    #[test]
    fn parts_are_by_both_or_by_moves_where_sines_do_not_know_and_their_sum_is_that_of_the_sines() {
        let ratio = |chain: &Chain| chain.load.mass / (chain.motor_inertia + chain.ring_inertia);
        for more in [0.98, 1.02] {
            let moved = with(&CHAIN, more * 0.0238, more * 0.032, more * 0.0237);
            for (of_parts, share) in [(0.0, 1.0 / 1.49), (1.0, 1.0)] {
                let found = together(&sines(of_parts), &moved);
                let sum = in_the_middle(&found) / in_the_middle(&CHAIN);
                assert!((sum - 1.0).abs() < 1e-9, "{found:?}");
                let by_moves =
                    (ratio(&found) / ratio(&CHAIN)).ln() / (ratio(&moved) / ratio(&CHAIN)).ln();
                assert!((by_moves - share).abs() < 1e-3, "{by_moves}");
                assert_eq!(found.motor_inertia, CHAIN.motor_inertia);
            }
        }
    }

    #[test]
    fn a_mean_of_two_that_are_as_sure_is_between_them() {
        assert!((mean([1.0, 4.0], [0.1, 0.1]) - 2.0).abs() < 1e-12);
        assert!((mean([1.0, 4.0], [0.1, 1e3]) - 1.0).abs() < 1e-6);
    }
}
