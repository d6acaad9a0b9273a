//! What a motor's current tells that nothing else does so soon: a lost lead, a sensor that is off; and machines that explain theirs.

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
    assert!(fault.value.abs() > fault.limit && fault.limit > 1.0);
    assert_eq!((bench.mode(), bench.outputs.awake), (Mode::Fault, true));
    // Without this watch: later, and as something else.
    let (twin, later) = without_lead(20.0);
    assert_eq!(twin.fault_kind(), Some(FaultKind::FollowingError));
    assert!(ticks < later, "{ticks} and {later} ticks");
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
