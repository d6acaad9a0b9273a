//! The tests, in the order in which they are run: first what needs nothing, then what moves the stage.

use super::controller::Controller;
use super::{Found, Test, Verdict};
use crate::record::RecordError;
use std::time::{Duration, Instant};

type Result<T> = std::result::Result<T, RecordError>;

/// Lines of the test of the line.
const QUESTIONS: u32 = 200;
/// How long the tick's rate is measured, and how far it may be off: this machine's clock and its delays, not the crystal's 30 ppm.
const RATE_OVER: Duration = Duration::from_secs(4);
const RATE_TOLERANCE: f64 = 0.005;
/// Looks at the encoders at rest, and how far their readings may lie apart: 19 counts of 26 bits.
const LOOKS: u32 = 50;
const SPREAD_DEG: f64 = 1e-4;
/// Largest following errors, rad: a tenth and a quarter of what is a fault at rest.
const HOLD_RAD: f64 = 2e-4;
const MOVE_RAD: f64 = 5e-4;
/// How near the measured pose has to be to the target at rest, mm and deg.
const REST_MM: f64 = 1e-3;
/// The readings of `TST?` that an emulated chip can not show: it has no option bytes, and its timers do not see the watchdog's
/// oscillator.
const NOT_EMULATED: [&str; 2] = ["BROWN_OUT_LEVEL=", "LSI="];

/// See the module.
pub static PLAN: &[Test] = &[
    test("line", "200 questions answered, none lost or refused", line),
    test(
        "identity",
        "a Tripivot controller; serial number and version are told",
        identity,
    ),
    test(
        "refusal",
        "a line that is no command: error 2, and the next line is understood",
        refusal,
    ),
    test(
        "self-test",
        "every reading of TST? is as it has to be (BROWN_OUT_LEVEL and LSI are not judged on an emulated chip, which has no option bytes and no way from the oscillator to a timer)",
        self_test,
    ),
    test(
        "rate",
        "20000 ticks a second of this machine's clock, within 0.5 % (not judged on an emulated chip)",
        rate,
    ),
    test(
        "start",
        "no fault, and no start that nobody asked for",
        start,
    ),
    test("encoders", "all three deliver good frames", encoders),
    test(
        "noise",
        "readings at rest within 1e-4 deg, servo off and nobody touching the stage",
        noise,
    ),
    test(
        "loop",
        "no late tick in a second; cycles are told",
        unhurried,
    ),
    test(
        "supervision",
        "no threshold looser than the reference",
        supervision,
    ),
    test("commissioned", "the machine is commissioned", commissioned),
    moving(
        "reference",
        "FRF is taken, and the stage settles",
        reference,
    ),
    moving(
        "hold",
        "following error under 0.2 mrad in a second of rest, no late tick",
        hold,
    ),
    moving(
        "move",
        "X 5 Y -5 W 10 and back: following error under 0.5 mrad, at the target within 1 um and 1 mdeg",
        travel,
    ),
    moving(
        "stop",
        "a STP in motion brings it to rest short of its target, settled",
        stop,
    ),
    moving("servo", "the servo goes off and the motors let go", servo),
];

const fn test(
    name: &'static str,
    expected: &'static str,
    run: fn(&mut Controller) -> Result<Found>,
) -> Test {
    Test {
        name,
        expected,
        moves: false,
        run,
    }
}

const fn moving(
    name: &'static str,
    expected: &'static str,
    run: fn(&mut Controller) -> Result<Found>,
) -> Test {
    Test {
        moves: true,
        ..test(name, expected, run)
    }
}

fn found(passed: bool, text: String) -> Result<Found> {
    let verdict = passed.into();
    Ok(Found { text, verdict })
}

/// What an emulated chip can not show is not judged there.
fn judged(passed: bool, can_be_shown: bool) -> Verdict {
    match (passed, can_be_shown) {
        (true, _) => Verdict::Passed,
        (false, true) => Verdict::Failed,
        (false, false) => Verdict::NotJudged,
    }
}

fn line(controller: &mut Controller) -> Result<Found> {
    let begin = Instant::now();
    let mut answered = 0;
    for _ in 0..QUESTIONS {
        answered += u32::from(controller.ask("CSV?")? == "2.0");
    }
    let each_ms = begin.elapsed().as_secs_f64() * 1e3 / f64::from(QUESTIONS);
    found(
        answered == QUESTIONS,
        format!("{answered} answered, {each_ms:.2} ms each"),
    )
}

fn identity(controller: &mut Controller) -> Result<Found> {
    let identity = controller.identity().to_owned();
    found(identity.contains("Tripivot"), identity)
}

fn refusal(controller: &mut Controller) -> Result<Found> {
    let error = controller.error_of("QQQ")?;
    let after = controller.error_of("CSV?")?;
    found(
        (error, after) == (2, 0),
        format!("error {error}, then {after}"),
    )
}

fn self_test(controller: &mut Controller) -> Result<Found> {
    let answer = controller.ask("TST?")?;
    Ok(self_test_found(&answer, controller.is_emulated))
}

fn self_test_found(answer: &str, is_emulated: bool) -> Found {
    let bad: Vec<&str> = (answer.lines())
        .filter(|line| line.ends_with("BAD"))
        .collect();
    let is_known = |line: &&str| NOT_EMULATED.iter().any(|name| line.starts_with(name));
    let can_be_shown = !is_emulated || !bad.iter().all(is_known);
    let text = if bad.is_empty() {
        format!("{} readings good", answer.lines().count().saturating_sub(2))
    } else {
        bad.join("; ")
    };
    Found {
        text,
        verdict: judged(bad.is_empty(), can_be_shown),
    }
}

fn rate(controller: &mut Controller) -> Result<Found> {
    let wanted = controller.rate_hz()?;
    let measured = controller.measured_rate_hz(RATE_OVER)?;
    let passed = (measured / wanted - 1.0).abs() <= RATE_TOLERANCE;
    Ok(Found {
        text: format!("{measured:.0} of {wanted:.0} ticks a second"),
        verdict: judged(passed, !controller.is_emulated),
    })
}

fn start(controller: &mut Controller) -> Result<Found> {
    let answer = controller.ask("FLT?")?;
    let first = answer.lines().next().unwrap_or_default().to_owned();
    let is_faultless = !answer.starts_with(|c: char| c != '0' && c.is_ascii_digit());
    let unasked = first.contains("started by");
    let latched = controller.ask("MON?")?.contains("MODE=fault");
    found(is_faultless && !unasked && !latched, first)
}

fn encoders(controller: &mut Controller) -> Result<Found> {
    let answer = controller.ask("FLT?")?;
    let bad: Vec<&str> = answer
        .lines()
        .filter(|line| line.contains(", pivot "))
        .collect();
    let text = if bad.is_empty() {
        "all answer".to_owned()
    } else {
        bad.join("; ")
    };
    found(bad.is_empty(), text)
}

fn noise(controller: &mut Controller) -> Result<Found> {
    let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for _ in 0..LOOKS {
        for (range, name) in ranges.iter_mut().zip(["PIVOT1", "PIVOT2", "PIVOT3"]) {
            let deg = controller.field("MON?", name)?;
            *range = [range[0].min(deg), range[1].max(deg)];
        }
    }
    let spread = ranges.map(|[low, high]| high - low);
    let worst = spread.into_iter().fold(0.0, f64::max);
    let [a, b, c] = spread;
    found(
        worst <= SPREAD_DEG,
        format!("{a:.6}, {b:.6}, {c:.6} deg apart"),
    )
}

/// Late ticks in a second, and the worst cost of one.
fn late(controller: &mut Controller) -> Result<(f64, f64)> {
    controller.carry_out("LST")?;
    controller.delay(1.0)?;
    let late = controller.field("LST?", "LATE")?;
    Ok((late, controller.field("LST?", "CYCLES_WORST")?))
}

fn unhurried(controller: &mut Controller) -> Result<Found> {
    let (late, worst) = late(controller)?;
    found(
        late == 0.0,
        format!("{late} late, worst tick {worst} cycles"),
    )
}

fn supervision(controller: &mut Controller) -> Result<Found> {
    let loosened = controller.field("LST?", "LOOSENED")?;
    found(loosened == 0.0, format!("{loosened} looser"))
}

fn commissioned(controller: &mut Controller) -> Result<Found> {
    let answer = controller.ask("CMS?")?;
    found(answer.starts_with("1 "), answer)
}

fn reference(controller: &mut Controller) -> Result<Found> {
    controller.carry_out("FRF")?;
    match controller.settled()? {
        Some(seconds) => found(true, format!("settled after {seconds:.3} s")),
        None => found(false, "never settled".to_owned()),
    }
}

fn hold(controller: &mut Controller) -> Result<Found> {
    controller.field("LST?", "PEAK_ERROR_RAD")?;
    let (late, _) = late(controller)?;
    let peak = controller.field("LST?", "PEAK_ERROR_RAD")?;
    found(
        peak < HOLD_RAD && late == 0.0,
        format!("{:.4} mrad, {late} late", peak * 1e3),
    )
}

fn travel(controller: &mut Controller) -> Result<Found> {
    controller.carry_out("VLS 20")?;
    controller.field("LST?", "PEAK_ERROR_RAD")?;
    let mut worst = 0.0_f64;
    for [x, y, w] in [[5.0, -5.0, 10.0], [0.0, 0.0, 0.0]] {
        controller.carry_out(&format!("MOV X {x} Y {y} W {w}"))?;
        if controller.settled()?.is_none() {
            return found(false, "never settled".to_owned());
        }
        for (axis, target) in [("X", x), ("Y", y), ("W", w)] {
            let error = controller.field(&format!("POS? {axis}"), axis)? - target;
            worst = worst.max(error.abs());
        }
    }
    let peak = controller.field("LST?", "PEAK_ERROR_RAD")?;
    found(
        peak < MOVE_RAD && worst < REST_MM,
        format!(
            "{:.4} mrad in motion, {:.6} mm or deg at rest",
            peak * 1e3,
            worst
        ),
    )
}

fn stop(controller: &mut Controller) -> Result<Found> {
    controller.carry_out("VLS 10")?;
    controller.carry_out("MOV X 10")?;
    controller.delay(0.2)?;
    controller.carry_out("STP")?;
    let settled = controller.settled()?.is_some();
    let x = controller.field("POS? X", "X")?;
    controller.carry_out("MOV X 0")?;
    let back = controller.settled()?.is_some();
    found(
        settled && back && x > 0.1 && x < 9.9,
        format!("rests at X {x:.3} mm"),
    )
}

fn servo(controller: &mut Controller) -> Result<Found> {
    controller.carry_out("SVO X 0")?;
    controller.delay(0.1)?;
    let on = controller.field("SVO? X", "X")?;
    found(on == 0.0, format!("servo {on}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An emulated chip is excused for what it has not, and for nothing else; a board for nothing.
    #[test]
    fn a_bad_reading_fails_but_the_one_that_an_emulated_chip_can_not_show() {
        let option_bytes = "BROWN_OUT_LEVEL=0, 3 to 3, BAD";
        let clock = "CORE=100, 168 to 168, BAD";
        for (readings, on_board, emulated) in [
            (
                vec!["CORE=168, 168 to 168, ok"],
                Verdict::Passed,
                Verdict::Passed,
            ),
            (vec![option_bytes], Verdict::Failed, Verdict::NotJudged),
            (vec![clock], Verdict::Failed, Verdict::Failed),
            (vec![option_bytes, clock], Verdict::Failed, Verdict::Failed),
        ] {
            let answer = readings.join("\n");
            assert_eq!(
                self_test_found(&answer, false).verdict,
                on_board,
                "{answer}"
            );
            assert_eq!(self_test_found(&answer, true).verdict, emulated, "{answer}");
        }
    }
}
