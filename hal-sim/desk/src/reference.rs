//! What the parameters of the reference stage are, for the page to tell what differs.

use firmware::gcs::PARAMETERS;
use firmware::parameters::Parameters;

/// Values by number as a script of the page, made from the controller's table.
pub(crate) fn script() -> String {
    let rows = PARAMETERS.iter().filter_map(|parameter| {
        let value = parameter.number(&Parameters::REFERENCE)?;
        Some(format!("  {}: {value},\n", parameter.id))
    });
    let rows: String = rows.collect();
    format!(
        "// Parameters of the reference stage by number, made from the program's table.\n\nexport const REFERENCE = {{\n{rows}}};\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_that_has_a_number_is_there() {
        let script = script();
        let numbers = (PARAMETERS.iter()).filter(|p| p.number(&Parameters::REFERENCE).is_some());
        assert_eq!(script.matches(": ").count(), numbers.count());
        // The speed of the platform's centre, mm/s.
        let speed = Parameters::REFERENCE.limits.speed_mm_s;
        assert!(
            script.contains(&format!("\n  {}: {speed},\n", 0x5450_0100)),
            "{script}"
        );
    }
}
