//! Margins that are predicted, against the loop as it is measured: the program's own servo before a simulated machine, a sine added to what
//! an encoder reads, and what the following error makes of it.

use commissioning::chain::{Chain, Place, Uncertainty};
use commissioning::drive_model::Electrical;
use commissioning::record::Timing;
use commissioning::tuning::{
    Gains, Limits, MOST_MS, Margins, PLACES, PivotGains, Plant, SEARCHED, Sought, Tuned, margins,
    sensitivity, tune,
};
use firmware::motion::{Constraints, plan_line};
use firmware::parameters::{self, Parameters};
use firmware::queues::{Command, Queues};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::loop_model;
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use hal_sim::rig::with_payload_told;
use nalgebra::Complex;
use std::f64::consts::TAU;

const TIMING: Timing = Timing::STAGE;
const WINDOW: usize = 4096;
/// Bins of a window whose frequencies are tried: 34 Hz to 1.9 kHz.
const BINS: [usize; 24] = [
    7, 10, 14, 20, 27, 34, 41, 48, 55, 62, 70, 80, 92, 106, 122, 142, 166, 194, 226, 258, 290, 320,
    350, 390,
];

struct Point {
    hz: f64,
    /// Answer of pivot 1's following error to what its encoder reads too much.
    measured: Complex<f64>,
    /// Where the platform was, along its own axes, track radii.
    place: [f64; 2],
}

/// S of pivot 1 on a stage that turns slowly, so that friction is what it is in motion.
fn measure(stage: &StageParameters, parameters: &Parameters, x_m: f64) -> Vec<Point> {
    let mut parameters = parameters.clone();
    parameters.limits.turn_speed_deg_s = 4.0;
    parameters.supervision.oscillation_v = 120.0;
    // What is learnt is not in the model.
    parameters.servo.learning = 0.0;
    let mut queues = Queues::new();
    let (mut tick_queues, mut commands) = queues.split();
    let mut host = Host::new(stage, &parameters);
    host.stage.set_pose_at_rest([x_m, 0.0, 0.0]);
    let mut record = TickRecord::default();
    let mut run = |host: &mut Host, record: &mut TickRecord, ticks: usize| {
        for _ in 0..ticks {
            host.tick(&mut tick_queues, record);
            assert!(host.fault().is_none(), "{:?}", host.fault());
        }
    };
    run(&mut host, &mut record, 20);
    assert!(commands.send(Command::Reference).is_ok());
    run(&mut host, &mut record, 2_000);
    let from = record
        .sample
        .as_ref()
        .expect("a tick has run")
        .reference_point
        .position;
    let to = [from[0], from[1], from[2] + (10.0 * 4_294_967_296.0) as i64];
    let constraints = Constraints::new(parameters.limits, parameters.geometry);
    let plan = plan_line(1, from, to, &constraints).expect("in place");
    assert!(commands.send_plan(&plan).is_ok());
    run(&mut host, &mut record, 10_000);
    let mut points = Vec::new();
    for bin in BINS {
        let hz = bin as f64 / (WINDOW as f64 * TIMING.tick_s);
        let size_rad = f64::min(20e-6, 4e-3 / hz);
        let mut sum = Complex::default();
        let settle = 1_000;
        for tick in 0..settle + WINDOW {
            let phase = |tick: usize| TAU * ((bin * tick) % WINDOW) as f64 / WINDOW as f64;
            host.stage.encoders[0].set_offset(size_rad * phase(tick).sin());
            run(&mut host, &mut record, 1);
            if tick >= settle {
                let sample = record.sample.as_ref().expect("a tick has run");
                let error_rad = (sample.pivots[0] - sample.pivot_setpoints[0]).units() as f64 * TAU
                    / 4_294_967_296.0;
                // What this tick read was latched, and offset, in the period before.
                let read = phase(tick - 1);
                let window = 1.0 - (TAU * (tick - settle) as f64 / WINDOW as f64).cos();
                sum += Complex::new(read.sin(), read.cos()) * (window * error_rad);
            }
        }
        let [x, y, theta] = host.stage.plant.pose();
        let (sin, cos) = theta.sin_cos();
        points.push(Point {
            hz,
            measured: sum * (2.0 / WINDOW as f64 / size_rad),
            place: [(x * cos + y * sin) / 0.1, (y * cos - x * sin) / 0.1],
        });
    }
    host.stage.encoders[0].set_offset(0.0);
    points
}

/// Frequency, and the sensitivity there, measured and predicted.
type Pair = (f64, Complex<f64>, Complex<f64>);

struct Compared {
    /// Worst and typical distance of the sensitivities, over the larger of measured size and a half.
    worst: f64,
    median: f64,
    predicted: Margins,
    /// Largest sizes of S of pivot 1, measured and predicted, at the same frequencies.
    largest: [f64; 2],
    /// Highest frequencies at which `|1/S - 1|` is 1, measured and predicted, between the frequencies.
    crossovers_hz: [f64; 2],
}

fn compare(stage: &StageParameters, parameters: &Parameters, x_m: f64, print: &str) -> Compared {
    let (chain, electrical) = loop_model(stage);
    let gains = Gains::of(parameters);
    let points = measure(stage, parameters, x_m);
    let (mut off, mut sizes) = (Vec::new(), Vec::new());
    for point in &points {
        let place = Place::new(point.place[0], point.place[1]).expect("inside");
        let plant = Plant::from_model(&electrical, &chain, &place, &TIMING);
        // The grid is fine enough for a line between its points.
        let all = sensitivity(&plant, &gains);
        let k = plant.hz.partition_point(|&hz| hz < point.hz);
        let part = (point.hz - plant.hz[k - 1]) / (plant.hz[k] - plant.hz[k - 1]);
        let predicted = all[k - 1][(0, 0)] * (1.0 - part) + all[k][(0, 0)] * part;
        off.push((predicted - point.measured).norm() / point.measured.norm().max(0.5));
        sizes.push((point.hz, point.measured, predicted));
    }
    let crossover = |value: fn(&Pair) -> Complex<f64>| {
        let gain = |k: usize| (1.0 / value(&sizes[k]) - 1.0).norm().ln();
        let last = (1..sizes.len())
            .rev()
            .find(|&k| gain(k - 1) >= 0.0 && gain(k) < 0.0)
            .expect("it crosses");
        let part = gain(last - 1) / (gain(last - 1) - gain(last));
        sizes[last - 1].0 * (sizes[last].0 / sizes[last - 1].0).powf(part)
    };
    let crossovers_hz = [crossover(|point| point.1), crossover(|point| point.2)];
    let largest = [
        sizes.iter().map(|point| point.1.norm()).fold(0.0, f64::max),
        sizes.iter().map(|point| point.2.norm()).fold(0.0, f64::max),
    ];
    off.sort_by(f64::total_cmp);
    let place = Place::new(points[0].place[0], points[0].place[1]).expect("inside");
    let predicted = margins(
        &Plant::from_model(&electrical, &chain, &place, &TIMING),
        &gains,
    );
    let found = Compared {
        worst: off[off.len() - 1],
        median: off[off.len() / 2],
        predicted,
        largest,
        crossovers_hz,
    };
    println!(
        "{print}: S off by {:.3} in the middle, {:.3} at worst; largest {:.2} measured, {:.2} predicted; crossover {:.0} and {:.0} Hz; all three: Ms {:.2} at {:.0} Hz, S(30 Hz) {:.4}, stable {}",
        found.median,
        found.worst,
        largest[0],
        largest[1],
        crossovers_hz[0],
        crossovers_hz[1],
        predicted.ms,
        predicted.ms_hz,
        predicted.rejection,
        predicted.is_stable
    );
    found
}

fn machine(payload_kg: f64) -> (StageParameters, Parameters) {
    let options = RunOptions {
        mismatch_percent: 0.0,
        payload_kg,
        ..RunOptions::default()
    };
    let stage = stage_parameters(&options);
    let parameters = with_payload_told(&controller_parameters(&options), &stage);
    (stage, parameters)
}

#[test]
fn predicted_loops_are_those_that_the_program_has() {
    for (payload_kg, x_m) in [(0.0, 0.0), (5.0, 0.0), (5.0, 0.076)] {
        let (stage, parameters) = machine(payload_kg);
        let found = compare(
            &stage,
            &parameters,
            x_m,
            &format!("as it comes, {payload_kg} kg, {x_m} m"),
        );
        found.holds();
        // Beside the resonance the play in the gears softens it.
        assert!(found.median < 0.032 && found.worst < 0.28);
    }
}

/// Gains for plants of a model, scheduled for what it carries in the middle.
fn tuned(
    [found, may_be]: [&[Plant]; 2],
    model: &(Chain, [Electrical; 3]),
    limits: &Limits,
) -> Tuned {
    let elsewhere = &[];
    let sought = Sought {
        found,
        may_be,
        elsewhere,
    };
    sought_for(sought, model, limits)
}

fn sought_for(
    sought: Sought<'_>,
    (chain, electrical): &(Chain, [Electrical; 3]),
    limits: &Limits,
) -> Tuned {
    let centre = Place::centre();
    let (resonances_hz, inertia) = (chain.resonances_hz(&centre), chain.inertia(&centre)[(0, 0)]);
    tune(sought, electrical, &resonances_hz, inertia, limits).expect("there are gains")
}

#[test]
fn tuned_gains_give_the_margins_that_were_promised() {
    let (mut stage, parameters) = machine(0.0);
    // Guides that give way: the platform swings on them at some 800 Hz.
    stage.plant.imperfections.guide_compliance = true;
    let (chain, electrical) = loop_model(&stage);
    let plants: Vec<_> = [(0.0, 0.0), (0.7, 0.0), (-0.35, 0.6), (-0.35, -0.6)]
        .map(|(x, y)| {
            Plant::from_model(
                &electrical,
                &chain,
                &Place::new(x, y).expect("inside"),
                &TIMING,
            )
        })
        .into();
    let tuned = tuned([&plants, &[]], &(chain, electrical), &Limits::USUAL);
    println!("{tuned:.3?}");
    let found = compare(&stage, &tuned.gains.applied_to(&parameters), 0.0, "tuned");
    found.holds();
    // These gains reach further up, 180 Hz, than those for which the second bound was 0.16.
    assert!(found.median < 0.0154 && found.worst < 0.178);
    // What was asked for.
    assert!(
        tuned.margins.ms <= 1.9 && tuned.margins.resonance_peak <= 0.5 && tuned.margins.is_stable
    );
    assert!(
        tuned.margins.rejection < 0.0514,
        "{}",
        tuned.margins.rejection
    );
}

/// Springs that may be 5 % off, and dampers of 0.7 and of half of what was found.
fn uncertainty() -> Uncertainty {
    Uncertainty {
        stiffness: 1.05_f64.ln(),
        damping: 2.0_f64.ln(),
        guide_stiffness: 1.05_f64.ln(),
        guide_damping: -0.7_f64.ln(),
    }
}

/// With springs so many times as stiff, dampers of 0.7, and the transmission's so many times as strong.
fn off(chain: &Chain, springs: f64, transmission_dampers: f64) -> Chain {
    Chain {
        stiffness: springs * chain.stiffness,
        damping: transmission_dampers * chain.damping,
        guide_stiffness: springs * chain.guide_stiffness,
        guide_damping: 0.7 * chain.guide_damping,
        ..*chain
    }
}

/// Gains for a model whose springs may be off keep their margins where they are, those for the model as it stands do not.
#[test]
fn gains_for_an_uncertain_model_bear_springs_that_are_off() {
    let stage = hal_sim::machine::unknown(24);
    let (chain, electrical) = loop_model(&stage);
    let places = &PLACES[..SEARCHED];
    let at_places = |chain: &Chain| Plant::at_places(&electrical, chain, places, &TIMING);
    let found = at_places(&chain);
    let at_worst = |as_it_may_be: &[Plant]| {
        let model = (chain, electrical);
        let tuned = tuned([&found, as_it_may_be], &model, &Limits::WITH_FRICTION);
        let off = [0.95, 0.97, 0.99, 1.01, 1.03, 1.05].map(|springs| {
            let off = at_places(&off(&chain, springs, 0.7));
            let worst = (tuned.gains.at_worst(&off)).expect("a plant");
            assert!(worst.is_stable);
            worst.ms
        });
        off.into_iter().fold(0.0, f64::max)
    };
    let certain = at_worst(&[]);
    let may_be = chain.as_it_may_be(&uncertainty());
    let uncertain = at_worst(&may_be.map(|chain| at_places(&chain)).concat());
    println!("Ms for the model as it stands {certain:.2}, as it may be {uncertain:.2}");
    assert!(uncertain < MOST_MS && certain > MOST_MS);
}

/// A winding that is warm at work makes the loop slower and not its integral: gains that are sought with warm ones as well keep Ms there.
#[test]
fn gains_bear_windings_that_are_warm_at_work() {
    let (chain, electrical) = loop_model(&hal_sim::machine::unknown(34));
    let at_work = (electrical.each_ref()).map(Electrical::at_work);
    let plants = |electrical| Plant::at_places(electrical, &chain, &PLACES[..SEARCHED], &TIMING);
    let [found, warm] = [&electrical, &at_work].map(plants);
    let ms_at_work = |may_be: &[Plant]| {
        let tuned = tuned(
            [&found, may_be],
            &(chain, electrical),
            &Limits::WITH_FRICTION,
        );
        (tuned.gains.at_worst(&warm)).expect("a plant").ms
    };
    let (without, with) = (ms_at_work(&[]), ms_at_work(&warm));
    println!("Ms with windings that are warm at work {without:.2}, with gains for them {with:.2}");
    assert!(with <= MOST_MS && without > MOST_MS);
}

/// Where the figures of the searches below are known: in the middle, and 0.7 of the track's radius out, 30 degrees beside the guides.
const BESIDE: [[f64; 2]; 4] = [[0.0, 0.0], [0.7, 0.0], [-0.35, 0.6], [-0.35, -0.6]];

/// S(30 Hz) of the best that searches of ten times the effort and from four times the starts have found: a search may miss a valley, and this machine's
/// lie apart.
#[test]
fn a_search_finds_what_longer_ones_find() {
    const LONGEST: f64 = 0.0595;
    let (chain, electrical) = loop_model(&hal_sim::machine::unknown(10));
    let found = Plant::at_places(&electrical, &chain, &BESIDE[..2], &TIMING);
    let tuned = tuned([&found, &[]], &(chain, electrical), &Limits::ON_MODEL);
    let over = tuned.margins.rejection / LONGEST;
    println!("S(30 Hz) over that of longer searches {over:.3}");
    assert!(over < 1.06);
}

/// A load that is off the centre: where gains for two places do not keep Ms at the others, they are sought there as well, and reject more than
/// slower ones of the same shape.
#[test]
fn gains_are_for_places_that_were_not_searched_as_well() {
    let (chain, electrical) = loop_model(&hal_sim::machine::unknown(9));
    let at = |places: &[[f64; 2]]| {
        let of = |chain: &Chain| Plant::at_places(&electrical, chain, places, &TIMING);
        [
            of(&chain),
            [0.95, 1.05]
                .map(|springs| of(&off(&chain, springs, 0.5)))
                .concat(),
        ]
    };
    let [found, may_be] = &at(&BESIDE[..2]);
    let elsewhere = at(&BESIDE[2..]).concat();
    let all = [found, may_be, &elsewhere[..]].concat();
    let ms_and_rejection = |elsewhere: &[Plant]| {
        let sought = Sought {
            found,
            may_be,
            elsewhere,
        };
        let gains = sought_for(sought, &(chain, electrical), &Limits::WITH_FRICTION).gains;
        let margins = gains.at_worst(&all).expect("a plant");
        let slowed = gains.slowed_until_sound(&all, MOST_MS);
        (margins.ms, slowed.expect("gains").1.rejection)
    };
    let (without, with) = (ms_and_rejection(&[]), ms_and_rejection(&elsewhere));
    println!("Ms, and S(30 Hz) once slowed: {without:.3?}, with all places {with:.3?}");
    assert!(without.0 > MOST_MS && with.0 < MOST_MS);
    assert!(with.1 < 0.71 * without.1);
    // 0.139 and a tenth more.
    assert!(with.1 < 0.153);
}

impl Compared {
    /// Crossover and the largest S of a pivot, as predicted, within 2 and 3 %.
    fn holds(&self) {
        let [measured, predicted] = self.largest;
        assert!((predicted / measured - 1.0).abs() < 0.03);
        let [measured, predicted] = self.crossovers_hz;
        assert!((predicted / measured - 1.0).abs() < 0.02);
        assert!(self.predicted.is_stable);
    }
}

/// A double integrator with one gain has a sensitivity in closed form: Nyquist's criterion has to say when it is unstable, and only then.
#[test]
fn stability_is_that_of_the_characteristic_polynomial() {
    // Held for a tick, read at its end: (z + 1) T^2 / 2 (z - 1)^2, three times without coupling. With r = e' + a e and a velocity gain alone the
    // closed loop is z (z - 1)^2 + g (z + 1) (z - b) = 0 with g = K T / 2 (1 + a T), b = 1 / (1 + a T).
    let t = 1e-3;
    let timing = Timing {
        tick_s: t,
        duty_s: 0.0,
        angle_s: 0.0,
        current_s: 0.0,
    };
    for (gain, corner) in [
        (100.0, 50.0),
        (400.0, 50.0),
        (800.0, 20.0),
        (1_000.0, 20.0),
        (1_500.0, 20.0),
        (3_000.0, 100.0),
        (50.0, 900.0),
    ] {
        let hz = commissioning::tuning::grid(&timing);
        let response = hz
            .iter()
            .map(|&hz| {
                let z = Complex::cis(TAU * hz * t);
                nalgebra::Matrix3::identity()
                    * ((z + 1.0) * (0.5 * t * t) / ((z - 1.0) * (z - 1.0)))
            })
            .collect();
        let mut plant = Plant::new(hz, response, [1.0; 3], true, t);
        let pivot = PivotGains {
            gains: parameters::Gains {
                velocity_v_s_rad: gain,
                position_1_s: corner,
                integral_v_rad: 0.0,
            },
            filters: parameters::FeedbackFilters::NONE,
        };
        let gains = Gains {
            pivots: [pivot; 3],
            scheduled_inertia_kg_m2: 0.0,
        };
        let found = margins(&plant, &gains);
        let (g, b) = (
            0.5 * gain * t * (1.0 + corner * t),
            1.0 / (1.0 + corner * t),
        );
        // z^3 + (g - 2) z^2 + (1 + g (1 - b)) z - g b: inside the circle by Jury's conditions.
        let [a2, a1, a0] = [g - 2.0, 1.0 + g * (1.0 - b), -g * b];
        let is_stable = 1.0 + a2 + a1 + a0 > 0.0
            && 1.0 - a2 + a1 - a0 > 0.0
            && a0.abs() < 1.0
            && (a0 * a0 - 1.0).abs() > (a0 * a2 - a1).abs();
        assert_eq!(found.is_stable, is_stable, "{gain} {corner}: {found:?}");
        // A loop of which a frequency is not known is none that is stable.
        plant.response[100][(0, 0)] = Complex::from(f64::NAN);
        assert!(!margins(&plant, &gains).is_stable, "{gain} {corner}");
    }
}

/// Machine 10 has a resonance that is held at high gains and not at half of them: 0.061, and a tenth more. Halving a range of gains ends at 0.71.
#[test]
fn gains_beyond_those_that_keep_no_margins_are_found() {
    let (chain, electrical) = loop_model(&hal_sim::machine::unknown(10));
    let plants = Plant::at_places(&electrical, &chain, &BESIDE[..2], &TIMING);
    let tuned = tuned([&plants, &[]], &(chain, electrical), &Limits::ON_MODEL);
    println!("{:?}", tuned.margins);
    assert!(tuned.margins.rejection < 0.0675);
}
