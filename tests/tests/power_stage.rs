//! Bus, brake resistor, bridges with limits, and the limit of the motors' currents.

use firmware::drivers::bridge::Duty;
use firmware::drivers::power_stage::{BRIDGE, BUS};
use firmware::fault::FaultKind;
use firmware::mode::Mode;
use hal_sim::machine::devices::{BrakeResistorFault, StageParameters};
use hal_sim::machine::plant::Imperfections;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use parallel::{cores, of_all};
use tests::Bench;
use tests::reactions::Motion;

const LIMIT: u32 = 0x5450_080F;

/// A machine with a bus and bridges as they are.
fn machine() -> StageParameters {
    let options = RunOptions {
        imperfections: Imperfections {
            bus: true,
            bridge_limits: true,
            ..Imperfections::CALIBRATED
        },
        ..RunOptions::default()
    };
    stage_parameters(&options)
}

fn turning(stage: &StageParameters, deg_s: f64) -> Bench {
    let mut bench = Bench::new(stage);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    assert_eq!(bench.error_after(&format!("JOG W {deg_s}")), "0");
    bench.run(10_000);
    assert_eq!((bench.fault(), bench.mode()), (None, Mode::Moving));
    bench
}

/// The highest voltage of the bus, V, and what the resistor has taken, J.
fn bus(bench: &Bench) -> (f64, f64) {
    let bus = bench.rig.front.stage.bus().expect("it has one");
    (bus.highest_v(), bus.resistor_j())
}

/// The largest current of a motor in so many ticks, A.
fn most_current(bench: &mut Bench, ticks: u32) -> f64 {
    (0..ticks).fold(0.0, |most, _| {
        bench.tick();
        let currents = bench.rig.front.stage.plant.currents_a();
        currents.into_iter().map(f64::abs).fold(most, f64::max)
    })
}

/// A stage that turns at its largest rate is stopped by command on a capacitor like this.
fn stopped(capacitor_f: f64, fault: Option<BrakeResistorFault>) -> Bench {
    let mut stage = machine();
    stage.bus.capacitor_f = capacitor_f;
    let mut bench = turning(&stage, 360.0);
    bench.rig.front.stage.set_brake_resistor_fault(fault);
    assert_eq!(bench.error_after("HLT"), "10");
    bench.run(10_000);
    bench
}

/// What three motors give back in a stop raises the bus until the resistor takes it. On the reference stage's capacitor an empty
/// platform's stop ends under 54 V; on one that is spent it does not.
#[test]
fn what_a_stop_gives_back_goes_into_the_resistor() {
    let bench = stopped(1e-3, None);
    let (highest_v, resistor_j) = bus(&bench);
    println!("{highest_v:.1} V, {resistor_j:.2} J");
    assert_eq!((bench.fault(), bench.mode()), (None, Mode::Holding));
    assert!((54.0..54.5).contains(&highest_v) && resistor_j > 0.5);
}

/// A resistor that is open is found by the supply that rises on, long before that is too high for the bridges.
#[test]
fn a_resistor_that_opens_is_found_in_a_stop() {
    for capacitor_f in [2e-3, 1e-3] {
        let bench = stopped(capacitor_f, Some(BrakeResistorFault::Open));
        let (highest_v, _) = bus(&bench);
        let fault = bench.fault().expect("a fault");
        println!("{:.1} mF: {highest_v:.2} V, {fault}", capacitor_f * 1e3);
        assert_eq!(fault.kind, FaultKind::SupplyRises);
        assert_eq!(bench.mode(), Mode::Fault);
        assert!(fault.value > fault.limit && highest_v < 57.5, "{highest_v}");
        assert!(bench.outputs.awake, "it brakes");
    }
    // The twin: a capacitor that takes all of it.
    let twin = stopped(4.7e-3, Some(BrakeResistorFault::Open));
    assert_eq!(twin.fault(), None);
}

/// The highest voltage of the bus in stops as hard as the pivots can follow, from these motions of the worst machine, on a supply at its
/// upper end and such a capacitor; and the faults.
fn hardest_stops(
    motions: &[Motion],
    capacitor_f: f64,
    fault: Option<BrakeResistorFault>,
) -> (f64, Vec<Option<FaultKind>>) {
    let stopped = of_all(motions, cores(), |motion| {
        let mut stage = motion.machine();
        stage.bus.capacitor_f = capacitor_f;
        stage.plant.supply_v = BUS.supply_v * (1.0 + BUS.supply_tolerance);
        let mut bench = motion.under_way(&stage);
        bench.rig.front.stage.set_brake_resistor_fault(fault);
        bench.send("STP\n");
        bench.run(6_000);
        (bus(&bench).0, bench.fault_kind())
    });
    let highest_v = stopped.iter().map(|(volts, _)| *volts).fold(0.0, f64::max);
    (
        highest_v,
        stopped.into_iter().map(|(_, kind)| kind).collect(),
    )
}

/// With a resistor that is open no stop takes the bus to what is too high for the bridges, on the board's capacitor and on a fifth of it: the
/// fault's own reaction, shorted windings, is what holds it. So nothing else in the servo holds back what is given back.
#[test]
fn no_stop_on_an_open_resistor_takes_the_bus_too_high() {
    let motions = Motion::all();
    // What it was, over the supply, and a tenth.
    for (capacitor_f, was_v) in [(4.7e-3, 54.82), (1e-3, 56.11)] {
        let open = Some(BrakeResistorFault::Open);
        let (highest_v, faults) = hardest_stops(&motions, capacitor_f, open);
        let found = faults.iter().flatten().count();
        println!("{capacitor_f} F: {highest_v:.2} V, {found} faults");
        let most_v = 49.9 + 1.1 * (was_v - 49.9);
        assert!(most_v < BUS.too_high_v && highest_v < most_v, "{highest_v}");
        let rises = |kind: &FaultKind| *kind == FaultKind::SupplyRises;
        assert!(
            found > 0 && faults.iter().flatten().all(rises),
            "{faults:?}"
        );
    }
}

/// The twin: where it works it is no fault, and the bus ends where the resistor begins.
#[test]
fn no_stop_on_a_resistor_that_works_is_a_fault() {
    let motions: Vec<_> = Motion::all().into_iter().step_by(3).collect();
    for capacitor_f in [4.7e-3, 1e-3] {
        let (highest_v, faults) = hardest_stops(&motions, capacitor_f, None);
        println!("{capacitor_f} F: {highest_v:.2} V");
        assert!(highest_v < 54.2, "{highest_v}");
        assert!(faults.iter().all(Option::is_none), "{faults:?}");
    }
}

/// Before anything drives: open, on for good, or well.
#[test]
fn a_resistor_is_tested_while_the_bridges_wake_up() {
    use BrakeResistorFault::{Open, StuckOn};
    for bus in [true, false] {
        for noise in [true, false] {
            for fault in [None, Some(Open), Some(StuckOn)] {
                let mut stage = machine();
                stage.plant.imperfections.bus = bus;
                stage.plant.imperfections.analog_errors = noise;
                let mut bench = Bench::new(&stage);
                bench.rig.front.stage.set_brake_resistor_fault(fault);
                bench.send("FRF\n");
                bench.run_until("awake", |bench| bench.outputs.awake);
                for _ in 0..300 {
                    bench.tick();
                    let drives = bench.outputs.duty != [Duty(0); 3];
                    assert!(!drives || fault.is_none(), "nothing drives");
                }
                let expected = fault.map(|_| FaultKind::BrakeResistorDead);
                assert_eq!(bench.fault_kind(), expected, "{bus} {noise} {fault:?}");
                if fault.is_none() {
                    continue;
                }
                // Three tries of 2 ms.
                let took = bench.fault().map_or(0, |fault| fault.tick);
                assert!(took < 150, "{took}");
                // It stays until it is mended.
                for (mended, kind) in [(fault, expected), (None, None)] {
                    bench.rig.front.stage.set_brake_resistor_fault(mended);
                    assert_eq!(bench.error_after("FLC"), "0");
                    bench.send("FRF\n");
                    bench.run(300);
                    assert_eq!(bench.fault_kind(), kind);
                }
                assert_eq!(bench.mode(), Mode::Holding);
            }
        }
    }
}

/// While the stage rests: what breaks then, or has its converter stuck, is told within two seconds and the tests; a motion that comes in between
/// is none the worse for it, and a resistor that works is none for ten seconds.
#[test]
fn a_resistor_is_tested_while_the_stage_rests() {
    use BrakeResistorFault::{Open, StuckOn};
    type Breaks = fn(&mut Bench);
    let breaks: [(&str, Breaks); 3] = [
        ("open", |bench| {
            let stage = &mut bench.rig.front.stage;
            stage.set_brake_resistor_fault(Some(Open));
        }),
        ("stuck on", |bench| {
            let stage = &mut bench.rig.front.stage;
            stage.set_brake_resistor_fault(Some(StuckOn));
        }),
        ("sensor stuck", |bench| {
            bench.rig.front.stage.stick_supply_sensor();
        }),
    ];
    for (what, breaks) in breaks {
        let mut bench = Bench::new(&machine());
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        breaks(&mut bench);
        let at = bench.sample().tick;
        for _ in 0..41_000 {
            bench.tick();
        }
        let fault = bench.fault().expect("a fault");
        println!("{what}: {fault}");
        assert_eq!(fault.kind, FaultKind::BrakeResistorDead);
        assert!(fault.tick - at < 40_300, "{}", fault.tick - at);
        assert_eq!(bench.mode(), Mode::Fault);
    }
    let mut bench = Bench::new(&machine());
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    let mut pulses = 0;
    let mut was_on = false;
    for _ in 0..200_000 {
        bench.tick();
        let is_on = bench.outputs.brake_resistor;
        pulses += u32::from(is_on && !was_on);
        was_on = is_on;
    }
    assert_eq!((bench.fault(), pulses), (None, 10), "two for each test");
    // Moves that begin in every tick of a test: it ends, and says nothing.
    for delay in 0..45 {
        bench.settle();
        bench.run_until("a test", |bench| bench.outputs.brake_resistor);
        bench.run(delay);
        bench.send("MVR X 0.5\n");
        bench.run(20);
        assert!(bench.fault().is_none() && !bench.outputs.brake_resistor);
    }
}

/// `TST?` tells what the test has seen.
#[test]
fn what_the_resistor_draws_is_told() {
    let line = |bench: &mut Bench| {
        let told = bench.say("TST?\n");
        (told.lines())
            .find(|line| line.starts_with("RESISTOR_DROP"))
            .map(str::to_owned)
    };
    let mut bench = Bench::new(&machine());
    assert_eq!(line(&mut bench), None);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    assert_eq!(bench.error_after("SVO X 0"), "0");
    let told = line(&mut bench).expect("it has been tested");
    let volts: f64 = told[14..].split(' ').next().unwrap().parse().unwrap();
    assert!((volts / 0.171 - 1.0).abs() < 0.1, "{told}");
    assert!(told.ends_with("V, 0.064 to 6, ok "), "{told}");
    let fault = Some(BrakeResistorFault::Open);
    bench.rig.front.stage.set_brake_resistor_fault(fault);
    assert_eq!(bench.error_after("SVO X 1"), "0");
    bench.run(200);
    let told = line(&mut bench).expect("it has been tested");
    assert!(told.ends_with("BAD "), "{told}");
}

/// A stage that is held well is none that fails its test: after a stop whose energy is in the capacitor, switched off and on as fast as can
/// be, on ripple, with a weak supply.
#[test]
fn a_resistor_that_works_passes_its_test_at_any_time() {
    let mut stage = machine();
    stage.plant.imperfections.analog_errors = true;
    let mut bench = turning(&stage, 360.0);
    assert_eq!(bench.error_after("HLT"), "10");
    bench.run(2_000);
    assert!(bus(&bench).0 > 50.0, "charged");
    for time in 0..40 {
        // 100 Hz, 2 V to each side.
        for _ in 0..7 * time {
            bench.tick();
        }
        assert_eq!(bench.error_after("SVO X 0"), "0");
        bench.run(20);
        bench.send("SVO X 1\n");
        for tick in 0..60 {
            let turns = 100.0 * 50e-6 * f64::from(tick + time * 5);
            let ripple_v = if time % 2 == 0 { 2.0 } else { 0.0 };
            let volts = 48.0 + ripple_v * (core::f64::consts::TAU * turns).sin();
            bench.rig.front.stage.set_supply_v(volts);
            bench.tick();
        }
        assert_eq!((bench.fault(), bench.mode()), (None, Mode::Holding));
    }
    for source_ohm in [0.02, 0.3] {
        stage.bus.source_ohm = source_ohm;
        for seed in 0..20 {
            stage.seed = seed;
            let mut bench = Bench::new(&stage);
            bench.send("FRF\n");
            bench.run(70);
            assert_eq!((bench.fault(), bench.mode()), (None, Mode::Holding));
        }
    }
}

/// Shorted windings brake with all the current that the back-EMF drives, which the bridge bears: it does not trip, and no energy
/// comes back.
#[test]
fn an_emergency_stop_at_full_speed_is_braked_to_its_end() {
    let mut bench = turning(&machine(), 360.0);
    bench.rig.front.emergency_stop = true;
    let most_a = most_current(&mut bench, 2_000);
    let (highest_v, _) = bus(&bench);
    println!("{most_a:.1} A, {highest_v:.1} V");
    assert_eq!(bench.rig.front.stage.pulled_fault_pins(), [false; 3]);
    // 6.28 rad/s of 2.4 V s/rad are 15.1 V over 2.1 ohm.
    assert!((5.5..7.2).contains(&most_a) && highest_v < 50.0);
    let rates = bench.rig.front.stage.plant.pivot_rates_rad_s();
    assert!(rates.iter().all(|rate| rate.abs() < 0.01), "{rates:?}");
}

/// A pivot that is held fast, under a servo that would give it all there is: 22 A.
#[test]
fn a_motor_carries_no_more_than_its_limit() {
    for limit_a in [4.0, 6.0] {
        let mut bench = Bench::new(&machine());
        bench.set(&[
            (0x5450_0500, 0.05),
            (0x5450_0506, 0.05),
            (0x5450_0507, 36.0),
            (0x5450_0508, 0.02),
            // What 4 A bear.
            (0x5450_0107, 150.0),
            (LIMIT, limit_a),
        ]);
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        assert_eq!(bench.error_after("JOG W 60"), "0");
        bench.run(8_000);
        bench.jam();
        let (most_a, settled_a) = (most_current(&mut bench, 300), most_current(&mut bench, 50));
        println!("{limit_a} A: {most_a:.2} at most, {settled_a:.2} after 15 ms");
        // 2.2 A over it for a moment.
        assert!(most_a < limit_a + 2.4 && (settled_a / limit_a - 1.0).abs() < 0.01);
        bench.run_until("stalled", |bench| bench.fault().is_some());
        assert_eq!(bench.fault_kind(), Some(FaultKind::Stalled));
    }
}

/// More than that trips a bridge: it opens, and the fault pin says so.
#[test]
fn a_current_that_no_bridge_bears_trips_it() {
    let mut stage = machine();
    let tripped = |stage: &StageParameters| {
        let mut bench = turning(stage, 360.0);
        bench.rig.front.emergency_stop = true;
        bench.run(200);
        bench.rig.front.stage.pulled_fault_pins()
    };
    assert_eq!(tripped(&stage), [false; 3]);
    // The smaller part, which this stage once had.
    stage.bridge.trip_a = 6.0;
    assert_eq!(tripped(&stage), [true; 3]);
}

/// A supply of 55 V has the resistor on for ever, which it does not bear.
#[test]
fn a_supply_that_is_too_high_is_told_before_the_resistor_burns() {
    let mut stage = machine();
    stage.plant.supply_v = 55.0;
    let mut bench = Bench::new(&stage);
    bench.run(40_000);
    assert_eq!(bench.fault_kind(), Some(FaultKind::BrakeResistorHot));
    let (_, resistor_j) = bus(&bench);
    assert!((500.0..620.0).contains(&resistor_j), "{resistor_j}");
    bench.run(20_000);
    let (_, later_j) = bus(&bench);
    assert!(later_j - resistor_j < 1.0, "it is off: {later_j}");
    stage.plant.supply_v = 48.0;
    let mut twin = Bench::new(&stage);
    twin.run(40_000);
    assert_eq!(twin.fault(), None);
    assert!(bus(&twin).1 == 0.0);
}

/// A machine whose bridges take so long to wake up, and pull their fault pins until then.
fn waking(wake_s: f64) -> StageParameters {
    let mut stage = machine();
    stage.bridge.wake_s = wake_s;
    stage
}

/// Parts pull their fault pins while they wake up: that is no fault, nothing is driven into them, and no integral collects what they
/// could not give. Half as long again as the part's table has it is forgiven.
#[test]
fn bridges_that_wake_up_are_waited_for() {
    for wake_s in [BRIDGE.wake_s, 1.5 * BRIDGE.wake_s] {
        for start in ["FRF", "SVO X 1"] {
            let mut bench = Bench::new(&waking(wake_s));
            assert_eq!(bench.error_after("FRF"), "0");
            bench.settle();
            assert_eq!(bench.error_after("SVO X 0"), "0");
            bench.run(100);
            bench.send(&format!("{start}\n"));
            bench.run_until("awake", |bench| bench.outputs.awake);
            let mut pulled = 0;
            while bench.rig.front.stage.pulled_fault_pins() != [false; 3] {
                pulled += 1;
                assert_eq!((bench.fault(), bench.mode()), (None, Mode::Holding));
                assert_eq!(bench.outputs.duty, [Duty(0); 3], "tick {pulled}");
                bench.tick();
            }
            assert!(f64::from(pulled) * 50e-6 > 0.9 * wake_s, "{pulled} ticks");
            bench.settle();
            assert_eq!((bench.fault(), bench.mode()), (None, Mode::Holding));
        }
    }
}

/// The twins: bridges that do not wake up in their time, and one that has a fault as soon as it is awake.
#[test]
fn a_bridge_that_does_not_wake_up_is_a_fault() {
    let mut bench = Bench::new(&waking(5e-3));
    bench.send("FRF\n");
    bench.run_until("awake", |bench| bench.outputs.awake);
    let begun = bench.sample().tick;
    bench.run_until("a fault", |bench| bench.fault().is_some());
    let waited = bench.sample().tick - begun;
    assert_eq!(bench.fault_kind(), Some(FaultKind::BridgeFault));
    assert!(
        !bench.outputs.awake && (40..=44).contains(&waited),
        "{waited}"
    );

    let mut bench = Bench::new(&waking(BRIDGE.wake_s));
    bench.rig.front.bridges[2].set_fault(true);
    bench.send("FRF\n");
    bench.run_until("a fault", |bench| bench.fault().is_some());
    let fault = bench.fault().expect("a fault");
    assert_eq!((fault.kind, fault.pivot), (FaultKind::BridgeFault, Some(2)));
}

/// A spike on a fault pin that one tick happens to see is none; two in a row are.
#[test]
fn a_fault_pin_is_believed_in_its_second_tick() {
    for (ticks, is_fault) in [(1, false), (2, true)] {
        let mut bench = turning(&machine(), 60.0);
        for _ in 0..3 {
            bench.rig.front.bridges[1].set_fault(true);
            bench.run(ticks);
            bench.rig.front.bridges[1].set_fault(false);
            bench.run(1);
        }
        let kind = is_fault.then_some(FaultKind::BridgeFault);
        assert_eq!(bench.fault_kind(), kind);
    }
}
