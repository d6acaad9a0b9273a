//! Encoders, servo and the tick as a whole.

mod frames;
mod tick;

use crate::bench::{Bench, no_result};
use core::hint::black_box;
use firmware::control::SubdivisionTable;
use firmware::control::config::Config;
use firmware::control::encoder::Encoder;
use firmware::control::rest_mode::Stiffness;
use firmware::control::servo::{
    LoopSetpoint, PivotFeedback, PivotServo, PivotSetpoint, carried_inertia,
};
use firmware::drivers::{biss::RawFrame, bridge::Duty};
use firmware::parameters::{Harmonic, Lead, Notch, Parameters, Subdivision, SubdivisionHarmonic};
use firmware_cost::random::Random;
use frames::frames;
use kinematics::Angle;

/// 48 V, the supply of the reference stage, in counts of the ADC.
const SUPPLY_COUNTS: u16 = 2979;

/// Counts encoder decoding, the servo and the tick.
#[inline(never)]
pub fn run(bench: &mut Bench) {
    let config = Config::new(&Parameters::REFERENCE);
    let config = black_box(&config);
    decoding(bench, config, "encoder decoding, three", None);
    let corrected = SubdivisionTable::new(&Subdivision {
        periods: 15_708,
        harmonics: [SubdivisionHarmonic {
            amplitude_nrad: 400,
            phase_tenths_deg: 300,
        }; 3],
    });
    decoding(
        bench,
        config,
        "encoder decoding, three, corrected",
        Some(&corrected),
    );
    servo(bench, "servo, three", config);
    servo(bench, "servo, three, notches, lead, ripple", &shaped());
    scheduled(bench, config);
    tick::run(bench, config);
}

/// All that shapes a loop in force: two notches and a lead, four sines of ripple.
fn shaped() -> Config {
    let mut parameters = Parameters::REFERENCE;
    let servo = &mut parameters.servo;
    for filters in &mut servo.filters {
        filters.notches = [1_425.0, 1_680.0].map(|frequency_hz| Notch {
            frequency_hz,
            width_hz: 450.0,
            gain: 0.3,
        });
        filters.lead = Lead {
            from_hz: 480.0,
            to_hz: 3_000.0,
        };
    }
    for ripple in &mut servo.ripple {
        ripple.harmonics = [325.0, 650.0, 1_300.0, 2_600.0].map(|periods| Harmonic {
            periods,
            amplitude_n_m: 0.03,
            phase_deg: 30.0,
        });
    }
    Config::new(&parameters)
}

/// What one pivot of three is asked in a tick where gains go by the inertia.
fn scheduled(bench: &mut Bench, config: &Config) {
    let body = &config.servo.body;
    bench.part_with(
        "inertia at a pivot, for its gains",
        Bench::SHORT,
        &mut (),
        |(), random| [0; 6].map(|_| random.within(0.6, 1.3) as f32),
        |(), &[a, b, c, d, e, f]| carried_inertia(body, &[a, b, c], &[d, e, f], 1),
        no_result,
    );
}

fn decoding(
    bench: &mut Bench,
    config: &Config,
    title: &'static str,
    table: Option<&SubdivisionTable>,
) {
    let mut memory = ([Encoder::default(); 3], Rings::default());
    bench.part_with(
        title,
        Bench::SHORT,
        &mut memory,
        |(_, rings), random| rings.turned(random),
        |(encoders, _), frames| {
            // As the tick has it: written out for both.
            if table.is_none() {
                for (i, encoder) in encoders.iter_mut().enumerate() {
                    encoder.update(&config.encoders[i], None, &frames[i]);
                }
            } else {
                for (i, encoder) in encoders.iter_mut().enumerate() {
                    encoder.update(&config.encoders[i], table, &frames[i]);
                }
            }
            encoders.each_ref().map(Encoder::angle)
        },
        no_result,
    );
}

/// The rings under the encoders, which turn at 2 rad/s (over 2.5 an encoder does not become ready), a few counts more
/// or less from tick to tick.
#[derive(Default)]
struct Rings([Angle; 3]);

impl Rings {
    /// The frames a tick later; one in 64 times one of them is missing.
    fn turned(&mut self, random: &mut Random) -> [RawFrame; 3] {
        const STEP: f64 = 2.0 / core::f64::consts::TAU / 20_000.0 * 4_294_967_296.0;
        for pivot in &mut self.0 {
            *pivot += Angle::from_units((STEP + random.within(-250.0, 250.0)) as i64);
        }
        let mut frames = frames(&self.0);
        if random.once_in(64) {
            frames[1] = RawFrame::MISSING;
        }
        frames
    }
}

fn servo(bench: &mut Bench, name: &'static str, config: &Config) {
    // Derived from parameters, as far as the compiler knows.
    let config = black_box(config);
    bench.part_with(
        name,
        Bench::SHORT,
        &mut [PivotServo::default(); 3],
        |_, random| [0; 3].map(|_| pivot(random)),
        |servo, pivots| {
            let common = LoopSetpoint {
                counts_per_volt: config.servo.counts_per_volt(f32::from(SUPPLY_COUNTS)),
                stiffness: Stiffness::FULL,
            };
            let mut duty = [Duty(0); 3];
            for i in 0..3 {
                let (setpoint, measured) = &pivots[i];
                servo[i].feed_forward(&config.servo.pivots[i], setpoint);
                duty[i] = servo[i].step(&config.servo.pivots[i], measured, &common);
                if i == 0 {
                    servo[i].learn(&config.servo.pivots[i]);
                }
            }
            duty
        },
        no_result,
    );
}

fn pivot(random: &mut Random) -> (PivotSetpoint, PivotFeedback) {
    let error = random.within(-3e4, 3e4) as i32;
    let setpoint = PivotSetpoint {
        rate: random.within(-10.0, 10.0) as f32,
        acceleration: random.within(-100.0, 100.0) as f32,
        platform_torque: random.within(-6.0, 6.0) as f32,
        angle: Angle::from_units(random.within(-2e9, 2e9) as i64),
        has_turn: true,
    };
    let measured = PivotFeedback {
        error,
        current_counts: random.within(-1_400.0, 1_400.0) as i16,
        added_volts: 0.0,
    };
    (setpoint, measured)
}
