//! `tripivot commission` on many machines, as a table: `cargo bench -p tripivot --bench commission`. `SEEDS=24` takes machines 1 to 24 in place
//! of 1 to 4.

use desk::commission::{Chosen, Done, run};
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::machine::unknown;
use tripivot::attended::SimulatedMachine;

/// Quantities of a machine: what they are called, and how many digits behind the point.
type Figures = Vec<(&'static str, usize, f64)>;

fn main() {
    let seeds = std::env::var("SEEDS")
        .ok()
        .and_then(|text| text.parse().ok());
    let seeds: u64 = seeds.unwrap_or(4);
    let (mut all, mut refused) = (Vec::<Figures>::new(), Vec::new());
    for seed in 1..=seeds {
        let machine = unknown(seed);
        let mut attended = SimulatedMachine::new(&machine, SettingsFlash::in_memory());
        let ran = run(&mut attended, &Chosen::all(), &mut |_| {});
        let done = ran.unwrap_or_else(|error| panic!("machine {seed}: {error}"));
        match done
            .iter()
            .find_map(|done| done.failure.as_ref().zip(Some(done.step.name)))
        {
            Some((failure, step)) => refused.push(format!("{seed} at {step}: {}", failure.what)),
            None => all.push(figures(&machine, &done)),
        }
    }
    println!("machines 1 to {seeds}; refused: {}", refused.len());
    for line in refused {
        println!("{line}");
    }
    println!("| what | median | 90 % | worst |");
    println!("|---|---|---|---|");
    let names = all.first().map_or(0, Vec::len);
    for at in 0..names {
        let mut sizes: Vec<f64> = all.iter().map(|figures| figures[at].2.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let part = |part: f64| sizes[((sizes.len() - 1) as f64 * part).round() as usize];
        let (name, digits, _) = all[0][at];
        let [median, most, worst] = [0.5, 0.9, 1.0].map(part);
        println!("| {name} | {median:.digits$} | {most:.digits$} | {worst:.digits$} |");
    }
}

/// A number of a step; none where the step did not tell it.
fn number(all: &[Done], step: &str, name: &str, unit: &str) -> f64 {
    let numbers = all.iter().filter(|done| done.step.name == step);
    let mut numbers = numbers.flat_map(|done| &done.found.numbers);
    let found = numbers.find(|number| number.name == name && number.unit == unit);
    found.map_or(f64::NAN, |number| number.value)
}

fn figures(machine: &StageParameters, all: &[Done]) -> Figures {
    let worst = |step: &str, name: &str| {
        let at = |place: &str| number(all, step, &format!("{name} {place}"), "");
        f64::max(at("in the middle"), at("at X 70 Y 0"))
    };
    let (plant, analog) = (&machine.plant, &machine.analog);
    let percent = |found: f64, truth: f64| 100.0 * (found / truth - 1.0);
    // Volts and amperes are those of the controller's meters.
    let constant = plant.torque_constant_n_m_a * plant.gear_ratio * analog.supply_gain;
    let torque = analog.supply_gain * analog.current_gain.iter().sum::<f64>() / 3.0;
    let payload = &plant.payload;
    let friction = plant.ring_friction.coulomb + plant.motor_friction.coulomb;
    let drive = plant.motor_inertia_kg_m2 + plant.ring_inertia_kg_m2;
    let mass = plant.platform_mass_kg + payload.mass_kg;
    let inertia = plant.platform_inertia_kg_m2
        + payload.inertia_kg_m2
        + payload.mass_kg * payload.eccentricity_m.powi(2);
    let of = |name: &str, unit: &str| number(all, "identification", name, unit);
    vec![
        (
            "simulated time, s",
            0,
            all.iter().map(|done| done.seconds).sum(),
        ),
        (
            "Ms with safe gains, worse of two places",
            2,
            worst("response", "Ms"),
        ),
        ("Ms as tuned", 2, worst("tuning", "Ms")),
        (
            "S(30 Hz) with safe gains, worse of two places",
            3,
            worst("response", "S(30 Hz)"),
        ),
        ("S(30 Hz) as tuned", 3, worst("tuning", "S(30 Hz)")),
        (
            "S(30 Hz) as tuned over that with safe gains",
            2,
            worst("tuning", "S(30 Hz)") / worst("response", "S(30 Hz)"),
        ),
        (
            "peak following error of a pivot, urad",
            1,
            number(all, "verification", "largest following error", "urad"),
        ),
        (
            "motor constant, % off",
            2,
            percent(
                number(all, "friction", "motor of pivot 1", "V s/rad"),
                constant,
            ),
        ),
        (
            "Coulomb friction, % off",
            2,
            percent(number(all, "friction", "Coulomb friction", "N m"), friction),
        ),
        (
            "inertia of motor and ring, % off",
            2,
            percent(
                of("inertia of a motor with its ring", "kg m^2"),
                drive * torque,
            ),
        ),
        (
            "mass of platform and load, % off",
            2,
            percent(of("mass of platform and load", "kg"), mass * torque),
        ),
        (
            "their inertia, % off",
            2,
            percent(
                of("inertia of platform and load", "kg m^2"),
                inertia * torque,
            ),
        ),
    ]
}
