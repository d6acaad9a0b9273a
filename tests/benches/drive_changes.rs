//! What condition monitoring tells of a drive that changes, and when: `cargo bench -p tests --bench drive_changes`.
//!
//! Machines as a workshop builds them, with every imperfection, whose controllers were told their numbers, on another day than that of the
//! telling (warm or cold, a quarter more or less friction, magnets and supply a little off): random moves all over the disk at a random
//! speed, and after some seconds something changes.
//! `MACHINES=100` takes more of them.

use firmware::mode::Mode;
use hal_sim::campaign::{Injection, machine, on_another_day, told};
use hal_sim::random::Random;
use parallel::{cores, of_all};
use tests::Bench;

const MACHINES: u64 = 16;
/// Seconds before the change, and after it.
const BEFORE: u64 = 6;
const AFTER: u64 = 30;
const TICKS_PER_S: u64 = 20_000;
const PIVOT: usize = 1;
/// Where moves go: within this, mm, and by so much of a turn, deg; and how fast, mm/s.
const REACH_MM: f64 = 78.0;
const TURN_DEG: f64 = 200.0;
const SPEED_MM_S: [f64; 2] = [50.0, 200.0];
/// Words of the events.
const WORDS: [&str; 4] = ["motor constant", "current sensor", "friction", "knocks"];

/// What changes, and the word of its event.
const CASES: [(&str, Option<Injection>, Option<usize>); 25] = [
    ("nothing", None, None),
    ("motor 5 % weaker", Some(Injection::Fading(0.05)), Some(0)),
    ("motor 10 % weaker", Some(Injection::Fading(0.1)), Some(0)),
    ("motor 15 % weaker", Some(Injection::Fading(0.15)), Some(0)),
    ("motor 20 % weaker", Some(Injection::Fading(0.2)), Some(0)),
    ("motor 40 % weaker", Some(Injection::Fading(0.4)), Some(0)),
    (
        "supply's sensor 15 % low",
        Some(Injection::SupplyBias(0.85)),
        Some(0),
    ),
    (
        "supply's sensor 10 % low",
        Some(Injection::SupplyBias(0.9)),
        Some(0),
    ),
    (
        "supply's sensor 10 % high",
        Some(Injection::SupplyBias(1.1)),
        Some(0),
    ),
    (
        "current sensor 0.2 A off",
        Some(Injection::CurrentBias(0.2)),
        Some(1),
    ),
    (
        "current sensor 0.3 A off",
        Some(Injection::CurrentBias(0.3)),
        Some(1),
    ),
    (
        "current sensor 0.5 A off",
        Some(Injection::CurrentBias(0.5)),
        Some(1),
    ),
    (
        "current sensor 1 A off",
        Some(Injection::CurrentBias(1.0)),
        Some(1),
    ),
    (
        "1 N m more friction",
        Some(Injection::Friction(1.0)),
        Some(2),
    ),
    (
        "1.5 N m more friction",
        Some(Injection::Friction(1.5)),
        Some(2),
    ),
    (
        "2 N m more friction",
        Some(Injection::Friction(2.0)),
        Some(2),
    ),
    (
        "5 N m more friction",
        Some(Injection::Friction(5.0)),
        Some(2),
    ),
    (
        "coupling loose by 0.02 mrad",
        Some(Injection::LooseCoupling(20e-6)),
        Some(3),
    ),
    (
        "coupling loose by 0.05 mrad",
        Some(Injection::LooseCoupling(50e-6)),
        Some(3),
    ),
    (
        "coupling loose by 0.1 mrad",
        Some(Injection::LooseCoupling(0.1e-3)),
        Some(3),
    ),
    (
        "coupling loose by 0.3 mrad",
        Some(Injection::LooseCoupling(0.3e-3)),
        Some(3),
    ),
    (
        "coupling loose by 1 mrad",
        Some(Injection::LooseCoupling(1e-3)),
        Some(3),
    ),
    ("load lost", Some(Injection::LoadLost), None),
    (
        "encoder drifts by 2 mrad/s",
        Some(Injection::Drift(2e-3)),
        None,
    ),
    (
        "encoder's scale 0.3 % off",
        Some(Injection::Scale(3e-3)),
        None,
    ),
];

/// What came of it: the seconds until the event, or the fault that came before; other events of drives; what was found of the drives last.
struct Outcome {
    told_s: Option<f64>,
    fault: Option<String>,
    others: usize,
    found: Vec<[f64; 3]>,
}

fn main() {
    let machines = std::env::var("MACHINES");
    let machines = machines.map_or(MACHINES, |number| number.parse().expect("a number"));
    let runs: Vec<(usize, u64)> = (0..CASES.len())
        .flat_map(|case| (1..=machines).map(move |number| (case, number)))
        .collect();
    let outcomes = of_all(&runs, cores(), |(case, number)| run(*case, *number));
    println!(
        "| what changes | machines | told | after, s: median / worst | a fault | something else told |"
    );
    println!("|---|---|---|---|---|---|");
    for (outcomes, (name, ..)) in outcomes.chunks(machines as usize).zip(CASES) {
        println!("{}", row(name, outcomes));
    }
    let sound: Vec<[f64; 3]> = (outcomes.iter().take(machines as usize))
        .flat_map(|outcome| outcome.found.clone())
        .collect();
    let spread = |i: usize, digits: usize| {
        let values = || sound.iter().map(|found| found[i]);
        let least = values().fold(f64::INFINITY, f64::min);
        let most = values().fold(f64::NEG_INFINITY, f64::max);
        format!("{least:.digits$} to {most:.digits$}")
    };
    println!(
        "where nothing changes: motor constants {} of their parameters, current sensors {} A off, friction {} N m over its parameters",
        spread(0, 3),
        spread(1, 2),
        spread(2, 2)
    );
}

fn row(name: &str, outcomes: &[Outcome]) -> String {
    let mut told: Vec<f64> = outcomes
        .iter()
        .filter_map(|outcome| outcome.told_s)
        .collect();
    told.sort_by(f64::total_cmp);
    let after = match (told.get(told.len() / 2), told.last()) {
        (Some(median), Some(worst)) => format!("{median:.1} / {worst:.1}"),
        _ => String::new(),
    };
    let mut faults: Vec<(String, usize)> = Vec::new();
    for fault in outcomes.iter().filter_map(|outcome| outcome.fault.as_ref()) {
        match faults.iter_mut().find(|(known, _)| known == fault) {
            Some((_, count)) => *count += 1,
            None => faults.push((fault.clone(), 1)),
        }
    }
    let faults: Vec<String> = (faults.into_iter())
        .map(|(fault, count)| format!("{count} {fault}"))
        .collect();
    let others: usize = outcomes.iter().map(|outcome| outcome.others).sum();
    format!(
        "| {name} | {} | {} | {after} | {} | {others} |",
        outcomes.len(),
        told.len(),
        faults.join(", ")
    )
}

fn run(case: usize, number: u64) -> Outcome {
    let (_, change, _) = CASES[case];
    let known = machine(number, number);
    let parameters = told(&known);
    let mut bench = Bench::told(&on_another_day(&known, number), &parameters);
    let mut random = Random::new(number);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    for tick in 0..(BEFORE + AFTER) * TICKS_PER_S {
        if bench.mode() == Mode::Holding {
            let line = random_move(&mut random);
            bench.send(&line);
            bench.tick();
        }
        let age = tick.checked_sub(BEFORE * TICKS_PER_S);
        if let (Some(age), Some(change)) = (age, change) {
            change.apply(&mut bench.rig.front, PIVOT, age, &mut random);
        }
        bench.tick();
        // A look twice a second is near enough.
        let is_over = bench.fault().is_some();
        if is_over || tick.is_multiple_of(TICKS_PER_S / 2) {
            let told = events_of_drives(&mut bench);
            assert!(age.is_some() || told.is_empty(), "{number}: {told:?}");
            if is_over || told.iter().any(|event| is_of(case, event)) {
                return outcome(&mut bench, case, age);
            }
        }
    }
    outcome(&mut bench, case, None)
}

fn random_move(random: &mut Random) -> String {
    let (radius, angle) = (
        REACH_MM * random.between(0.0, 1.0).sqrt(),
        random.between(0.0, core::f64::consts::TAU),
    );
    format!(
        "VLS {:.3}\nMOV X {:.3} Y {:.3} W {:.3}\n",
        random.between(SPEED_MM_S[0], SPEED_MM_S[1]),
        radius * angle.cos(),
        radius * angle.sin(),
        random.between(-TURN_DEG, TURN_DEG)
    )
}

fn events_of_drives(bench: &mut Bench) -> Vec<String> {
    let events = bench.say("EVT?\n");
    let is_of_drive = |line: &&str| WORDS.iter().any(|word| line.contains(word));
    (events.lines().filter(is_of_drive))
        .map(str::to_owned)
        .collect()
}

/// Whether an event is that of the change: all three motors are where the supply's sensor is off.
fn is_of(case: usize, event: &str) -> bool {
    let (_, change, word) = CASES[case];
    let is_of_all = matches!(change, Some(Injection::SupplyBias(_)));
    word.is_some_and(|word| event.contains(WORDS[word]))
        && (is_of_all || event.contains(&format!("pivot {}", PIVOT + 1)))
}

/// `age`: ticks from the change to its event, or to a fault.
fn outcome(bench: &mut Bench, case: usize, age: Option<u64>) -> Outcome {
    let events = events_of_drives(bench);
    let (of_it, others): (Vec<_>, Vec<_>) = events.iter().partition(|event| is_of(case, event));
    let told_s = age.filter(|_| !of_it.is_empty());
    let told_s = told_s.map(|age| age as f64 / TICKS_PER_S as f64);
    Outcome {
        told_s,
        fault: (bench.fault_kind().filter(|_| told_s.is_none())).map(|kind| format!("{kind:?}")),
        others: others.len(),
        found: (0..3)
            .filter_map(|pivot| bench.drive_condition(pivot))
            .collect(),
    }
}
