//! What iterative learning leaves of the following error, as a table: `cargo bench -p tests --bench repeated_moves`.
//!
//! Random moves of 1 mm and more from the middle of the disk, theta with them, each to its target and back: six times without a table,
//! which tells how far the same move is from itself, then six times with a table from the first time on. The first trial is the one
//! without. An error is the root mean square over the pivots and the ticks of the move and of 5 ms after it.
//! `TRIALS=1` prints every one of them.

use hal_sim::random::Random;
use hal_sim::rig::Told;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use parallel::{cores, of_all};
use tests::Bench;

const MOVES: usize = 40;
const TRIALS: usize = 6;
/// Ticks after a motion that count as well.
const AFTER: u32 = 100;
const TITLES: [&str; 8] = [
    "machine",
    "load, kg",
    "told",
    "first trial, LSB rms: median / 90 % / worst",
    "after five trials: median / 90 % / worst",
    "at most 1 LSB",
    "worst trial over the first",
    "the same without a table",
];

/// Errors of a move, time by time: without a table and with one.
struct Repeats {
    without: Vec<f64>,
    with: Vec<f64>,
}

fn main() {
    let cases = [
        (0.0, 0.0, Told::Nothing),
        (20.0, 0.0, Told::Nothing),
        (-20.0, 0.0, Told::Nothing),
        (0.0, 0.0, Told::Machine),
        (20.0, 0.0, Told::Machine),
        (-20.0, 0.0, Told::Machine),
        (20.0, 0.0, Told::MachineAndRipple),
        (-20.0, 0.0, Told::MachineAndRipple),
        (35.0, 5.0, Told::MachineAndRipple),
        (0.0, 0.0, Told::Reference),
    ];
    let only = std::env::var("ONLY").map(|only| only.parse::<usize>().expect("a row's number"));
    let cases = match only {
        Ok(only) => vec![cases[only]],
        Err(_) => cases.to_vec(),
    };
    let rows = of_all(&cases, cores(), |case| row(*case));
    println!("| {} |", TITLES.join(" | "));
    println!("|{}", "---|".repeat(TITLES.len()));
    for row in rows {
        println!("{row}");
    }
}

fn row((mismatch_percent, payload_kg, told): (f64, f64, Told)) -> String {
    let options = RunOptions {
        mismatch_percent,
        payload_kg,
        told,
        ..match told {
            Told::Reference => RunOptions::reference(),
            _ => RunOptions::default(),
        }
    };
    let (stage, parameters) = (stage_parameters(&options), controller_parameters(&options));
    let machine = match told {
        Told::Reference => "reference stage".to_owned(),
        _ => format!("kind, {mismatch_percent} % off"),
    };
    let mut bench = Bench::told(&stage, &parameters);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    let mut random = Random::new(20_261_123);
    let moves: Vec<Repeats> = (0..MOVES)
        .map(|number| repeats(&mut bench, number, &mut random))
        .collect();
    if std::env::var_os("TRIALS").is_some() {
        for repeats in &moves {
            println!("{:.2?} {:.2?}", repeats.without, repeats.with);
        }
    }
    let first = sorted(moves.iter().map(|repeats| repeats.with[0]));
    let last = sorted(moves.iter().map(|repeats| repeats.with[TRIALS - 1]));
    let good = last.iter().filter(|error| **error <= 1.0).count();
    format!(
        "| {machine} | {payload_kg} | {told} | {} | {} | {:.0} % | {:.2} | {:.2} |",
        spread(&first),
        spread(&last),
        good as f64 / MOVES as f64 * 100.0,
        worst(moves.iter().map(|repeats| &repeats.with)),
        worst(moves.iter().map(|repeats| &repeats.without)),
    )
}

/// A random move's errors.
fn repeats(bench: &mut Bench, number: usize, random: &mut Random) -> Repeats {
    let way_mm = 10_f64.powf(random.between(0.0, 1.85));
    let (sin, cos) = random.between(0.0, core::f64::consts::TAU).sin_cos();
    let [x, y, turn] = [
        way_mm * cos,
        way_mm * sin,
        way_mm * random.between(-1.8, 1.8),
    ];
    let line = format!("MOV X {x:.4} Y {y:.4} W {turn:.4}\n");
    // From where the first one starts as the others do: after the way back.
    there_and_back(bench, &line);
    let without = (0..TRIALS).map(|_| there_and_back(bench, &line)).collect();
    assert_eq!(bench.error_after(&format!("ILC LEARN M{number}")), "0");
    let with = (0..TRIALS).map(|_| there_and_back(bench, &line)).collect();
    assert_eq!(bench.error_after("ILC FORGET"), "0");
    Repeats { without, with }
}

/// The error of the way there.
fn there_and_back(bench: &mut Bench, line: &str) -> f64 {
    bench.send(line);
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
    bench.say("MOV X 0 Y 0 W 0\n");
    bench.settle();
    (sum / count).sqrt()
}

/// The largest error over the first one of its move.
fn worst<'a>(moves: impl Iterator<Item = &'a Vec<f64>>) -> f64 {
    let over = moves.flat_map(|errors| errors[1..].iter().map(move |error| error / errors[0]));
    over.fold(0.0, f64::max)
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
