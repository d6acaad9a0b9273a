//! Limits of motion that the drives do not bear are refused, with those that they do; a machine that has them is put right line by line.

mod gcs_bench;

use firmware::gcs::{Identity, Interpreter};
use firmware::parameters::Parameters;
use gcs_bench::Bench;

const RATE: &str = "0x54500106";
const ACCELERATION: &str = "0x54500107";
const STOP: &str = "0x5450050F";
const PAYLOAD: &str = "0x54500702";
const MASS: &str = "0x54500700";
const CURRENT: &str = "0x5450080F";
const TOLD: &str = "limits over what motors and supply bear with this load; they bear ";

fn advanced(bench: &mut Bench) {
    assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
}

/// What `SPA` takes, from the last event: three parameters with their values.
fn proposed(bench: &mut Bench) -> String {
    let events = bench.say("EVT?\n");
    let last = events.lines().last().unwrap_or_default();
    let (_, limits) = last.split_once(TOLD).unwrap_or_else(|| panic!("{last}"));
    let limits: Vec<_> = limits
        .trim()
        .split(", ")
        .map(|one| format!("1 {one}"))
        .collect();
    limits.join(" ")
}

#[test]
fn a_payload_that_the_limits_are_too_much_for_is_refused_with_those_that_fit() {
    let mut bench = Bench::ready();
    advanced(&mut bench);
    let before = bench.say("SPA?\n");
    for line in [
        format!("1 {PAYLOAD} 5"),
        format!("1 {ACCELERATION} 400"),
        format!("1 {RATE} 15"),
        format!("1 {CURRENT} 4"),
        format!("1 {STOP} 0.01"),
        format!("1 {PAYLOAD} 5 1 0x54500704 40 1 0x54500705 -20"),
    ] {
        assert_eq!(bench.error_after(&format!("SPA {line}")), "4011", "{line}");
        assert_eq!(bench.say("SPA?\n"), before, "{line}");
        // With what is proposed besides it is taken; and back again.
        let with = format!("SPA {line} {}", proposed(&mut bench));
        assert_eq!(bench.error_after(&with), "0", "{with}");
        assert_ne!(bench.say("SPA?\n"), before);
        let back = format!(
            "SPA 1 {PAYLOAD} 0 1 {CURRENT} 6 1 {STOP} 0.06 1 {RATE} 10 1 {ACCELERATION} 300 1 0x54500704 0 1 0x54500705 0"
        );
        assert_eq!(bench.error_after(&back), "0");
        assert_eq!(bench.say("SPA?\n"), before);
    }
}

#[test]
fn what_no_limits_are_borne_with_is_told_so() {
    let mut bench = Bench::ready();
    advanced(&mut bench);
    let line = format!("SPA 1 {CURRENT} 0.5 1 0x54500509 0.1 1 0x54500801 1");
    assert_eq!(bench.error_after(&line), "4011");
    let events = bench.say("EVT?\n");
    assert!(
        events.contains("motors and supply do not move this load"),
        "{events}"
    );
}

/// A controller that starts with a payload that its limits are too much for, as a firmware that did not look had kept it.
fn overloaded() -> Bench {
    let identity = Identity {
        serial: "4711",
        version: "0.1.0",
    };
    let mut panel = Interpreter::new(&Parameters::REFERENCE, identity);
    let mut parameters = Parameters::REFERENCE;
    parameters.platform.payload_kg = 5.0;
    panel.start_with(parameters, None);
    let mut bench = Bench::with(panel);
    bench.run(2);
    advanced(&mut bench);
    bench
}

#[test]
fn what_was_kept_before_is_in_force_and_told_and_is_put_right_line_by_line() {
    let mut bench = overloaded();
    let limits = proposed(&mut bench);
    assert_eq!(bench.value(&format!("SPA? 1 {PAYLOAD}")), 5.0);
    assert_eq!(bench.value(&format!("SPA? 1 {ACCELERATION}")), 300.0);
    // What has to do with it and makes it worse is not taken; what makes it no worse is, and all else.
    for (line, error) in [
        (format!("SPA 1 {MASS} 3.1"), "4011"),
        (format!("SPA 1 {PAYLOAD} 5.1"), "4011"),
        (format!("SPA 1 {PAYLOAD} 4.9"), "0"),
        (format!("SPA 1 {ACCELERATION} 250"), "0"),
        (format!("SPA 1 {ACCELERATION} 260"), "4011"),
        ("SPA 1 0x54500300 250".to_owned(), "0"),
        ("SPA 1 0x54500108 1.5".to_owned(), "0"),
        (format!("SPA {limits}"), "0"),
        (format!("SPA 1 {ACCELERATION} 160"), "4011"),
    ] {
        assert_eq!(bench.error_after(&line), error, "{line}");
    }
}

#[test]
fn a_machine_is_commissioned_with_limits_that_it_bears() {
    let mut bench = Bench::new();
    advanced(&mut bench);
    // Nothing drives, and nothing is known yet.
    let lines = format!("CMS 0\nSPA 1 {PAYLOAD} 5\nSPA 1 {ACCELERATION} 500");
    assert_eq!(bench.error_after(&lines), "0");
    assert_eq!(bench.error_after("CMS 1"), "4011");
    assert!(bench.say("CMS?\n").starts_with('0'));
    let limits = proposed(&mut bench);
    assert_eq!(bench.error_after(&format!("SPA {limits}\nCMS 1")), "0");
    assert!(bench.say("CMS?\n").starts_with('1'));
}
