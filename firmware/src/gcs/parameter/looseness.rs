//! Supervision that is looser than the reference: allowed at command level 1, inside ranges that no level crosses, and told
//! wherever somebody asks how the stage is.

use super::descriptor::Parameter;
use super::table::PARAMETERS;
use crate::parameters::Parameters;

/// The thresholds of supervision, and whether a debugger may be attached.
const THRESHOLDS: core::ops::RangeInclusive<u32> = 0x5450_0500..=0x5450_0513;
/// Between them, what is no threshold: the longest silence, which 0 switches off and a client asks for.
const SILENCE: u32 = 0x5450_0510;
/// Of them, the one that a lower value makes looser: the lowest supply.
const LOWEST_SUPPLY: u32 = 0x5450_0501;

/// The thresholds that let pass what those of the reference do not.
pub(in crate::gcs) fn loosened(
    parameters: &Parameters,
) -> impl Iterator<Item = &'static Parameter> {
    let is_looser = |parameter: &&Parameter| {
        let (now, reference) = (
            parameter.number(parameters),
            parameter.number(&Parameters::REFERENCE),
        );
        match parameter.id {
            LOWEST_SUPPLY => now < reference,
            SILENCE => false,
            id => THRESHOLDS.contains(&id) && now > reference,
        }
    };
    PARAMETERS.iter().filter(is_looser)
}
