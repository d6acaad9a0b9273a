//! What iterative learning leaves of the following error, as a table: `cargo bench -p tests --bench repeated_moves`.
//!
//! Random moves of 1 mm and more from the middle of the disk, theta with them, each to its target and back six times, with a table from
//! the first time on. The first trial is the one without. An error is the root mean square over the pivots and the ticks of the move and of
//! 5 ms after it.

use hal_sim::random::Random;
use hal_sim::rig::Told;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use tests::Bench;

const MOVES: usize = 40;
const TRIALS: usize = 6;
/// Ticks after a motion that count as well.
const AFTER: u32 = 100;

fn main() {
    println!(
        "| machine | load, kg | told | first trial, LSB rms: median / 90 % / worst | after five trials: median / 90 % / worst | at most 1 LSB | worst trial over the first |"
    );
    println!("|---|---|---|---|---|---|---|");
    for (mismatch_percent, payload_kg, told) in [
        (0.0, 0.0, Told::Nothing),
        (20.0, 0.0, Told::Nothing),
        (-20.0, 0.0, Told::Nothing),
        (0.0, 0.0, Told::Machine),
        (20.0, 0.0, Told::Machine),
        (-20.0, 0.0, Told::Machine),
        (20.0, 0.0, Told::MachineAndRipple),
        (-20.0, 0.0, Told::MachineAndRipple),
        (35.0, 5.0, Told::MachineAndRipple),
    ] {
        let options = RunOptions {
            mismatch_percent,
            payload_kg,
            ..RunOptions::default()
        };
        let stage = stage_parameters(&options);
        let parameters = told.parameters(&controller_parameters(&options), &stage);
        let mut bench = Bench::told(&stage, &parameters);
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        let mut random = Random::new(20_261_123);
        let moves: Vec<Vec<f64>> = (0..MOVES)
            .map(|number| errors(&mut bench, number, &mut random))
            .collect();
        let first = sorted(moves.iter().map(|errors| errors[0]));
        let last = sorted(moves.iter().map(|errors| errors[TRIALS - 1]));
        let good = last.iter().filter(|error| **error <= 1.0).count();
        let worst = moves.iter().flat_map(|errors| {
            let first = errors[0];
            errors[1..].iter().map(move |error| error / first)
        });
        println!(
            "| {mismatch_percent} % off | {payload_kg} | {told} | {} | {} | {:.0} % | {:.2} |",
            spread(&first),
            spread(&last),
            good as f64 / MOVES as f64 * 100.0,
            worst.fold(0.0, f64::max)
        );
    }
}

/// A random move's errors, trial by trial.
fn errors(bench: &mut Bench, number: usize, random: &mut Random) -> Vec<f64> {
    let way_mm = 10_f64.powf(random.between(0.0, 1.85));
    let (sin, cos) = random.between(0.0, core::f64::consts::TAU).sin_cos();
    let [x, y, turn] = [
        way_mm * cos,
        way_mm * sin,
        way_mm * random.between(-1.8, 1.8),
    ];
    let line = format!("MOV X {x:.4} Y {y:.4} W {turn:.4}\n");
    let back = |bench: &mut Bench| {
        bench.say("MOV X 0 Y 0 W 0\n");
        bench.settle();
    };
    // From where the first trial starts as the others do: after the way back.
    back(bench);
    bench.say(&line);
    bench.settle();
    back(bench);
    assert_eq!(bench.error_after(&format!("ILC LEARN M{number}")), "0");
    let errors = (0..TRIALS).map(|_| {
        bench.send(&line);
        let (mut sum, mut count, mut after) = (0.0, 0.0, 0);
        let mut last = bench.sample().pivot_setpoints;
        let mut has_started = false;
        while after < AFTER {
            bench.tick();
            for counts in bench.following_errors() {
                sum += counts * counts;
                count += 1.0;
            }
            let setpoints = bench.sample().pivot_setpoints;
            let moves = setpoints != last;
            last = setpoints;
            has_started |= moves;
            after = if moves || !has_started { 0 } else { after + 1 };
        }
        bench.settle();
        back(bench);
        (sum / count).sqrt()
    });
    let errors: Vec<f64> = errors.collect();
    assert_eq!(bench.error_after("ILC FORGET"), "0");
    errors
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

fn spread(values: &[f64]) -> String {
    let at = |part: f64| values[((values.len() - 1) as f64 * part) as usize];
    [0.5, 0.9, 1.0]
        .map(|part| format!("{:.2}", at(part)))
        .join(" / ")
}
