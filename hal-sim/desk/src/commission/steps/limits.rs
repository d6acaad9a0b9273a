//! Limits of motion that the motors bear with what they move: those of a controller that knows nothing, or less where that is too much. So a
//! lighter load gets back what a heavier one had taken.

use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::id;
use crate::commission::known::Known;
use firmware::control::servo::pivot_limits;
use firmware::parameters::Parameters;

/// What a stage that is of any use has at least, rad/s and rad/s^2.
const LEAST: [f64; 2] = [1.0, 20.0];
const WEAK: &str = "the motors are too weak for the load: less load, a larger current limit (0x5450080F) or supply, another gear";

pub(super) fn run(
    bench: &mut Bench<'_>,
    _: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    let parameters = bench.parameters()?;
    let borne = pivot_limits(&parameters);
    let limits = &Parameters::REFERENCE.limits;
    let most = [limits.pivot_rate_rad_s, limits.pivot_acceleration_rad_s2];
    let names = ["rate (rad/s)", "acceleration (rad/s^2)"];
    for (i, name) in names.into_iter().enumerate() {
        found.push(Finding::new(
            format!("largest {name} of a pivot that motors and supply bear with this load"),
            format!("{:.1}; in force: {:.1}", borne[i], most[i].min(borne[i])),
            format!("over {}", LEAST[i]),
            borne[i] > LEAST[i],
            WEAK,
        ));
    }
    bench.set(&[
        (id::PIVOT_RATE, most[0].min(borne[0])),
        (id::PIVOT_ACCELERATION, most[1].min(borne[1])),
    ])?;
    found.number("rate of a pivot", borne[0], "rad/s");
    found.number("acceleration of a pivot", borne[1], "rad/s^2");
    Ok(())
}
