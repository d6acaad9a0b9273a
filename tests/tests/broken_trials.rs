//! Trials of iterative learning that do not come to their end: the table stays what it was, and the next trial is as good as the last one.

use firmware::fault::FaultKind;
use hal_sim::machine::devices::EncoderFault;
use tests::Bench;
use tests::repeated::{BACK, OUT};

/// Ticks into the way out after which something happens: at its start, in the middle, where it slows down. It takes 4,370; at 3,300 no
/// stop is sooner than its end.
const AFTER: [u32; 3] = [60, 1_700, 2_600];
/// Ticks in which a table would be through, with what follows its motion.
const THROUGH: u32 = 5_000;
/// Trials before.
const TRIALS: u32 = 4;

/// A table that has learnt, and its error in the last trial, encoder counts.
fn learnt() -> (Bench, f64) {
    let mut bench = Bench::repeating(20.0, "");
    assert_eq!(bench.error_after("ILC LEARN OUT"), "0");
    let errors: Vec<f64> = (0..TRIALS).map(|_| bench.way_out()).collect();
    (bench, errors[TRIALS as usize - 1])
}

/// Breaks the way out off, gets the stage back to where that starts, and looks at the table and the next trial.
fn broken(what: &str, break_off: impl Fn(&mut Bench), mend: impl Fn(&mut Bench)) {
    for after in AFTER {
        let (mut bench, last) = learnt();
        let before = bench.table("OUT");
        bench.say(OUT);
        bench.run(after);
        assert_eq!(bench.value("ONT? X"), 0.0, "{what}: over after {after}");
        break_off(&mut bench);
        bench.run(THROUGH);
        assert_eq!(bench.table("OUT"), before, "{what} after {after}");
        mend(&mut bench);
        bench.settle();
        assert_eq!(bench.table("OUT"), before, "{what} after {after}, mended");
        // From elsewhere, and so with no table.
        bench.say(BACK);
        bench.settle();
        assert_eq!(bench.table("OUT"), before, "{what} after {after}, back");
        // Friction is in another state than after a whole trial.
        bench.way_out();
        let next = bench.way_out();
        println!(
            "{what} after {after}: {last:.3} and {next:.3}; {}",
            bench.table("OUT")
        );
        assert!(
            bench
                .table("OUT")
                .contains(&format!("TRIALS={} ", TRIALS + 2)),
            "{what} after {after}"
        );
        assert!(
            next < 1.14 * last,
            "{what} after {after}: {next} after {last}"
        );
        assert_eq!(bench.fault(), None);
    }
}

/// Faults take the servo with them: acknowledged, the stage is referenced and holds.
fn acknowledge(bench: &mut Bench) {
    bench.run(20_000);
    assert_eq!(bench.error_after("FLC"), "0");
    assert_eq!(bench.error_after("FRF"), "0");
}

#[test]
fn stopped() {
    for line in ["HLT\n", "STP\n"] {
        broken(
            line.trim(),
            |bench| {
                bench.say(line);
                bench.say("ERR?\n");
                bench.settle();
            },
            |_| {},
        );
    }
}

#[test]
fn sent_elsewhere() {
    broken(
        "another target",
        |bench| {
            assert_eq!(bench.error_after("MOV X 10 Y -5 W 0"), "0");
            bench.settle();
        },
        |_| {},
    );
}

#[test]
fn switched_off() {
    broken(
        "servo off",
        |bench| {
            assert_eq!(bench.error_after("SVO X 0"), "0");
            bench.run(20_000);
            assert_eq!(bench.value("SVO? X"), 0.0);
        },
        |bench| {
            assert_eq!(bench.error_after("SVO X 1"), "0");
        },
    );
}

#[test]
fn power_lost() {
    broken(
        "power lost",
        |bench| {
            bench.rig.front.stage.set_supply_v(20.0);
            bench.run(20_000);
            assert_eq!(bench.fault_kind(), Some(FaultKind::SupplyLow));
            bench.rig.front.stage.set_supply_v(48.0);
        },
        acknowledge,
    );
}

/// A fault that stops on the path: the table is let go of where the stop begins.
#[test]
fn a_lost_encoder() {
    broken(
        "encoder lost",
        |bench| {
            bench.rig.front.stage.encoders[0].set_fault(Some(EncoderFault::StuckHigh));
            bench.run(20_000);
            assert_eq!(bench.fault_kind(), Some(FaultKind::EncoderSilent));
            bench.rig.front.stage.encoders[0].set_fault(None);
        },
        acknowledge,
    );
}
