//! The loop as it is measured, and what a push does, as tables: `cargo bench -p hal-sim --bench loop`.
//!
//! The stage turns slowly, so that friction is what it is in motion. A sine is added to what an encoder reads, frequency by frequency;
//! what the following error makes of it is the sensitivity S, and the loop is L = 1 / S - 1: a property of the simulated machine
//! and the program, without any equation of the plant. Crossover is the highest frequency at which |L| is 1, Ms the largest |S|.
//! A push is a torque of 1 N m on a ring of a stage at rest, with the full loop and after rest mode.

use firmware::motion::{Constraints, plan_line};
use firmware::parameters::{Lead, Notch, Parameters};
use firmware::queues::{Command, Queues, TickQueues};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::External;
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use hal_sim::rig::{with_inertia_scheduled, with_payload_told};
use std::f64::consts::TAU;

const RATE_HZ: f64 = 20_000.0;
const UNIT: f64 = 4_294_967_296.0;
const UNITS_PER_LSB: f64 = 64.0;
const LSB_RAD: f64 = TAU / 67_108_864.0;
/// Amplitude of the sine, rad.
const SINE_RAD: f64 = 2e-6;
/// Ticks before and while a sine is measured: whole periods of it, at least these.
const SETTLE_TICKS: u64 = 2_000;
const SINE_TICKS: f64 = 4_000.0;

/// A machine, where it stands, and its loop.
struct Case {
    words: &'static str,
    payload_kg: f64,
    x_mm: f64,
    resonance_hz: f64,
    tuning: Tuning,
}

#[derive(Clone, Copy)]
struct Gains {
    velocity_v_s_rad: f64,
    position_1_s: f64,
    integral_1_s: f64,
}

const SHAPED: Tuning = Tuning::Shaped(Gains {
    velocity_v_s_rad: 43.0,
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
    /// For a soft transmission: half the velocity gain, and a notch.
    Soft,
}

fn main() {
    let case = |words, payload_kg, x_mm, resonance_hz, tuning| Case {
        words,
        payload_kg,
        x_mm,
        resonance_hz,
        tuning,
    };
    let cases = [
        case("as it comes, centre", 0.0, 0.0, 1_500.0, Tuning::Reference),
        case(
            "as it comes, 76 mm out",
            0.0,
            76.0,
            1_500.0,
            Tuning::Reference,
        ),
        case(
            "as it comes, 5 kg told, centre",
            5.0,
            0.0,
            1_500.0,
            Tuning::Reference,
        ),
        case(
            "as it comes, 5 kg told, 76 mm out",
            5.0,
            76.0,
            1_500.0,
            Tuning::Reference,
        ),
        case("shaped, centre", 0.0, 0.0, 1_500.0, SHAPED),
        case("shaped, 76 mm out", 0.0, 76.0, 1_500.0, SHAPED),
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
            76.0,
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
    for case in &cases {
        case.print();
    }
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
                Tuning::Reference => {}
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
        if matches!(self.tuning, Tuning::Shaped(_)) {
            parameters = with_inertia_scheduled(&parameters);
        }
        (stage, parameters)
    }

    fn print(&self) {
        let (stage, mut parameters) = self.parameters();
        let sensitivities = self.sensitivities(&stage, &parameters);
        let crossover_hz = (sensitivities.iter().rev())
            .find(|(_, [re, im])| {
                // |L| = |1 - S| / |S|.
                (1.0 - re).hypot(*im) >= re.hypot(*im)
            })
            .map_or(f64::NAN, |(hz, _)| *hz);
        let (worst_hz, most) = (sensitivities.iter())
            .map(|(hz, [re, im])| (*hz, re.hypot(*im)))
            .fold(
                (0.0, 0.0),
                |worst, one| if one.1 > worst.1 { one } else { worst },
            );
        let low = sensitivities
            .iter()
            .find(|(hz, _)| *hz >= 30.0)
            .map_or(f64::NAN, |(_, [re, im])| re.hypot(*im));
        let rested = push(&stage, &parameters, self.x_mm);
        parameters.servo.rest.stiffness = 1.0;
        let full = push(&stage, &parameters, self.x_mm);
        println!(
            "| {} | {crossover_hz:.0} | {most:.2} at {worst_hz:.0} | {low:.3} | {full} | {rested} |",
            self.words
        );
    }

    /// S of pivot 1, frequency by frequency.
    fn sensitivities(
        &self,
        stage: &StageParameters,
        parameters: &Parameters,
    ) -> Vec<(f64, [f64; 2])> {
        let mut queues = Queues::new();
        let (mut tick_queues, mut commands) = queues.split();
        let mut bench = Bench::at(stage, parameters, self.x_mm, &mut tick_queues);
        let from = bench.referenced(&mut commands);
        let to = [
            from[0],
            from[1],
            from[2] + (60.0 / 360.0 * 60.0 * UNIT) as i64,
        ];
        let constraints = Constraints::new(parameters.limits, parameters.geometry);
        let plan = plan_line(1, from, to, &constraints).expect("in place");
        assert!(commands.send(Command::Move(plan)).is_ok(), "room");
        bench.run(20_000);
        let mut sensitivities = Vec::new();
        let mut hz = 20.0;
        while hz < 3_000.0 {
            // Whole periods.
            let periods = (SINE_TICKS * hz / RATE_HZ).ceil();
            let ticks = (periods * RATE_HZ / hz).round();
            let exact_hz = periods * RATE_HZ / ticks;
            sensitivities.push((exact_hz, bench.sensitivity(exact_hz, ticks as u64)));
            hz *= 1.04;
        }
        sensitivities
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
        x_mm: f64,
        queues: &'a mut TickQueues<'q>,
    ) -> Self {
        let mut host = Host::new(stage, parameters);
        host.stage.set_pose_at_rest([x_mm * 1e-3, 0.0, 0.0]);
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

    /// Following error of pivot 1, LSB.
    fn error_lsb(&self) -> f64 {
        let sample = self.record.sample.as_ref().expect("a tick has run");
        (sample.pivots[0] - sample.pivot_setpoints[0]).units() as f64 / UNITS_PER_LSB
    }

    fn sensitivity(&mut self, hz: f64, ticks: u64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for tick in 0..SETTLE_TICKS + ticks {
            // What is set now is latched later in this period and read by the next tick.
            let phase = TAU * hz * tick as f64 / RATE_HZ;
            self.host.stage.encoders[0].set_offset(SINE_RAD * phase.sin());
            let error = self.error_lsb() * LSB_RAD;
            if tick >= SETTLE_TICKS {
                // Read in this tick's sample: what was set a tick ago.
                let read = TAU * hz * (tick - 1) as f64 / RATE_HZ;
                // The sample shown is the tick's before, so its offset was set two ticks ago.
                let shown = read - TAU * hz / RATE_HZ;
                sums[0] += error * shown.sin();
                sums[1] += error * shown.cos();
            }
            self.tick();
        }
        self.host.stage.encoders[0].set_offset(0.0);
        sums.map(|sum| sum * 2.0 / ticks as f64 / SINE_RAD)
    }
}

/// Peak and the time after which the error stays within 2.5 LSB, of the mean over a millisecond.
fn push(stage: &StageParameters, parameters: &Parameters, x_mm: f64) -> String {
    let mut queues = Queues::new();
    let (mut tick_queues, mut commands) = queues.split();
    let mut bench = Bench::at(stage, parameters, x_mm, &mut tick_queues);
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
        let error = bench.error_lsb();
        peak = peak.max(error.abs());
        last.pop_front();
        last.push_back(error);
        if (last.iter().sum::<f64>() / 20.0).abs() > 2.5 {
            outside = tick;
        }
    }
    format!("{peak:.0}, {:.1}", f64::from(outside) / RATE_HZ * 1e3)
}
