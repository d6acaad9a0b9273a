//! Encoders, bridges and the timeline between the plant and the controller.

use std::f64::consts::TAU;

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;
use embedded_hal::spi::SpiBus;
use firmware::drivers::biss::{self, FrameError};
use hal_sim::machine::devices::biss::COUNTS_PER_TURN;
use hal_sim::machine::devices::{
    Bridge, BridgeParameters, BridgeState, Encoder, EncoderFault, EncoderParameters, Stage,
    StageParameters, WiringParameters,
};
use hal_sim::machine::plant::{Drive, Imperfections, Plant, PlantParameters};
use hal_sim::random::Random;

/// Position and flags as a driver would find them: behind the start bit, which follows the acknowledge.
fn decode(frame: u64) -> (u32, bool, bool) {
    let acknowledged = frame << frame.leading_ones();
    let body = acknowledged << acknowledged.leading_zeros();
    (
        (body >> 36) as u32 & (COUNTS_PER_TURN - 1),
        body >> 35 & 1 == 0,
        body >> 34 & 1 == 0,
    )
}

fn ideal(parameters: EncoderParameters) -> Encoder {
    Encoder::new(parameters, 1, &Imperfections::NONE)
}

fn reading(encoder: &mut Encoder, angle_rad: f64) -> u32 {
    encoder.latch(angle_rad, 0.0);
    decode(encoder.frame()).0
}

#[test]
fn encoder_counts_with_its_zero_and_direction() {
    let quarter = COUNTS_PER_TURN / 4;
    let parameters = EncoderParameters {
        zero_counts: 1000,
        ..EncoderParameters::REFERENCE
    };
    let mut forward = ideal(parameters);
    let mut backward = ideal(EncoderParameters {
        reversed: true,
        ..parameters
    });
    for turns in [-10_000.0, 0.0, 10_000.0] {
        let angle_rad = (turns + 0.25) * TAU;
        assert_eq!(reading(&mut forward, angle_rad), 1000 + quarter);
        assert_eq!(
            reading(&mut backward, angle_rad),
            COUNTS_PER_TURN - quarter + 1000
        );
    }
    assert_eq!(
        reading(&mut forward, -1001.0 * TAU / f64::from(COUNTS_PER_TURN)),
        COUNTS_PER_TURN - 1
    );
}

#[test]
fn encoder_rounds_to_the_nearest_count() {
    let mut encoder = ideal(EncoderParameters::REFERENCE);
    let lsb_rad = TAU / f64::from(COUNTS_PER_TURN);
    assert_eq!(reading(&mut encoder, 7.4 * lsb_rad), 7);
    assert_eq!(reading(&mut encoder, 7.6 * lsb_rad), 8);
}

#[test]
fn encoder_bus_repeats_the_latched_frame() {
    let mut encoder = ideal(EncoderParameters::REFERENCE);
    encoder.latch(1.0, 0.0);
    let (mut first, mut second, mut longer) = ([0u8; 8], [0u8; 8], [0xffu8; 10]);
    encoder.read(&mut first).unwrap();
    encoder.transfer(&mut second, &[0; 8]).unwrap();
    encoder.transfer_in_place(&mut longer).unwrap();
    assert_eq!(u64::from_be_bytes(first), encoder.frame());
    assert_eq!(first, second);
    assert_eq!((&longer[..8], &longer[8..]), (&first[..], &[0, 0][..]));
}

#[test]
fn the_firmware_reads_what_the_encoder_says() {
    let mut encoder = ideal(EncoderParameters::REFERENCE);
    let mut noise = Random::new(5);
    let mut read = |encoder: &mut Encoder| {
        encoder.latch(noise.normal(), 0.0);
        biss::decode(&biss::read(encoder).unwrap())
    };
    for _ in 0..1000 {
        let reading = read(&mut encoder).unwrap();
        assert_eq!(
            (reading.counts, reading.warning),
            (encoder.position(), false)
        );
    }
    encoder.set_fault(EncoderFault::WarningBit);
    assert!(read(&mut encoder).unwrap().warning);
    encoder.set_fault(EncoderFault::ErrorBit);
    assert_eq!(read(&mut encoder), Err(FrameError::Error));
    encoder.set_fault(EncoderFault::BadFrame { flip: 1 << 30 });
    assert_eq!(read(&mut encoder), Err(FrameError::Crc));
    for silent in [EncoderFault::StuckHigh, EncoderFault::StuckLow] {
        encoder.set_fault(silent);
        assert_eq!(read(&mut encoder), Err(FrameError::Silent));
    }
}

#[test]
fn latency_shows_an_older_angle() {
    let parameters = EncoderParameters {
        latency_s: 2e-6,
        ..EncoderParameters::REFERENCE
    };
    let mut encoder = ideal(parameters);
    encoder.latch(1.0, 10.0);
    let expected = ((1.0 - 20e-6) / TAU * f64::from(COUNTS_PER_TURN)).round() as u32;
    assert_eq!(encoder.position(), expected);
    encoder.set_fault(EncoderFault::Late { micros: 50 });
    encoder.latch(1.0, 10.0);
    let expected = ((1.0 - 520e-6) / TAU * f64::from(COUNTS_PER_TURN)).round() as u32;
    assert_eq!(encoder.position(), expected);
}

#[test]
fn every_encoder_fault_shows_and_ends() {
    let mut encoder = ideal(EncoderParameters::REFERENCE);
    let good = reading(&mut encoder, 1.0);
    let good_frame = encoder.frame();
    let mut frame_with = |fault| {
        encoder.set_fault(fault);
        encoder.latch(1.0, 0.0);
        encoder.frame()
    };
    assert_eq!(frame_with(EncoderFault::StuckHigh), u64::MAX);
    assert_eq!(frame_with(EncoderFault::StuckLow), 0);
    assert_eq!(
        decode(frame_with(EncoderFault::ErrorBit)),
        (good, true, false)
    );
    assert_eq!(
        decode(frame_with(EncoderFault::WarningBit)),
        (good, false, true)
    );
    assert_eq!(
        decode(frame_with(EncoderFault::Jump { counts: -5 })).0,
        good - 5
    );
    assert_eq!(
        frame_with(EncoderFault::BadFrame { flip: 1 << 40 }),
        good_frame ^ 1 << 40
    );
    encoder.latch(1.0, 0.0);
    assert_eq!((encoder.frame(), encoder.fault()), (good_frame, None));
    encoder.set_fault(EncoderFault::Frozen);
    assert_eq!(reading(&mut encoder, 2.0), good);
    encoder.set_fault(None);
    assert_ne!(reading(&mut encoder, 2.0), good);
}

#[test]
fn noise_and_eccentricity_have_their_size() {
    let parameters = EncoderParameters {
        noise_rad: 1e-6,
        ..EncoderParameters::REFERENCE
    };
    let lsb_rad = TAU / f64::from(COUNTS_PER_TURN);
    let mut noisy = Encoder::new(
        parameters,
        3,
        &Imperfections {
            encoder_noise: true,
            ..Imperfections::NONE
        },
    );
    let centre = 1.0 / lsb_rad;
    let squares: f64 = (0..10_000)
        .map(|_| (f64::from(reading(&mut noisy, 1.0)) - centre).powi(2))
        .sum();
    let deviation_rad = (squares / 1e4).sqrt() * lsb_rad;
    assert!(
        (deviation_rad / 1e-6 - 1.0).abs() < 0.05,
        "{deviation_rad:e}"
    );
    let mut eccentric = Encoder::new(
        parameters,
        3,
        &Imperfections {
            encoder_eccentricity: true,
            ..Imperfections::NONE
        },
    );
    let error_rad = f64::from(reading(&mut eccentric, TAU / 4.0)) * lsb_rad - TAU / 4.0;
    assert!((error_rad - 5e-6).abs() < lsb_rad, "{error_rad:e}");
}

#[test]
fn bridge_pins_become_a_drive() {
    let (bridge, mut pins) = Bridge::new();
    let parameters = BridgeParameters {
        dead_time_s: 0.0,
        ..BridgeParameters::REFERENCE
    };
    let drive = |bridge: &Bridge| bridge.state().drive(&parameters, 0.0);
    pins.pwm.set_duty_cycle(2100).unwrap();
    assert_eq!(drive(&bridge), Drive::Coast, "asleep");
    pins.sleep.set_high().unwrap();
    assert_eq!(drive(&bridge), Drive::Voltage(-24.0));
    pins.direction.set_high().unwrap();
    assert_eq!(drive(&bridge), Drive::Voltage(24.0));
    assert!(pins.fault.is_high().unwrap());
    bridge.set_fault(true);
    assert!(pins.fault.is_low().unwrap());
    assert_eq!(drive(&bridge), Drive::Coast, "switched off by itself");
    bridge.set_fault(false);
    pins.pwm.set_duty_cycle_fully_off().unwrap();
    assert_eq!(drive(&bridge), Drive::Brake);
}

#[test]
fn dead_time_takes_voltage_against_the_current() {
    let parameters = BridgeParameters::REFERENCE;
    let pins = BridgeState {
        pulse: 0.5,
        forward: true,
        awake: true,
        fault: false,
    };
    let volts = |pins: BridgeState, current_a| match pins.drive(&parameters, current_a) {
        Drive::Voltage(volts) => volts,
        other => panic!("{other:?}"),
    };
    let lost = 200e-9 * 40e3 * 48.0;
    assert!((volts(pins, 1.0) - (24.0 - lost)).abs() < 1e-12);
    assert!((volts(pins, -1.0) - (24.0 + lost)).abs() < 1e-12);
    assert_eq!(volts(pins, 0.0), 24.0);
    let short = BridgeState {
        pulse: 0.001,
        ..pins
    };
    assert_eq!(
        volts(short, 1.0),
        0.0,
        "a pulse shorter than the dead time is swallowed"
    );
    assert_eq!(
        volts(BridgeState { pulse: 1.0, ..pins }, 1.0),
        48.0,
        "nothing switches"
    );
}

#[test]
fn period_runs_old_pins_then_new_ones_and_latches_before_the_tick() {
    let mut parameters = StageParameters::REFERENCE;
    parameters.plant.imperfections = Imperfections::NONE;
    // All at one instant: that they are not is looked at elsewhere (`latch`).
    parameters.latch_offsets_s = [0.0; 3];
    let mut stage = Stage::new(&parameters);
    stage.set_pose_at_rest([0.01, 0.02, 0.3]);
    // So fast that 10 us are a hundred counts.
    stage.plant.set_velocity([0.02, 0.01, 1.0]);
    let pins = |pulse| {
        [BridgeState {
            pulse,
            forward: true,
            awake: true,
            fault: false,
        }; 3]
    };
    stage.advance_period(pins(0.25));
    stage.advance_period(pins(0.5));

    let mut plant = Plant::new(parameters.plant);
    plant.set_pose_at_rest([0.01, 0.02, 0.3]);
    plant.set_velocity([0.02, 0.01, 1.0]);
    let (asleep, first, second) = (
        [Drive::Coast; 3],
        [Drive::Voltage(12.0); 3],
        [Drive::Voltage(24.0); 3],
    );
    let grid = [
        (16e-6, asleep),
        (16e-6, asleep),
        (3e-6, first),
        (15e-6, first),
        (16e-6, first),
        (16e-6, first),
        (3e-6, second),
    ];
    for (step_s, drives) in grid {
        plant.step(step_s, &drives);
    }
    let latched_rad = plant.pivots_rad();
    plant.step(15e-6, &second);
    for (axis, angle_rad) in latched_rad.iter().enumerate() {
        let expected = angle_rad / TAU * f64::from(COUNTS_PER_TURN);
        let encoder = parameters.encoders[axis];
        let sign = if encoder.reversed { -1.0 } else { 1.0 };
        let counts = (sign * expected).round() as i64 + i64::from(encoder.zero_counts);
        assert_eq!(
            stage.encoders[axis].position(),
            counts as u32 & (COUNTS_PER_TURN - 1)
        );
        assert!((stage.plant.pivots_rad()[axis] - plant.pivots_rad()[axis]).abs() < 1e-13);
        assert_eq!(
            stage.frames()[axis],
            stage.encoders[axis].frame().to_be_bytes()
        );
    }
}

/// Every frame, pose and analog count of 200 periods under changing pins.
fn trace(parameters: &StageParameters) -> Vec<u8> {
    let mut stage = Stage::new(parameters);
    let mut bytes = Vec::new();
    for period in 0..200 {
        let pulse = f64::from(period * 37 % 1000) / 4200.0;
        let pins = BridgeState {
            pulse,
            forward: period % 7 > 2,
            awake: true,
            fault: false,
        };
        stage.advance_period([
            pins,
            BridgeState {
                forward: true,
                ..pins
            },
            pins,
        ]);
        bytes.extend(stage.frames().concat());
        bytes.extend(
            stage
                .plant
                .pose()
                .iter()
                .flat_map(|coordinate| coordinate.to_le_bytes()),
        );
        let (currents, supply) = stage.analog();
        bytes.extend(
            currents
                .iter()
                .chain([&supply])
                .flat_map(|counts| counts.to_le_bytes()),
        );
    }
    bytes
}

#[test]
fn same_seed_gives_the_same_trace_byte_for_byte() {
    let parameters = StageParameters::REFERENCE;
    assert_eq!(trace(&parameters), trace(&parameters));
    assert_ne!(
        trace(&parameters),
        trace(&StageParameters {
            seed: 2,
            ..parameters
        })
    );
}

#[test]
fn another_control_rate_scales_the_timeline() {
    let mut stage = Stage::new(&StageParameters {
        period_s: 100e-6,
        ..StageParameters::REFERENCE
    });
    let pins = [BridgeState {
        pulse: 0.1,
        forward: true,
        awake: true,
        fault: false,
    }; 3];
    for _ in 0..10_000 {
        stage.advance_period(pins);
    }
    // 1 s at 4.8 V less what friction and dead time take.
    let theta_rad = stage.plant.pose()[2];
    assert!((1.2..1.6).contains(&theta_rad), "{theta_rad}");
}

/// The ripple beside a winding that is really switched, 48 V and nothing in turns, until it repeats.
#[test]
fn the_ripple_is_that_of_a_switched_winding() {
    let parameters = BridgeParameters::REFERENCE;
    let (inductance_h, resistance_ohm, steps) = (0.7e-3, 2.1, 2_000);
    let step_s = 1.0 / (parameters.pwm_hz * f64::from(steps));
    for (pulse, forward) in [(0.05, true), (0.3, true), (0.5, false), (0.9, false)] {
        let pins = BridgeState {
            pulse,
            forward,
            awake: true,
            fault: false,
        };
        let sign = if forward { 1.0 } else { -1.0 };
        let mut current_a = sign * pulse * parameters.supply_v / resistance_ohm;
        let mut switched = Vec::new();
        for step in 0..100 * steps {
            let part = f64::from(step % steps) / f64::from(steps);
            let volts = if part < pulse {
                sign * parameters.supply_v
            } else {
                0.0
            };
            if step >= 99 * steps {
                switched.push(current_a);
            }
            current_a += (volts - resistance_ohm * current_a) / inductance_h * step_s;
        }
        let mean_a = switched.iter().sum::<f64>() / f64::from(steps);
        let ripple = |part: f64| pins.ripple_a(&parameters, inductance_h, part / parameters.pwm_hz);
        let (mut least_a, mut most_a, mut sum_a) = (f64::MAX, f64::MIN, 0.0);
        for (step, current_a) in switched.iter().enumerate() {
            let part = step as f64 / f64::from(steps);
            let ripple_a = ripple(part);
            // What the resistance bends of it: a hundredth of the largest.
            let off_a = current_a - mean_a - ripple_a;
            assert!(off_a.abs() < 5e-3, "{pulse} at {part}: {ripple_a} {off_a}");
            // Each period alike.
            assert!((ripple(part + 3.0) - ripple_a).abs() < 1e-9);
            (least_a, most_a) = (least_a.min(ripple_a), most_a.max(ripple_a));
            sum_a += ripple_a / f64::from(steps);
        }
        let swing_a = 48.0 / (inductance_h * 40e3) * pulse * (1.0 - pulse);
        assert!(((most_a - least_a) / swing_a - 1.0).abs() < 2e-3);
        assert!(sum_a.abs() < 1e-3 * swing_a, "{sum_a:e}");
    }
}

#[test]
fn nothing_ripples_that_is_not_switched() {
    let pins = BridgeState {
        pulse: 0.5,
        forward: true,
        awake: true,
        fault: false,
    };
    let ripple = |pins: BridgeState| pins.ripple_a(&BridgeParameters::REFERENCE, 0.7e-3, 5.3e-6);
    assert!(ripple(pins) < -0.01);
    for still in [
        BridgeState { pulse: 0.0, ..pins },
        BridgeState { pulse: 1.0, ..pins },
        BridgeState {
            awake: false,
            ..pins
        },
        BridgeState {
            fault: true,
            ..pins
        },
    ] {
        assert_eq!(ripple(still), 0.0, "{still:?}");
    }
}

/// A bridge in air that is too hot lets its motor go and pulls its own fault pin, whatever ring it drives; where bridges have no limits none does.
#[test]
fn a_stage_whose_bridge_is_too_hot_pulls_its_fault_pin() {
    let run = |bridge_limits: bool| {
        let mut parameters = StageParameters {
            wiring: WiringParameters {
                bridge_of_ring: [2, 0, 1],
                ..WiringParameters::REFERENCE
            },
            ..StageParameters::REFERENCE
        };
        parameters.bridge.heat.air_c = 160.0;
        parameters.bridge.heat.time_constant_s = 0.1;
        parameters.plant.imperfections = Imperfections {
            bridge_limits,
            ..Imperfections::NONE
        };
        parameters.plant.motor_inertia_kg_m2 = 1e6;
        let mut stage = Stage::new(&parameters);
        let awake = BridgeState {
            awake: true,
            ..BridgeState::RESET
        };
        let driving = BridgeState {
            pulse: 0.2,
            forward: true,
            ..awake
        };
        for _ in 0..20_000 {
            stage.advance_period([driving, awake, awake]);
        }
        stage
    };
    let hot = run(true);
    assert_eq!(hot.pulled_fault_pins(), [true, false, false]);
    // The first bridge drives the second ring.
    assert_eq!(hot.plant.currents_a()[1], 0.0);
    let [junction_c, others_c @ ..] = hot.junctions_c().unwrap();
    assert!((160.0..165.1).contains(&junction_c) && others_c == [160.0; 2]);
    let bearing = run(false);
    assert_eq!(bearing.pulled_fault_pins(), [false; 3]);
    assert!(bearing.plant.currents_a()[1] > 4.5);
    assert_eq!(bearing.junctions_c(), None);
}

/// Each input samples its own bridge's ripple at its own time, whatever ring the bridge drives and whichever way round.
#[test]
fn each_input_has_the_ripple_of_its_own_time() {
    let wiring = WiringParameters {
        bridge_of_ring: [2, 0, 1],
        leads_exchanged: [false, true, false],
        port_of_ring: [0, 1, 2],
    };
    let run = |current_ripple: bool| {
        let mut parameters = StageParameters {
            wiring,
            ..StageParameters::REFERENCE
        };
        parameters.plant.imperfections = Imperfections {
            current_ripple,
            ..Imperfections::NONE
        };
        let mut stage = Stage::new(&parameters);
        let pins = [0.3, 0.5, 0.2].map(|pulse| BridgeState {
            pulse,
            forward: pulse != 0.5,
            awake: true,
            fault: false,
        });
        for _ in 0..5 {
            stage.advance_period(pins);
        }
        (stage.analog().0, pins)
    };
    let ((mean, pins), (sampled, _)) = (run(false), run(true));
    let sampled_s = StageParameters::REFERENCE.analog.current_sampled_s;
    for i in 0..3 {
        let ripple_a = pins[i].ripple_a(&BridgeParameters::REFERENCE, 0.7e-3, sampled_s[i]);
        let expected = ripple_a * 0.2 / 3.3 * 4096.0;
        let counts = f64::from(sampled[i]) - f64::from(mean[i]);
        // Both are rounded.
        assert!((counts - expected).abs() <= 1.0, "{i}: {counts} {expected}");
        assert!(counts.abs() > 5.0, "{i}: {counts}");
    }
}

#[test]
fn analog_inputs_follow_current_and_supply() {
    let mut parameters = StageParameters::REFERENCE;
    parameters.plant = PlantParameters {
        supply_v: 24.0,
        ..PlantParameters::REFERENCE
    };
    let mut stage = Stage::new(&parameters);
    assert_eq!(stage.analog(), ([2048; 3], 1489));
    let pins = [BridgeState {
        pulse: 0.5,
        forward: false,
        awake: true,
        fault: false,
    }; 3];
    stage.advance_period(pins);
    stage.advance_period(pins);
    // Backwards: less than the middle of 3.3 V.
    let expected = ((1.65 + 0.2 * stage.plant.currents_a()[0]) / 3.3 * 4096.0).round() as u16;
    assert!(expected < 2048 - 60, "{expected}");
    assert_eq!(stage.analog().0[0], expected);
}

/// Twice the mains' frequency, 0.1 V to each side; without it the supply stands still, and so it does behind a diode that nothing draws
/// through.
#[test]
fn a_supply_ripples() {
    let supplies = |supply_ripple: bool, bus: bool| -> Vec<i32> {
        let mut parameters = StageParameters::REFERENCE;
        parameters.plant.imperfections = Imperfections {
            supply_ripple,
            bus,
            ..Imperfections::NONE
        };
        let mut stage = Stage::new(&parameters);
        let period = |_| {
            stage.advance_period([BridgeState::RESET; 3]);
            i32::from(stage.analog().1)
        };
        (0..20_000).map(period).collect()
    };
    let counts_of = |volts: f64| (volts / 20.0 / 3.3 * 4096.0).round() as i32;
    let ends = |all: &[i32]| [all.iter().min().copied(), all.iter().max().copied()];
    assert_eq!(ends(&supplies(false, false)), [Some(counts_of(48.0)); 2]);
    let rippling = supplies(true, false);
    let expected = [counts_of(47.9), counts_of(48.1)].map(Some);
    assert_eq!(ends(&rippling), expected);
    let rises = rippling.windows(2).filter(|two| {
        let mean = counts_of(48.0);
        two[0] <= mean && two[1] > mean
    });
    assert_eq!(rises.count(), 100);
    let last = &supplies(true, true)[1_000..];
    let [lowest, highest] = ends(last);
    assert_eq!(lowest, highest);
    assert!(lowest > Some(counts_of(47.5)), "{lowest:?}");
}

/// A bridge turns the motor that its leads go to, the way round that they are, and sees the current that it gives; a port has the frames of
/// the encoder that is plugged into it.
#[test]
fn plugs_decide_what_a_bridge_turns_and_what_a_port_reads() {
    let wiring = WiringParameters {
        bridge_of_ring: [2, 0, 1],
        leads_exchanged: [false, true, false],
        port_of_ring: [1, 2, 0],
    };
    for (bridge, ring, way) in [(2, 0, 1.0), (0, 1, -1.0), (1, 2, 1.0)] {
        let mut stage = Stage::new(&StageParameters {
            wiring,
            ..StageParameters::REFERENCE
        });
        let mut pins = [BridgeState::RESET; 3];
        pins[bridge] = BridgeState {
            pulse: 0.3,
            forward: true,
            awake: true,
            fault: false,
        };
        for _ in 0..20 {
            stage.advance_period(pins);
        }
        let rates = stage.plant.motor_rates_rad_s();
        let fastest = rates.into_iter().map(f64::abs).fold(0.0, f64::max);
        assert!(
            rates[ring] * way == fastest && fastest > 0.1,
            "{bridge}: {rates:?}"
        );
        let (currents, _) = stage.analog();
        for (i, counts) in currents.into_iter().enumerate() {
            assert_eq!(counts > 2048, i == bridge, "{bridge}: {currents:?}");
        }
        let frames = stage.frames();
        for (ring, port) in [(0, 1), (1, 2), (2, 0)] {
            assert_eq!(frames[port], stage.encoders[ring].frame_bytes());
            let at_port = stage.encoder_at(port).position();
            assert_eq!(at_port, stage.encoders[ring].position());
        }
    }
}
