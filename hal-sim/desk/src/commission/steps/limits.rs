//! Limits of motion that the motors bear with what they move: those of a controller that knows nothing, or less where that is too much. So a
//! lighter load gets back what a heavier one had taken.

use crate::commission::bench::{self, Bench};
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::known::Known;
use commissioning::chain::cylinder_kg_m2;
use firmware::control::servo::{BorneLimits, largest_limits};
use firmware::parameters::Parameters;

/// What a stage that is of any use has at least, rad/s and rad/s^2.
const LEAST: [f64; 2] = [1.0, 20.0];
const WEAK: &str = "the motors are too weak for the load: less load, a larger current limit (0x5450080F) or supply, another gear";

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    let mut parameters = bench.parameters()?;
    parameters.platform.mass_kg += known.also_carries_kg;
    parameters.platform.inertia_kg_m2 += cylinder_kg_m2(known.also_carries_kg);
    let (limits, most) = (&mut parameters.limits, &Parameters::REFERENCE.limits);
    limits.pivot_rate_rad_s = most.pivot_rate_rad_s;
    limits.pivot_acceleration_rad_s2 = most.pivot_acceleration_rad_s2;
    let borne = BorneLimits::new(&parameters);
    let in_force = [borne.rate_rad_s, borne.acceleration_rad_s2];
    let largest = largest_limits(&parameters);
    let load = match known.also_carries_kg {
        0.0 => "this load".to_owned(),
        more_kg => format!("this load and {more_kg} kg more"),
    };
    let names = ["rate (rad/s)", "acceleration (rad/s^2)"];
    for (i, name) in names.into_iter().enumerate() {
        found.push(Finding::new(
            format!("largest {name} of a pivot that motors and supply bear with {load}"),
            format!("{:.1}; in force: {:.1}", largest[i], in_force[i]),
            format!("over {}", LEAST[i]),
            largest[i] > LEAST[i],
            WEAK,
        ));
    }
    // With less nothing is to be verified.
    if largest[0] > LEAST[0] && largest[1] > LEAST[1] {
        bench.set(&bench::limits(&borne))?;
    }
    found.number("rate of a pivot", largest[0], "rad/s");
    found.number("acceleration of a pivot", largest[1], "rad/s^2");
    Ok(())
}
