//! What gains that are sought for identified machines do on the machines as they are, as a table: `cargo bench -p commissioning --bench gains`;
//! `-- FIRST LAST` takes these unknown machines. No friction that holds the stage off, no play, no loop that is measured: the search alone.

#[path = "../tests/machine/mod.rs"]
mod machine;

use commissioning::chain::{Chain, Place, Uncertainty};
use commissioning::drive_model::Electrical;
use commissioning::tuning::{
    Gains, Limits, MOST_MS, Margins, PLACES, Plant, SEARCHED, Sought, tune,
};
use hal_sim::rig::loop_model;
use machine::truth::identify;
use machine::{PLAN, TIMING, unknown};
use parallel::{cores, of_all};

const MACHINES: [u64; 2] = [1, 24];

/// What gains are sought for.
struct Machine {
    chain: Chain,
    electrical: [Electrical; 3],
    /// Where it was identified.
    off: Option<Uncertainty>,
}

impl Machine {
    fn at(&self, places: &[[f64; 2]]) -> Vec<Plant> {
        Plant::at_places(&self.electrical, &self.chain, places, &TIMING)
    }

    /// What it may be as well, as the step `tuning` takes it.
    fn may_be(&self, places: &[[f64; 2]]) -> Vec<Plant> {
        let Some(off) = &self.off else {
            return Vec::new();
        };
        let [softer, stiffer] = &self.chain.as_it_may_be(off);
        let cold = &self.electrical;
        let warm = &cold.each_ref().map(Electrical::at_work);
        [(cold, softer), (cold, stiffer), (warm, &self.chain)]
            .map(|(electrical, chain)| Plant::at_places(electrical, chain, places, &TIMING))
            .concat()
    }

    /// Gains that are sound on all of that, and their worst margins there.
    fn sought(&self, limits: &Limits) -> (Gains, Margins) {
        let centre = Place::centre();
        let of = |places| [self.at(places), self.may_be(places)];
        let [found, may_be] = of(&PLACES[..SEARCHED]);
        let elsewhere = of(&PLACES[SEARCHED..]).concat();
        let tuned = tune(
            Sought {
                found: &found,
                may_be: &may_be,
                elsewhere: &elsewhere,
            },
            &self.electrical,
            &self.chain.resonances_hz(&centre),
            self.chain.inertia(&centre)[(0, 0)],
            &TIMING,
            limits,
        );
        let all = [found, may_be, elsewhere].concat();
        let gains = tuned.expect("there are gains").gains;
        let sound = gains.slowed_until_sound(&all, MOST_MS, TIMING.tick_s);
        sound.expect("small gains are sound")
    }
}

/// S(30 Hz) as told, on the true machine and over the best there; Ms there.
fn row(seed: u64) -> [f64; 4] {
    let parameters = unknown(seed);
    let (chain, mut electrical) = loop_model(&parameters);
    let identified = identify(&parameters, &PLAN);
    // As warm as they were then.
    for (drive, warmer_k) in electrical.iter_mut().zip(identified.excited.warmer_k) {
        drive.resistance_ohm *= 1.0 + parameters.plant.winding.resistance_per_k * warmer_k;
    }
    let truth = Machine {
        chain,
        electrical,
        off: None,
    };
    let model = identified.model;
    let found = Machine {
        chain: Chain {
            along_stiffness: 0.0,
            along_damping: 0.0,
            ..model.mechanical.chain
        },
        electrical: model.electrical,
        off: Some(model.mechanical.uncertainty()),
    };
    let (gains, told) = found.sought(&Limits::WITH_FRICTION);
    let mut plants = truth.at(&PLACES);
    // Volts are those of the controller's meter.
    for response in plants.iter_mut().flat_map(|plant| &mut plant.response) {
        *response = response.scale(1.0 / parameters.analog.supply_gain);
    }
    let there = (gains.at_worst(&plants, TIMING.tick_s)).expect("a plant");
    let best = truth.sought(&Limits::ON_MODEL).1;
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
    let [first, last] = <[u64; 2]>::try_from(numbers).unwrap_or(MACHINES);
    let seeds: Vec<u64> = (first..=last).collect();
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
        all.sort_by(f64::total_cmp);
        let [median, most, worst] =
            [0.5, 0.9, 1.0].map(|part| all[((all.len() - 1) as f64 * part).round() as usize]);
        println!("{name}: median {median:.2}, 90 % {most:.2}, worst {worst:.2}");
    }
}
