//! What a motor's current tells that nothing else does so soon: a lost lead, a sensor that is off or stuck; and machines that explain theirs.

use firmware::fault::FaultKind;
use firmware::mode::Mode;
use firmware::parameters::Parameters;
use hal_sim::front::Wiring;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::External;
use tests::Bench;
use tests::trouble::PIVOT;

const UNEXPLAINED: u32 = 0x5450_0513;
const COUNTS_PER_A: f64 = 1.0 / firmware::control::units::CURRENT_A_PER_COUNT;

fn ticks_to_fault(bench: &mut Bench, most: u32) -> u32 {
    (0..most)
        .find(|_| {
            bench.tick();
            bench.fault().is_some()
        })
        .unwrap_or(most)
}

/// Ticks of a jog that speeds up with a lead of its motor lost.
fn without_lead(unexplained_a: f64) -> (Bench, u32) {
    let mut bench = Bench::holding(&[(UNEXPLAINED, unexplained_a)]);
    bench.rig.front.wiring[PIVOT] = Wiring::Open;
    bench.send("JOG W 100\n");
    let ticks = ticks_to_fault(&mut bench, 4_000);
    (bench, ticks)
}

#[test]
fn a_lost_lead_is_told_as_that_and_before_the_pivot_is_too_far_off() {
    let (bench, ticks) = without_lead(1.0);
    let fault = bench.fault().expect("a fault");
    println!("{fault}, {ticks} ticks");
    assert_eq!(
        (fault.kind, fault.pivot),
        (FaultKind::CurrentUnexplained, Some(PIVOT as u8))
    );
    // A reading of nothing that stays the same, on converters without noise, is unexplained from half of it on.
    assert!(fault.value.abs() > fault.limit && fault.limit > 0.49);
    assert_eq!((bench.mode(), bench.outputs.awake), (Mode::Fault, true));
    // Without this watch: later, and as something else.
    let (twin, later) = without_lead(20.0);
    assert_eq!(twin.fault_kind(), Some(FaultKind::FollowingError));
    assert!(ticks < later, "{ticks} and {later} ticks");
}

/// What comes of `FRF` with a motor wired like this, and the fault's tick since the bridges were woken; the largest way of a pivot meanwhile.
fn referenced_with(stage: &StageParameters, wiring: Wiring) -> (Bench, Option<u64>, f64) {
    let mut bench = Bench::new(stage);
    bench.rig.front.wiring[PIVOT] = wiring;
    let before = bench.rig.front.stage.plant.pivots_rad();
    bench.send("FRF\n");
    bench.run_until("awake", |bench| bench.outputs.awake);
    let mut moved_rad = 0.0_f64;
    let mut found = None;
    for tick in 0..300 {
        bench.tick();
        found = found.or(bench.fault().map(|_| tick));
        let now = bench.rig.front.stage.plant.pivots_rad();
        for (now, before) in now.iter().zip(before) {
            moved_rad = moved_rad.max((now - before).abs());
        }
    }
    (bench, found, moved_rad)
}

/// At rest, before anything is driven: a lead, and a direction that is stuck either way. On the reference stage and one that is 35 % off.
#[test]
fn leads_are_tested_when_the_servo_goes_on() {
    let mut weak = StageParameters::REFERENCE;
    weak.plant.resistance_ohm *= 1.35;
    weak.plant.inductance_h *= 1.35;
    for stage in [StageParameters::REFERENCE, weak] {
        let (bench, found, moved_rad) = referenced_with(&stage, Wiring::Sound);
        println!("{:.1} urad to and fro", moved_rad * 1e6);
        assert_eq!((bench.mode(), found), (Mode::Holding, None));
        assert!(moved_rad < 20e-6, "{moved_rad}");
        for wiring in [
            Wiring::Open,
            Wiring::Direction { forward: true },
            Wiring::Direction { forward: false },
        ] {
            let (bench, found, _) = referenced_with(&stage, wiring);
            let fault = bench.fault().expect("a fault");
            println!("{wiring:?}: {fault}");
            assert_eq!(
                (fault.kind, fault.pivot),
                (FaultKind::CurrentUnexplained, Some(PIVOT as u8))
            );
            assert!(found.is_some_and(|tick| tick < 57), "{found:?}");
            assert!(
                fault.value.abs() > fault.limit && fault.limit > 0.1,
                "{fault}"
            );
        }
    }
}

/// Who has turned the largest voltage down gets no more for the test; what it drives then is too little to tell a lead by.
#[test]
fn leads_are_tested_with_no_more_than_the_voltage_that_is_allowed() {
    for (limit_v, is_told) in [(48.0, true), (2.0, false)] {
        let mut parameters = Parameters::REFERENCE;
        parameters.power.voltage_limit_v = limit_v;
        let mut bench = Bench::told(&StageParameters::REFERENCE, &parameters);
        bench.rig.front.wiring[PIVOT] = Wiring::Open;
        bench.send("FRF\n");
        bench.run_until("awake", |bench| bench.outputs.awake);
        let mut most = 0;
        for _ in 0..80 {
            bench.tick();
            let largest = bench
                .outputs
                .duty
                .map(|duty| duty.0.abs())
                .into_iter()
                .max();
            most = most.max(largest.unwrap_or(0));
        }
        let most_v = f64::from(most) * 48.0 / f64::from(parameters.power.pwm_counts);
        println!("{limit_v} V: {most_v:.2} V");
        assert!(most_v < limit_v * 1.01 && most_v > 0.9 * limit_v.min(4.0));
        assert_eq!(bench.fault().is_some(), is_told);
    }
}

/// A ring that somebody turns gives back what is no answer to a voltage: nothing is said of its leads.
#[test]
fn a_ring_that_is_turned_says_nothing_of_its_leads() {
    let mut bench = Bench::new(&StageParameters::REFERENCE);
    bench.send("FRF\n");
    bench.run_until("awake", |bench| bench.outputs.awake);
    let mut external = External::default();
    external.ring_torque_n_m[PIVOT] = -107.0;
    bench.rig.front.stage.plant.set_external(external);
    let ticks = ticks_to_fault(&mut bench, 2_000);
    println!("{:?} after {ticks} ticks", bench.fault());
    assert_ne!(bench.fault_kind(), Some(FaultKind::CurrentUnexplained));
    assert!(bench.fault().is_some());
}

/// A converter that repeats a sample, from when the stage speeds up on: found by how far the current has gone by then, which is less than
/// what it may be off by.
#[test]
fn a_reading_that_stays_the_same_while_the_current_does_not_is_a_fault() {
    let stuck = |unexplained_a: f64| {
        let mut bench = Bench::holding(&[(UNEXPLAINED, unexplained_a)]);
        bench.rig.front.stage.stick_current_sensor(PIVOT);
        bench.send("JOG W 100\n");
        let ticks = ticks_to_fault(&mut bench, 4_000);
        println!("{:?} after {ticks} ticks", bench.fault());
        bench.fault()
    };
    let fault = stuck(1.5).expect("a fault");
    assert_eq!(
        (fault.kind, fault.pivot),
        (FaultKind::CurrentUnexplained, Some(PIVOT as u8))
    );
    assert!((0.74..0.76).contains(&fault.limit), "{fault}");
    // Where it may be off by as much as it goes, it is none: the loop does not need it.
    assert_eq!(stuck(20.0), None);
}

/// With the servo off no current flows: a sensor that shows some for 0.1 s is off, or a bridge conducts that is to be open.
#[test]
fn a_current_with_the_servo_off_is_a_fault_where_the_machine_is_commissioned() {
    let off_by = |amperes: f64, commissioned: bool| {
        let mut parameters = Parameters::REFERENCE;
        parameters.commissioned = commissioned;
        let mut bench = Bench::told(&StageParameters::REFERENCE, &parameters);
        bench.run(10);
        bench.rig.front.stage.analog_inputs().current_offset_counts[PIVOT] = amperes * COUNTS_PER_A;
        let ticks = ticks_to_fault(&mut bench, 3_000);
        (bench.fault_kind(), ticks)
    };
    let (kind, ticks) = off_by(-1.1, true);
    assert_eq!(kind, Some(FaultKind::CurrentUnexplained));
    assert!((2_000..2_010).contains(&ticks), "{ticks}");
    assert_eq!(off_by(0.9, true).0, None);
    assert_eq!(off_by(-1.1, false).0, None);
}

/// A controller that has not been told of its machine, which is 35 % off in everything that makes currents: hard motion, all at once.
#[test]
fn a_machine_that_is_not_as_it_is_told_explains_its_currents_all_the_same() {
    let mut longest = 0.0_f64;
    'machines: for bits in 0..16 {
        let off = |bit: u32| if bits >> bit & 1 == 0 { 0.65 } else { 1.35 };
        let mut stage = StageParameters::REFERENCE;
        let plant = &mut stage.plant;
        plant.resistance_ohm *= off(0);
        plant.torque_constant_n_m_a *= off(1);
        plant.ring_inertia_kg_m2 *= off(2);
        plant.motor_inertia_kg_m2 *= off(2);
        plant.inductance_h *= off(3);
        let mut bench = Bench::new(&stage);
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        for line in [
            "MOV X 30 Y 20 W 120",
            "MOV X -30 W -60",
            "JOG W 340",
            "JOG W -340",
            "HLT",
        ] {
            bench.send(&format!("{line}\n"));
            for _ in 0..6_000 {
                bench.tick();
                if let Some(fault) = bench.fault() {
                    // A loop with so much more gain than it was made for may oscillate; that is told rightly.
                    let gain = off(1) / (off(0) * off(2));
                    println!("{bits:04b}, gain {gain:.2}, {line}: {fault}");
                    assert!(fault.kind == FaultKind::Oscillation && gain > 1.4);
                    continue 'machines;
                }
                longest = longest.max(bench.following_errors().into_iter().fold(0.0, f64::max));
            }
        }
    }
    println!("{longest} counts of following error at most");
}

/// A coupling that comes loose in a jog makes its servo oscillate, faster than motion does.
#[test]
fn a_servo_that_oscillates_in_motion_is_found() {
    let mut bench = Bench::turning(&[], 200.0);
    let mut external = External::default();
    external.loose_rad[PIVOT] = 4e-4;
    bench.rig.front.stage.plant.set_external(external);
    let ticks = ticks_to_fault(&mut bench, 20_000);
    println!("{:?} after {ticks} ticks", bench.fault());
    assert_eq!(bench.fault_kind(), Some(FaultKind::Oscillation));
    let twin = &mut Bench::turning(&[], 200.0);
    assert_eq!(ticks_to_fault(twin, 20_000), 20_000);
}
