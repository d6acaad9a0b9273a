//! What gains that are sought for identified machines do on the machines as they are, as a table: `cargo bench -p commissioning --bench gains`;
//! `-- 9 31` takes these unknown machines. The search alone: no loop is measured, and what gains are judged on has neither friction nor play.

#[path = "../tests/machine/mod.rs"]
mod machine;

use commissioning::chain::{Chain, Place};
use commissioning::drive_model::Electrical;
use commissioning::tuning::{
    Gains, Limits, MOST_MS, Margins, PLACES, Plant, SEARCHED, Sought, tune,
};
use machine::truth::{as_warm, identify, spread};
use machine::{PLAN, TIMING, unknown};
use parallel::{cores, of_all};

const MACHINES: std::ops::RangeInclusive<u64> = 1..=24;

/// Gains that are sound at all places, on plants as they are found and as they may be, and their worst margins there.
fn sought(
    (chain, electrical): (&Chain, &[Electrical; 3]),
    plants: impl Fn(&[[f64; 2]]) -> [Vec<Plant>; 2],
    limits: &Limits,
) -> (Gains, Margins) {
    let centre = Place::centre();
    let [found, may_be] = plants(&PLACES[..SEARCHED]);
    let elsewhere = plants(&PLACES[SEARCHED..]).concat();
    let tuned = tune(
        Sought {
            found: &found,
            may_be: &may_be,
            elsewhere: &elsewhere,
        },
        electrical,
        &chain.resonances_hz(&centre),
        chain.inertia(&centre)[(0, 0)],
        limits,
    );
    let all = [found, may_be, elsewhere].concat();
    let gains = tuned.expect("there are gains").gains;
    let sound = gains.slowed_until_sound(&all, MOST_MS);
    sound.expect("small gains are sound")
}

/// S(30 Hz) as told, on the true machine and over the best there; Ms there.
fn row(seed: u64) -> [f64; 4] {
    let parameters = unknown(seed);
    let identified = identify(&parameters, &PLAN);
    let (chain, electrical) = as_warm(&parameters, &identified.excited);
    let truth = |places: &[[f64; 2]]| {
        let mut plants = Plant::at_places(&electrical, &chain, places, &TIMING);
        // Volts are those of the controller's meter.
        for response in plants.iter_mut().flat_map(|plant| &mut plant.response) {
            *response = response.scale(1.0 / parameters.analog.supply_gain);
        }
        plants
    };
    let model = identified.model;
    let found_chain = model.mechanical.chain.sliding();
    let found = |places: &[[f64; 2]]| {
        [
            Plant::at_places(&model.electrical, &found_chain, places, &TIMING),
            Plant::as_they_may_be(&model, &found_chain, places, &TIMING),
        ]
    };
    let (gains, told) = sought(
        (&found_chain, &model.electrical),
        found,
        &Limits::WITH_FRICTION,
    );
    let certain = |places: &[[f64; 2]]| [truth(places), Vec::new()];
    let (_, best) = sought((&chain, &electrical), certain, &Limits::ON_MODEL);
    let there = (gains.at_worst(&truth(&PLACES))).expect("a plant");
    [
        told.rejection,
        there.rejection,
        there.rejection / best.rejection,
        there.ms,
    ]
}

fn main() {
    let numbers: Vec<u64> = std::env::args()
        .filter_map(|word| word.parse().ok())
        .collect();
    let seeds = if numbers.is_empty() {
        MACHINES.collect()
    } else {
        numbers
    };
    let rows = of_all(&seeds, cores(), |seed| row(*seed));
    println!(
        "| machine | S(30 Hz) as told | on the true machine | over the best there | Ms there |"
    );
    println!("|---|---|---|---|---|");
    for (seed, [told, there, over, ms]) in seeds.iter().zip(&rows) {
        println!("| {seed} | {told:.4} | {there:.4} | {over:.2} | {ms:.2} |");
    }
    for (name, k) in [("over the best there", 2), ("Ms there", 3)] {
        let mut all: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        let [median, most, worst] = spread(&mut all);
        println!("{name}: median {median:.2}, 90 % {most:.2}, worst {worst:.2}");
    }
}
