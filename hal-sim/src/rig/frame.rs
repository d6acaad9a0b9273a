//! Where the angles of pivots are counted from: found zeros beside true ones.

use crate::machine::devices::{COUNTS_PER_TURN, StageParameters};
use firmware::parameters::Parameters;

/// How far left of where they are a controller takes the pivots for, turns.
pub(crate) fn leads_turns(parameters: &Parameters, stage: &StageParameters) -> [f64; 3] {
    let leads = [0, 1, 2].map(|i| {
        let (told, truth) = (&parameters.encoders[i], &stage.encoders[i]);
        let behind = truth.zero_counts.wrapping_sub(told.zero_counts) % COUNTS_PER_TURN;
        let turns = f64::from(behind) / f64::from(COUNTS_PER_TURN);
        if told.reversed { -turns } else { turns }
    });
    // They differ by little; none is taken half a turn off.
    let [first, ..] = leads;
    leads.map(|lead| lead - (lead - first).round())
}

/// Turns each pivot's zero to the left: it is told so many turns less. What goes with its angle goes on with the same places.
pub(crate) fn turn_zeros(parameters: &mut Parameters, turns: [f64; 3]) {
    for (encoder, turns) in parameters.encoders.iter_mut().zip(turns) {
        let turns = if encoder.reversed { -turns } else { turns };
        let counts = (turns.rem_euclid(1.0) * f64::from(COUNTS_PER_TURN)).round() as u32;
        encoder.zero_counts = encoder.zero_counts.wrapping_add(counts) % COUNTS_PER_TURN;
    }
    let gears = parameters.servo.gear_errors.iter_mut();
    for ((gear, drive), turns) in gears.zip(&parameters.drives).zip(turns) {
        gear.phase_deg = (gear.phase_deg + 360.0 * turns * drive.gear_ratio).rem_euclid(360.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::unknown;
    use crate::rig::with_wiring_told;

    #[test]
    fn zeros_of_any_jig_are_turned_to_the_true_ones() {
        for (machine, off) in [
            (7, [0.083; 3]),
            (8, [-0.41, -0.409, -0.412]),
            (9, [0.499, 0.501, 0.5]),
            (10, [0.0; 3]),
        ] {
            let stage = unknown(machine);
            let told = with_wiring_told(&Parameters::REFERENCE, &stage);
            let mut jig = told.clone();
            turn_zeros(&mut jig, off.map(|turns| -turns));
            let leads = leads_turns(&jig, &stage);
            for (lead, off) in leads.iter().zip(off) {
                let left = lead - off;
                assert!((left - left.round()).abs() < 1e-7, "{leads:?}");
                assert!((lead - leads[0]).abs() < 0.01, "{leads:?}");
            }
            turn_zeros(&mut jig, leads);
            for (found, truth) in jig.encoders.iter().zip(&told.encoders) {
                assert_eq!(found.zero_counts, truth.zero_counts);
            }
            for (found, truth) in jig.servo.gear_errors.iter().zip(&told.servo.gear_errors) {
                let off_deg = (found.phase_deg - truth.phase_deg).rem_euclid(360.0);
                assert!(off_deg.min(360.0 - off_deg) < 1e-3, "{off_deg} deg");
            }
        }
    }
}
