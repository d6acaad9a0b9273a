//! The loop as it is measured, and what a push does, as tables: `cargo bench -p hal-sim --bench loop`.
//!
//! The stage turns slowly, so that friction is what it is in motion. A sine is added to what an encoder reads, frequency by frequency;
//! what the following error makes of it is the sensitivity S, and the loop is L = 1 / S - 1: a property of the simulated machine
//! and the program, without any equation of the plant. Crossover is the highest frequency at which |L| is 1, Ms the largest |S|.
//! A push is a torque of 1 N m on a ring of a stage at rest, with the full loop and after rest mode.
//!
//! Then Ms of each pivot over the disk, with and without a load. The body couples the three loops: what a sine on one encoder makes of all
//! three errors is a column of a matrix, whose largest singular value is what the worst combination of the three encoders' sines is raised
//! by. The diagonal alone would miss a combination that no single pivot shows.

use firmware::motion::{Constraints, plan_line};
use firmware::parameters::{Lead, Notch, Parameters};
use firmware::queues::{Command, Queues, TickQueues};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::External;
use hal_sim::parallel::{cores, of_all};
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use hal_sim::rig::{with_gains_firmer, with_inertia_scheduled, with_payload_told};
use std::f64::consts::TAU;

const RATE_HZ: f64 = 20_000.0;
const UNIT: f64 = 4_294_967_296.0;
const UNITS_PER_LSB: f64 = 64.0;
const LSB_RAD: f64 = TAU / 67_108_864.0;
/// Amplitude of the sine, rad.
const SINE_RAD: f64 = 2e-6;
/// The largest radius at which the reference motion works.
const RIM_MM: f64 = 76.0;
/// Places on the rim.
const RIM_PLACES: u32 = 5;

/// Frequencies that are measured one after the other.
struct Sweep {
    from_hz: f64,
    to_hz: f64,
    /// From one to the next.
    ratio: f64,
    /// Ticks before and while a sine is measured: whole periods of it, at least these.
    settle_ticks: u64,
    sine_ticks: f64,
}

/// All that a loop does. Meanwhile the stage turns by 150 deg.
const WIDE: Sweep = Sweep {
    from_hz: 20.0,
    to_hz: 3_000.0,
    ratio: 1.04,
    settle_ticks: 2_000,
    sine_ticks: 4_000.0,
};
/// Where |S| is largest, while the stage turns by 25 deg: what the guides' directions are is nearly the same all the time.
const AROUND_MS: Sweep = Sweep {
    from_hz: 80.0,
    to_hz: 1_600.0,
    ratio: 1.08,
    settle_ticks: 1_000,
    sine_ticks: 2_000.0,
};

/// A machine, where it stands, and its loop.
#[derive(Clone, Copy)]
struct Case {
    words: &'static str,
    payload_kg: f64,
    place_mm: [f64; 2],
    resonance_hz: f64,
    tuning: Tuning,
}

/// A complex number.
type Complex = [f64; 2];
/// S at a frequency: what a sine on the encoder of the second index makes of the error of the first.
type Matrix = [[Complex; 3]; 3];

#[derive(Clone, Copy)]
struct Gains {
    velocity_v_s_rad: f64,
    position_1_s: f64,
    integral_1_s: f64,
}

const SHAPED: Tuning = Tuning::Shaped(Gains {
    velocity_v_s_rad: 43.6,
    position_1_s: 650.0,
    integral_1_s: 720.0,
});
/// For a load of 5 kg: what a ring moves is another part of it in every place, and the resonance comes closer.
const SHAPED_FOR_LOAD: Tuning = Tuning::Shaped(Gains {
    velocity_v_s_rad: 33.0,
    position_1_s: 520.0,
    integral_1_s: 560.0,
});

#[derive(Clone, Copy)]
enum Tuning {
    Reference,
    /// Faster, with a notch at the resonance, a lead over the winding's corner, and gains scheduled by the inertia.
    Shaped(Gains),
    /// Told of the machine, scheduled, and firmer: what the told table is of.
    Firmer,
    /// For a soft transmission: half the velocity gain, and a notch.
    Soft,
}

fn main() {
    let case = |words, payload_kg, x_mm, resonance_hz, tuning| Case {
        words,
        payload_kg,
        place_mm: [x_mm, 0.0],
        resonance_hz,
        tuning,
    };
    let reference = Tuning::Reference;
    let cases = [
        case("as it comes, centre", 0.0, 0.0, 1_500.0, reference),
        case("as it comes, 76 mm out", 0.0, RIM_MM, 1_500.0, reference),
        case(
            "as it comes, 5 kg told, centre",
            5.0,
            0.0,
            1_500.0,
            reference,
        ),
        case(
            "as it comes, 5 kg told, 76 mm out",
            5.0,
            RIM_MM,
            1_500.0,
            reference,
        ),
        case("shaped, centre", 0.0, 0.0, 1_500.0, SHAPED),
        case("shaped, 76 mm out", 0.0, RIM_MM, 1_500.0, SHAPED),
        case(
            "shaped, 5 kg told, centre",
            5.0,
            0.0,
            1_500.0,
            SHAPED_FOR_LOAD,
        ),
        case(
            "shaped, 5 kg told, 76 mm out",
            5.0,
            RIM_MM,
            1_500.0,
            SHAPED_FOR_LOAD,
        ),
        case(
            "resonance at 600 Hz, notch, half the gain",
            0.0,
            0.0,
            600.0,
            Tuning::Soft,
        ),
    ];
    println!(
        "| loop | crossover of pivot 1, Hz | Ms at, Hz | S at 30 Hz | push of 1 N m, LSB, back within ms | the same in rest mode |"
    );
    println!("|---|---|---|---|---|---|");
    for row in of_all(&cases, cores(), Case::row) {
        println!("{row}");
    }
    println!();
    print_over_the_disk();
}

/// Ms of each pivot, place by place, and the worst of each loop.
fn print_over_the_disk() {
    let loops = [
        ("as it comes", 0.0, Tuning::Reference),
        ("as it comes, 5 kg told", 5.0, Tuning::Reference),
        ("told, firmer", 0.0, Tuning::Firmer),
        ("told, firmer, 5 kg", 5.0, Tuning::Firmer),
        ("shaped", 0.0, SHAPED),
        ("shaped, 5 kg told", 5.0, SHAPED_FOR_LOAD),
    ];
    let rim = (0..RIM_PLACES).map(|k| 360.0 / f64::from(RIM_PLACES) * f64::from(k));
    let places: Vec<Option<f64>> = std::iter::once(None).chain(rim.map(Some)).collect();
    let cases: Vec<Case> = (loops.iter())
        .flat_map(|&(words, payload_kg, tuning)| {
            places.iter().map(move |place| Case {
                words,
                payload_kg,
                place_mm: place.map_or([0.0; 2], |angle_deg| {
                    let (sin, cos) = angle_deg.to_radians().sin_cos();
                    [RIM_MM * cos, RIM_MM * sin]
                }),
                resonance_hz: 1_500.0,
                tuning,
            })
        })
        .collect();
    let peaks = of_all(&cases, cores(), Case::peaks);
    println!(
        "| loop | place | Ms of pivot 1 at, Hz | of pivot 2 | of pivot 3 | all three encoders together |"
    );
    println!("|---|---|---|---|---|---|");
    let told = |peak: &Peak| format!("{:.2} at {:.0}", peak.size, peak.hz);
    let word = |place: &Option<f64>| {
        place.map_or("centre".to_owned(), |angle_deg| {
            format!("{RIM_MM} mm out at {angle_deg} deg")
        })
    };
    for (case, (place, peaks)) in cases.iter().zip(places.iter().cycle().zip(&peaks)) {
        let peaks = peaks.each_ref().map(told).join(" | ");
        println!("| {} | {} | {peaks} |", case.words, word(place));
    }
    println!();
    for (of, (words, ..)) in peaks.chunks(places.len()).zip(loops) {
        let largest = |whose: std::ops::Range<usize>| {
            let of_places = of.iter().zip(&places);
            of_places
                .flat_map(|(peaks, place)| {
                    (peaks.iter().enumerate())
                        .filter(|(i, _)| whose.contains(i))
                        .map(move |(i, peak)| (i, peak, place))
                })
                .max_by(|a, b| a.1.size.total_cmp(&b.1.size))
                .expect("there are places")
        };
        let (pivot, one, place) = largest(0..3);
        let (_, all, all_place) = largest(3..4);
        println!(
            "{words}: worst of a pivot {}, pivot {}, {}; of all together {}, {}",
            told(one),
            pivot + 1,
            word(place),
            told(all),
            word(all_place)
        );
    }
}

/// The largest value, and at which frequency it is.
#[derive(Clone, Copy, Default)]
struct Peak {
    hz: f64,
    size: f64,
}

impl Peak {
    fn of(values: impl Iterator<Item = (f64, f64)>) -> Self {
        values
            .map(|(hz, size)| Self { hz, size })
            .max_by(|a, b| a.size.total_cmp(&b.size))
            .unwrap_or_default()
    }
}

/// The largest singular value: the root of the largest eigenvalue of S^H S, by its powers.
fn largest_singular_value(matrix: &Matrix) -> f64 {
    // No eigenvector of these three would be at a right angle to that but by chance.
    let mut vector: [Complex; 3] = [[1.0, 0.3], [-0.7, 0.2], [0.4, -0.9]];
    let mut square = 0.0;
    for _ in 0..200 {
        let mut image = [[0.0; 2]; 3];
        for (row, image) in matrix.iter().zip(&mut image) {
            for ([a, b], [c, d]) in row.iter().zip(&vector) {
                image[0] += a * c - b * d;
                image[1] += a * d + b * c;
            }
        }
        let mut back = [[0.0; 2]; 3];
        for (row, [c, d]) in matrix.iter().zip(&image) {
            for ([a, b], back) in row.iter().zip(&mut back) {
                back[0] += a * c + b * d;
                back[1] += a * d - b * c;
            }
        }
        let size = |vector: &[Complex; 3]| {
            (vector.iter().map(|[re, im]| re * re + im * im).sum::<f64>()).sqrt()
        };
        square = size(&back) / size(&vector);
        let length = size(&back);
        vector = back.map(|value| value.map(|part| part / length));
    }
    square.sqrt()
}

impl Case {
    fn parameters(&self) -> (StageParameters, Parameters) {
        let options = RunOptions {
            mismatch_percent: 0.0,
            payload_kg: self.payload_kg,
            ..RunOptions::default()
        };
        let mut stage = stage_parameters(&options);
        let softer = self.resonance_hz / 1_500.0;
        stage.plant.transmission_stiffness_n_m_rad *= softer * softer;
        stage.plant.transmission_damping_n_m_s_rad *= softer;
        let mut parameters = controller_parameters(&options);
        // Slowly round: 4 deg/s.
        parameters.limits.turn_speed_deg_s = 4.0;
        // The sine is none of its own.
        parameters.supervision.oscillation_v = 120.0;
        parameters = with_payload_told(&parameters, &stage);
        if matches!(self.tuning, Tuning::Firmer) {
            parameters = with_gains_firmer(&parameters);
        }
        let servo = &mut parameters.servo;
        // With what the platform weighs at a ring, from nothing to all of it and a load, the resonance is between 0.9 and 1.15 times
        // what it is for the slowest mode in the centre.
        let notch = |part: f64| Notch {
            frequency_hz: self.resonance_hz * part,
            width_hz: self.resonance_hz * 0.3,
            gain: 0.3,
        };
        let notches = [notch(0.95), notch(1.12)];
        for (gains, filters) in servo.gains.iter_mut().zip(&mut servo.filters) {
            match self.tuning {
                Tuning::Reference | Tuning::Firmer => {}
                Tuning::Shaped(shaped) => {
                    gains.velocity_v_s_rad = shaped.velocity_v_s_rad;
                    gains.position_1_s = shaped.position_1_s;
                    gains.integral_v_rad = shaped.velocity_v_s_rad * shaped.integral_1_s;
                    filters.notches = notches;
                    filters.lead = Lead {
                        from_hz: 2.1 / 0.7e-3 / TAU,
                        to_hz: 3_000.0,
                    };
                }
                Tuning::Soft => {
                    gains.velocity_v_s_rad *= 0.5;
                    gains.integral_v_rad *= 0.25;
                    gains.position_1_s *= 0.5;
                    filters.notches = notches;
                }
            }
        }
        if matches!(self.tuning, Tuning::Shaped(_) | Tuning::Firmer) {
            parameters = with_inertia_scheduled(&parameters);
        }
        (stage, parameters)
    }

    fn row(&self) -> String {
        let (stage, mut parameters) = self.parameters();
        let sensitivities: Vec<(f64, Complex)> = (self.columns(&stage, &parameters, 0, &WIDE))
            .into_iter()
            .map(|(hz, [own, ..])| (hz, own))
            .collect();
        let crossover_hz = (sensitivities.iter().rev())
            .find(|(_, [re, im])| {
                // |L| = |1 - S| / |S|.
                (1.0 - re).hypot(*im) >= re.hypot(*im)
            })
            .map_or(f64::NAN, |(hz, _)| *hz);
        let most = Peak::of((sensitivities.iter()).map(|(hz, [re, im])| (*hz, re.hypot(*im))));
        let low = sensitivities
            .iter()
            .find(|(hz, _)| *hz >= 30.0)
            .map_or(f64::NAN, |(_, [re, im])| re.hypot(*im));
        let rested = push(&stage, &parameters, self.place_mm);
        parameters.servo.rest.stiffness = 1.0;
        let full = push(&stage, &parameters, self.place_mm);
        format!(
            "| {} | {crossover_hz:.0} | {:.2} at {:.0} | {low:.3} | {full} | {rested} |",
            self.words, most.size, most.hz
        )
    }

    /// Ms of each pivot, and the largest singular value.
    fn peaks(&self) -> [Peak; 4] {
        let (stage, parameters) = self.parameters();
        let columns = [0, 1, 2].map(|pivot| self.columns(&stage, &parameters, pivot, &AROUND_MS));
        let own = [0, 1, 2].map(|pivot: usize| {
            Peak::of(columns[pivot].iter().map(|(hz, column)| {
                let [re, im] = column[pivot];
                (*hz, re.hypot(im))
            }))
        });
        let matrices = (0..columns[0].len()).map(|k| {
            let matrix = [0, 1, 2]
                .map(|row: usize| [0, 1, 2].map(|column: usize| columns[column][k].1[row]));
            (columns[0][k].0, largest_singular_value(&matrix))
        });
        let [first, second, third] = own;
        [first, second, third, Peak::of(matrices)]
    }

    /// What a sine on a pivot's encoder makes of all errors, frequency by frequency.
    fn columns(
        &self,
        stage: &StageParameters,
        parameters: &Parameters,
        pivot: usize,
        sweep: &Sweep,
    ) -> Vec<(f64, [Complex; 3])> {
        let mut queues = Queues::new();
        let (mut tick_queues, mut commands) = queues.split();
        let mut bench = Bench::at(stage, parameters, self.place_mm, &mut tick_queues);
        let from = bench.referenced(&mut commands);
        let to = [
            from[0],
            from[1],
            from[2] + (60.0 / 360.0 * 60.0 * UNIT) as i64,
        ];
        let constraints = Constraints::new(parameters.limits, parameters.geometry);
        let plan = plan_line(1, from, to, &constraints).expect("in place");
        assert!(commands.send_plan(&plan).is_ok(), "room");
        bench.run(20_000);
        let mut columns = Vec::new();
        let mut hz = sweep.from_hz;
        while hz < sweep.to_hz {
            // Whole periods.
            let periods = (sweep.sine_ticks * hz / RATE_HZ).ceil();
            let ticks = (periods * RATE_HZ / hz).round();
            let exact_hz = periods * RATE_HZ / ticks;
            let column = bench.column(pivot, exact_hz, sweep.settle_ticks, ticks as u64);
            columns.push((exact_hz, column));
            hz *= sweep.ratio;
        }
        columns
    }
}

struct Bench<'a, 'q> {
    host: Host,
    record: TickRecord,
    queues: &'a mut TickQueues<'q>,
}

impl<'a, 'q> Bench<'a, 'q> {
    fn at(
        stage: &StageParameters,
        parameters: &Parameters,
        [x_mm, y_mm]: [f64; 2],
        queues: &'a mut TickQueues<'q>,
    ) -> Self {
        let mut host = Host::new(stage, parameters);
        (host.stage).set_pose_at_rest([x_mm * 1e-3, y_mm * 1e-3, 0.0]);
        Self {
            host,
            record: TickRecord::default(),
            queues,
        }
    }

    fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.tick();
        }
    }

    fn tick(&mut self) {
        self.host.tick(self.queues, &mut self.record);
        assert!(self.host.fault().is_none(), "{:?}", self.host.fault());
    }

    fn referenced(&mut self, commands: &mut firmware::queues::CommandQueues<'_>) -> [i64; 3] {
        self.run(20);
        assert!(commands.send(Command::Reference).is_ok(), "room");
        self.run(2_000);
        self.record
            .sample
            .as_ref()
            .expect("a tick has run")
            .reference_point
            .position
    }

    /// Following error of a pivot, LSB.
    fn error_lsb(&self, pivot: usize) -> f64 {
        let sample = self.record.sample.as_ref().expect("a tick has run");
        (sample.pivots[pivot] - sample.pivot_setpoints[pivot]).units() as f64 / UNITS_PER_LSB
    }

    fn column(&mut self, pivot: usize, hz: f64, settle_ticks: u64, ticks: u64) -> [Complex; 3] {
        let mut sums = [[0.0; 2]; 3];
        for tick in 0..settle_ticks + ticks {
            // What is set now is latched later in this period and read by the next tick.
            let phase = TAU * hz * tick as f64 / RATE_HZ;
            self.host.stage.encoders[pivot].set_offset(SINE_RAD * phase.sin());
            if let Some(measured) = tick.checked_sub(settle_ticks) {
                // Read in this tick's sample: what was set a tick ago. The sample shown is the tick's before, so its offset was set two
                // ticks ago.
                let shown = phase - 2.0 * TAU * hz / RATE_HZ;
                // Ripple is near, and no whole number of its periods: rising and falling weights keep it out.
                let weight = 1.0 - (TAU * measured as f64 / ticks as f64).cos();
                for (i, [sine, cosine]) in sums.iter_mut().enumerate() {
                    let error = weight * self.error_lsb(i) * LSB_RAD;
                    *sine += error * shown.sin();
                    *cosine += error * shown.cos();
                }
            }
            self.tick();
        }
        self.host.stage.encoders[pivot].set_offset(0.0);
        sums.map(|sum| sum.map(|sum| sum * 2.0 / ticks as f64 / SINE_RAD))
    }
}

/// Peak and the time after which the error stays within 2.5 LSB, of the mean over a millisecond.
fn push(stage: &StageParameters, parameters: &Parameters, place_mm: [f64; 2]) -> String {
    let mut queues = Queues::new();
    let (mut tick_queues, mut commands) = queues.split();
    let mut bench = Bench::at(stage, parameters, place_mm, &mut tick_queues);
    bench.referenced(&mut commands);
    bench.run(60_000);
    bench.host.stage.plant.set_external(External {
        ring_torque_n_m: [1.0, 0.0, 0.0],
        ..External::default()
    });
    let (mut peak, mut outside) = (0.0_f64, 0);
    let mut last = std::collections::VecDeque::from([0.0; 20]);
    for tick in 1..=6_000 {
        bench.tick();
        let error = bench.error_lsb(0);
        peak = peak.max(error.abs());
        last.pop_front();
        last.push_back(error);
        if (last.iter().sum::<f64>() / 20.0).abs() > 2.5 {
            outside = tick;
        }
    }
    format!("{peak:.0}, {:.1}", f64::from(outside) / RATE_HZ * 1e3)
}
