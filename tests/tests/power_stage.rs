//! Bus, brake resistor, bridges with limits, and the limit of the motors' currents.

use firmware::drivers::bridge::Duty;
use firmware::drivers::power_stage::BRIDGE;
use firmware::fault::FaultKind;
use firmware::mode::Mode;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::Imperfections;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use tests::Bench;

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

/// What three motors give back in a stop raises the bus until the resistor takes it; without a resistor it is a fault before the
/// bridges' 60 V.
#[test]
fn what_a_stop_gives_back_goes_into_the_resistor() {
    let stopped = |brake_resistor_ohm: f64| {
        let mut stage = machine();
        stage.bus.brake_resistor_ohm = brake_resistor_ohm;
        // A capacitor that is spent: with the one of the reference stage an empty platform's stop ends under 54 V.
        stage.bus.capacitor_f = 1e-3;
        let mut bench = turning(&stage, 360.0);
        // Stopped by command.
        assert_eq!(bench.error_after("HLT"), "10");
        bench.run(10_000);
        bench
    };
    let bench = stopped(8.2);
    let (highest_v, resistor_j) = bus(&bench);
    println!("{highest_v:.1} V, {resistor_j:.2} J");
    assert_eq!((bench.fault(), bench.mode()), (None, Mode::Holding));
    assert!((54.0..54.5).contains(&highest_v) && resistor_j > 0.5);
    let without = stopped(1e6);
    println!("without: {:.1} V", bus(&without).0);
    assert_eq!(without.fault_kind(), Some(FaultKind::SupplyHigh));
    assert!(bus(&without).0 < 60.0);
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
