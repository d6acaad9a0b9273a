//! What a commissioned machine came to, against its own numbers. Volts and amperes are those of the controller's meters: what these are off makes
//! every torque as much larger, and is no error of the method.

use commissioning::chain::{Chain, Place};
use commissioning::record::Timing;
use commissioning::tuning::{Gains, PLACES, Plant};
use desk::commission::Done;
use firmware::parameters::Parameters;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::{loop_model, with_gains_for_every_day, with_gains_tuned};
use std::cell::Cell;
use std::rc::Rc;
use tripivot::attended::EachTick;

pub type Figures = Vec<(&'static str, f64)>;

/// Resonances over this are beyond what any servo here reaches.
const REACHED_HZ: f64 = 1_500.0;

/// Where the windings are identified: with the platform no further than this from the middle, m.
const MIDDLE_M: f64 = 5e-3;

/// How warm the windings were in the steps that measure what they answer, K, by ring: in the mean over a step, as their currents show it (by their
/// squares). What is found of the windings is found in the middle.
#[derive(Default)]
pub struct Warmth {
    now: Rc<Cell<[Mean; 3]>>,
    in_the_middle: Rc<Cell<[Mean; 3]>>,
    identified: Cell<[f64; 3]>,
    tuned: Cell<[f64; 3]>,
}

#[derive(Clone, Copy, Default)]
struct Mean {
    weighted: f64,
    weights: f64,
}

impl Mean {
    /// The mean of the windings' warmth so far, with what they are and carry now.
    fn with(means: [Self; 3], plant: &hal_sim::machine::plant::Plant) -> [Self; 3] {
        let (warmer_k, current_a) = (plant.windings_warmer_k(), plant.currents_a());
        std::array::from_fn(|i| {
            let weight = current_a[i] * current_a[i];
            Self {
                weighted: means[i].weighted + weight * warmer_k[i],
                weights: means[i].weights + weight,
            }
        })
    }
}

impl Warmth {
    pub fn watch(&self) -> EachTick {
        let (now, in_the_middle) = (Rc::clone(&self.now), Rc::clone(&self.in_the_middle));
        Box::new(move |host, _| {
            let plant = &host.stage.plant;
            now.set(Mean::with(now.get(), plant));
            let [x_m, y_m, _] = plant.pose();
            if x_m.hypot(y_m) < MIDDLE_M {
                in_the_middle.set(Mean::with(in_the_middle.get(), plant));
            }
        })
    }

    /// After a step.
    pub fn note(&self, step: &str) {
        let warmer_k = |means: [Mean; 3]| means.map(|mean| mean.weighted / mean.weights);
        let (all, in_the_middle) = (self.now.take(), self.in_the_middle.take());
        match step {
            "identification" => self.identified.set(warmer_k(in_the_middle)),
            "tuning" => self.tuned.set(warmer_k(all)),
            _ => (),
        }
    }
}

/// A number of a step; none where the step did not tell it.
fn number(all: &[Done], step: &str, name: &str, unit: &str) -> f64 {
    let numbers = all.iter().filter(|done| done.step.name == step);
    let mut numbers = numbers.flat_map(|done| &done.found.numbers);
    let found = numbers.find(|number| number.name == name && number.unit == unit);
    found.map_or(f64::NAN, |number| number.value)
}

fn percent(found: f64, truth: f64) -> f64 {
    100.0 * (found / truth - 1.0)
}

/// The largest, whatever its sign.
fn worst(all: impl Iterator<Item = f64>) -> f64 {
    all.fold(
        0.0,
        |most: f64, one| {
            if one.abs() <= most.abs() { most } else { one }
        },
    )
}

pub fn figures(machine: &StageParameters, all: &[Done], warmth: &Warmth) -> Figures {
    let mut figures = loops(all);
    figures.extend(drives(machine, all, warmth));
    figures.extend(mechanics(machine, all));
    figures.extend(gears(machine, all));
    figures.extend(guides(machine, all));
    figures
}

const FOLLOWING: &str = "following error once a turn of a motor";

fn gears(machine: &StageParameters, all: &[Done]) -> Figures {
    let of = |name: &str| number(all, "gears", name, "urad");
    let truth_urad = 1e6 * machine.plant.gear.cyclic_error_rad;
    let gears = (1..=3).map(|pivot| percent(of(&format!("gear of pivot {pivot}")), truth_urad));
    let [with, without] =
        ["", "not "].map(|not| of(&format!("{FOLLOWING}, gears {not}made up for")));
    vec![("gears", worst(gears)), ("gears left", with / without)]
}

fn guides(machine: &StageParameters, all: &[Done]) -> Figures {
    let of = |name: &str, unit: &str| number(all, "guides", name, unit);
    let (plant, torque) = (&machine.plant, torque(machine));
    let friction = of("friction of a carriage", "N");
    let stiffness = of("stiffness across a guide", "N/um");
    vec![
        (
            "guides",
            percent(friction, plant.guide_friction.coulomb * torque),
        ),
        (
            "give",
            percent(stiffness, plant.guide_stiffness_n_m * 1e-6 * torque),
        ),
    ]
}

fn loops(all: &[Done]) -> Figures {
    let worst = |step: &str, name: &str| {
        let at = |place: &str| number(all, step, &format!("{name} {place}"), "");
        f64::max(at("in the middle"), at("at X 66 Y 38"))
    };
    let [safe, tuned] = ["response", "tuning"].map(|step| worst(step, "S(30 Hz)"));
    vec![
        ("ms safe", worst("response", "Ms")),
        ("ms", worst("tuning", "Ms")),
        ("s30 safe", safe),
        ("s30", tuned),
        ("s30 gain", tuned / safe),
        (
            "peak",
            number(all, "verification", "largest following error", "urad"),
        ),
    ]
}

/// Ring and bridge of a pivot: pivot 1 is bridge 1's ring, the others follow it to the left.
fn ring_and_bridge(machine: &StageParameters, pivot: usize) -> (usize, usize) {
    let wiring = &machine.wiring;
    let ring = (wiring.ring_of_bridge(0) + pivot) % 3;
    (ring, usize::from(wiring.bridge_of_ring[ring]))
}

/// What a pivot's numbers are compared with.
struct Pivot {
    number: usize,
    /// An ohm by the controller's meters.
    ohm: f64,
    /// How much of its resistance its winding had as warm as it was.
    warm: f64,
    /// At its ring in the middle of the disk, kg m^2 by the meters.
    inertia: f64,
}

fn drives(machine: &StageParameters, all: &[Done], warmth: &Warmth) -> Figures {
    let (plant, analog) = (&machine.plant, &machine.analog);
    let constant = plant.ring_torque_constant_n_m_a() * analog.supply_gain;
    let (chain, _) = loop_model(machine);
    let inertia = chain.inertia(&Place::centre()) * torque(machine);
    let pivots: [Pivot; 3] = std::array::from_fn(|pivot| {
        let (ring, bridge) = ring_and_bridge(machine, pivot);
        let warm = 1.0 + plant.winding.resistance_per_k * warmth.identified.get()[ring];
        Pivot {
            number: pivot + 1,
            ohm: analog.supply_gain / analog.current_gain[bridge],
            warm,
            inertia: inertia[(ring, ring)],
        }
    });
    let pivots = |of: &dyn Fn(&Pivot) -> f64| worst(pivots.iter().map(of));
    let of = |name: String, unit: &str| number(all, "identification", &name, unit);
    let constant_of = |pivot| {
        number(
            all,
            "friction",
            &format!("motor of pivot {pivot}"),
            "V s/rad",
        )
    };
    let friction = plant.ring_friction.coulomb + plant.motor_friction.coulomb;
    let of_friction = |name: &str, unit: &str| number(all, "friction", name, unit);
    let coulomb = of_friction("Coulomb friction", "N m");
    let viscous = of_friction("viscous friction", "N m s/rad");
    vec![
        (
            "R J / K",
            pivots(&|pivot| {
                let found = of(format!("pivot {}: R J / K", pivot.number), "V s^2/rad");
                let ohm = pivot.ohm * pivot.warm * plant.resistance_ohm;
                percent(found, ohm * pivot.inertia / constant)
            }),
        ),
        (
            "K",
            pivots(&|pivot| percent(constant_of(pivot.number), constant)),
        ),
        (
            "R",
            pivots(&|pivot| {
                let found = of(format!("winding of pivot {}", pivot.number), "ohm");
                percent(found, pivot.ohm * plant.resistance_ohm)
            }),
        ),
        (
            "R warm",
            pivots(&|pivot| {
                let found = of(format!("winding of pivot {}", pivot.number), "ohm");
                percent(found, pivot.ohm * pivot.warm * plant.resistance_ohm)
            }),
        ),
        (
            "L",
            pivots(&|pivot| {
                let found = of(format!("winding of pivot {}", pivot.number), "mH");
                percent(found, pivot.ohm * plant.inductance_h * 1e3)
            }),
        ),
        ("friction", percent(coulomb, friction * torque(machine))),
        (
            "total",
            percent(
                coulomb + viscous,
                (friction + plant.ring_friction.viscous) * torque(machine),
            ),
        ),
    ]
}

/// What torques are by the meters, over what they are.
fn torque(machine: &StageParameters) -> f64 {
    let analog = &machine.analog;
    analog.supply_gain * analog.current_gain.iter().sum::<f64>() / 3.0
}

fn mechanics(machine: &StageParameters, all: &[Done]) -> Figures {
    let (plant, (chain, _)) = (&machine.plant, loop_model(machine));
    let square = plant.track_radius_m * plant.track_radius_m;
    let torque = torque(machine);
    let of = |name: &str, unit: &str| number(all, "identification", name, unit);
    // What is in force in the end.
    let part = |name: &str, unit: &str| match number(all, "forces", name, unit) {
        moved if moved.is_nan() => of(name, unit),
        moved => moved,
    };
    let drive = part("inertia of a motor with its ring", "kg m^2");
    let mass = part("mass of platform and load", "kg");
    let inertia = part("inertia of platform and load", "kg m^2");
    let true_drive = chain.motor_inertia + chain.ring_inertia;
    let true_mass = chain.load.mass / square;
    let found = Chain {
        motor_inertia: drive,
        ring_inertia: 0.0,
        load: commissioning::chain::Load {
            mass: mass * square,
            inertia,
            moment: chain.load.moment,
        },
        ..chain
    };
    let at_ring = |chain: &Chain| chain.inertia(&Place::centre())[(0, 0)];
    let resonances = chain.resonances_hz(&Place::centre());
    let off =
        |(number, hz): (usize, &f64)| percent(of(&format!("resonance {}", number + 1), "Hz"), *hz);
    let reached = resonances
        .iter()
        .enumerate()
        .filter(|(_, hz)| **hz < REACHED_HZ);
    vec![
        ("ring", percent(at_ring(&found), at_ring(&chain) * torque)),
        ("drive", percent(drive, true_drive * torque)),
        ("mass", percent(mass, true_mass * torque)),
        ("inertia", percent(inertia, chain.load.inertia * torque)),
        ("ratio", percent(mass / drive, true_mass / true_drive)),
        (
            "resonance",
            resonances
                .iter()
                .enumerate()
                .map(off)
                .next()
                .unwrap_or(f64::NAN),
        ),
        ("resonances", worst(reached.map(off))),
    ]
}

/// Warmth of windings at which gains have to be sound as well, K: they cool while the stage rests, and warm while it works.
const WARMEST_K: f64 = 60.0;

/// What the servos see of the true machine with its windings so much warmer, K by ring; volts are those of the controller's meter. Carriages slide:
/// they hold nothing along their guides.
fn plants(machine: &StageParameters, warmer_k: [f64; 3]) -> Vec<Plant> {
    let (chain, mut electrical) = loop_model(machine);
    for (pivot, drive) in electrical.iter_mut().enumerate() {
        let (ring, _) = ring_and_bridge(machine, pivot);
        drive.resistance_ohm *= 1.0 + machine.plant.winding.resistance_per_k * warmer_k[ring];
    }
    let mut plants = Plant::at_places(&electrical, &chain, &PLACES, &Timing::STAGE);
    for response in plants.iter_mut().flat_map(|plant| &mut plant.response) {
        *response = response.scale(1.0 / machine.analog.supply_gain);
    }
    plants
}

/// The controller's gains before the machine's own plants, with windings as warm as they were when the gains were sought, and the best that a servo of
/// this structure does there: everything known, and no friction that holds the stage off; or the best with what the controller's have to bear besides, every
/// day. And Ms with windings that are cold, and warm.
pub fn gains(machine: &StageParameters, parameters: &Parameters, warmth: &Warmth) -> Figures {
    let at_worst = |parameters: &Parameters, warmer_k: [f64; 3]| {
        let plants = plants(machine, warmer_k);
        let worst = Gains::of(parameters).at_worst(&plants);
        worst.expect("a plant")
    };
    let tuned_k = warmth.tuned.get();
    let mut as_tuned = *machine;
    as_tuned.plant.resistance_ohm *=
        1.0 + machine.plant.winding.resistance_per_k * tuned_k.iter().sum::<f64>() / 3.0;
    let found = at_worst(parameters, tuned_k);
    let best = at_worst(&with_gains_tuned(parameters, &as_tuned), tuned_k);
    let every_day = at_worst(&with_gains_for_every_day(parameters, &as_tuned), tuned_k);
    let [cold, warm] = [0.0, WARMEST_K].map(|warmer_k| at_worst(parameters, [warmer_k; 3]));
    vec![
        ("ms true", found.ms),
        ("s30 true", found.rejection),
        ("s30 best", found.rejection / best.rejection),
        ("s30 every day", found.rejection / every_day.rejection),
        ("ms cold", cold.ms),
        ("ms warm", warm.ms),
    ]
}
